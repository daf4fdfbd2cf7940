"""Engraving: lines that swell have the tone, lie evenly, and go on smoothly."""

from dataclasses import replace

import numpy as np
import pytest

from penink_cli.blasting.blast import blast
from penink_cli.ground.model import Directions, EdgeList, Engraving, Strokes, Texture
from penink_cli.options.textures import find_texture
from tests.blasting import measures
from tests.textures.shipped import ENGRAVINGS


def flat(tone, shape=(40, 40)):
    return np.full(shape, tone)


def ramp(columns=300, rows=100):
    return np.tile(np.linspace(0, 1, columns), (rows, 1))


def engraved(kind=None, **changes):
    kind = replace(kind or Engraving(), **changes)
    return Texture("engraved", Strokes(9, 9), np.zeros(0), engraving=kind)


def swirl(side=40):
    """A field of rings about a corner."""
    y, x = np.mgrid[0:side, 0:side] + 0.5
    angle = 2 * (np.arctan2(y, x) + np.pi / 2)
    return Directions(np.cos(angle), np.sin(angle), np.ones((side, side)))


@pytest.mark.parametrize("name", ENGRAVINGS)
@pytest.mark.parametrize("tone", [0.05, 0.15, 0.5, 0.9])
def test_every_engraving_has_the_tone(name, tone):
    strokes = blast(flat(tone), 144, 144, None, find_texture(name))
    rms, bias, _ = measures.tone_figures(strokes, flat(tone))
    assert rms < 1.0 and abs(bias) < 0.5


def test_tone_goes_on_evenly_where_dashes_and_solids_begin():
    strokes = blast(ramp(), 288, 96, None, find_texture("engraving"))
    tone = 100 * np.linspace(0, 1, 400) - measures.tone_error(strokes, ramp())[20:-20].mean(axis=0)
    steps = np.diff(tone[10:-10:4])
    assert steps.min() > -0.35 and steps.max() < 1.5 + 1  # one in a hundred is what the ramp itself climbs


def test_white_is_left_bare_and_black_is_filled():
    assert len(blast(flat(0.0), 100, 100, None, find_texture("engraving"))) == 0
    solid = blast(flat(1.0), 100, 100, None, find_texture("engraving"))
    assert measures.rendered(solid, 600)[20:-20, 20:-20].mean() > 0.999


