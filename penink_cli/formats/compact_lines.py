"""Telling lines in few bytes: a member of a packed illustration, ``PIl3`` (see `compact`).

Three whole numbers, W, H and the number of lines, then code. Lines come by falling rank, so that the lines of a smaller
print are the first ones of a larger print's. Points lie on a grid, of 640 steps to the root of the frame's area. As few
points are kept as let the curve through them, which is what is drawn, stay near the given line. Ranks are kept in
eighths of an octave, weights in thirds. Lines whose points all lie on the grid are written as they are: what has been
read is written again as the same bytes.

``PIl2``, of finer steps and the points of polygons, and ``PIl1``, of all points, are read and no longer written.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from penink_cli.formats import lines as lines_format
from penink_cli.formats._compiled.coder import Coder
from penink_cli.formats.members import MAX_GRID, check_end, finished, header, size_class, within, written_numbers
from penink_cli.geometry import curves
from penink_cli.ground.errors import FormatError, LimitError
from penink_cli.ground.model import Floats, Ints, Lines

LINES, LINES_2, LINES_1 = b"PIl3", b"PIl2", b"PIl1"
ALL_LINES = LINES, LINES_2, LINES_1
MOST_RANK = 1000
MAX_POINTS = 1 << 20  # of all lines

_RANK, _KIND, _COUNT, _BREADTH, _X, _Y, _MAIN, _ASIDE, _MAIN_TURN, _ASIDE_TURN, _WEIGHT, _PRESS = range(12)


class _Steps(NamedTuple):
    """side: steps of the grid to the root of the frame's area. ranks: those that are kept. weight: steps up to 1."""

    side: int
    ranks: Floats
    weight: int

    def grid(self, width: int, height: int) -> tuple[int, int]:
        """Columns and rows of the grid over a frame."""
        root = math.sqrt(width * height)
        columns, rows = (min(max(1, math.floor(self.side * side / root + 0.5)), MAX_GRID) for side in (width, height))
        return columns, rows


# A rank is kept as the next higher of these: with a lower one a line that there is room for might be left out.
_RANKS = np.array([0.0, *(round(0.25 * 2 ** (k / 8), 4) for k in range(96)), MOST_RANK])
_WRITTEN = _Steps(640, _RANKS, 3)
_STEPS = {
    LINES: _WRITTEN,
    LINES_2: _Steps(880, np.arange(MOST_RANK * 4 + 1) / 4, 3),
    LINES_1: _Steps(1280, np.arange(MOST_RANK * 16 + 1) / 16, 7),
}
_NEAR = 0.75  # steps that the curve that is kept may lie beside the line: half a point at 6 in, less than a pen's width
_LEAST_RING = 6  # points of a line that is drawn as a ring; with fewer it is drawn open


def lines_bytes(lines: Lines) -> bytes:
    """Telling lines at the precision they are kept at, without those that then have no length. Raises LimitError."""
    columns, rows = _WRITTEN.grid(lines.width, lines.height)
    scale = np.array([columns / lines.width, rows / lines.height])
    kept, at, weights = _fewest(lines, scale)
    broad = np.floor(lines.breadth * (2 * math.sqrt(float(scale[0] * scale[1]))) + 0.5).astype(np.int64)
    ranks = np.searchsorted(_WRITTEN.ranks, np.minimum(lines.rank, MOST_RANK))
    items = []
    for i in np.argsort(-lines.rank, kind="stable").tolist():
        mine = np.flatnonzero(kept[lines.first[i] : lines.first[i + 1]]) + int(lines.first[i])
        points = at[mine]
        moves = np.ones(len(points), bool)
        moves[1:] = (points[1:] != points[:-1]).any(axis=1)
        breadth = max(int(broad[i]), 1) if lines.breadth[i] > 0 else 0
        if moves.sum() >= 2 or breadth:
            items.append(
                (int(ranks[i]), int(lines.white[i]), breadth, points[moves].tolist(), weights[mine][moves].tolist())
            )
    if sum(len(item[3]) for item in items) > MAX_POINTS:
        raise LimitError(f"telling lines of more than {MAX_POINTS} points")
    coder = Coder()
    last = 0
    for k, (rank, white, breadth, points, pressed) in enumerate(items):
        coder.number(last - rank if k else rank, _RANK, int(k > 0))
        last = rank
        coder.number(white + 2 * (breadth > 0), _KIND)
        if breadth:
            coder.number(breadth, _BREADTH)
        coder.number(len(points), _COUNT, int(breadth > 0))
        _code_path_2(coder, points, columns, rows)
        _code_weights_2(coder, pressed)
    return LINES + written_numbers(lines.width, lines.height, len(items)) + finished(coder)


