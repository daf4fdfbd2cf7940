"""The order for a pen: the same strokes, shorter ways."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from penink_cli.travel.order import drawn_length, joined, ordered, ordered_each, travel_length
from tests.outputs.drawings import crosshatch, every_kind, strokes_of

place = st.tuples(st.integers(0, 30).map(float), st.integers(0, 30).map(float))
curve, dot = (st.lists(place, min_size=n, max_size=n) for n in (4, 1))
chains = st.lists(st.one_of(curve, dot), max_size=40)


def as_multiset(strokes):
    """Each stroke with its pen, whichever way round."""
    both = ((p.tolist(), p[::-1].tolist()) for p in (strokes[i] for i in range(len(strokes))))
    return sorted((w, *sorted(pair)) for w, pair in zip(strokes.widths.tolist(), both))


def greedy_by_hand(strokes):
    """Always the nearest end, by trying all."""
    left, at, total = list(range(len(strokes))), np.zeros(2), 0.0
    while left:
        ways = [(np.hypot(*(strokes[i][e] - at)), i, e) for i in left for e in (0, -1)]
        distance, i, e = min(ways)
        total += distance
        at = strokes[i][-1 if e == 0 else 0]
        left.remove(i)
    return total


def whole_way(strokes):
    """Travel from the corner on."""
    return travel_length(strokes) + (float(np.hypot(*strokes[0][0])) if len(strokes) else 0)


@settings(deadline=None)
@given(chains, st.booleans())
def test_the_same_strokes_in_another_order(chains, improve):
    strokes = strokes_of(chains, np.arange(1, len(chains) + 1))
    assert as_multiset(ordered(strokes, improve)) == as_multiset(strokes)


def test_progress_is_told_to_twice_the_number_of_strokes():
    strokes = crosshatch(2000, 300)
    for improve in (True, False):
        told = []
        ordered(strokes, improve, told.append)
        assert sum(told) == 2 * len(strokes) and min(told) >= 0 and len(told) > 5


@settings(deadline=None)
@given(st.lists(chains, max_size=12))
def test_runs_are_ordered_each_as_by_itself(runs):
    """Ties too: places are few, and dots and strokes lie on one another."""
    parts = [strokes_of(part, np.arange(1, len(part) + 1)) for part in runs if part]
    if not parts:
        return
    whole = type(parts[0]).joined(parts)
    found = ordered_each(whole, np.cumsum([0, *map(len, parts)]))
    wanted = type(whole).joined([ordered(part, improve=False) for part in parts])
    assert found.points.tolist() == wanted.points.tolist() and found.widths.tolist() == wanted.widths.tolist()


@settings(deadline=None)
@given(st.integers(0, 2**32), st.integers(1, 60))
def test_always_the_nearest_next(seed, count):
    rng = np.random.default_rng(seed)  # no two distances are equal
    strokes = strokes_of(rng.random((count, 4, 2)) * 100, 1)
    assert whole_way(ordered(strokes, improve=False)) == pytest.approx(greedy_by_hand(strokes))


@settings(deadline=None)
@given(chains)
def test_improving_never_makes_it_longer(chains):
    strokes = strokes_of(chains, 1)
    assert travel_length(ordered(strokes)) <= travel_length(ordered(strokes, improve=False)) + 1e-4


def test_small_drawings_come_close_to_the_best_there_is():
    ratios = []
    for seed in range(8):
        strokes = strokes_of(np.random.default_rng(seed).random((5, 4, 2)) * 100, 1)
        ends = [(s[0].tolist(), s[3].tolist()) for s in map(strokes.__getitem__, range(5))]
        best = min(
            sum(
                math.dist(ends[b][fb], ends[a][1 - fa])
                for (a, fa), (b, fb) in itertools.pairwise(zip(tour, flips))
            )
            for tour in itertools.permutations(range(5))
            for flips in itertools.product((0, 1), repeat=5)
        )
        ratios.append(travel_length(ordered(strokes)) / best)
    assert min(ratios) > 1 - 1e-9
    assert np.mean(ratios) < 1.15


def test_a_drawing_travels_far_less():
    strokes = crosshatch(3000, 288)
    nearest, best = ordered(strokes, improve=False), ordered(strokes)
    assert travel_length(nearest) < 0.05 * travel_length(strokes)
    assert travel_length(best) < 0.9 * travel_length(nearest)


@pytest.mark.parametrize("spread", [0.0, 1e-9, 1e-3])
def test_clusters_take_no_longer(spread):
    """A grid would be quadratic here; this would not end."""
    rng = np.random.default_rng(0)
    points = rng.random((20000, 2)) * spread
    points[:10] += 1000 * rng.random((10, 2))
    strokes = strokes_of(points[:, None], 1)
    assert as_multiset(ordered(strokes))[0] == as_multiset(strokes)[0]


def test_ends_that_meet_are_joined():
    a = [[0, 0], [1, 1], [2, 1], [3, 0]]
    b = [[3.01, 0], [4, 1], [5, 1], [6, 0]]
    c = [[6.5, 0], [7, 1], [8, 1], [9, 0]]
    result = joined(strokes_of([a, b, c, [[9, 0]]], 1), 0.05)
    assert [len(result[i]) for i in range(len(result))] == [7, 4, 1]
    assert result[0].tolist() == [*a, *b[1:]]
    assert len(joined(strokes_of([a, b, c], [1, 2, 2]), 0.05)) == 3  # another pen
    assert len(joined(strokes_of([a, b, c], 1), 1.0)) == 1
    assert len(joined(strokes_of([], 1), 1.0)) == 0


def test_a_cut_line_is_one_line_again():
    strokes = every_kind()
    spiral = strokes[int(np.argmax(np.diff(strokes.first)))]
    pieces = [spiral[i : i + 4] for i in range(0, len(spiral) - 1, 3)]
    shuffled = [pieces[i] for i in np.random.default_rng(0).permutation(len(pieces))]
    whole = joined(ordered(strokes_of(shuffled, 1)), 0.01)
    assert len(whole) == 1
    assert drawn_length(whole) == pytest.approx(drawn_length(strokes_of([spiral], 1)), abs=0.01)


def test_lengths():
    straight = strokes_of([[[0, 0], [10, 0], [20, 0], [30, 40]], [[5, 5]]], 1)
    t = np.linspace(0, 1, 200001)[:, None]
    a, b, c, d = straight[0]
    curve = (1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t**2 * c + t**3 * d
    assert drawn_length(straight) == pytest.approx(np.hypot(*np.diff(curve, axis=0).T).sum(), rel=1e-4)
    assert travel_length(straight) == pytest.approx(np.hypot(25, 35))
