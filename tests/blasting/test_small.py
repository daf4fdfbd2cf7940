"""Small dark things on a tone are black as a whole; texture, shades and what lines have drawn are not."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from penink_cli.blasting import marks, solids
from penink_cli.blasting.blast import blast
from penink_cli.blasting.sheet import coverage
from penink_cli.options.textures import find_texture

SIDE, PX = 120, 2
NOTHING = np.zeros((SIDE * PX, SIDE * PX), np.float32)


def disc(y: float, x: float, radius: float) -> np.ndarray:
    """Where a disc is, all in points."""
    i, j = np.ogrid[: SIDE * PX, : SIDE * PX]
    return (i + 0.5 - y * PX) ** 2 + (j + 0.5 - x * PX) ** 2 < (radius * PX) ** 2


def ground(level: float) -> np.ndarray:
    return np.full((SIDE * PX, SIDE * PX), level)


def black(tone: np.ndarray, ink: np.ndarray = NOTHING) -> np.ndarray:
    """What is filled as a texture does that has white lines in its black."""
    value = solids.found(tone, SIDE, SIDE, ink, solids.BLACK, None, True, solids.LINED)
    return np.zeros(tone.shape, bool) if value is None else value > marks.LEVEL


@pytest.mark.parametrize(("level", "dark"), [(0.15, 0.88), (0.3, 0.9), (0.3, 0.93), (0.5, 0.93)])
def test_a_pupil_on_a_tone_is_black(level, dark):
    tone = ground(level)
    tone[disc(60, 60, 2.5)] = dark
    found = black(gaussian_filter(tone, 0.4 * PX))
    inside, outside = disc(60, 60, 2), ~disc(60, 60, 3.2)
    assert found[inside].mean() > 0.97
    assert not found[outside].any()


def test_a_catchlight_stays_white():
    tone = ground(0.3)
    tone[disc(60, 60, 4)] = 0.9
    tone[disc(59, 59, 1.2)] = 0.0
    found = black(tone)
    assert not found[disc(59, 59, 0.8)].any()
    assert found[disc(60, 60, 3.6) & ~disc(59, 59, 1.8)].all()


def test_a_frame_is_black_from_end_to_end():
    """Its tone varies, as a photograph's does, and nowhere reaches that of solid black."""
    tone = ground(0.2)
    tone[56 * PX : 60 * PX, 20 * PX : 100 * PX] = 0.84 + 0.08 * np.sin(np.arange(80 * PX) / 5)
    found = black(tone)
    assert found[57 * PX : 59 * PX, 22 * PX : 98 * PX].mean() > 0.98
    assert not found[: 55 * PX].any()


@pytest.mark.parametrize("dark", [0.6, 0.8])
def test_what_is_not_dark_enough_is_hatched(dark):
    tone = ground(0.15)
    tone[disc(60, 60, 3)] = dark
    assert not black(tone).any()


@pytest.mark.parametrize("seed", range(3))
def test_fur_is_texture(seed):
    """Dark hairs side by side, as dark as a pupil is, are all hatched."""
    rng = np.random.default_rng(seed)
    hairs = gaussian_filter(rng.standard_normal((SIDE * PX, SIDE * PX)), (4 * PX, 0.8 * PX))
    tone = np.clip(0.5 + 0.28 * hairs / hairs.std(), 0.05, 0.93)
    assert (tone > 0.85).mean() > 0.05
    assert black(tone).mean() < 0.02


def test_what_lines_have_drawn_is_not_filled_again():
    tone = ground(0.2)
    tone[disc(60, 60, 3)] = 0.9
    assert black(tone).any()
    assert not black(tone, disc(60, 60, 2.2).astype(np.float32)).any()


def test_a_broad_dark_place_is_no_small_thing():
    tone = ground(0.2)
    tone[disc(60, 60, 9)] = 0.85
    assert not black(gaussian_filter(tone, 3.0 * PX)).any()


def test_form_draws_it_solid():
    tone = ground(0.2)
    tone[disc(60, 60, 3)] = 0.9
    drawn = coverage(blast(tone, SIDE, SIDE, None, find_texture("form")), SIDE * PX, SIDE * PX)
    assert drawn[disc(60, 60, 2)].mean() > 0.97