def lines_from(data: bytes) -> Lines:
    """What `lines_bytes` wrote, each line sound (see `lines.check`). Raises FormatError and LimitError."""
    magic = data[:4] if data[:4] in _STEPS else LINES
    first, kept = magic == LINES_1, _STEPS[magic]
    (width, height, count), rest = header(data, magic, 3)
    if not (1 <= width <= lines_format.MAX_SIDE and 1 <= height <= lines_format.MAX_SIDE):
        raise FormatError(f"lines of a frame {width} x {height}")
    if count > 8 * len(rest) + 64:
        raise FormatError(f"{count} lines in {len(rest)} bytes; truncated")
    columns, rows = kept.grid(width, height)
    coder = Coder(rest)
    ranks: list[int] = []
    whites: list[int] = []
    breadths: list[int] = []
    sizes: list[int] = []
    points: list[list[int]] = []
    weights: list[int] = []
    last = 0
    while len(ranks) < count and not coder.overrun:
        fall = coder.number(0, _RANK, int(len(ranks) > 0))
        last = last - fall if ranks else fall
        kind = coder.number(0, _KIND)
        breadth = coder.number(0, _BREADTH) if kind & 2 else 0
        size = coder.number(0, _COUNT, int(kind & 2 > 0))
        if not (0 <= last < len(kept.ranks) and 0 <= kind <= 3 and breadth >= 0 and size > 0):
            raise FormatError(f"line {len(ranks)} is damaged")
        if len(points) + size > MAX_POINTS:
            raise LimitError(f"telling lines of more than {MAX_POINTS} points")
        path, pressed = [[0, 0] for _ in range(size)], [0] * size
        if first:
            _code_path(coder, path, columns, rows)
            _code_weights(coder, pressed)
        else:
            _code_path_2(coder, path, columns, rows)
            _code_weights_2(coder, pressed)
        ranks.append(last)
        whites.append(kind & 1)
        breadths.append(breadth)
        sizes.append(size)
        points += path
        weights += pressed
    check_end(coder)
    begins = np.zeros(len(sizes) + 1, np.int64)
    np.cumsum(sizes, out=begins[1:])
    step = np.array([width / columns, height / rows])
    found = Lines(
        width, height, np.minimum(np.array(points, np.float64).reshape(-1, 2) * step, (width, height)), begins,
        np.array(weights, np.float64) / kept.weight,
        kept.ranks[np.array(ranks, np.int64)], np.array(whites, np.bool_),
        np.array(breadths, np.float64) * (math.sqrt(float(step[0] * step[1])) / 2),
    )  # fmt: skip
    lines_format.check(found)
    return found


def _fewest(lines: Lines, scale: Floats) -> tuple[npt.NDArray[np.bool_], Ints, Ints]:
    """(p,) which points are kept, (p, 2) the nearest grid point of each, (p,) its weight in steps.

    scale: (2,) grid steps to a pixel.
    """
    points, weight = lines.points * scale, lines.weight * _WRITTEN.weight
    places = np.floor(points + 0.5)
    if not len(points) or (np.abs(points - places) < 1e-6).all():
        return np.ones(len(points), bool), places.astype(np.int64), np.floor(weight + 0.5).astype(np.int64)
    count = np.diff(lines.first)
    paths = np.repeat(count > 1, count)
    first = np.concatenate([[0], np.cumsum(count[count > 1])])
    kept = np.ones(len(points), bool)
    if paths.any():
        kept[paths], at, weight[paths] = curves.fewest(points[paths], first, weight[paths], _NEAR, _NEAR)
        places[paths] = np.floor(at + 0.5)
    places = np.clip(places, 0, np.floor(scale * (lines.width, lines.height) + 0.5))
    for begin, end in pairwise(lines.first.tolist()):
        _still_closed(points[begin:end], kept[begin:end])
    return kept, places.astype(np.int64), np.floor(weight + 0.5).astype(np.int64)


def _still_closed(points: Floats, kept: npt.NDArray[np.bool_]) -> None:
    """Keep more points of a line, in place, where those kept would open a ring, or close a line that is open."""
    if _closes(points):
        wanted = np.rint(np.linspace(0, len(points) - 1, _LEAST_RING)).astype(np.int64)
        if kept.sum() < _LEAST_RING:
            kept[wanted] = True
        return
    while _closes(points[kept]):
        here = np.flatnonzero(kept)
        longest = int(np.argmax(curves.lengths(points[here]) * (np.diff(here) > 1)))
        middle = (here[longest] + here[longest + 1]) // 2
        if kept[middle]:
            return
        kept[middle] = True


