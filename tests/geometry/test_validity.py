"""Which edge lists are arrangements: a table of faults, and the exact sweep against all pairs."""

from __future__ import annotations

import subprocess
import sys
from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from penink_cli.geometry.validity import check
from penink_cli.ground.errors import ArrangementError
from penink_cli.ground.model import EdgeList
from tests.oracles.brute import turn


def edge_list(vertices, edges, width=10, height=10):
    return EdgeList(width, height, np.array(vertices, float).reshape(-1, 2), np.array(edges, np.int64).reshape(-1, 2))


@pytest.mark.parametrize(
    ("vertices", "edges", "message"),
    [
        ([(0, 0), (8, 8), (0, 8), (8, 0)], [(0, 1), (2, 3)], "edges 0 and 1 cross"),
        ([(0, 0), (8, 8), (4, 4), (8, 0)], [(0, 1), (2, 3)], "edge 0: vertex 2, an end of edge 1, at 4,4 lies on it"),
        ([(0, 0), (8, 8), (4, 4), (9, 9)], [(0, 1), (2, 3)], "edges 0 and 1 overlap"),
        ([(0, 0), (4, 4), (8, 8)], [(0, 1), (0, 2)], "edges 0 and 1 overlap"),
        ([(0, 0), (4, 4), (8, 8)], [(1, 2), (2, 0)], "edges 0 and 1 overlap"),
        ([(0, 3), (4, 3), (8, 3), (6, 3)], [(0, 2), (1, 3)], "edges 0 and 1 overlap"),
        ([(0, 0), (8, 8)], [(0, 1), (1, 0)], "edge 1 repeats edge 0"),
        ([(0, 0), (8, 8)], [(0, 1), (1, 1)], "edge 1 has no length: both its ends are vertex 1"),
        ([(0, 0), (8, 8), (0, 0)], [(0, 1), (1, 2)], "edge 1: vertex 2 repeats vertex 0 at 0,0"),
        ([(0, 0), (8, 10.5)], [(0, 1)], "edge 0: vertex 1 at 8,10.5 is outside the frame of 10 x 10"),
        ([(0, 0), (-0.001, 3)], [(0, 1)], "edge 0: vertex 1 at -0.001,3 is outside the frame"),
        ([(0, 0), (8, np.nan)], [(0, 1)], "edge 0: vertex 1 is not finite"),
        ([(0, 0), (np.inf, 3)], [(0, 1)], "edge 0: vertex 1 is not finite"),
        ([(0, 0), (8, 8)], [(0, 2)], "edge 0: vertex 2 is not in 0..1"),
        ([(0, 0), (8, 8)], [(-1, 1)], "edge 0: vertex -1 is not in 0..1"),
        ([], [(0, 1)], "edge 0: vertex 0 is not in an empty list"),
    ],
)
def test_a_fault_is_refused_and_named(vertices, edges, message):
    with pytest.raises(ArrangementError) as caught:
        check(edge_list(vertices, edges))
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("vertices", "edges"),
    [
        ([], []),
        ([(0, 0), (10, 0), (10, 10), (0, 10)], [(0, 1), (1, 2), (2, 3), (3, 0)]),
        ([(5, 5), (1, 1), (9, 9), (1, 9), (9, 1), (5, 0)], [(0, k) for k in range(1, 6)]),
        ([(1, 1), (4, 4), (5, 5), (8, 8)], [(0, 1), (2, 3)]),
        ([(1, 1), (9, 9), (5, 5)], [(0, 1)]),  # a vertex without an edge is ignored, wherever it lies
        ([(3, 1), (3, 4), (3, 5), (3, 9)], [(0, 1), (3, 2)]),
    ],
)
def test_an_arrangement_is_accepted(vertices, edges):
    check(edge_list(vertices, edges))


def meet(a, b, c, d):
    """Whether two closed segments meet other than at one shared end."""
    shared = {a, b} & {c, d}
    if shared:
        (p,) = shared
        q, r = ({a, b} - shared).pop(), ({c, d} - shared).pop()
        return turn(p, q, r) == 0 and (q[0] - p[0]) * (r[0] - p[0]) + (q[1] - p[1]) * (r[1] - p[1]) > 0
    if all(turn(a, b, x) == 0 for x in (c, d)):
        return max(min(a, b), min(c, d)) <= min(max(a, b), max(c, d))
    return turn(a, b, c) * turn(a, b, d) <= 0 and turn(c, d, a) * turn(c, d, b) <= 0