@pytest.mark.parametrize(("directions", "most"), [(None, 0.05), (swirl(), 0.12)])
def test_lines_lie_evenly(directions, most):
    strokes = blast(flat(0.4), 200, 200, None, find_texture("engraving"), directions=directions)
    page = measures.rendered(strokes, 600)
    gaps = []
    for across in (page[200:-200:97], page[:, 200:-200:97].T):
        for row in across:
            changes = np.flatnonzero(np.diff((row > 0.5).astype(int), prepend=0, append=0))
            middles = changes.reshape(-1, 2).mean(axis=1)
            gaps.append(np.diff(middles)[2:-2])
    if directions is None:  # one angle: each way of scanning has its own distance
        for some in (gaps[: len(gaps) // 2], gaps[len(gaps) // 2 :]):
            pooled = np.concatenate(some)
            assert pooled.std() / pooled.mean() < most + 0.02  # whole pixels of some 14
    else:
        points = strokes.points
        away = np.hypot(*(points - 0).T)
        rings = np.sort(np.array([np.hypot(*strokes[i].T).mean() for i in range(len(strokes))]))
        assert len(rings) > 50 and away.max() > 190
        apart = np.diff(np.unique(np.round(rings, 1)))
        apart = apart[apart > 0.5]
        assert apart.std() / apart.mean() < 0.5


def test_widths_are_smooth_along_a_line():
    strokes = blast(ramp(), 288, 96, None, find_texture("engraving-straight"))
    widths, knots = strokes.at_knots, strokes.knots
    bends = []
    for i in np.flatnonzero(np.diff(knots) > 12):
        bends.append(np.abs(np.diff(widths[knots[i] : knots[i + 1]], 2))[4:-4])
    bends = np.concatenate(bends)
    assert len(bends) > 1000
    assert np.quantile(bends, 0.99) < 0.1 * 2.0  # a tenth of the distance of knots


def test_lines_stop_at_strong_edges():
    tone = np.where(np.arange(60) < 30, 0.8, 0.1)[None].repeat(60, axis=0)
    edges = EdgeList(60, 60, np.array([[30.0, 0.0], [30.0, 60.0]]), np.array([[0, 1]]))
    strokes = blast(tone, 120, 120, edges, find_texture("engraving"))
    for i in range(len(strokes)):
        x = strokes[i][:, 0]
        assert x.max() < 60.5 or x.min() > 59.5


def test_what_is_dark_ends_at_an_edge_without_a_saw():
    side = 120
    a, b = np.array([40.0, 0.0]), np.array([75.0, 120.0])  # some 30 degrees from the lines
    y, x = np.mgrid[0:side, 0:side] + 0.5
    beyond = (x - a[0]) - (y - a[1]) * (b - a)[0] / (b - a)[1]
    tone = np.where(beyond < 0, 0.7, 0.1)
    edges = EdgeList(side, side, np.array([a, b]), np.array([[0, 1]]))
    page = measures.rendered(blast(tone, side, side, edges, find_texture("engraving"), device_dpi=None), 600)
    rows, columns = np.mgrid[0 : len(page), 0 : page.shape[1]] * (72 / 600)
    away = ((columns - a[0]) - (rows - a[1]) * (b - a)[0] / (b - a)[1]) * (b - a)[1] / np.hypot(*(b - a))
    inner = (rows > 5) & (rows < side - 5)
    assert page[inner & (away > -0.7) & (away < -0.15)].mean() > 0.93
    assert page[inner & (away > 0.15) & (away < 1.5)].mean() < 0.2


def test_rings_lie_about_their_centre():
    strokes = blast(flat(0.5), 120, 120, None, engraved(along=False, centre=(0.25, 0.75)))
    for i in np.flatnonzero(np.diff(strokes.first) > 30):
        if np.ptp(strokes[i], axis=0).min() < 0.01:
            continue  # along the frame
        away = np.hypot(*(strokes[i][::3] - (30, 90)).T)
        assert np.ptp(away) < 1.0


def test_as_many_lines_at_any_size():
    few, many = (blast(flat(0.5), side, side, None, engraved(lines=40)) for side in (100, 300))
    spacing = [np.median(s.widths) / s.width for s in (few, many)]
    assert spacing[1] == pytest.approx(spacing[0], rel=0.15)
    assert len(blast(flat(0.5), 300, 300, None, engraved())) > 1.5 * len(many)


def test_any_texture_is_engraved_by_the_rule():
    strokes = blast(flat(0.5), 60, 60, None, find_texture("crosshatch"), rule="engrave")
    assert strokes.knot_widths is not None


def test_a_plotters_pen_draws_the_hatching_that_stands_for_it():
    strokes = blast(flat(0.5), 60, 60, None, find_texture("engraving"), pen_pt=0.5, device_dpi=None)
    assert strokes.knot_widths is None and set(strokes.widths.tolist()) == {0.5}


def test_ink_that_is_there_counts_and_threads_do_not():
    bar = Strokes.of(100, 100, [[[0, 50], [30, 50], [60, 50], [100, 50]]], [20.0])
    texture = find_texture("engraving")
    one, two = (blast(ramp(50, 50), 100, 100, None, texture, outlines=bar, threads=n) for n in (1, 2))
    assert np.array_equal(one.points, two.points) and np.array_equal(one.at_knots, two.at_knots)
    less = blast(ramp(50, 50), 100, 100, None, texture)
    near = [s.widths[np.abs(s.points[s.first[:-1], 1] - 50) < 5].sum() for s in (one, less)]
    assert near[0] < near[1]


@pytest.mark.parametrize("size", [(0.3, 0.2), (1, 200), (200, 1), (7, 7)])
@pytest.mark.parametrize("name", ENGRAVINGS)
def test_any_sheet(name, size):
    for level in (0.0, 0.05, 0.5, 1.0):
        strokes = blast(flat(level, (3, 5)), *size, None, find_texture(name))
        assert np.isfinite(strokes.points).all() and (strokes.widths > 0).all()


def test_where_it_crosses_a_second_set_of_lines_does_and_the_tone_is_kept():
    def angles(strokes):
        ends = strokes.points[strokes.first[1:] - 1] - strokes.points[strokes.first[:-1]]
        ends = ends[np.hypot(*ends.T) > 20]
        return set(np.round(np.degrees(np.arctan2(ends[:, 1], ends[:, 0])) % 180))

    light, dark = (blast(flat(tone), 140, 140, None, engraved(crosses=0.5)) for tone in (0.4, 0.75))
    assert 25.0 not in angles(light)
    assert {150.0, 25.0} <= angles(dark)
    assert abs(measures.tone_error(dark, flat(0.75))[20:-20, 20:-20].mean()) < 0.3
