"""Telling lines in as few bytes as they can be: a member of a packed illustration, ``PIl1`` (see `compact`).

Three whole numbers, W, H and how many lines, then code. Lines come by falling rank, so that the list of a smaller
print is the beginning of that of a larger one. Points lie on a grid that has `SIDE` steps to the root of the frame's
area, two fifths of a pixel of a photo of 512 × 512; ranks are kept in sixteenths, weights in sevenths.
"""

from __future__ import annotations

import math

import numpy as np

from penink_cli.formats import lines as lines_format
from penink_cli.formats._compiled.compact import Coder
from penink_cli.formats.compact import MAX_GRID, _check_end, _finished, _header, _numbers
from penink_cli.ground.errors import FormatError, LimitError
from penink_cli.ground.model import Lines

LINES = b"PIl1"
SIDE = 1280  # grid steps to the root of the frame's area
RANKS, WEIGHTS = 16, 7  # steps to 1
MOST_RANK = RANKS * 1000
MAX_POINTS = 1 << 20

_RANK, _KIND, _COUNT, _BREADTH, _X, _Y, _MAIN, _ASIDE, _MAIN_TURN, _ASIDE_TURN, _WEIGHT, _PRESS = range(12)


def _grid(width: int, height: int) -> tuple[int, int]:
    root = math.sqrt(width * height)
    columns, rows = (min(max(1, math.floor(SIDE * side / root + 0.5)), MAX_GRID) for side in (width, height))
    return columns, rows


def lines_bytes(lines: Lines) -> bytes:
    """Telling lines at the precision they are kept at, those that it leaves no length left away. Raises LimitError."""
    columns, rows = _grid(lines.width, lines.height)
    scale = np.array([columns / lines.width, rows / lines.height])
    grid = np.floor(lines.points * scale + 0.5).astype(np.int64)
    weights = np.floor(lines.weight * WEIGHTS + 0.5).astype(np.int64)
    broad = np.floor(lines.breadth * (2 * math.sqrt(float(scale[0] * scale[1]))) + 0.5).astype(np.int64)
    ranks = np.minimum(np.floor(lines.rank * RANKS + 0.5), MOST_RANK).astype(np.int64)
    items = []
    for i in np.argsort(-lines.rank, kind="stable").tolist():
        mine = slice(int(lines.first[i]), int(lines.first[i + 1]))
        points = grid[mine]
        keep = np.ones(len(points), bool)
        keep[1:] = (points[1:] != points[:-1]).any(axis=1)
        breadth = max(int(broad[i]), 1) if lines.breadth[i] > 0 else 0
        if keep.sum() >= 2 or breadth:
            path, pressed = points[keep].tolist(), weights[mine][keep].tolist()
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
        _code_path(coder, points, columns, rows)
        _code_weights(coder, pressed)
    return LINES + _numbers(lines.width, lines.height, len(items)) + _finished(coder)


def lines_from(data: bytes) -> Lines:
    """What `lines_bytes` wrote, each line sound. Raises FormatError, and LimitError."""
    (width, height, count), rest = _header(data, LINES, 3)
    if not (1 <= width <= lines_format.MAX_SIDE and 1 <= height <= lines_format.MAX_SIDE):
        raise FormatError(f"lines of a frame {width} x {height}")
    if count > 8 * len(rest) + 64:
        raise FormatError(f"{count} lines in {len(rest)} bytes; truncated")
    columns, rows = _grid(width, height)
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
        if not (0 <= last <= MOST_RANK and 0 <= kind <= 3 and breadth >= 0 and size > 0):
            raise FormatError(f"line {len(ranks)} is damaged")
        if len(points) + size > MAX_POINTS:
            raise LimitError(f"telling lines of more than {MAX_POINTS} points")
        path, pressed = [[0, 0] for _ in range(size)], [0] * size
        _code_path(coder, path, columns, rows)
        _code_weights(coder, pressed)
        ranks.append(last)
        whites.append(kind & 1)
        breadths.append(breadth)
        sizes.append(size)
        points += path
        weights += pressed
    _check_end(coder)
    first = np.zeros(len(sizes) + 1, np.int64)
    np.cumsum(sizes, out=first[1:])
    step = np.array([width / columns, height / rows])
    found = Lines(
        width, height, np.array(points, np.float64).reshape(-1, 2) * step, first,
        np.array(weights, np.float64) / WEIGHTS,
        np.array(ranks, np.float64) / RANKS, np.array(whites, np.bool_),
        np.array(breadths, np.float64) * (math.sqrt(float(step[0] * step[1])) / 2),
    )  # fmt: skip
    lines_format.check(found)
    return found


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
        if not 0 <= last <= WEIGHTS:
            raise FormatError(f"a weight of {last} sevenths")


def _size(value: int) -> int:
    """0 … 11, finer for small numbers."""
    value = abs(value)
    return value if value < 6 else min(11, 6 + (value - 6) // 4)


def _within(value: int) -> int:
    """0 … 20."""
    return max(-10, min(10, value)) + 10