def _closes(points: Floats) -> bool:
    """Whether a line is drawn as a ring; the rule is that of `penink_cli/lines/strokes.py`."""
    gap = points[0] - points[-1]
    if len(points) < _LEAST_RING:
        return False
    return math.sqrt(float(gap[0] * gap[0] + gap[1] * gap[1])) < float(curves.lengths(points).max()) / 3


def _code_path_2(coder: Coder, path: list[list[int]], columns: int, rows: int) -> None:
    """Code the points of a line, of ``PIl2`` and ``PIl3``: they are written, or read in place.

    Each step is expected in the direction of the one before. It is coded by its coordinate along the longer side of
    that one, then by how far it lies beside the direction. Raises FormatError.
    """
    x = path[0][0] = coder.number(path[0][0], _X)
    y = path[0][1] = coder.number(path[0][1], _Y)
    bx = by = aside = 0
    for k in range(1, len(path)):
        if coder.overrun:
            return
        dx, dy = path[k][0] - x, path[k][1] - y
        swap = abs(by) > abs(bx)
        a, b, ga, gb = (dy, dx, by, bx) if swap else (dx, dy, bx, by)
        back = -1 if ga < 0 else 1
        if k == 1:
            a = coder.number(a, _MAIN)
            b = coder.number(b, _ASIDE, min(255, 2 * abs(a) + (a < 0)))
        else:
            slope = min(255, abs(ga).bit_length() * 16 + min(15, 16 * abs(gb) // abs(ga)))
            a = back * coder.number(back * a, _MAIN_TURN, slope >> 4, slope)
            guess = (2 * a * gb + abs(ga)) // (2 * abs(ga)) * back
            near = min(abs(a), 15) * 16 + min(slope >> 4, 15)
            aside = coder.number_in(b - guess, _ASIDE_TURN, near, slope, max(-7, min(7, aside)) + 8)
            b = guess + aside
        bx, by = (b, a) if swap else (a, b)
        if not (bx or by):
            raise FormatError("a line that stands still")
        x, y = x + bx, y + by
        path[k][0], path[k][1] = x, y
    if not all(0 <= px <= columns and 0 <= py <= rows for px, py in path):
        raise FormatError(f"a point off the grid of {columns} x {rows}")


def _code_weights_2(coder: Coder, weights: list[int]) -> None:
    """Code the weights of a line, of ``PIl2`` and ``PIl3``: they are written, or read in place. Raises FormatError."""
    last = 0
    for k in range(len(weights)):
        if coder.overrun:
            return
        last = weights[k] = last + coder.number(weights[k] - last, _PRESS if k else _WEIGHT, last)
        _check_weight(last, _WRITTEN.weight)


def _check_weight(weight: int, most: int) -> None:
    if not 0 <= weight <= most:
        raise FormatError(f"a weight of {weight}; 0 to {most} is allowed")


def _code_path(coder: Coder, path: list[list[int]], columns: int, rows: int) -> None:
    """Read the points of a line of ``PIl1``, in place. Raises FormatError.

    Each step is expected to be the one before again. It is coded by its difference from that one, along the longer side
    of that one, then across.
    """
    x = path[0][0] = coder.number(path[0][0], _X)
    y = path[0][1] = coder.number(path[0][1], _Y)
    bx = by = 0
    main = aside = 0  # how much the last step differed
    for k in range(1, len(path)):
        if coder.overrun:
            return
        dx, dy = path[k][0] - x, path[k][1] - y
        swap = abs(by) > abs(bx)
        a, b, ga, gb = (dy, dx, by, bx) if swap else (dx, dy, bx, by)
        back = -1 if ga < 0 else 1
        if k == 1:
            a, b = coder.number(a, _MAIN), coder.number(b, _ASIDE)
        else:
            main = coder.number(back * (a - ga), _MAIN_TURN, size_class(main) * 12 + size_class(aside), size_class(gb))
            a = ga + back * main
            aside = coder.number(b - gb, _ASIDE_TURN, within(aside, 10) * 12 + size_class(main), size_class(gb))
            b = gb + aside
        bx, by = (b, a) if swap else (a, b)
        x, y = x + bx, y + by
        path[k][0], path[k][1] = x, y
    if not all(0 <= px <= columns and 0 <= py <= rows for px, py in path):
        raise FormatError(f"a point off the grid of {columns} x {rows}")


def _code_weights(coder: Coder, weights: list[int]) -> None:
    """Read the weights of a line of ``PIl1``, in place. Raises FormatError."""
    last = step = 0
    for k in range(len(weights)):
        if coder.overrun:
            return
        step = coder.number(weights[k] - last, _PRESS if k else _WEIGHT, within(step, 10), last)
        last = weights[k] = last + step
        _check_weight(last, _STEPS[LINES_1].weight)
