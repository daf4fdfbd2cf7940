"""Lines that leave off where it is light, one of each two neighbours; lines that close up where one ends."""

from itertools import pairwise

import numpy as np

from penink_cli.blasting import taking_turns
from penink_cli.blasting.curves import starts


def straight(count, length, spacing):
    """Samples of horizontal lines, where each begins, their normals."""
    x, y = np.meshgrid(np.arange(length, dtype=float), np.arange(count) * spacing)
    points = np.column_stack([x.ravel(), y.ravel()])
    return points, starts(np.full(count, length)), np.tile([0.0, 1.0], (len(points), 1))


def test_of_each_two_lines_one_leaves_off_and_of_those_left_one_again():
    points, first, normals = straight(24, 200, 1.46)
    level = taking_turns.levels(points, first, normals, np.ones(len(points)), 1.46).reshape(24, 200)
    assert (level == level[:, :1]).all()  # a line is one thing from end to end
    lines = level[:, 0]
    assert (lines[:-1] != lines[1:]).all()
    for k in (1, 2, 3):
        left = lines[(lines == 0) | (lines >= k)]
        assert (np.diff(np.flatnonzero(left == k)) == 2).all()
        assert abs((left == k).sum() - len(left) / 2) <= 1


def test_on_rings_that_are_cut_no_two_neighbours_go_on_or_leave_off_together():
    spacing, lines = 1.5, []
    for r in np.arange(10, 60, spacing):
        turn = np.linspace(0.3, 5.9, int(5.6 * r))
        lines.append(100 + r * np.column_stack([np.cos(turn), np.sin(turn)]))
    points, first = np.concatenate(lines), starts(np.array([len(line) for line in lines]))
    normals = (points - 100) / np.hypot(*(points - 100).T)[:, None]
    level = taking_turns.levels(points, first, normals, np.ones(len(points)), spacing)
    left_off = np.array([np.mean(level[a:b] == 1) for a, b in pairwise(first)])
    assert ((left_off < 0.02) | (left_off > 0.98)).all()
    assert (np.abs(np.diff(np.round(left_off))) == 1).all()


def test_distances_are_those_to_the_neighbours():
    points, first, normals = straight(9, 60, 2.0)
    points[first[4] : first[5], 1] += 0.5
    apart, more, both = taking_turns.distances(points, first, normals, 2.0)
    inner = slice(first[3], first[6])
    assert both[inner].all() and not both[: first[1]].any()
    np.testing.assert_allclose(apart[inner].reshape(3, 60)[:, 5], [2.25, 2.0, 1.75])
    np.testing.assert_allclose(more[inner].reshape(3, 60)[:, 5], [0.5, -1.0, 0.5])


def test_distances_are_told_at_any_angle():
    """Lines askew pass corners of the cells in which they are looked for, and no ray may slip between two."""
    for angle in np.radians([12.0, 37.0, 45.0, 63.0]):
        across, along = np.mgrid[-20:20, -60:61]
        c, s = np.cos(angle), np.sin(angle)
        u, v = along.ravel() * 1.0, across.ravel() * 1.5
        points, normals = np.column_stack([c * u - s * v, s * u + c * v]), np.tile([-s, c], (u.size, 1))
        apart, more, both = taking_turns.distances(points, starts(np.full(40, 121)), normals, 1.5)
        inner = (np.abs(across) < 17) & (np.abs(along) < 55)
        assert both.reshape(40, 121)[inner].all()
        np.testing.assert_allclose(apart.reshape(40, 121)[inner], 1.5)
        np.testing.assert_allclose(more.reshape(40, 121)[inner], 0, atol=1e-9)


def test_nothing_is_all_right():
    none = np.zeros((0, 2))
    assert taking_turns.levels(none, np.zeros(1, np.int64), none, np.zeros(0), 1.5).shape == (0,)
