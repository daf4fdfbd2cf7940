"""Blasting: the tone is true, the lines lie even, edges are clean, nothing depends on size, threads or chance."""

from dataclasses import replace

import numpy as np
import pytest

from penink_cli.blasting import candidates, sweep, walls
from penink_cli.blasting.blast import blast, too_dark
from penink_cli.blasting.shares import shares
from penink_cli.blasting.sheet import Sheet
from penink_cli.ground.errors import ParameterError
from penink_cli.ground.model import EdgeList, HatchLayer, Strokes, Texture
from penink_cli.options.textures import find_texture, shipped
from penink_cli.outputs.page import ink_box
from tests.blasting import measures


def flat(level: float) -> np.ndarray:
    return np.full((16, 16), level)


def ramp() -> np.ndarray:
    return np.tile(np.linspace(0, 1, 200), (100, 1))


def same(a: Strokes, b: Strokes) -> bool:
    return a.points.tobytes() == b.points.tobytes() and a.widths.tobytes() == b.widths.tobytes()


@pytest.mark.parametrize(
    ("texture", "rms", "bias"),
    [("crosshatch", 1.1, 0.4), ("parallel", 2.2, 0.8), ("stipple", 1.7, 0.9), ("scribble", 3.2, 1.3)],
)
def test_the_tone_of_a_ramp_is_true(texture, rms, bias):
    strokes = blast(ramp(), 216, 108, None, find_texture(texture))
    found = measures.tone_figures(strokes, ramp())
    assert found[0] < rms and abs(found[1]) < bias


@pytest.mark.parametrize("dpi", [300, 1200])
def test_a_device_is_allowed_for(dpi):
    strokes = blast(flat(0.4), 144, 144, None, find_texture("crosshatch"), device_dpi=dpi)
    assert abs(measures.tone_figures(strokes, flat(0.4), dpi)[1]) < 0.8


def test_the_measure_of_tone_sees_a_device_that_was_not_allowed_for():
    strokes = blast(flat(0.4), 144, 144, None, find_texture("crosshatch"), device_dpi=None)
    assert measures.tone_figures(strokes, flat(0.4), 300)[1] < -5


def test_the_papers_rule_is_too_light_and_never_too_dark():
    wanted = ramp()
    strokes = blast(wanted, 216, 108, None, find_texture("crosshatch"), rule="strict")
    assert 4 < measures.tone_figures(strokes, wanted)[1] < 16


def test_the_papers_rule_is_no_lighter_where_a_photograph_is_noisy():
    noise = np.clip(0.5 + np.random.default_rng(1).normal(0, 0.15, (200, 200)), 0, 1)
    bias = [
        measures.tone_figures(blast(t, 200, 200, None, find_texture("crosshatch"), rule="strict"), t)[1]
        for t in (flat(0.5), noise)
    ]
    assert bias[1] < bias[0] + 3


def test_the_threshold_rule_draws_nothing_where_the_paper_is_white():
    wanted = np.zeros((50, 50))
    wanted[:, 25:] = 0.5
    strokes = blast(wanted, 144, 144, None, find_texture("lawn"), rule="threshold")
    assert len(strokes) > 50 and strokes.points[:, 0].min() > 68


def test_size_changes_neither_tone_nor_pen():
    found = []
    for side in (100, 200, 300):
        strokes = blast(flat(0.3), side, side, None, find_texture("crosshatch"), pen_pt=0.85)
        assert set(strokes.widths.tolist()) == {0.85}
        found.append(measures.lengths(strokes).sum() / side**2)
    assert max(found) / min(found) < 1.06


@pytest.mark.parametrize(("level", "angle"), [(0.2, -45.0), (0.55, 45.0)])
def test_hatching_on_a_flat_field_lies_even_but_is_not_ruled(level, angle):
    texture = find_texture("crosshatch")
    found = measures.evenness(blast(flat(level), 360, 360, None, texture), angle)
    assert found["spread"] > 0.04 and found["cv"] < 0.24
    assert found["doubled"] < 0.01 and found["gaping"] < 0.03 and found["aligned_ends"] < 0.16


def test_no_rows_of_ends_where_the_tone_changes():
    # few ends are free at all, so one hand's share of them in rows says little: three hands'
    y, x = np.mgrid[:100, :100] / 99
    for wanted, texture in ((0.02 + 0.4 * x, "parallel"), (0.3 + 0.4 * x + 0.2 * y, "crosshatch")):
        hands = [blast(wanted, 288, 288, None, find_texture(texture), seed=seed) for seed in range(3)]
        assert np.mean([measures.ends_in_rows(strokes, -45.0) for strokes in hands]) < 0.04


