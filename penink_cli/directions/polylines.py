"""Drawn lines as evidence: the user's own strokes, and telling lines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from penink_cli.ground.model import Floats, Ints, Lines, Strokes

_PER_CELL = 3.0  # pieces of a line to a cell's length
_PIECES = 8  # straight pieces of a Bézier segment


@dataclass(frozen=True, eq=False)
class WeightedLines:
    """Lines in the photo's frame, and how much each of their points counts.

    points: (p, 2) x, y as parts of the frame's width and height. first: (n + 1,) where each line begins. weight: (p,).
    """

    points: Floats
    first: Ints
    weight: Floats


def crossed(lines: WeightedLines, rows: int, columns: int) -> tuple[Floats, Floats]:
    """Sums by cell of double-angle vectors (rows, columns, 2) along the lines, and of their lengths (rows, columns).

    Each piece of a line counts by its length in cells times its weight. What lies outside the frame does not count.
    """
    points = lines.points * (columns, rows)
    within = np.ones(max(0, len(points) - 1), np.bool_)
    within[lines.first[1:-1] - 1] = False  # from the end of a line to the beginning of the next
    start = np.flatnonzero(within)
    a, step = points[start], points[start + 1] - points[start]
    length = np.sqrt(step[:, 0] * step[:, 0] + step[:, 1] * step[:, 1])
    vectors, sums = np.zeros((rows * columns, 2)), np.zeros(rows * columns)
    some = (length > 0) & (length < 10.0 * (rows + columns))
    a, step, length, start = a[some], step[some], length[some], start[some]
    pieces = np.maximum(1, np.ceil(length * _PER_CELL)).astype(np.int64)
    of = np.repeat(np.arange(len(a)), pieces)
    at = (np.arange(len(of)) - np.repeat(np.cumsum(pieces) - pieces, pieces) + 0.5) / pieces[of]
    x, y = (a[of] + step[of] * at[:, None]).T
    inside = (x >= 0) & (y >= 0) & (x < columns) & (y < rows)
    of, at, cell = of[inside], at[inside], (y[inside].astype(np.int64) * columns + x[inside].astype(np.int64))
    weight = lines.weight[start][of] * (1 - at) + lines.weight[start + 1][of] * at
    weight *= length[of] / pieces[of]
    unit = step / length[:, None]
    double = np.stack([unit[:, 0] * unit[:, 0] - unit[:, 1] * unit[:, 1], 2 * unit[:, 0] * unit[:, 1]], axis=1)[of]
    for k in range(2):
        vectors[:, k] = np.bincount(cell, double[:, k] * weight, rows * columns)
    sums += np.bincount(cell, weight, rows * columns)
    return vectors.reshape(rows, columns, 2), sums.reshape(rows, columns)


def of_strokes(strokes: Strokes) -> WeightedLines:
    """Strokes on a sheet of any size that stands for the photo, each point with weight 1. Dots tell no direction."""
    begin = strokes.first[:-1]
    segments = (np.diff(strokes.first) - 1) // 3
    of = np.repeat(np.arange(len(segments)), segments)
    number = np.arange(len(of)) - np.repeat(np.cumsum(segments) - segments, segments)  # within its stroke
    at = (np.arange(_PIECES) + 1)[:, None] / _PIECES
    left = 1 - at
    a, b, c, d = (strokes.points[begin[of] + 3 * number + k][:, None] for k in range(4))
    curve = left * left * left * a + 3 * left * left * at * b + 3 * left * at * at * c + at * at * at * d
    first = np.concatenate([[0], np.cumsum(1 + _PIECES * segments)])
    points = np.empty((first[-1], 2))
    points[first[:-1]] = strokes.points[begin]
    points[first[of, None] + 1 + _PIECES * number[:, None] + np.arange(_PIECES)] = curve
    return WeightedLines(points / (strokes.width, strokes.height), first, np.ones(len(points)))


def of_lines(lines: Lines) -> WeightedLines:
    """Telling lines, each point with the weight with which the pen is pressed."""
    return WeightedLines(lines.points / (lines.width, lines.height), lines.first, lines.weight)