@settings(max_examples=300, deadline=None, derandomize=True)
@given(st.integers(0, 2**32), st.integers(2, 9), st.sampled_from([3, 5, 9, None]))
def test_the_sweep_agrees_with_all_pairs(seed, count, lattice):
    rng = np.random.default_rng(seed)
    points = rng.integers(0, lattice + 1, (2 * count, 2)) if lattice else rng.uniform(0, 9, (2 * count, 2)) ** 1.0
    if lattice is None:
        points[1::2] = np.clip(points[::2] + rng.normal(0, 1.5, (count, 2)), 0, 10)
    vertices = sorted({(float(x), float(y)) for x, y in points})
    pairs = {
        tuple(sorted(vertices.index((float(x), float(y))) for x, y in points[2 * k : 2 * k + 2])) for k in range(count)
    }
    edges = sorted((a, b) for a, b in pairs if a != b)
    wrong = any(meet(*(vertices[k] for k in (*e, *f))) for e, f in combinations(edges, 2))
    try:
        check(edge_list(vertices, edges))
    except ArrangementError:
        assert wrong
    else:
        assert not wrong


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_nearly_touching_is_decided_exactly(scale):
    # The end of the second edge lies one step of a double off the first.
    for off, valid in ((0.0, False), (np.spacing(0.5 * scale), True)):
        edges = edge_list(
            np.array([(0, 0), (1, 1), (0.5, 0.5), (1, 0)]) * scale + [(0, 0), (0, 0), (off, 0), (0, 0)],
            [(0, 1), (2, 3)],
        )
        edges = EdgeList(2 * 10**9, 2 * 10**9, edges.vertices, edges.edges)
        if valid:
            check(edges)
        else:
            with pytest.raises(ArrangementError):
                check(edges)


def test_many_edges_that_all_cross_are_refused():
    rng = np.random.default_rng(0)
    with pytest.raises(ArrangementError, match="cross"):
        check(edge_list(rng.uniform(0, 10, (200_000, 2)), np.arange(200_000).reshape(-1, 2)))


@pytest.mark.parametrize("seed", range(4))
def test_a_deep_order_agrees_with_all_pairs(seed):
    rng = np.random.default_rng(seed)
    begin = rng.uniform(0, 9, (150, 2))
    ends = np.clip(begin + rng.normal(0, 1, (150, 2)) * (3.0, 0.3), 0, 10)
    kept = []
    for a, b in zip(map(tuple, begin.tolist()), map(tuple, ends.tolist()), strict=True):
        meets = [k for k, other in enumerate(kept) if meet(a, b, *other)]
        edges = np.arange(2 * len(kept) + 2).reshape(-1, 2)
        tried = edge_list([point for edge in [*kept, (a, b)] for point in edge], edges)
        if meets:
            with pytest.raises(ArrangementError):
                check(tried)
        else:
            check(tried)
            kept.append((a, b))
    assert 40 < len(kept) < 150


def test_edges_that_leave_a_vertex_by_nearly_one_slope_are_sorted_exactly():
    rng = np.random.default_rng(0)
    across = 2.0 * np.arange(50_000) + 1
    tips = np.stack([across, across * 0.1], axis=1)
    tips = np.array(list({Fraction(y) / Fraction(x): (x, y) for x, y in tips.tolist()}.values()))
    assert len(tips) > 30_000
    assert len(np.unique(tips[:, 1] / tips[:, 0])) < 10
    tips = tips[rng.permutation(len(tips))]
    edges = np.stack([np.zeros(len(tips), np.int64), 1 + np.arange(len(tips))], axis=1)
    check(edge_list([(0, 0), *tips.tolist()], edges, 200_000, 20_000))


#: Edges numbered so that 2654435769 k + 1, mixed to a hash, falls from the outermost inwards on both sides in turn.
NESTED = """
import numpy as np
from penink_cli.geometry.validity import check
from penink_cli.ground.model import EdgeList
n = 300_000
h = np.arange(n, dtype=np.uint32) * np.uint32(2654435769) + np.uint32(1)
h ^= h >> 15
h *= np.uint32(2246822519)
h ^= h >> 13
rank = np.empty(n)
rank[np.argsort(h, kind="stable")] = np.arange(n)
y = n // 2 + np.where(rank % 2, 1, -1) * ((rank + 1) // 2)
vertices = np.stack([np.stack([rank, y], axis=1), np.stack([np.where(rank, n + 10, n + 5), y], axis=1)], axis=1)
check(EdgeList(2 * n, n + 10, vertices.reshape(-1, 2), np.arange(2 * n).reshape(-1, 2)))
"""


def test_no_order_of_the_edges_overflows_the_stack():
    # A tree balanced by a hash of the edges' numbers was a path 300 000 deep for these.
    subprocess.run([sys.executable, "-c", NESTED], check=True)