@pytest.mark.parametrize("texture", ["crosshatch", "stipple", "scribble"])
@pytest.mark.parametrize("level", [0.01, 0.025])
def test_a_light_flat_has_as_much_ink_as_its_tone_asks(texture, level):
    strokes = blast(flat(level), 288, 288, None, find_texture(texture))
    assert abs(measures.tone_figures(strokes, flat(level))[1]) < 0.3 * 100 * level


def test_hatching_keeps_off_the_diagonal_of_pixels_but_not_off_their_rows():
    for angle, off in ((-45.0, 1.5), (135.0, 1.5), (0.0, 0.0), (-44.0, 0.5), (30.0, 0.0)):
        c, s = sweep.heading(angle)
        assert abs(np.degrees(np.arctan2(s, c)) - angle - off) < 1e-6


def test_stubs_at_joints_are_made_one_with_their_neighbours():
    # strokes of 30, 8 and 40 points in a line, the last one a little aside, and one more that is not joined
    ends = [(0, 30, 0.0), (30.4, 38, 0.1), (38.4, 78, 0.3), (80, 85, 0.3)]
    points = np.concatenate([np.linspace([a, y], [b, y], 4) for a, b, y in ends])
    merged, first, begins = candidates.without_stubs(points, np.arange(5) * 4, np.array([True, True, False]))
    assert first.tolist() == [0, 7, 11, 15] and begins.tolist() == [0, 2, 3]
    assert np.allclose(merged[[0, 6, 7, 10]], [[0, 0], [38, 0.1], [38.4, 0.3], [78, 0.3]])
    assert np.allclose(merged[3], [30.2, 0.05])


def test_small_outlines_are_no_walls():
    turn = np.arange(24) * np.pi / 12
    y, x = np.mgrid[:200, :200] + 0.5
    for radius, walls_there in ((3.0, False), (20.0, True)):
        wanted = np.where(np.hypot(x - 100, y - 100) < 100 / 72 * radius, 0.9, 0.1)
        ring = EdgeList(
            200, 200, 100 + 100 / 72 * radius * np.column_stack([np.cos(turn), np.sin(turn)]),
            np.column_stack([np.arange(24), (np.arange(24) + 1) % 24]),
        )  # fmt: skip
        assert (len(walls.strong_edges(ring, Sheet(wanted, 144, 144, 0.0))) > 0) == walls_there


def test_the_strong_edge_nearest_to_a_point():
    ends = np.array([[20.0, 20.0], [120.0, 60.0]])
    sheet = Sheet(flat(0.5), 144, 144, 0.0)
    built = walls.build(None, sheet, 1.0)
    built = replace(
        built, segments=np.concatenate([built.segments, ends.reshape(1, 4)]), inside=np.append(built.inside, 1)
    )
    points = np.random.default_rng(1).uniform(0, 144, (4000, 2))
    part = np.clip(((points - ends[0]) * (ends[1] - ends[0])).sum(axis=1) / 100**2 / 1.16, 0, 1)
    out = points - (ends[0] + part[:, None] * (ends[1] - ends[0]))
    away = np.hypot(*out.T)
    near = away < 3
    found = walls.beside(built, points, 3.0)
    assert near.sum() > 50 and np.isinf(found.away[~near]).all() and not found.out[~near].any()
    assert np.allclose(found.away[near], away[near]) and np.allclose(found.out[near] * away[near, None], out[near])


def test_a_dark_picture_has_no_white_rim():
    ink = measures.rendered(blast(flat(0.97), 144, 144, None, find_texture("crosshatch")), 600)
    assert min(side.mean() for side in (ink[2:6], ink[-6:-2], ink[:, 2:6], ink[:, -6:-2])) > 0.97


def test_a_layer_begins_with_lines_near_each_other_and_not_for_a_spot():
    layers = find_texture("crosshatch").layers
    tone = np.linspace(0.0, 0.98, 99)[None]
    first, second = shares(tone, tone, layers)
    assert np.allclose(1 - (1 - first) * (1 - second), tone)
    assert (second[tone <= layers[1].low] == 0).all() and second[second > 0].min() > 0.08
    spot = np.full((1, 1), layers[1].low + 0.05)
    assert shares(spot, spot - 0.1, layers)[1][0, 0] == 0 and shares(spot, spot, layers)[1][0, 0] > 0


def test_the_measure_of_evenness_sees_uneven_lines():
    strict = blast(flat(0.2), 360, 360, None, find_texture("parallel"), rule="strict")
    assert measures.evenness(strict, -45.0)["cv"] > 0.4


def test_ink_on_a_flat_field_is_in_long_strokes():
    assert measures.long_share(blast(flat(0.3), 288, 288, None, find_texture("crosshatch"))) > 0.95


@pytest.mark.parametrize("texture", ["crosshatch", "lawn", "grass"])
def test_threads_change_no_byte(texture):
    wanted = np.add.outer(np.linspace(0, 0.5, 60), np.linspace(0, 0.5, 80))
    one, two, eight = (blast(wanted, 320, 200, None, find_texture(texture), threads=n) for n in (1, 2, 8))
    assert same(one, two) and same(one, eight)


