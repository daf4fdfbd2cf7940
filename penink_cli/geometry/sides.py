"""Vertices rounded to a grid such that every sample stays on its side of every edge.

A rounded edge may come to lie on a sample, or beyond it. The sample is then on the wrong side, and where a dark thing
meets a light ground its tone shows as a blot outside the thing. There is nearly always another grid point close by that
leaves all samples on their sides.
"""

from __future__ import annotations

import math

import numpy as np

from penink_cli.ground.model import Floats, Ints

Point = tuple[float, float]

_REACH = 2  # grid steps that a vertex may be moved by, each way
_ROUNDS = 3


def _side(a: Point, b: Point, sample: Point) -> bool:
    """Whether a sample is to the right of a → b, y being down; ties by the rule of `_compiled/predicates.pyx`."""
    turn = (b[0] - a[0]) * (sample[1] - a[1]) - (b[1] - a[1]) * (sample[0] - a[0])
    return (turn or a[1] - b[1] or b[0] - a[0]) > 0


def _passed(a: Point, b: Point, cell: int, first: float) -> list[Point]:
    """Samples within a few grid steps of the edge a → b: on each line of samples that it crosses the nearest to it."""
    steep = abs(b[1] - a[1]) > abs(b[0] - a[0])
    (u0, v0), (u1, v1) = ((a[1], a[0]), (b[1], b[0])) if steep else (a, b)
    if u0 == u1:
        return []
    low, high = min(u0, u1), max(u0, u1)
    found = []
    for i in range(math.ceil((low - first) / cell), math.floor((high - first) / cell) + 1):
        u = first + cell * i
        v = v0 + (v1 - v0) * (u - u0) / (u1 - u0)
        nearest = first + cell * math.floor((v - first) / cell + 0.5)
        if abs(v - nearest) <= 2 * (_REACH + 1):
            found.append((nearest, u) if steep else (u, nearest))
    return found


def _changed(a: Point, b: Point, to_a: Point, to_b: Point, cell: int, first: float) -> list[Point]:
    """The samples that change sides where the edge a → b moves to to_a → to_b."""
    return [s for s in _passed(to_a, to_b, cell, first) if _side(a, b, s) != _side(to_a, to_b, s)]


def rounded_beside_samples(exact: Floats, ends: Ints, cell: int, first: float | None = None) -> Ints:
    """Grid points (n, 2) next to exact vertices (n, 2) that leave samples on their sides of the edges ends (m, 2).

    exact: in steps of the grid, of which `cell` go to a sample's spacing; sample i lies at first + cell i, where
    first is cell / 2 unless given. Most vertices go to the nearest grid points. Where no grid point close by leaves all
    samples on their sides, the one by which the fewest change sides is taken. A vertex on the grid stays.
    """
    first = cell / 2 if first is None else first
    near = np.rint(exact).astype(np.int64)
    # a vertex that was on the grid before it was scaled to the frame and back is to be on it exactly
    exact = np.where(np.abs(exact - near) < 1e-6, near, exact)
    at: list[Point] = [(float(x), float(y)) for x, y in exact.tolist()]
    grid: list[Point] = [(float(x), float(y)) for x, y in near.tolist()]
    edges: list[tuple[int, int]] = [(a, b) for a, b in ends.tolist()]
    around: list[list[int]] = [[] for _ in at]
    for e, (a, b) in enumerate(edges):
        around[a].append(e)
        around[b].append(e)

    def changes(v: int, place: Point) -> int:
        """How many samples change sides of the edges at vertex v if it goes there."""
        count = 0
        for e in around[v]:
            a, b = edges[e]
            to_a, to_b = place if a == v else grid[a], place if b == v else grid[b]
            count += len(_changed(at[a], at[b], to_a, to_b, cell, first))
        return count

    def settle(v: int) -> None:
        x, y = near[v].tolist()
        steps = range(-_REACH, _REACH + 1)
        places = [(float(x + i), float(y + j)) for i in steps for j in steps]
        places.sort(key=lambda place: ((place[0] - at[v][0]) ** 2 + (place[1] - at[v][1]) ** 2, place))
        best = changes(v, grid[v])
        for place in places:
            if best == 0:
                break
            if (count := changes(v, place)) < best:
                best, grid[v] = count, place

    for _ in range(_ROUNDS):
        wrong = [e for e, (a, b) in enumerate(edges) if _changed(at[a], at[b], grid[a], grid[b], cell, first)]
        if not wrong:
            break
        for e in wrong:
            for v in edges[e]:
                settle(v)
    return np.array(grid, np.int64).reshape(-1, 2)
