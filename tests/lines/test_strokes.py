"""Telling lines as strokes: chosen by rank, with room around each, as wide as they weigh."""

from __future__ import annotations

import numpy as np
import pytest

from penink_cli.blasting.telling import with_room
from penink_cli.ground.device import widened
from penink_cli.ground.model import LineChoice, Lines
from penink_cli.lines.choice import chosen, least_rank
from penink_cli.lines.strokes import line_strokes


def listed(*lines: tuple, width: int = 400, height: int = 300) -> Lines:
    """Lines from (points, rank) or (points, rank, members)."""
    points = [np.array(line[0], float) for line in lines]
    more = [line[2] if len(line) > 2 else {} for line in lines]
    first = np.concatenate([[0], np.cumsum([len(p) for p in points])]).astype(np.int64)
    return Lines(
        width, height, np.concatenate(points), first,
        np.concatenate([np.broadcast_to(m.get("weight", 1.0), len(p)) for m, p in zip(more, points)]),
        np.array([line[1] for line in lines], float), np.array([m.get("white", False) for m in more]),
        np.array([m.get("breadth", 0.0) for m in more], float),
    )  # fmt: skip


def straight(y: float, x: float = 20, to: float = 380) -> np.ndarray:
    xs = np.linspace(x, to, 91)
    return np.column_stack([xs, np.full(91, float(y))])


def test_the_most_telling_come_first_and_white_ones_not():
    lines = listed((straight(50), 2), (straight(150), 5), (straight(250), 9, {"white": True}), (straight(290), 3))
    assert chosen(lines, 432, 324, LineChoice()).tolist() == [1, 3, 0]
    assert chosen(lines, 432, 324, LineChoice(), white=True).tolist() == [2]
    assert len(line_strokes(lines, 432, 324, LineChoice())) == 3


def test_there_is_room_for_more_lines_on_a_larger_sheet():
    lines = listed(*((straight(100 + 2.5 * k), 3 - 0.05 * k) for k in range(40)))
    counts = [len(chosen(lines, w, 0.75 * w, LineChoice(per_inch2=50))) for w in (144, 432, 1728)]
    assert counts[0] < counts[1] < counts[2] <= 40
    dense, sparse = (len(chosen(lines, 432, 324, LineChoice(density=d, per_inch2=50))) for d in (0.3, 0.06))
    assert sparse < counts[1] < dense


@pytest.mark.parametrize("per_inch2", [0.5, 1, 2])
def test_ink_is_bounded_by_the_square_inch(per_inch2):
    lines = listed(*((straight(5 + 5 * k), 3) for k in range(55)))
    drawn = line_strokes(lines, 432, 324, LineChoice(per_inch2=per_inch2, density=9))
    assert 0 < 388.8 / 72 * len(drawn) <= per_inch2 * 6 * 4.5


def test_small_prints_take_higher_ranks_unless_told():
    assert least_rank(72, 72) > least_rank(432, 432) > least_rank(1728, 1728)
    lines = listed((straight(100), 0.9))
    assert len(chosen(lines, 72, 54, LineChoice())) == 0
    assert len(chosen(lines, 72, 54, LineChoice(min_rank=0.5))) == 1
    assert len(chosen(listed((straight(100, 20, 30), 9)), 72, 54, LineChoice())) == 0  # 1.8 pt long


def test_strokes_lie_on_the_line_whatever_the_size():
    t = np.linspace(0, 1.8 * np.pi, 80)
    arc = np.column_stack([200 + 90 * np.cos(t), 150 + 90 * np.sin(t)])
    for width in (144, 432, 1728):
        strokes = line_strokes(listed((arc, 9)), width, 0.75 * width, LineChoice())
        control, scale = strokes[0], width / 400
        s = np.linspace(0, 1, 9)[:, None]
        for a, b, c, d in (control[k : k + 4] for k in range(0, len(control) - 1, 3)):
            p = (1 - s) ** 3 * a + 3 * s * (1 - s) ** 2 * b + 3 * s * s * (1 - s) * c + s**3 * d
            assert np.abs(np.hypot(*(p / scale - (200, 150)).T) - 90).max() * scale < 0.35
        assert np.allclose(control[0], arc[0] * scale) and np.allclose(control[-1], arc[-1] * scale)


def test_strokes_swell_with_the_weight_and_taper_at_both_tips():
    weight = np.linspace(0.2, 1, 91)
    strokes = line_strokes(listed((straight(100), 9, {"weight": weight})), 432, 324, LineChoice(pen_pt=2))
    widths = strokes.knot_widths
    assert widths is not None and widths.max() <= 2
    middle = widths[10:-10]
    assert (np.diff(middle) > 0).all() and widths[0] < 0.8 * middle[0] and widths[-1] < 0.6 * middle[-1]
    even = line_strokes(listed((straight(100), 9)), 432, 324, LineChoice(pen_pt=2, even=True))
    assert even.widths.tolist() == [2] and even.knot_widths is None


