"""A phase along a field, its level lines, and pen strokes of them."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from penink_cli.blasting import curves, level_lines, pen_lines, phase
from penink_cli.blasting._compiled import phase as kernel

STEP = 0.96


def field(turn, rows=300, columns=240, density=0.5) -> phase.Field:
    """Lines at turn(x, y) radians from x towards y, about the middle of a grid."""
    y, x = (np.mgrid[:rows, :columns] - np.array([rows, columns])[:, None, None] / 2) * STEP
    angle = turn(x, y)
    nodes = phase.Nodes(-columns / 2 * STEP, -rows / 2 * STEP, STEP, STEP, rows, columns)
    planes = (-np.sin(angle), np.cos(angle), np.broadcast_to(density, angle.shape))
    return phase.Field(nodes, *(np.ascontiguousarray(plane, np.float32) for plane in planes))


def circles(x, y):
    return np.arctan2(y, x) + np.pi / 2


def waves(x, y):
    return 0.6 * np.sin(x / 60) + 0.4 * np.sin(y / 80)


def lines_of(f: phase.Field, level: float = 0.0) -> level_lines.LevelLines:
    return level_lines.level_lines(f, phase.solve(f, None, 3), level)


def sorted_segments(lines: level_lines.LevelLines) -> np.ndarray:
    """Every leg of all lines, whatever line it is in and which way it runs."""
    last = np.zeros(len(lines.points), bool)
    last[lines.first[1:] - 1] = True
    a, b = lines.points[:-1][~last[:-1]], lines.points[1:][~last[:-1]]
    swap = (a[:, 0] > b[:, 0]) | ((a[:, 0] == b[:, 0]) & (a[:, 1] > b[:, 1]))
    legs = np.where(swap[:, None], np.concatenate([b, a], 1), np.concatenate([a, b], 1))
    return np.round(legs[np.lexsort(legs.T)], 4)


@pytest.mark.parametrize("turn", [circles, waves])
def test_bands_change_nothing(turn, monkeypatch) -> None:
    f = field(turn)
    whole = phase.solve(f, None, 3)
    legs = sorted_segments(level_lines.level_lines(f, whole))
    for band in (38, 64):
        monkeypatch.setattr(phase, "BAND", band)
        monkeypatch.setattr(phase, "KEPT", 0)
        monkeypatch.setattr(level_lines, "BAND_NODES", band * f.nodes.columns)
        assert np.array_equal(phase.solve(f, None, 3), whole)
        banded = level_lines.level_lines(f, whole)
        assert np.array_equal(sorted_segments(banded), legs)
        # joined again: lines are as long as they were
        assert len(banded.ring) == len(lines_of(f).ring)


def test_wider_vectors_change_no_byte() -> None:
    f = field(waves, 131, 97)
    wall = np.array([[-20.0, -60.0, 15.0, 60.0]])
    results = []
    for lanes in (16, 32):
        kernel.take_lanes(lanes)
        results.append(phase.solve(f, wall, 3).tobytes())
    assert results[0] == results[1]


def test_threads_change_nothing(monkeypatch) -> None:
    f = field(waves)
    monkeypatch.setattr(phase, "BAND", 48)
    monkeypatch.setattr(level_lines, "BAND_NODES", 48 * f.nodes.columns)
    used = set()

    def each(work, items) -> None:
        def noted(item: int) -> None:
            used.add(threading.get_ident())
            work(item)

        with ThreadPoolExecutor(4) as pool:
            list(pool.map(noted, items))

    many = phase.solve(f, None, 3, each)
    assert np.array_equal(many, phase.solve(f, None, 3))
    a, b = level_lines.level_lines(f, many, 0.5, each), level_lines.level_lines(f, many, 0.5)
    assert np.array_equal(a.points, b.points)
    assert np.array_equal(a.first, b.first)
    assert used


@pytest.mark.parametrize(("turn", "most"), [(circles, 1.0), (waves, 2.0), (lambda x, y: -np.arctan2(y, x), 3.0)])
def test_lines_run_along_the_field(turn, most) -> None:
    lines = pen_lines.evened(lines_of(field(turn)), 7.0)
    pen_lines.smooth(lines, np.full(len(lines.points), 2.0))
    last = lines.first[1:] - 1
    legs = np.delete(np.diff(lines.points, axis=0), last[:-1], axis=0)
    middle = np.delete((lines.points[1:] + lines.points[:-1]) / 2, last[:-1], axis=0)
    away = np.hypot(*middle.T) > 12
    angle = turn(*middle.T)
    off = np.abs(legs[:, 1] * np.cos(angle) - legs[:, 0] * np.sin(angle)) / np.hypot(*legs.T)
    assert np.degrees(np.arcsin(np.clip(off[away], 0, 1)).mean()) < most


@pytest.mark.parametrize("density", [0.1, 0.5, 1.6])
def test_there_are_as_many_lines_as_asked_for(density) -> None:
    """Also where they lie closer than the nodes of the grid."""
    f = field(waves, density=density)
    lines = lines_of(f)
    total = pen_lines.lengths(lines).sum()
    area = (f.nodes.rows - 1) * (f.nodes.columns - 1) * STEP**2
    assert total / area == pytest.approx(density, rel=0.03)


def test_half_a_turn_on_lie_the_lines_between() -> None:
    f = field(lambda x, y: np.full_like(x, 0.4), density=0.25)
    found = phase.solve(f, None, 3)
    across = np.array([-np.sin(0.4), np.cos(0.4)])
    there, between = (level_lines.level_lines(f, found, level).points @ across for level in (0.0, 0.5))
    places = np.sort(there)
    lane = np.concatenate([[True], np.diff(places) > 1.0])
    assert np.diff(places[lane]) == pytest.approx(4.0, abs=0.15)
    nearest = np.abs(between[:, None] - places[lane]).min(axis=1)
    inside = (between > places[0]) & (between < places[-1])
    assert nearest[inside] == pytest.approx(2.0, abs=0.15)


def test_rings_close() -> None:
    lines = lines_of(field(circles))
    rings = np.flatnonzero(lines.ring)
    assert len(rings) > 40
    for i in rings:
        ring = lines.points[lines.first[i] : lines.first[i + 1]]
        assert np.array_equal(ring[0], ring[-1])
    pen_lines.turn_rings(lines, 1)
    begins = lines.points[lines.first[:-1]][rings]
    assert np.std(np.arctan2(begins[:, 1], begins[:, 0])) > 1


def test_a_wall_breaks_the_phase() -> None:
    """Two halves in different directions, a wall between them: up to the wall both run true."""
    f = field(lambda x, y: np.where(x < 0.0, 0.3, -0.9))
    wall = np.array([[-0.5, y, -0.5, y + 6.0] for y in np.arange(-150.0, 150.0, 6.0)])
    lines = level_lines.level_lines(f, phase.solve(f, wall, 3))
    last = lines.first[1:] - 1
    legs = np.delete(np.diff(lines.points, axis=0), last[:-1], axis=0)
    middle = np.delete((lines.points[1:] + lines.points[:-1]) / 2, last[:-1], axis=0)
    for angle, here in ((0.3, middle[:, 0] < -3), (-0.9, middle[:, 0] > 2)):
        off = np.abs(legs[:, 1] * np.cos(angle) - legs[:, 0] * np.sin(angle)) / np.hypot(*legs.T)
        assert np.degrees(np.arcsin(np.clip(off[here], 0, 1)).mean()) < 3


def test_strokes_are_of_a_hands_length_and_near_their_line() -> None:
    lines = pen_lines.evened(lines_of(field(circles)), 7.0)
    parts = pen_lines.cut(lines, np.full(len(lines.ring), 2.0), (34.0, 72.0), 7.0, 5)
    length = parts.span[:, 1] - parts.span[:, 0]
    assert length.max() <= 72.0
    assert length[pen_lines.lengths(lines)[parts.line] > 72.0].min() > 30.0
    points, first = pen_lines.drawn(lines, parts, np.zeros((len(parts.line), 3)))
    samples = curves.sample(points, first, np.full(int(curves.segments_of(first).sum()), 12))
    # the line that a stroke is of is a circle, but for the grid's corners
    for k in range(0, len(parts.line), 7):
        radius = np.hypot(*samples.points[samples.first[k] : samples.first[k + 1]].T)
        line = lines.points[lines.first[parts.line[k]] : lines.first[parts.line[k] + 1]]
        away = np.hypot(*line.T)
        assert away.min() - pen_lines.TOLERANCE_PT <= radius.min() and radius.max() <= away.max() + 0.2


def test_runs_that_are_wanted() -> None:
    points = np.column_stack([np.arange(20.0), np.zeros(20)])
    lines = level_lines.LevelLines(points, np.array([0, 12, 20]), np.array([False, False]))
    wanted = np.ones(20, bool)
    wanted[[4, 15]] = False
    runs, cut = pen_lines.live(lines, wanted)
    assert [runs.points[runs.first[i], 0] for i in range(4)] == [0, 5, 12, 16]
    assert np.diff(runs.first).tolist() == [4, 7, 3, 4]
    assert cut.tolist() == [[False, True], [True, False], [False, True], [True, False]]


def test_nothing_is_made_of_nothing() -> None:
    none = level_lines.LevelLines(np.zeros((0, 2), np.float32), np.zeros(1, np.int64), np.zeros(0, bool))
    assert len(pen_lines.evened(none, 7.0).ring) == 0
    none = pen_lines.evened(none, 7.0)
    parts = pen_lines.cut(none, np.zeros(0), (34.0, 72.0), 7.0, 1)
    points, first = pen_lines.drawn(none, parts, np.zeros((0, 3)))
    assert len(points) == 0 and first.tolist() == [0]