def test_the_seed_changes_the_strokes_and_not_the_tone():
    a, b = (blast(flat(0.3), 144, 144, None, find_texture("crosshatch"), seed=s) for s in (0, 1))
    assert not same(a, b)
    assert all(abs(measures.tone_figures(s, flat(0.3))[1]) < 0.6 for s in (a, b))


def disc() -> tuple[np.ndarray, EdgeList]:
    y, x = np.mgrid[:300, :300] - 149.5
    turn = np.arange(90) * np.pi / 45
    circle = 150 + 75 * np.column_stack([np.cos(turn), np.sin(turn)])
    ring = np.column_stack([np.arange(90), (np.arange(90) + 1) % 90])
    return np.where(np.hypot(x, y) < 75, 0.8, 0.15), EdgeList(300, 300, circle, ring)


def test_strokes_end_at_strong_edges():
    wanted, edges = disc()
    strokes = blast(wanted, 144, 144, edges, find_texture("crosshatch"))
    ink = measures.rendered(strokes, 600)
    yy, xx = np.mgrid[: len(ink), : len(ink)] + 0.5 - len(ink) / 2
    r = np.hypot(xx, yy) * 72 / 600 - 36
    assert ink[(r < 0) & (r > -1)].mean() > 0.66
    assert ink[(r > 0) & (r < 1)].mean() < 0.22


def test_a_thin_dark_line_gets_a_stroke_along_it():
    y, x = np.mgrid[:300, :300]
    wanted = np.where(np.abs(x - 0.3 * y - 100) < 2, 0.9, 0.1)
    strokes = blast(wanted, 144, 144, None, find_texture("crosshatch"))
    slope = 0.3
    along = 0
    for i in range(len(strokes)):
        chord = strokes[i][-1] - strokes[i][0]
        if abs(chord[0] - slope * chord[1]) < 0.06 * np.hypot(*chord):
            along += np.hypot(*chord)
    assert along > 0.8 * 144


def test_outlines_count_as_ink_and_are_not_drawn_again():
    line = np.linspace([20.0, 72.0], [124.0, 72.0], 4)
    thick = Strokes(144, 144, line, np.array([0, 4]), np.array([40.0]))
    texture = find_texture("crosshatch")
    with_it, without = (blast(flat(0.5), 144, 144, None, texture, outlines=o) for o in (thick, None))
    inside = np.abs(with_it.points - 72).max(axis=1) < 10
    assert inside.sum() == 0 and (np.abs(without.points - 72).max(axis=1) < 10).sum() > 10


def test_all_ink_lies_within_the_frame():
    for name in shipped():
        strokes = blast(flat(0.4), 60, 40, None, find_texture(name))
        for i in range(len(strokes)):
            line, half = measures.flattened(strokes, i), strokes.widths[i] / 2
            assert (line - half > -0.2).all() and (line + half < (90.2, 60.2)).all(), name
        x0, y0, x1, y1 = ink_box(strokes)
        assert min(x0, y0) > -0.2 and x1 < 60.2 and y1 < 40.2, name


@pytest.mark.parametrize("level", [0.0, 1e-6, 0.5, 1.0])
@pytest.mark.parametrize("size", [(0.3, 0.2), (1, 200), (200, 1), (7, 7), (60, 60)])
@pytest.mark.parametrize("texture", ["crosshatch", "stipple", "lawn", "fur"])
def test_any_sheet_and_any_tone(texture, size, level):
    for shape in ((1, 1), (1, 40), (40, 1), (33, 17)):
        strokes = blast(np.full(shape, level), *size, None, find_texture(texture))
        assert np.isfinite(strokes.points).all() and (strokes.widths > 0).all()
        assert level > 0 or len(strokes) == 0
        assert (np.diff(strokes.first) % 3 == 1).all()


@pytest.mark.parametrize("rule", ["strict", "threshold"])
def test_every_rule_draws_no_more_than_white_paper_asks(rule):
    assert len(blast(flat(0.0), 100, 100, None, find_texture("scribble"), rule=rule)) == 0


def test_an_unknown_rule_is_named():
    with pytest.raises(ParameterError, match="worst"):
        blast(flat(0.5), 10, 10, None, find_texture("grass"), rule="worst")


def test_what_is_out_of_reach_is_counted():
    assert too_dark(np.array([[0.2, 0.9], [0.7, 0.95]]), 0.8) == 0.5


def test_a_layer_keeps_its_least_spacing():
    texture = Texture("wide", Strokes(1, 1), np.zeros(0), layers=(HatchLayer(0.0, 0.0, 0.99, 0.4, 6.0),))
    found = measures.evenness(blast(flat(0.9), 300, 300, None, texture), 0.0)
    assert found["doubled"] < 0.02
