"""Cutting and sampling chains of cubics, against the slow way: one point at a time."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from penink_cli.blasting import curves
from penink_cli.blasting.curve_fitting import over_chords


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


def test_cubics_over_chords_pass_their_points_in_few_numbers():
    rng = np.random.default_rng(3)
    runs = [np.array([[4.0, 5.0]]), np.array([[0.0, 0.0], [3.0, 1.0]])]
    for radius in (6.0, 30.0, 200.0):
        t = np.linspace(0, 60 / radius, 40)
        turn = rng.uniform(0, 6)
        runs.append(radius * np.column_stack([np.cos(t + turn), np.sin(t + turn)]) + rng.uniform(-0.05, 0.05, (40, 2)))
    points, first = np.concatenate(runs), curves.starts(np.array([len(run) for run in runs]))
    control, begin = over_chords(points, first, 0.15)
    few = curves.segments_of(begin)
    assert few[0] == 0 and few[1] == 1 and few[4] <= 2 < few[2] <= 14
    lines = curves.sample(control, begin, np.full(few.sum(), 600))
    for i, run in enumerate(runs):
        drawn = lines.points[lines.first[i] : lines.first[i + 1]]
        assert (drawn[0] == run[0]).all() and np.allclose(drawn[-1], run[-1])
        assert np.hypot(*(run[:, None] - drawn[None]).T).min(axis=0).max() < 0.15 + 0.02
        each = control[begin[i] : begin[i + 1]]
        for k in range(0, len(each) - 1, 3):
            chord = each[k + 3] - each[k]
            thirds = (each[k + 1 : k + 3] - each[k]) @ chord / (chord @ chord)
            assert np.allclose(thirds, [1 / 3, 2 / 3])
