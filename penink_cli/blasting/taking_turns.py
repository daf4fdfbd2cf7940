"""Which lines go on where it is light: of each two neighbours one, of those that are left one again, and so on.

Lines along a field begin and end where the field has them, so even and odd ones cannot be counted through. The lines
are cut into pieces. Pieces beside each other should differ, pieces that follow each other on one line should be alike.
Where both cannot be had, a line leaves off and its neighbour goes on instead, preferably where it is dark and does not
show.

This module alone imports the compiled kernel `taking_turns`.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from penink_cli.blasting import curves
from penink_cli.blasting._compiled import taking_turns as _turns
from penink_cli.ground.model import Floats, Ints

Mask = npt.NDArray[np.bool_]

#: How many times every second line is left out: at the least one line in 2^LEVELS remains.
LEVELS = 3
#: Samples of a piece; the weight of the next piece on the same line beside that of one neighbour; rounds of settling.
PIECE, ALIKE, ROUNDS = 12, 16.0, 12
#: The width of the cells of the grid in which neighbours are found, in parts of the distance of lines.
CELL = 0.4
#: How neighbours are looked for there, by the names that a page has for it.
SEARCH: dict[str, float] = _turns.SEARCH


def levels(points: Floats, first: Ints, normals: Floats, light: Floats, spacing: float) -> npt.NDArray[np.int8]:
    """(p,) when a line is left out at each sample: 1 the first ones, every second; then 2 …; 0 those that remain.

    points: (p, 2) samples about a point apart; first: where each line's begin; normals: (p, 2) of the lines;
    light: (p,) how much it matters there, 0 … 1; spacing: of the lines.
    """
    counts = np.diff(first)
    which = np.repeat(np.arange(len(counts)), counts)
    pieces = np.maximum(1, np.rint(counts / PIECE)).astype(np.int64)
    number = curves.starts(pieces)
    piece = number[which] + curves.ramp(counts) * pieces[which] // counts[which]
    follows = np.ones(int(number[-1]), bool)
    follows[number[:-1]] = False
    weight = np.bincount(piece, light, len(follows)) / np.bincount(piece, minlength=len(follows))
    out = np.zeros(len(follows), np.int8)
    left = np.ones(len(follows), bool)
    for level in range(1, LEVELS + 1):
        sides = _sides(points, normals, piece, which, follows, weight, left, spacing * 2 ** (level - 1))
        out[left & (sides == 1)] = level
        left &= sides == 0
    return out[piece]


def _neighbours(points: Floats, normals: Floats, which: Ints, some: Ints, spacing: float) -> _turns.Neighbours:
    """Where lines are, so that those of their samples that are among `some` are found from beside."""
    cell = CELL * spacing
    x, y = points[:, 0], points[:, 1]
    left, top = float(x.min(initial=0.0)) - cell, float(y.min(initial=0.0)) - cell
    columns, rows = int((x.max(initial=0.0) - left) / cell) + 2, int((y.max(initial=0.0) - top) / cell) + 2
    there = np.full((rows, columns), -1, np.int32)
    points, normals, line = np.ascontiguousarray(points), np.ascontiguousarray(normals), which.astype(np.int32)
    near = max(3, round(3 * spacing))  # samples are about a point apart
    out = _turns.Neighbours(points, normals, line, there, left, top, cell, spacing, near)
    out.mark(some.astype(np.int32))
    return out


def beside(points: Floats, first: Ints, normals: Floats, samples: Ints, spacing: float) -> npt.NDArray[np.int32]:
    """(n, 2) the sample of the line next to each of those samples, along its normal and against it; -1 for none."""
    which = np.repeat(np.arange(len(first) - 1), np.diff(first))
    out = np.empty((len(samples), 2), np.int32)
    _neighbours(points, normals, which, np.arange(len(points)), spacing).beside(samples.astype(np.int32), out)
    return out


def distances(points: Floats, first: Ints, normals: Floats, spacing: float) -> tuple[Floats, Floats, Mask]:
    """How far apart lines are at each sample (p,), the mean of both sides; how much more to the normal's side.

    And whether there is a line on either side, of about the same direction.
    """
    n = len(points)
    which = np.repeat(np.arange(len(first) - 1), np.diff(first))
    apart, more, both = np.empty(n), np.empty(n), np.empty(n, np.uint8)
    _neighbours(points, normals, which, np.arange(n), spacing).distances(apart, more, both)
    return apart, more, both > 0


def _sides(
    points: Floats, normals: Floats, piece: Ints, which: Ints, follows: npt.NDArray[np.bool_], weight: Floats,
    left: npt.NDArray[np.bool_], spacing: float,
) -> npt.NDArray[np.int8]:  # fmt: skip
    """(n,) 0 or 1 for each piece that is left."""
    some = np.flatnonzero(left[piece])
    half = some[::2]
    met = np.empty((len(half), 2), np.int32)
    _neighbours(points, normals, which, some, spacing).beside(half.astype(np.int32), met)
    here = np.repeat(half, 2)[met.ravel() >= 0]
    pairs_of = np.sort(np.column_stack([piece[here], piece[met[met >= 0]]]), axis=1)
    n = len(follows)
    pairs, times = np.unique(pairs_of[:, 0] * n + pairs_of[:, 1], return_counts=True)
    a, b = pairs // n, pairs % n
    apart = a != b
    a, b, times = a[apart], b[apart], times[apart]
    after = np.flatnonzero(follows & left & np.concatenate([[False], left[:-1]]))
    a, b = np.concatenate([a, after - 1]), np.concatenate([b, after])
    matters = np.minimum(weight[a], weight[b]) + 0.02
    value = np.concatenate([-times.astype(np.float64), np.full(len(after), ALIKE)]) * matters
    value = np.rint(value * 64)  # whole numbers: no sum depends on its order
    order = np.argsort(-np.abs(value), kind="stable")
    side = np.zeros(n, np.int8)
    _turns.join(
        a[order].astype(np.int32), b[order].astype(np.int32), (value[order] < 0).astype(np.int8),
        np.arange(n, dtype=np.int32), side,
    )  # fmt: skip
    ends, others, values = np.concatenate([a, b]), np.concatenate([b, a]), np.concatenate([value, value])
    order = np.argsort(ends, kind="stable")
    begin = curves.starts(np.bincount(ends, minlength=n))
    _turns.settle(begin, others[order].astype(np.int32), values[order].astype(np.float32), side, ROUNDS)
    return side
