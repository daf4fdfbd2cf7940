"""Vertices moved to a grid without breaking the arrangement.

Rounding can make edges that only come close cross, touch or coincide. The remedy is that of snap
rounding (Hobby 1999): an edge that passes over a vertex is split there, and two edges that cross
are split at the grid point nearest to their crossing, until nothing is left to split. Each
split moves an edge by less than a cell of the grid; edges are not found as exactly as that.
"""

from __future__ import annotations

import numpy as np

from penink_cli.geometry import edge_index
from penink_cli.geometry.sides import rounded_beside_samples
from penink_cli.ground.median import distinct
from penink_cli.ground.model import EdgeList, Floats, Ints

_CELL = 16  # grid points: side of the cells within which conflicts are looked for
_ROUNDS = 50  # of splitting, after which the edges of a tangle are left out


def quantise(edges: EdgeList, columns: int, rows: int, cell: int = 0) -> EdgeList:
    """The arrangement with every vertex on a grid of columns × rows cells that spans the frame, each below 2²⁴.

    cell: grid cells to a sample's spacing, where samples are to stay on their sides of the edges; 0 where there are
    none.

    Vertices that come to lie on one another become one. Edges that shrink to nothing are left out, and
    of edges that coincide the strongest stays. An arrangement on the grid is returned unchanged, but
    without vertices that have no edge.
    """
    exact = edges.vertices * (columns / edges.width, rows / edges.height)
    grid = rounded_beside_samples(exact, edges.edges, cell) if cell else np.rint(exact).astype(np.int64)
    grid = np.clip(grid, 0, (columns, rows))
    strength = edges.strength if edges.strength is not None else np.zeros(len(edges.edges))
    grid, ends, strength = _merged(grid, edges.edges, strength)
    for _ in range(_ROUNDS):
        splits = _conflicts(grid, ends)
        if not len(splits):
            break
        grid, ends, strength = _merged(*_split(grid, ends, strength, splits))
    else:  # a tangle that splitting does not end: leave its edges out
        while len(splits := _conflicts(grid, ends)):
            keep = np.ones(len(ends), bool)
            keep[splits[:, 0]] = False
            grid, ends, strength = _merged(grid, ends[keep], strength[keep])
    vertices = grid * np.array([edges.width, edges.height], np.float64) / np.array([columns, rows], np.float64)
    return EdgeList(edges.width, edges.height, vertices, ends, None if edges.strength is None else strength)


def _merged(grid: Ints, ends: Ints, strength: Floats) -> tuple[Ints, Ints, Floats]:
    """The same with one vertex a point, each edge once, none without length and no vertex without an edge; sorted."""
    points, which = np.unique(grid[:, ::-1], axis=0, return_inverse=True)
    ends = np.sort(which.reshape(-1)[ends], axis=1) if len(ends) else ends.reshape(0, 2)
    ends, strength = ends[ends[:, 0] != ends[:, 1]], strength[ends[:, 0] != ends[:, 1]]
    order = np.lexsort((-strength, ends[:, 1], ends[:, 0]))
    ends, strength = ends[order], strength[order]
    first = np.ones(len(ends), bool)
    first[1:] = (ends[1:] != ends[:-1]).any(axis=1)
    ends, strength = ends[first], strength[first]
    used, ends = np.unique(ends, return_inverse=True)
    return points[used][:, ::-1], ends.reshape(-1, 2), strength


def _near_pairs(grid: Ints, ends: Ints) -> Ints:
    """Pairs (p, 2) of edges whose bounding boxes share a cell and overlap."""
    low, high = grid[ends].min(axis=1), grid[ends].max(axis=1)
    cell, edge = edge_index.touched(low // _CELL, high // _CELL, 1 << 24)
    later = np.searchsorted(cell, cell, side="right") - np.arange(len(cell)) - 1
    one = np.repeat(np.arange(len(cell)), later)
    other = one + 1 + np.arange(len(one)) - np.repeat(np.cumsum(later) - later, later)
    a, b = edge[one], edge[other]
    meet = ((low[a] <= high[b]) & (low[b] <= high[a])).all(axis=1)
    pair = distinct(a[meet] * len(ends) + b[meet])
    return np.column_stack([pair // len(ends), pair % len(ends)])


def _turn(a: Ints, b: Ints, c: Ints) -> Ints:
    """(b − a) × (c − a), exact: coordinates are below 2²⁴."""
    u, v = b - a, c - a
    return np.asarray(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


def _conflicts(grid: Ints, ends: Ints) -> Ints:
    """Splits (s, 3) that the arrangement needs: an edge, and x, y of the point to split it at."""
    pairs = _near_pairs(grid, ends)
    found = [np.zeros((0, 3), np.int64)]
    for one, other in ((0, 1), (1, 0)):
        edge = pairs[:, one]
        a, b = grid[ends[edge, 0]], grid[ends[edge, 1]]
        for end in (0, 1):
            vertex = ends[pairs[:, other], end]
            c = grid[vertex]
            along = ((c - a) * (b - a)).sum(axis=1)
            within = (along > 0) & (along < ((b - a) ** 2).sum(axis=1)) & (_turn(a, b, c) == 0)
            found.append(np.column_stack([edge[within], c[within]]))
    a, b = grid[ends[pairs[:, 0], 0]], grid[ends[pairs[:, 0], 1]]
    c, d = grid[ends[pairs[:, 1], 0]], grid[ends[pairs[:, 1], 1]]
    from_c, from_d = _turn(a, b, c), _turn(a, b, d)
    crossing = (np.sign(from_c) * np.sign(from_d) < 0) & (np.sign(_turn(c, d, a)) * np.sign(_turn(c, d, b)) < 0)
    part = (from_c[crossing] / (from_c[crossing] - from_d[crossing]))[:, None]
    point = np.rint(c[crossing] + part * (d[crossing] - c[crossing])).astype(np.int64)
    for side in (0, 1):
        found.append(np.column_stack([pairs[crossing, side], point]))
    return np.concatenate(found)


def _split(grid: Ints, ends: Ints, strength: Floats, splits: Ints) -> tuple[Ints, Ints, Floats]:
    """The arrangement with each edge of the splits (s, 3) led through its points, in their order along the edge."""
    edge, points = splits[:, 0], splits[:, 1:]
    number = len(grid) + np.arange(len(points))
    grid = np.concatenate([grid, points])
    whole = np.ones(len(ends), bool)
    whole[edge] = False
    a = grid[ends[edge, 0]]
    along = ((points - a) * (grid[ends[edge, 1]] - a)).sum(axis=1)
    order = np.lexsort((along, edge))
    edge, number = edge[order], number[order]
    opens = np.ones(len(edge), bool)
    opens[1:] = edge[1:] != edge[:-1]
    closes = np.append(opens[1:], True)
    before = np.where(opens, ends[edge, 0], np.roll(number, 1))
    pieces = np.concatenate(
        [np.column_stack([before, number]), np.column_stack([number[closes], ends[edge[closes], 1]])]
    )
    of = np.concatenate([edge, edge[closes]])
    return grid, np.concatenate([ends[whole], pieces]), np.concatenate([strength[whole], strength[of]])
