"""Edges in few bytes: a member of a packed illustration, ``PIe2`` (see `compact`).

Whole numbers: frame W, H; grid columns, rows; number of edges; 1 where strengths follow, else 0. Then code: chains,
each by its start and then step by step; then the strengths of all chains, one for each stretch between junctions.
``PIe1``, which has a strength for each edge, is read and no longer written.

Vertices lie on a grid of columns × rows cells that spans the edge list's frame W × H: the point (a, b) is
x = a·W / columns, y = b·H / rows. The grid has 4, 8 or 16 points to the sample spacing, the fewest whose step is at
most COARSEST pixels of the photo: edges were found in the photo, and are no more exact than its pixels. With 16 points
the grid costs at most 0.1 dB against exact edges. Strengths are kept in sixteenths.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from penink_cli.formats import edge_list
from penink_cli.formats._compiled.coder import Coder
from penink_cli.formats.members import MAX_GRID, check_end, finished, header, written_numbers
from penink_cli.geometry.trails import Trail, trails
from penink_cli.ground.errors import FormatError
from penink_cli.ground.model import EdgeList, Ints

EDGES, EDGES_1 = b"PIe2", b"PIe1"
GRIDS = (4, 8, 16)  # points of the grid to the sample spacing
COARSEST = 0.4  # step of a grid, in pixels of the photo, wherever one of GRIDS is so fine
STRENGTHS = 16  # steps of strength

# Kinds of numbers (see `Coder.number`).
_CHAIN, _DOWN, _ALONG, _STEP, _BACK, _MAIN, _ASIDE, _STRENGTH = range(8)
# What a step along a chain leads to.
_NEW, _END, _START, _OLD = range(4)
_MOST_OF_A_STRETCH = 20  # edges: longer stretches have the statistics of this length


def points_to_spacing(edges: EdgeList, columns: int, rows: int) -> int:
    """How many points to the sample spacing, of GRIDS, the grid of edges has beside samples of columns × rows."""
    spacing = max(edges.width / columns, edges.height / rows)
    return next((points for points in GRIDS if spacing <= COARSEST * points), GRIDS[-1])


def on_grid(edges: EdgeList, columns: int, rows: int) -> int | None:
    """The coarsest of GRIDS, beside samples of columns × rows, on which all vertices lie; None for no such grid."""
    for points in GRIDS:
        at = edges.vertices * (points * columns / edges.width, points * rows / edges.height)
        if (np.abs(at - np.rint(at)) < 1e-6).all():
            return points
    return None


def edges_bytes(edges: EdgeList, columns: int, rows: int) -> bytes:
    """Edges, their vertices rounded to a grid of columns × rows cells; the order is that of `trails`.

    The edges of a stretch between junctions share one strength, their mean by length, in sixteenths. Raises LimitError.
    """
    grid = np.rint(edges.vertices * (columns / edges.width, rows / edges.height)).astype(np.int64)
    strong = edges.strength is not None
    head = written_numbers(edges.width, edges.height, columns, rows, len(edges.edges), int(strong))
    coder = Coder()
    if len(edges.edges):
        found = trails(grid, edges.edges)
        chains = _Chains(coder)
        chains.write(grid, found)
        if edges.strength is not None:
            step = (grid[edges.edges[:, 0]] - grid[edges.edges[:, 1]]).astype(np.float64)
            length = np.sqrt(step[:, 0] * step[:, 0] + step[:, 1] * step[:, 1]).tolist()
            strength = edges.strength.tolist()
            means = []
            for stretch in _stretches([vertices for vertices, _ in found]):
                mine = [found[stretch[0]][1][k] for k in range(stretch[1], stretch[2])]
                total = math.fsum(length[e] for e in mine)
                means.append(math.floor(math.fsum(strength[e] * length[e] for e in mine) / total * STRENGTHS + 0.5))
            _code_strengths(coder, [vertices for vertices, _ in found], means)
    return EDGES + head + finished(coder)


def edges_from(data: bytes) -> EdgeList:
    """What `edges_bytes` wrote, each vertex and edge sound by itself (see `edge_list.check`).

    Raises FormatError and LimitError.
    """
    first = data[:4] == EDGES_1
    (width, height, columns, rows, count, strong), rest = header(data, EDGES_1 if first else EDGES, 6)
    if not (1 <= width <= edge_list.MAX_SIDE and 1 <= height <= edge_list.MAX_SIDE):
        raise FormatError(f"edges of a frame {width} x {height}")
    if not (1 <= columns <= MAX_GRID and 1 <= rows <= MAX_GRID) or strong > 1:
        raise FormatError(f"edges on a grid of {columns} x {rows}")
    if count > 16 * len(rest) + 64:
        raise FormatError(f"{count} edges in {len(rest)} bytes; truncated")
    coder = Coder(rest)
    chains = _Chains(coder, each=bool(strong) and first)
    chains.read(count, columns, rows)
    steps = chains.strengths
    if strong and not first and not coder.overrun:
        stretches = _stretches(chains.trails)
        means = [0] * len(stretches)
        _code_strengths(coder, chains.trails, means)
        steps = [mean for mean, (_, begin, end) in zip(means, stretches, strict=True) for _ in range(begin, end)]
    check_end(coder)
    vertices = np.array(chains.points, np.float64).reshape(-1, 2) * (width, height) / (columns, rows)
    strength = np.array(steps, np.float64) / STRENGTHS if strong else None
    found = EdgeList(width, height, vertices, np.array(chains.ends, np.int64).reshape(-1, 2), strength)
    edge_list.check(found)
    return found


def _stretches(found: list[list[int]]) -> list[tuple[int, int, int]]:
    """The stretches between junctions of trails of vertices: number of the trail, its first edge, one past its last."""
    degree: dict[int, int] = {}
    for trail in found:
        for a, b in pairwise(trail):
            degree[a] = degree.get(a, 0) + 1
            degree[b] = degree.get(b, 0) + 1
    stretches = []
    for number, trail in enumerate(found):
        begin = 0
        for k in range(1, len(trail)):
            if degree[trail[k]] != 2 or k == len(trail) - 1:
                stretches.append((number, begin, k))
                begin = k
    return stretches


def _code_strengths(coder: Coder, found: list[list[int]], means: list[int]) -> None:
    """Code one strength a stretch, 0 … STRENGTHS: they are written, or read in place. Raises FormatError."""
    for k, (_, begin, end) in enumerate(_stretches(found)):
        if coder.overrun:
            return
        means[k] = coder.number(means[k], _STRENGTH, min(end - begin, _MOST_OF_A_STRETCH))
        if not 0 <= means[k] <= STRENGTHS:
            raise FormatError(f"stretch {k}: strength {means[k]}; 0 to {STRENGTHS} is allowed")


class _Chains:
    """Edges as chains of steps from grid point to grid point.

    A chain starts at an old point, or at a new one, which is coded by its offset from the last new start. Each step is
    expected in the direction of the one before. Its coordinate along the longer side of that one is coded first, then
    how far the other coordinate is from where the direction has it.

    read: fills points, the (a, b) of each vertex; trails of vertices; ends, the vertices of each edge; strengths.
    """

    def __init__(self, coder: Coder, each: bool = False):
        """each: whether a strength follows each step, as in ``PIe1``."""
        self.coder, self.each = coder, each
        self.points: list[tuple[int, int]] = []
        self.trails: list[list[int]] = []
        self.ends: list[tuple[int, int]] = []
        self.strengths: list[int] = []

    def _step(self, dx: int, dy: int, before: tuple[int, int]) -> tuple[int, int]:
        """Code a step (dx, dy); when it is read, whatever is given is ignored. before: (0, 0) at a chain's start."""
        bx, by = before
        swap = abs(by) > abs(bx)
        if swap:
            dx, dy, bx, by = dy, dx, by, bx
        turned = -1 if bx < 0 else 1
        size = min(255, abs(bx).bit_length() * 16 + min(15, 16 * abs(by) // abs(bx) if bx else 0))
        dx = turned * self.coder.number(turned * dx, _MAIN, size >> 4, size)
        guess = (2 * dx * by + abs(bx)) // (2 * abs(bx)) * turned if bx else 0
        dy = guess + self.coder.number(dy - guess, _ASIDE, min(255, abs(dx).bit_length() * 16 + (size >> 4)), size)
        return (dy, dx) if swap else (dx, dy)

    def write(self, grid: Ints, found: list[Trail]) -> None:
        """Write trails over grid points (n, 2)."""
        coder = self.coder
        seen: dict[int, int] = {}
        points = grid.tolist()
        last = (0, 0)
        for chain, _ in found:
            x, y = points[chain[0]]
            if chain[0] in seen:
                coder.number(len(seen) - seen[chain[0]], _CHAIN)
            else:
                coder.number(0, _CHAIN)
                coder.number(y - last[1], _DOWN)
                coder.number(x - last[0], _ALONG, min(255, abs(y - last[1])))
                last = (x, y)
                seen[chain[0]] = len(seen)
            before, kind = (0, 0), _NEW
            for i, vertex in enumerate(chain[1:]):
                if vertex in seen:
                    now = _START if vertex == chain[0] else _OLD
                    coder.number(now, _STEP, kind, min(i, 15))
                    if now == _OLD:
                        coder.number(len(seen) - seen[vertex], _BACK)
                else:
                    now = _NEW
                    coder.number(now, _STEP, kind, min(i, 15))
                    nx, ny = points[vertex]
                    before = self._step(nx - x, ny - y, before)
                    seen[vertex] = len(seen)
                x, y = points[vertex]
                kind = now
            coder.number(_END, _STEP, kind, min(len(chain) - 1, 15))

    def read(self, count: int, columns: int, rows: int) -> None:
        """Read ``count`` edges. Raises FormatError."""
        coder, points, ends = self.coder, self.points, self.ends
        last = (0, 0)

        def new(x: int, y: int) -> int:
            if not (0 <= x <= columns and 0 <= y <= rows):
                raise FormatError(f"vertex {len(points)} at {x}, {y} is off the grid of {columns} x {rows}")
            points.append((x, y))
            return len(points) - 1

        def old(back: int) -> int:
            if not 0 < back <= len(points):
                raise FormatError(f"a step back over {back} of {len(points)} vertices")
            return len(points) - back

        while len(ends) < count and not coder.overrun:
            back = coder.number(0, _CHAIN)
            if back:
                at = old(back)
            else:
                y = last[1] + coder.number(0, _DOWN)
                last = (last[0] + coder.number(0, _ALONG, min(255, abs(y - last[1]))), y)
                at = new(*last)
            start, before, kind, strength, i = at, (0, 0), _NEW, 0, 0
            trail = [at]
            self.trails.append(trail)
            while not coder.overrun:
                now = coder.number(0, _STEP, kind, min(i, 15))
                if now == _END:
                    break
                if len(ends) == count:
                    raise FormatError(f"more than the {count} edges announced")
                if now == _NEW:
                    before = self._step(0, 0, before)
                    to = new(points[at][0] + before[0], points[at][1] + before[1])
                elif now == _START:
                    to = start
                else:
                    to = old(coder.number(0, _BACK))
                ends.append((at, to))
                trail.append(to)
                at, kind, i = to, now, i + 1
                if self.each:
                    strength += coder.number(0, _STRENGTH, strength, int(i > 1))
                    if not 0 <= strength <= STRENGTHS:
                        raise FormatError(f"edge {len(ends) - 1}: strength {strength}; 0 to {STRENGTHS} is allowed")
                    self.strengths.append(strength)
