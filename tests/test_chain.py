"""The whole chain on a real photograph, each stage a process of its own, as a user types it."""

from __future__ import annotations

import json
import shlex
import subprocess
import sys

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from tests.conftest import environment

PIPELINE = """
penink detect-edges photo.png -o e.json
penink extract-samples -e e.json photo.png | penink reduce -e e.json --factor 4 |
  penink enlarge -e e.json --scale 8 --soften | penink blast --texture crosshatch --width 4in | penink to-ps > out.ps
"""


def run(script: str, folder) -> None:
    """Run a shell script in a folder where ``penink`` is this checkout."""
    penink = f'penink() {{ {shlex.quote(sys.executable)} -m penink_cli "$@"; }}\nset -euo pipefail\n'
    done = subprocess.run(
        ["bash", "-c", penink + script], cwd=folder, env=environment(), capture_output=True, check=False
    )
    assert done.returncode == 0, done.stderr.decode()
    assert not done.stderr


@pytest.fixture(scope="module")
def camera_ps(tmp_path_factory, photographs):
    folder = tmp_path_factory.mktemp("chain")
    (folder / "photo.png").write_bytes(photographs("camera").read_bytes())
    run(PIPELINE, folder)
    first = (folder / "out.ps").read_bytes()
    run(PIPELINE, folder)
    assert (folder / "out.ps").read_bytes() == first, "the same input must give the same bytes"
    return first


def test_verbose_names_options_that_choose_the_same(penink, photographs, tmp_path):
    photo = photographs("coins")
    done = penink("detect-edges", "-v", photo, "-o", tmp_path / "e.json")
    chosen, found = done.stderr.decode().splitlines()
    again = penink("detect-edges", *chosen.split(": ")[1].split(";")[0].split(), photo)
    assert again.stdout == (tmp_path / "e.json").read_bytes()
    assert found == "{} edges, {} vertices".format(*(len(json.loads(again.stdout)[k]) for k in ("edges", "vertices")))
    done = penink("extract-samples", "-v", "-e", tmp_path / "e.json", photo)
    options = done.stderr.decode().split(": ")[1].split(";")[0].split()
    assert penink("extract-samples", "-e", tmp_path / "e.json", *options, photo).stdout == done.stdout


def test_the_drawing_has_the_tone_of_the_photograph(camera_ps, photographs, ghostscript):
    from PIL import Image

    drawing = ghostscript(camera_ps, dpi=128, antialias=True)
    assert drawing.shape == (512, 512)  # 4 in at 128 dpi
    photo = np.asarray(Image.open(photographs("camera")), dtype=np.float64) / 255
    blur = 128 / 16
    difference = gaussian_filter(drawing, blur) - gaussian_filter(photo, blur)
    assert np.sqrt((difference**2).mean()) < 0.05
    assert abs(difference.mean()) < 0.03


def test_the_drawing_is_strokes_and_not_a_halftone(camera_ps, ghostscript):
    drawing = ghostscript(camera_ps, dpi=600, antialias=False)
    assert set(np.unique(drawing)) <= {0.0, 1.0}
    assert 0.2 < drawing.mean() < 0.8


@pytest.mark.parametrize("width", ["5pt", "10pt", "0.2in", "20pt", "30pt"])
@pytest.mark.parametrize("style", ["house", "true", "engraving"])
def test_a_photograph_is_drawn_as_small_as_an_initial(penink, tmp_path, photographs, style, width):
    """Where a whole picture has a few dozen pixels, stages differ in shape by a rounding."""
    done = penink("draw", photographs("horse"), "--style", style, "--width", width, "--as", "svg")
    assert done.returncode == 0, done.stderr.decode()
    assert b"shape" not in done.stderr
    assert done.stdout.count(b"<path") > 0
