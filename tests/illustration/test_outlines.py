"""Outline strokes: near their edges, smooth, breaking at corners only, clear of one another."""

from __future__ import annotations

import numpy as np
import pytest

from penink_cli.blasting import curve_fitting, curves, outlines
from penink_cli.geometry import regions
from penink_cli.ground.device import widened
from penink_cli.ground.model import EdgeList, OutlineChoice, Strokes
from penink_cli.illustration.drawing import outline_strokes
from tests.illustration.test_quantisation import distance_to
from tests.oracles import curve_fitting as slow


def ring(n: int, radius: float, x: float = 50, y: float = 50) -> np.ndarray:
    a = np.arange(n) / n * 2 * np.pi
    return np.column_stack([x + radius * np.cos(a), y + radius * np.sin(a)])


def polygon(vertices: np.ndarray, strength: float | None = None, size: int = 100) -> EdgeList:
    n = len(vertices)
    ends = np.column_stack([np.arange(n), (np.arange(n) + 1) % n])
    return EdgeList(size, size, vertices, ends, None if strength is None else np.full(n, strength))


def together(*lists: EdgeList) -> EdgeList:
    offset = np.cumsum([0, *(len(e.vertices) for e in lists)])
    strength = np.concatenate([e.strength for e in lists]) if lists[0].strength is not None else None
    return EdgeList(
        lists[0].width, lists[0].height, np.concatenate([e.vertices for e in lists]),
        np.concatenate([e.edges + o for e, o in zip(lists, offset)]), strength,
    )  # fmt: skip


def dots(strokes: Strokes, step: float = 0.2) -> np.ndarray:
    return curves.sample(strokes.points, strokes.first, curves.pieces_of(strokes.points, strokes.first, step)).points


EVEN = OutlineChoice(pen_pt=0.5, even=True)


def test_a_circle_of_short_edges_becomes_one_round_stroke():
    edges = polygon(ring(40, 30))
    drawn = outlines.outline(edges, 200, 200, EVEN)
    assert len(drawn) == 1
    points = dots(drawn)
    off = np.hypot(*(points - 100).T) - 60
    assert np.abs(off).max() < 2 * outlines.TOLERANCE + 0.2  # of points, two to the pixel
    assert np.allclose(points[0], points[-1])
    way = np.diff(points, axis=0)
    turn = (way[1:] * way[:-1]).sum(1) / (np.hypot(*way[1:].T) * np.hypot(*way[:-1].T))
    assert turn.min() > 0.98  # nowhere a corner, its beginning included
    assert (way[0] @ way[-1]) / (np.hypot(*way[0]) * np.hypot(*way[-1])) > 0.98


def test_a_square_keeps_its_corners():
    square = np.array([[20, 20], [80, 20], [80, 80], [20, 80.0]])
    points = dots(outlines.outline(polygon(square), 100, 100, EVEN))
    for corner in square:
        assert np.hypot(*(points - corner).T).min() < 0.05


@pytest.mark.parametrize("seed", range(5))
def test_strokes_stay_within_tolerance_of_their_edges_and_cover_them(seed):
    rng = np.random.default_rng(seed)
    t = np.linspace(0, 1, 40)
    x = 10 + 80 * t
    wave = np.column_stack([x, 50 + 20 * np.sin(5 * t + seed) + rng.normal(0, 0.1, 40)])
    edges = EdgeList(100, 100, wave, np.column_stack([np.arange(39), np.arange(1, 40)]))
    for choice in (EVEN, OutlineChoice(pen_pt=0.5)):
        drawn = outlines.outline(edges, 300, 300, choice)
        points = dots(drawn) / 3
        assert distance_to(points, edges).max() <= outlines.TOLERANCE + 0.05
        gaps = np.hypot(*(wave[:, None] - points).transpose(2, 0, 1)).min(axis=1)
        assert gaps.max() < outlines.TOLERANCE + 0.1


def test_a_hand_swells_and_a_technical_pen_does_not():
    edges = polygon(ring(60, 35))
    assert np.unique(outlines.outline(edges, 300, 300, EVEN).widths).tolist() == [0.5]
    line = EdgeList(100, 100, np.array([[5, 50], [95, 50.0]]), np.array([[0, 1]]))
    widths = outlines.outline(line, 300, 300, OutlineChoice(pen_pt=1.0)).widths
    assert widths[0] < 0.75 and widths[-1] < 0.75  # thin tips
    assert 0.9 < np.median(widths) < 1.1
    assert np.abs(np.diff(widths)).max() <= 0.3  # and no jumps


def test_the_pens_width_is_the_same_at_any_size():
    edges = polygon(ring(60, 35), 0.9)
    small, large = (outlines.outline(edges, w, w, OutlineChoice(pen_pt=0.8)).widths for w in (100, 2000))
    assert abs(np.median(small) - np.median(large)) < 0.06


