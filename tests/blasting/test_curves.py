"""Cutting and sampling chains of cubics, against the slow way: one point at a time."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from penink_cli.blasting import curves


def chain(rng, segments):
    return rng.uniform(-20, 20, (3 * segments + 1, 2))


def at(points, t):
    """The point of a chain at t, counted in segments, by de Casteljau."""
    k = min(int(t), (len(points) - 1) // 3 - 1)
    p = points[3 * k : 3 * k + 4]
    t -= k
    while len(p) > 1:
        p = p[:-1] * (1 - t) + p[1:] * t
    return p[0]


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32), st.floats(0, 1), st.floats(0, 1))
def test_a_part_runs_through_the_points_of_the_whole(seed, a, b):
    rng = np.random.default_rng(seed)
    sizes = rng.integers(1, 4, 3)
    parts = [chain(rng, n) for n in sizes]
    points, first = np.concatenate(parts), curves.starts(3 * sizes + 1)
    pieces = curves.pieces_of(points, first, 3.0)
    lines = curves.sample(points, first, pieces)
    which = int(rng.integers(3))
    run = curves.starts(pieces)
    base = curves.starts(sizes)[which]
    total = run[base + sizes[which]] - run[base]
    lo, hi = sorted((a * total, b * total))
    cut, begin = curves.cut(points, first, pieces, np.array([which]), np.array([lo]), np.array([hi]))

    def parameter(sample):
        k = min(
            int(np.searchsorted(run[base : base + sizes[which] + 1] - run[base], sample, "right")) - 1, sizes[which] - 1
        )
        return k + (sample - (run[base + k] - run[base])) / pieces[base + k]

    assert np.allclose(cut[0], at(parts[which], parameter(lo)), atol=1e-6)
    assert np.allclose(cut[begin[1] - 1], at(parts[which], parameter(hi)), atol=1e-6)
    mine = lines.points[lines.first[which] : lines.first[which + 1]]
    assert len(mine) == total + 1
    for k in range(0, total + 1, 3):
        assert np.allclose(mine[k], at(parts[which], parameter(k)), atol=1e-6)


def test_dots_stay_dots():
    points, first = np.array([[1.0, 2.0], [0, 0], [1, 0], [2, 0], [3, 0], [5.0, 5.0]]), np.array([0, 1, 5, 6])
    pieces = curves.pieces_of(points, first, 1.0)
    lines = curves.sample(points, first, pieces)
    assert np.diff(lines.first).tolist() == [1, 4, 1]
    cut, begin = curves.cut(points, first, pieces, np.array([2, 0]), np.zeros(2), np.zeros(2))
    assert cut.tolist() == [[5, 5], [1, 2]] and begin.tolist() == [0, 1, 2]
