"""What the method is for: against scenes whose every tone is known."""

from __future__ import annotations

import pytest

from penink_cli.reconstruction.enlarge import reconstruct
from tests.reconstruction.scenes import SCENES, psnr, tones


@pytest.mark.parametrize("name", SCENES)
def test_a_known_scene_comes_back(name):
    make, least = SCENES[name]
    tone, edges = make()
    truth = tones(tone, 256)
    plain = psnr(reconstruct(tones(tone, 32), None, 256, 256), truth)
    found = psnr(reconstruct(tones(tone, 32), edges, 256, 256), truth)
    assert found >= least
    assert found > plain + 12
