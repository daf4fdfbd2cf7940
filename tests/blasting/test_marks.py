"""Small dark things on bare paper are drawn as themselves, nothing sticks out of them, and light ones alike."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image, ImageDraw, ImageFont

from penink_cli.blasting.blast import blast
from penink_cli.blasting.light import LightThings
from penink_cli.blasting.marks import marks
from penink_cli.blasting.sheet import coverage
from penink_cli.ground.masks import distance
from penink_cli.ground.model import Floats, Strokes
from penink_cli.options.textures import find_texture
from tests.blasting.measures import solids

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


@pytest.mark.parametrize("texture", ["crosshatch", "parallel", "stipple", "engraving"])
@pytest.mark.parametrize("diameter", [2, 3, 4, 6, 8, 12])
def test_a_black_disc_is_black_and_throws_nothing_out(texture, diameter):
    drawn = blast(disc(diameter), SIDE, SIDE, None, find_texture(texture), device_dpi=None)
    inside, stray = inside_and_stray(drawn, diameter)
    assert inside >= (0.75 if diameter > 2 else 0.6) and stray <= 0.1


def light_and_around(drawn: Strokes, diameter: float) -> tuple[float, float]:
    """How light a white disc in the middle is, and the ink from one to four points beside it."""
    ink = coverage(drawn, SIDE * FINE, SIDE * FINE)
    y, x = np.mgrid[: SIDE * FINE, : SIDE * FINE] + 0.5
    r = np.hypot(x - SIDE * FINE / 2, y - SIDE * FINE / 2) / FINE
    around = (r > diameter / 2 + 1) & (r < diameter / 2 + 4)
    return 1 - float(ink[r < diameter / 2].mean()), float(ink[around].mean())


SOME, OTHERS = ("crosshatch", "engraving", "stipple"), ("parallel", "form", "fur", "scribble", "brick")


@pytest.mark.parametrize("texture", [*SOME, *(pytest.param(name, marks=pytest.mark.slow) for name in OTHERS)])
@pytest.mark.parametrize("diameter", [2, 3, 4, 6, 8, 12])
def test_a_white_disc_in_black_is_white_and_the_black_beside_it_black(texture, diameter):
    drawn = blast(1 - disc(diameter), SIDE, SIDE, None, find_texture(texture), device_dpi=None)
    light, around = light_and_around(drawn, diameter)
    assert light >= (0.75 if diameter > 2 else 0.6) and around >= 0.97


@pytest.mark.parametrize("rule", ["strict", "engrave", "threshold"])
@pytest.mark.parametrize("diameter", [2, 3, 6])
def test_discs_by_other_rules(rule, diameter):
    drawn = blast(disc(diameter), SIDE, SIDE, None, find_texture("stipple"), device_dpi=None, rule=rule)
    inside, stray = inside_and_stray(drawn, diameter)
    assert inside >= (0.75 if diameter > 2 else 0.6) and stray <= 0.1
    drawn = blast(1 - disc(diameter), SIDE, SIDE, None, find_texture("stipple"), device_dpi=None, rule=rule)
    light, around = light_and_around(drawn, diameter)
    assert light >= (0.75 if diameter > 2 else 0.6) and around >= 0.97


@pytest.mark.parametrize("rule", ["best", "threshold"])
@pytest.mark.parametrize("texture", ["brick", "shingle"])
def test_walls_that_are_never_cut_are_not_drawn_around_a_small_thing(texture, rule):
    for diameter in (3, 6):
        drawn = blast(disc(diameter), SIDE, SIDE, None, find_texture(texture), device_dpi=None, rule=rule)
        inside, stray = inside_and_stray(drawn, diameter)
        assert inside >= 0.75 and stray <= 0.1, diameter
    wall = blast(np.maximum(disc(6), 0.3), SIDE, SIDE, None, find_texture(texture), device_dpi=None, rule=rule)
    plain = blast(np.full_like(disc(6), 0.3), SIDE, SIDE, None, find_texture(texture), device_dpi=None, rule=rule)
    assert len(wall) > 0.9 * len(plain)  # on a wall they are


@pytest.mark.parametrize("options", [{"swell": 1.0}, {"device_dpi": 600.0}, {"pen_pt": 0.5}])
def test_a_white_disc_among_swelling_strokes_for_a_printer_and_with_one_pen(options):
    drawn = blast(1 - disc(3), SIDE, SIDE, None, find_texture("form"), **{"device_dpi": None, **options})
    light, around = light_and_around(drawn, 3)
    assert light >= 0.75 and around >= 0.85  # drawn without the printer's gain, which closes it


def test_white_lettering_is_left_out_of_the_black():
    image = Image.new("L", (8 * SIDE, 8 * SIDE), 255)
    ImageDraw.Draw(image).text((60, 230), "Hamburg", 0, ImageFont.load_default(9 * 8 * 1.3))
    letters = np.asarray(image) < 128
    tone = np.where(letters, 0.0, 1.0).reshape(2 * SIDE, 4, 2 * SIDE, 4).mean(axis=(1, 3))
    for texture in ("crosshatch", "engraving"):
        ink = coverage(blast(tone, SIDE, SIDE, None, find_texture(texture), device_dpi=None), 8 * SIDE, 8 * SIDE)
        assert 1 - ink[letters].mean() >= 0.75
        beside = (distance(~letters) > 8) & (distance(~letters) < 24)
        assert ink[beside].mean() >= 0.97


def test_strokes_are_cut_at_light_things_and_nowhere_else():
    light = LightThings(1 - disc(6), SIDE, SIDE)
    across = [[x, SIDE / 2] for x in (10.0, 25.0, 45.0, 62.0)]
    beside = [[x, SIDE / 2 + 8] for x in (10.0, 25.0, 45.0, 62.0)]
    given = Strokes.of(SIDE, SIDE, [across, beside], [[0.5, 1.0], [0.5, 0.5]])
    kept = light.kept_out(given, 0.0)
    assert [len(kept[i]) for i in range(len(kept))] == [4, 4, 4]
    np.testing.assert_array_equal(kept[0], beside)
    left, right = kept[1], kept[2]
    half = 0.75 / 2  # the stroke is so wide half way along
    assert left[0].tolist() == across[0] and abs(left[3, 0] - (SIDE / 2 - 3 - half)) < 0.3
    assert right[3].tolist() == across[3] and abs(right[0, 0] - (SIDE / 2 + 3 + half)) < 0.3
    assert kept.knot_widths is not None
    np.testing.assert_allclose(kept.knot_widths[[2, 5]], [0.5, 1.0])
    assert 0.7 < kept.knot_widths[3] < kept.knot_widths[4] < 0.8
    assert LightThings(np.zeros((9, 9)), SIDE, SIDE).kept_out(given, 0.0) is given


def test_one_pen_fills_as_well():
    drawn = blast(disc(6), SIDE, SIDE, None, find_texture("crosshatch"), device_dpi=None, pen_pt=0.5)
    assert set(drawn.widths.tolist()) == {0.5}
    inside, stray = inside_and_stray(drawn, 6)
    assert inside >= 0.75 and stray <= 0.1


def test_what_is_large_soft_grey_or_in_grey_is_left_to_the_hatching():
    none = np.zeros((75, 75), np.float32)
    y, x = np.mgrid[:144, :144] - 71.5
    soft = np.exp(-(x * x + y * y) / 300)
    iris = 0.6 * disc(12) + 0.4 * disc(3)
    for tone in (disc(20), disc(6, ground=0.3), 0.6 * disc(6), soft, iris, np.ones((144, 144)), np.zeros((3, 2))):
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


def _filled(tone: Floats) -> Floats:
    """The part of 8 × 8 subpixels a point that solid black covers in the tone (144, 144)."""
    return coverage(solids(tone, SIDE, SIDE, None, 0.0, np.zeros((75, 75), np.float32)), 8 * SIDE, 8 * SIDE)


def test_grain_makes_neither_blots_in_hatching_nor_flecks_in_black():
    grain = np.random.default_rng(1).normal(0.0, 0.08, (2 * SIDE, 2 * SIDE))  # half of it is left by the smoothing
    assert _filled(np.clip(0.89 + grain, 0, 1)).mean() == 0
    assert _filled(np.clip(0.99 + grain, 0, 1)).mean() > 0.99


def test_grain_makes_no_beads_along_the_border_of_black():
    tone = np.ones((2 * SIDE, 2 * SIDE))
    tone[:, :SIDE] = 0
    for row in (10, 11, 12):
        tone[row::8, SIDE + 3 : SIDE + 6] = 0.6  # a point and a half of grain, not light
    assert _filled(tone)[:, 4 * SIDE + 8 :].mean() > 0.995


def test_a_fold_in_dark_cloth_is_filled_and_a_small_black_thing_on_grey():
    x = np.arange(2 * SIDE)[None, :] * np.ones((2 * SIDE, 1))
    fold = np.abs(x - SIDE) < 6
    drawn = _filled(np.where(fold, 1.0, 0.8))
    assert drawn[:, 8 * SIDE // 2].mean() > 0.95 and drawn[:, : 3 * SIDE].max() == 0
    assert _filled(disc(6, ground=0.5)).sum() > 0.8 * 64 * np.pi * 9


def test_a_hole_that_is_light_stays():
    assert _filled(1 - disc(6))[4 * SIDE, 4 * SIDE] == 0
