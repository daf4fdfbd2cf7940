"""The edges near a place: lists, by the cells of a uniform grid, of those whose bounding boxes touch each cell.

It serves every part of the program that looks edges up a few times for each edge. Two others stay beside it; their
worth is what `python -m tests.benchmarks.edge_index` prints. The reconstruction's
(`reconstruction/_compiled/cells.pyx`) is asked millions of times, and the edges of the arrangement's
(`arrangement/_compiled/planar.pyx`) come and go.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from penink_cli.ground.model import Floats, Ints


@dataclass(frozen=True, eq=False)
class EdgeGrid:
    """Segments, and those near each square of a grid over them.

    ends: (m, 4) x, y, x, y of both ends. size: side of a square. columns: squares in a row. The segments near square c,
    which is `columns` · row + column, are items[begin[c] : begin[c + 1]].
    """

    ends: Floats
    size: float
    columns: int
    begin: Ints
    items: Ints


def grid(ends: Floats, size: float, width: float, height: float) -> EdgeGrid:
    """Segments (m, 4) within width × height, by squares of that size; two rows and columns lie beyond the frame."""
    columns, rows = math.ceil(width / size) + 2, math.ceil(height / size) + 2
    return EdgeGrid(ends, size, columns, *lists(*cells(ends, size), columns, rows))


def touched(low: Ints, high: Ints, columns: int) -> tuple[Ints, Ints]:
    """Pairs of a cell and a box that touches it, (p,) and (p,), by cell, then by box. Cells are numbered row by row.

    low, high: (m, 2) column and row of the first and the last cell of each box; a box without cells has low above high.
    """
    wide, tall = np.maximum(high - low + 1, 0).T
    count = wide * tall
    box = np.repeat(np.arange(len(count)), count)
    inner = np.arange(len(box)) - np.repeat(np.cumsum(count) - count, count)
    cell = (low[box, 1] + inner // wide[box]) * columns + low[box, 0] + inner % wide[box]
    order = np.argsort(cell, kind="stable")
    return cell[order], box[order]


def lists(low: Ints, high: Ints, columns: int, rows: int) -> tuple[Ints, Ints]:
    """(begin, items): the boxes that touch cell c are items[begin[c] : begin[c + 1]].

    low, high: as of `touched`; cells outside columns × rows are left out.
    """
    cell, box = touched(np.maximum(low, 0), np.minimum(high, (columns - 1, rows - 1)), columns)
    return np.searchsorted(cell, np.arange(columns * rows + 1)), box


def cells(ends: Floats, size: float) -> tuple[Ints, Ints]:
    """The first and the last cell, (m, 2) column and row, of the bounding boxes of segments (m, 4), x y x y."""
    low, high = np.minimum(ends[:, :2], ends[:, 2:]), np.maximum(ends[:, :2], ends[:, 2:])
    return np.floor(low / size).astype(np.int64), np.floor(high / size).astype(np.int64)