def test_faint_short_and_doubled_edges_are_left_out():
    faint = polygon(ring(40, 10, 20, 20), 0.05)
    short = polygon(ring(8, 2, 80, 20), 0.9)
    strong = polygon(ring(60, 30, 50, 60), 0.9)
    double = polygon(ring(60, 30.4, 50, 60), 0.5)
    edges = together(faint, short, strong, double)
    choice = OutlineChoice(pen_pt=0.5, even=True, min_strength=0.3, min_length=20)
    alone = outlines.outline(strong, 100, 100, choice)
    drawn = outlines.outline(edges, 100, 100, choice)
    assert np.array_equal(drawn.points, alone.points)


def test_ink_on_the_sheet_is_not_doubled():
    edges = polygon(ring(60, 30), 0.9)
    first = outlines.outline(edges, 100, 100, EVEN)
    assert len(outlines.outline(edges, 100, 100, EVEN, ink=first)) == 0


def test_a_region_takes_the_edges_around_it():
    outer, inner = polygon(ring(30, 40)), polygon(ring(20, 10))
    edges = together(outer, inner)
    within = regions.edges_around(edges, np.array([[50.0, 50.0]]))
    assert within.tolist() == [False] * 30 + [True] * 20
    between = regions.edges_around(edges, np.array([[50.0, 75.0]]))
    assert between.all()
    outside = regions.edges_around(edges, np.array([[2.0, 2.0]]))
    assert outside.tolist() == [True] * 30 + [False] * 20
    mask = regions.region_mask(edges, np.array([[50.0, 75.0]]), 100, 100)
    y, x = np.mgrid[0:100, 0:100] + 0.5
    far = np.hypot(x - 50, y - 50)
    assert mask[(far > 11) & (far < 39)].all() and not mask[(far < 9) | (far > 41)].any()
    parts = [regions.region_mask(edges, np.array([p]), 37, 53) for p in ([50.0, 50.0], [50.0, 75.0], [1.0, 1.0])]
    assert (np.sum(parts, axis=0) == 1).all()  # every pixel in one region


def test_nothing_gives_nothing():
    assert len(outlines.outline(EdgeList(10, 10), 100, 100, EVEN)) == 0


@pytest.mark.parametrize("tolerance", [0.05, 0.5, 3.0])
@pytest.mark.parametrize("ring", [False, True])
@pytest.mark.parametrize("count", [2, 3, 5, 9, 40, 200])
def test_curves_are_those_of_the_slow_fit(tolerance, ring, count):
    rng = np.random.default_rng(count)
    t = np.linspace(0, 6.283, count)
    walk = np.stack([20 * np.cos(t), 13 * np.sin(3 * t)], axis=1) + rng.normal(0, 0.2, (count, 2))
    walk[-1] = walk[0] if ring else walk[-1]
    assert np.allclose(curve_fitting.fit(walk, tolerance, ring), slow.fit(walk, tolerance, ring), rtol=0, atol=1e-6)


def test_points_that_are_one_are_a_dot():
    control = curve_fitting.fit(np.full((7, 2), 3.0), 0.5)
    assert np.array_equal(control, np.full((len(control), 2), 3.0)) and len(control) % 3 == 1


@pytest.mark.parametrize("tolerance", [0.05, 0.5, 3.0])
def test_curves_keep_their_promise(tolerance):
    rng = np.random.default_rng(3)
    walk = np.cumsum(rng.normal(0, 1, (200, 2)), axis=0)
    control = curve_fitting.fit(walk, tolerance)
    assert len(control) % 3 == 1
    assert np.array_equal(control[0], walk[0]) and np.array_equal(control[-1], walk[-1])
    strokes = Strokes(1, 1, control, np.array([0, len(control)]), np.ones(1))
    line = dots(strokes, 0.02)
    assert np.hypot(*(walk[:, None] - line).transpose(2, 0, 1)).min(axis=1).max() <= tolerance + 0.02


def test_outlines_are_as_broad_in_print_as_they_were_meant_to_be():
    edges = polygon(ring(40, 30), 0.5)
    choice = OutlineChoice(pen_pt=0.7)
    meant, drawn = (outline_strokes(edges, 200, 200, choice, device_dpi=dpi) for dpi in (None, 600.0))
    assert drawn.device_dpi == 600 and meant.device_dpi is None
    assert widened(drawn, 600).widths == pytest.approx(meant.widths, abs=0.002)
    assert (drawn.widths < meant.widths - 0.1).all()
    pens = [outline_strokes(edges, 200, 200, EVEN, device_dpi=dpi).widths.tolist() for dpi in (None, 600.0)]
    assert pens[0] == pens[1]  # a technical pen is as broad as it is