def test_a_ring_is_closed_smooth_and_does_not_taper():
    t = np.linspace(0, 2 * np.pi, 60)
    ring = np.column_stack([200 + 60 * np.cos(t), 150 + 60 * np.sin(t)])
    ring[-1] += (0.3, 0.1)
    strokes = line_strokes(listed((ring, 9)), 432, 324, LineChoice(pen_pt=1))
    control = strokes[0]
    assert np.allclose(control[0], control[-1])
    begin, end = control[1] - control[0], control[-1] - control[-2]
    assert begin @ end > 0.99 * np.hypot(*begin) * np.hypot(*end)
    assert strokes.knot_widths is not None and np.ptp(strokes.knot_widths) < 1e-9


def test_spots_are_as_broad_as_they_are():
    lines = listed(
        ([[100, 100]], 2, {"breadth": 2.4}),
        ([[200, 100], [210, 104]], 2, {"breadth": 1.5}),
        ([[5, 5]], 2, {"breadth": 0.3}),
    )
    strokes = line_strokes(lines, 800, 600, LineChoice())
    assert [len(strokes[i]) for i in range(len(strokes))] == [1, 4, 1]
    assert strokes.widths.tolist() == pytest.approx([4.8, 3, 0.6])
    assert len(line_strokes(lines, 320, 240, LineChoice())) == 2  # the third is too fine by then
    assert len(line_strokes(lines, 1600, 1200, LineChoice())) == 1  # and here only that is small enough to be a dot


def test_ruled_lines_are_straight_and_go_beyond_their_corners():
    corner = np.concatenate([straight(200, 60, 300)[::6], [[300, y] for y in range(190, 40, -10)]])
    free = line_strokes(listed((corner, 9)), 400, 300, LineChoice())
    ruled = line_strokes(listed((corner, 9)), 400, 300, LineChoice(ruled_pt=5))
    assert len(free) == 1 and len(ruled) == 2
    across, up = ruled[0], ruled[1]
    for a, b in ((across, [[55, 200], [305, 200]]), (up, [[300, 205], [300, 45]])):
        np.testing.assert_allclose(a[[0, -1]], b, atol=1.5)
        chord = a[-1] - a[0]
        off = (a - a[0])[:, 0] * chord[1] - (a - a[0])[:, 1] * chord[0]
        assert np.abs(off).max() < 1e-9 * (chord @ chord)


def test_what_a_ruler_cannot_follow_is_drawn_by_hand():
    t = np.linspace(0.3, 2.8, 60)
    arc = np.column_stack([200 + 30 * np.cos(t), 150 + 30 * np.sin(t)])
    lines = listed((arc, 9))
    free, ruled = (line_strokes(lines, 200, 150, LineChoice(ruled_pt=r)) for r in (0.0, 5.0))
    np.testing.assert_array_equal(free.points, ruled.points)


def test_loose_lines_are_drawn_twice_each_near_where_it_belongs():
    lines = listed((straight(100), 9), (straight(220), 5))
    drawn = line_strokes(lines, 400, 300, LineChoice(loose_pt=1.5))
    again = line_strokes(lines, 400, 300, LineChoice(loose_pt=1.5))
    np.testing.assert_array_equal(drawn.points, again.points)
    assert len(drawn) == 4
    for i, y in enumerate((100, 100, 220, 220)):
        off = drawn[i][:, 1] - y
        assert 0.2 < np.abs(off).max() < 1.25 * 1.5
    assert drawn.widths[1] < 0.8 * drawn.widths[0]


@pytest.mark.parametrize("choice", [LineChoice(), LineChoice(density=0.3, per_inch2=14), LineChoice(even=True)])
@pytest.mark.parametrize("width", [120, 400])
def test_a_list_made_for_a_size_draws_there_what_the_whole_list_does(choice, width):
    whole = listed(*((straight(y), 3.0 + 0.01 * y) for y in range(10, 290, 3)))
    left = whole.chosen(with_room(whole, width, 0.75 * width, np.zeros((75, 100), np.float32), choice, 1))
    assert len(left) < len(whole)
    drawn, expected = (line_strokes(lines, width, 0.75 * width, choice) for lines in (left, whole))
    assert len(drawn) == len(expected) > 3
    assert np.array_equal(drawn.points, expected.points) and np.array_equal(drawn.widths, expected.widths)


def test_a_line_is_as_broad_in_print_as_it_was_meant_to_be():
    lines = listed((straight(100), 9), (np.array([[200.0, 200.0]]), 9, {"breadth": 4.0}))
    meant, drawn = (line_strokes(lines, 432, 324, LineChoice(), device_dpi=dpi) for dpi in (None, 600.0))
    assert drawn.device_dpi == 600 and meant.device_dpi is None
    printed = widened(drawn, 600)
    assert printed.widest == pytest.approx(meant.widest, abs=0.002)
    assert drawn.widest.sum() < meant.widest.sum() - 0.2
    even = [line_strokes(lines, 432, 324, LineChoice(even=True), device_dpi=dpi) for dpi in (None, 600.0)]
    assert even[0].widest.tolist() == even[1].widest.tolist()  # a pen is as broad as it is
