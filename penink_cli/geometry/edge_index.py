"""The edges near a place: lists, by the cells of a uniform grid, of those whose bounding boxes touch each cell.

One index for all who look edges up a few times for each edge. Two others stay beside it, whose worth
`python -m tests.benchmarks.edge_index` prints: the reconstruction's (`reconstruction/_compiled/cells.pyx`), which is
asked millions of times, and the arrangement's (`arrangement/_compiled/planar.pyx`), whose edges come and go.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from penink_cli.ground.model import Floats, Ints


@dataclass(frozen=True, eq=False)
class EdgeGrid:
    """Segments, and those near each square of a grid over them.

    ends: (m, 4) x, y, x, y. size: of a square, as long. columns: squares in a row. Those near square c, which is
    `columns` · row + column, are items[begin[c] : begin[c + 1]].
    """

    ends: Floats
    size: float
    columns: int
    begin: Ints
    items: Ints


def grid(ends: Floats, size: float, width: float, height: float) -> EdgeGrid:
    """Segments (m, 4) within width × height, by squares of that size; there is one more beyond the frame each way."""
    columns, rows = math.ceil(width / size) + 2, math.ceil(height / size) + 2
    return EdgeGrid(ends, size, columns, *lists(*cells(ends, size), columns, rows))


def touched(low: Ints, high: Ints, columns: int) -> tuple[Ints, Ints]:
    """Cells, row by row numbered, and boxes (m,): each box with each cell that it touches; by cell, then by box.

    low, high: (m, 2) column and row of the first and of the last cell of each box; one with none has low above high.
    """
    wide, tall = np.maximum(high - low + 1, 0).T
    count = wide * tall
    box = np.repeat(np.arange(len(count)), count)
    inner = np.arange(len(box)) - np.repeat(np.cumsum(count) - count, count)
    cell = (low[box, 1] + inner // wide[box]) * columns + low[box, 0] + inner % wide[box]
    order = np.argsort(cell, kind="stable")
    return cell[order], box[order]


def lists(low: Ints, high: Ints, columns: int, rows: int) -> tuple[Ints, Ints]:
    """The boxes that touch each cell, those of cell c being items[begin[c] : begin[c + 1]]: (begin, items).

    low, high: as of `touched`; cells outside of the columns × rows are left out.
    """
    cell, box = touched(np.maximum(low, 0), np.minimum(high, (columns - 1, rows - 1)), columns)
    return np.searchsorted(cell, np.arange(columns * rows + 1)), box


def cells(ends: Floats, size: float) -> tuple[Ints, Ints]:
    """The first and the last cell, (m, 2) column and row, of the bounding boxes of segments (m, 4), x y x y."""
    low, high = np.minimum(ends[:, :2], ends[:, 2:]), np.maximum(ends[:, :2], ends[:, 2:])
    return np.floor(low / size).astype(np.int64), np.floor(high / size).astype(np.int64)
