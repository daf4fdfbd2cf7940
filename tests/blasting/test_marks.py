"""Small dark things on bare paper are drawn as themselves, and nothing sticks out of them."""

from __future__ import annotations

import numpy as np
import pytest

from penink_cli.blasting.blast import blast
from penink_cli.blasting.marks import marks
from penink_cli.blasting.sheet import coverage
from penink_cli.ground.model import Floats, Strokes
from penink_cli.options.textures import find_texture

SIDE, FINE = 72, 8  # the sheet, points; what it is looked at in, pixels a point


def disc(diameter: float, ground: float = 0.0) -> Floats:
    """Tone (144, 144) of a black disc of so many points in the middle of the sheet."""
    n = 8 * SIDE
    y, x = np.mgrid[:n, :n] + 0.5
    inside = np.hypot(x - n / 2, y - n / 2) < 4 * diameter
    return np.where(inside, 1.0, ground).reshape(2 * SIDE, 4, 2 * SIDE, 4).mean(axis=(1, 3))


def inside_and_stray(drawn: Strokes, diameter: float) -> tuple[float, float]:
    """Tone inside the disc, and ink further than a point outside it, in parts of the disc."""
    ink = coverage(drawn, SIDE * FINE, SIDE * FINE)
    y, x = np.mgrid[: SIDE * FINE, : SIDE * FINE] + 0.5
    r = np.hypot(x - SIDE * FINE / 2, y - SIDE * FINE / 2) / FINE
    area = np.pi * diameter * diameter / 4
    return float(ink[r < diameter / 2].mean()), float(ink[r > diameter / 2 + 1].sum()) / FINE**2 / area


@pytest.mark.parametrize("texture", ["crosshatch", "parallel", "stipple"])
@pytest.mark.parametrize("diameter", [2, 3, 4, 6, 8, 12])
def test_a_black_disc_is_black_and_throws_nothing_out(texture, diameter):
    drawn = blast(disc(diameter), SIDE, SIDE, None, find_texture(texture), device_dpi=None)
    inside, stray = inside_and_stray(drawn, diameter)
    assert inside >= (0.75 if diameter > 2 else 0.6) and stray <= 0.1


def test_one_pen_fills_as_well():
    drawn = blast(disc(6), SIDE, SIDE, None, find_texture("crosshatch"), device_dpi=None, pen_pt=0.5)
    assert set(drawn.widths.tolist()) == {0.5}
    inside, stray = inside_and_stray(drawn, 6)
    assert inside >= 0.75 and stray <= 0.1


def test_what_is_large_soft_grey_or_in_grey_is_left_to_the_hatching():
    none = np.zeros((75, 75), np.float32)
    y, x = np.mgrid[:144, :144] - 71.5
    soft = np.exp(-(x * x + y * y) / 300)
    for tone in (disc(20), disc(6, ground=0.3), 0.6 * disc(6), soft, np.ones((144, 144)), np.zeros((3, 2))):
        assert len(marks(tone, SIDE, SIDE, 0.4, 0.0, False, none)) == 0
    assert len(marks(disc(6), SIDE, SIDE, 0.4, 0.0, False, none)) > 0


def test_what_is_inked_is_not_drawn_again():
    black = np.ones((75, 75), np.float32)
    assert len(marks(disc(6), SIDE, SIDE, 0.4, 0.0, False, black)) == 0


def test_coarse_samples_and_the_sheet_s_rim_do_no_harm():
    tone = np.zeros((18, 18))
    tone[0, 0] = tone[9, 17] = 1.0
    drawn = blast(tone, SIDE, SIDE, None, find_texture("crosshatch"))
    assert np.isfinite(drawn.points).all()
