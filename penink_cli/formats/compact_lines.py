"""Telling lines in as few bytes as they can be: a member of a packed illustration, ``PIl2`` (see `compact`).

Three whole numbers, W, H and how many lines, then code. Lines come by falling rank, so that the list of a smaller
print is the beginning of that of a larger one. Points lie on a grid that has so many steps to the root of the frame's
area, and are as few as stay within a step of those given; ranks and weights are kept in few steps. ``PIl1``, which
had finer steps and all points, is read.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from penink_cli.formats import lines as lines_format
from penink_cli.formats._compiled.compact import Coder
from penink_cli.formats.compact import MAX_GRID, _check_end, _finished, _header, _numbers
from penink_cli.ground.errors import FormatError, LimitError
from penink_cli.ground.model import Lines

LINES, LINES_1 = b"PIl2", b"PIl1"
MOST_RANK = 1000
MAX_POINTS = 1 << 20

_RANK, _KIND, _COUNT, _BREADTH, _X, _Y, _MAIN, _ASIDE, _MAIN_TURN, _ASIDE_TURN, _WEIGHT, _PRESS = range(12)


class _Steps(NamedTuple):
    """What numbers are kept in: grid steps to the root of the frame's area, steps of rank and of weight to 1."""

    side: int
    rank: int
    weight: int

    def grid(self, width: int, height: int) -> tuple[int, int]:
        root = math.sqrt(width * height)
        columns, rows = (min(max(1, math.floor(self.side * side / root + 0.5)), MAX_GRID) for side in (width, height))
        return columns, rows


_WRITTEN = _Steps(880, 4, 3)
_STEPS = {LINES: _WRITTEN, LINES_1: _Steps(1280, 16, 7)}


def lines_bytes(lines: Lines) -> bytes:
    """Telling lines at the precision they are kept at, those that it leaves no length left away. Raises LimitError."""
    columns, rows = _WRITTEN.grid(lines.width, lines.height)
    scale = np.array([columns / lines.width, rows / lines.height])
    grid = np.floor(lines.points * scale + 0.5).astype(np.int64)
    weights = np.floor(lines.weight * _WRITTEN.weight + 0.5).astype(np.int64)
    broad = np.floor(lines.breadth * (2 * math.sqrt(float(scale[0] * scale[1]))) + 0.5).astype(np.int64)
    ranks = np.floor(np.minimum(lines.rank, MOST_RANK) * _WRITTEN.rank + 0.5).astype(np.int64)
    items = []
    for i in np.argsort(-lines.rank, kind="stable").tolist():
        mine = slice(int(lines.first[i]), int(lines.first[i + 1]))
        points = grid[mine]
        keep = np.ones(len(points), bool)
        keep[1:] = (points[1:] != points[:-1]).any(axis=1)
        breadth = max(int(broad[i]), 1) if lines.breadth[i] > 0 else 0
        if keep.sum() >= 2 or breadth:
            path, pressed = _fewest(points[keep].tolist(), weights[mine][keep].tolist())
            items.append((int(ranks[i]), int(lines.white[i]), breadth, path, pressed))
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
    return LINES + _numbers(lines.width, lines.height, len(items)) + _finished(coder)


def lines_from(data: bytes) -> Lines:
    """What `lines_bytes` wrote, each line sound. Raises FormatError, and LimitError."""
    first = data[:4] == LINES_1
    kept = _STEPS[LINES_1 if first else LINES]
    (width, height, count), rest = _header(data, LINES_1 if first else LINES, 3)
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
        if not (0 <= last <= MOST_RANK * kept.rank and 0 <= kind <= 3 and breadth >= 0 and size > 0):
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
    _check_end(coder)
    begins = np.zeros(len(sizes) + 1, np.int64)
    np.cumsum(sizes, out=begins[1:])
    step = np.array([width / columns, height / rows])
    found = Lines(
        width, height, np.array(points, np.float64).reshape(-1, 2) * step, begins,
        np.array(weights, np.float64) / kept.weight,
        np.array(ranks, np.float64) / kept.rank, np.array(whites, np.bool_),
        np.array(breadths, np.float64) * (math.sqrt(float(step[0] * step[1])) / 2),
    )  # fmt: skip
    lines_format.check(found)
    return found


def _fewest(points: list[list[int]], weights: list[int]) -> tuple[list[list[int]], list[int]]:
    """The fewest points between which the path, and the weight along it, stays within a step of those given.

    So often that once more would change nothing: what is read is written as the same bytes.
    """
    while True:
        keep = [False] * len(points)
        keep[0] = keep[-1] = True
        spans = [(0, len(points) - 1)]
        while spans:
            first, last = spans.pop()
            (ax, ay), wa = points[first], weights[first]
            dx, dy, dw = points[last][0] - ax, points[last][1] - ay, weights[last] - wa
            square = dx * dx + dy * dy
            worst, at = 0, 0
            for k in range(first + 1, last):
                px, py = points[k][0] - ax, points[k][1] - ay
                along = px * dx + py * dy
                if 0 <= along <= square and square:
                    off = (px * dy - py * dx) ** 2  # of the square of a step, times that of the length
                    pressed = abs(wa * square + dw * along - weights[k] * square)
                    wrong = max(off if off > square else 0, pressed * square if pressed > square else 0)
                else:
                    wrong = (px * px + py * py) * max(1, square)
                if wrong > worst:
                    worst, at = wrong, k
            if worst:
                keep[at] = True
                spans += [(first, at), (at, last)]
        if all(keep):
            return points, weights
        points = [point for point, stays in zip(points, keep) if stays]
        weights = [weight for weight, stays in zip(weights, keep) if stays]


def _code_path_2(coder: Coder, path: list[list[int]], columns: int, rows: int) -> None:
    """Points, given (to write) or not (to read, in place), each step expected in the direction of the one before it.

    Steps are written along the longer side of the one before, then what they are beside its direction.
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
    """Points, given (to write) or not (to read, in place): each step is expected to go on as the one before it.

    Steps are written along the longer side of the one before, then across it.
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
            main = coder.number(back * (a - ga), _MAIN_TURN, _size(main) * 12 + _size(aside), _size(gb))
            a = ga + back * main
            aside = coder.number(b - gb, _ASIDE_TURN, _within(aside) * 12 + _size(main), _size(gb))
            b = gb + aside
        bx, by = (b, a) if swap else (a, b)
        x, y = x + bx, y + by
        path[k][0], path[k][1] = x, y
    if not all(0 <= px <= columns and 0 <= py <= rows for px, py in path):
        raise FormatError(f"a point off the grid of {columns} x {rows}")


def _code_weights(coder: Coder, weights: list[int]) -> None:
    last = step = 0
    for k in range(len(weights)):
        if coder.overrun:
            return
        step = coder.number(weights[k] - last, _PRESS if k else _WEIGHT, _within(step), last)
        last = weights[k] = last + step
        _check_weight(last, _STEPS[LINES_1].weight)


def _size(value: int) -> int:
    """0 … 11, finer for small numbers."""
    value = abs(value)
    return value if value < 6 else min(11, 6 + (value - 6) // 4)


def _within(value: int) -> int:
    """0 … 20."""
    return max(-10, min(10, value)) + 10
