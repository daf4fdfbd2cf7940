"""Samples, edges and texts in as few bytes as they can be: the members of a packed illustration.

Each begins with four bytes that say what it is, then whole numbers (seven bits a byte, low ones
first, the eighth set on all but the last), then one stretch of the adaptive code of `_compact`:

=========  =========================================  ==========================================
``PIs1``   width, height, maxval                      samples, row by row, by their neighbours
``PIe1``   W, H, grid columns, grid rows, number of   chains: where each starts, then one step
           edges, 1 where strengths follow else 0     after the other
``PId1``   columns, rows                              directions: angles row by row, then confidence
``PIt1``   number of bytes                            a text, byte by byte
=========  =========================================  ==========================================

Vertices lie on a grid of columns × rows cells that spans the edge list's frame W × H: the point (a, b) is
x = a·W / columns, y = b·H / rows. The grid has `GRID` points to the sample spacing, which costs at most
0.1 dB against exact edges. Strengths are kept in sixteenths.

Directions are kept as ANGLES angles of a half turn, 3.75° apart, and as confidence in sevenths, one for 4 × 4 samples.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from penink_cli.formats import edge_list
from penink_cli.formats._compiled.compact import Coder
from penink_cli.geometry.trails import trails
from penink_cli.ground.errors import FormatError, LimitError
from penink_cli.ground.model import Directions, EdgeList, Floats, GreyImage, Ints

SAMPLES, EDGES, DIRECTIONS, TEXT = b"PIs1", b"PIe1", b"PId1", b"PIt1"

GRID = 16  # points of the edges' grid to the sample spacing
STRENGTHS = 16  # steps of strength
ANGLES = 48  # of a half turn: 0°, 45° and 90° are among them
SURE = 7  # the highest level of confidence
BLOCK = 4  # samples along a side that share one
MAX_FIELD = 1 << 20  # samples of a direction field
MAX_GRID = 1 << 24  # points along a side
# Decoding takes 0.6 µs a sample where all is paper, 8 µs a byte of text and up to 25 µs a byte of code: with these
# limits at most 10, 9 and some 20 seconds a member.
MAX_SAMPLES = 1 << 24
MAX_TEXT = 1 << 20
MAX_CODE = 1 << 20

# Kinds of numbers; each has statistics of its own.
_CHAIN, _DOWN, _ALONG, _STEP, _BACK, _MAIN, _ASIDE, _STRENGTH, _TURN = range(9)
# What a step along a chain leads to.
_NEW, _END, _START, _OLD = range(4)


def requantised(image: GreyImage, levels: int) -> GreyImage:
    """The image at no more than ``levels`` grey levels; one that has no more is returned as it is."""
    if image.maxval < levels:
        return image
    most = levels - 1
    values = (image.values.astype(np.int64) * (2 * most) + image.maxval) // (2 * image.maxval)
    return _grey(values, most)


def _grey(values: npt.NDArray[Any], maxval: int) -> GreyImage:
    return GreyImage(values.astype(np.uint8) if maxval < 256 else values.astype(np.uint16), maxval)


# ------------------------------------------------------------------------------ samples


def samples_bytes(image: GreyImage) -> bytes:
    """Samples, without loss. Raises LimitError."""
    h, w = image.values.shape
    coder = Coder()
    coder.samples(np.ascontiguousarray(image.values, np.int32), image.maxval)
    return SAMPLES + _numbers(w, h, image.maxval) + _finished(coder)


def samples_from(data: bytes, max_pixels: int) -> GreyImage:
    """What `samples_bytes` wrote. Raises FormatError, and LimitError before anything large is allocated."""
    (width, height, maxval), rest = _header(data, SAMPLES, 3)
    if not (width and height and 1 <= maxval <= 65535):
        raise FormatError(f"samples of {width} x {height} with maxval {maxval}")
    limit = min(max_pixels, MAX_SAMPLES)
    if width * height > limit:
        raise LimitError(f"{width} x {height} samples; {limit} are allowed in all")
    values = np.zeros((height, width), np.int32)
    coder = Coder(rest)
    coder.samples(values, maxval)
    _check_end(coder)
    return _grey(values, maxval)


# -------------------------------------------------------------------------------- texts


def text_bytes(text: bytes) -> bytes:
    """Any bytes, best those of a text. Raises LimitError."""
    if len(text) > MAX_TEXT:
        raise LimitError(f"a text of {len(text)} bytes; {MAX_TEXT} are allowed")
    coder = Coder()
    coder.text(np.frombuffer(bytearray(text), np.uint8))
    return TEXT + _numbers(len(text)) + _finished(coder)


def text_from(data: bytes) -> bytes:
    """What `text_bytes` wrote."""
    (size,), rest = _header(data, TEXT, 1)
    if size > MAX_TEXT:
        raise LimitError(f"a text of {size} bytes; {MAX_TEXT} are allowed")
    values = np.zeros(size, np.uint8)
    coder = Coder(rest)
    coder.text(values)
    _check_end(coder)
    return values.tobytes()


# --------------------------------------------------------------------------- directions


def _angles() -> Floats:
    """(ANGLES, 2) the double-angle vectors of the angles that are kept."""
    double = [2 * math.pi * k / ANGLES for k in range(ANGLES)]
    return np.array([(round(math.cos(a), 12), round(math.sin(a), 12)) for a in double])


def directions_bytes(field: Directions) -> bytes:
    """A direction field, each sample at the nearest of the angles and levels that are kept. Raises LimitError."""
    rows, columns = field.cos2.shape
    _check_field(columns, rows)
    angles = _angles()
    nearest = np.empty((rows, columns), np.int64)
    for i in range(rows):  # where nothing is known, both 0, it is the first angle
        nearest[i] = np.argmax(field.cos2[i, :, None] * angles[:, 0] + field.sin2[i, :, None] * angles[:, 1], axis=1)
    coder = Coder()
    _code_angles(coder, nearest)
    coder.samples(_by_blocks(field.confidence), SURE)
    return DIRECTIONS + _numbers(columns, rows) + _finished(coder)


def directions_from(data: bytes) -> Directions:
    """What `directions_bytes` wrote."""
    (columns, rows), rest = _header(data, DIRECTIONS, 2)
    if not (columns and rows):
        raise FormatError(f"directions of {columns} x {rows} samples")
    _check_field(columns, rows)
    coder = Coder(rest)
    nearest = np.zeros((rows, columns), np.int64)
    _code_angles(coder, nearest)
    levels = np.zeros((-(-rows // BLOCK), -(-columns // BLOCK)), np.int32)
    coder.samples(levels, SURE)
    _check_end(coder)
    if not levels.any():
        raise FormatError("confidence is 0 everywhere")
    cos2, sin2 = np.moveaxis(_angles()[nearest], 2, 0)
    confidence = levels.repeat(BLOCK, axis=0).repeat(BLOCK, axis=1)[:rows, :columns] / SURE
    return Directions(np.ascontiguousarray(cos2), np.ascontiguousarray(sin2), confidence)


def _check_field(columns: int, rows: int) -> None:
    if columns * rows > MAX_FIELD:
        raise LimitError(f"{columns} x {rows} samples of a direction field; {MAX_FIELD} are allowed")


def _by_blocks(confidence: npt.NDArray[np.floating]) -> npt.NDArray[np.int32]:
    """Levels of confidence, the mean of a block each; at least one above 0."""
    h, w = confidence.shape
    whole = np.pad(confidence.astype(np.float64), ((0, -h % BLOCK), (0, -w % BLOCK)), mode="edge")
    mean = np.zeros((len(whole) // BLOCK, whole.shape[1] // BLOCK))
    for i in range(BLOCK):
        for j in range(BLOCK):
            mean += whole[i::BLOCK, j::BLOCK] / BLOCK**2
    levels = np.floor(np.clip(mean, 0, 1) * SURE + 0.5).astype(np.int32)
    if not levels.any():
        levels[np.unravel_index(np.argmax(mean), mean.shape)] = 1
    return levels


def _code_angles(coder: Coder, nearest: Ints) -> None:
    """Angles (h, w), 0 … ANGLES − 1, row by row, each as its turn from what its neighbours let expect; in place."""
    h, w = nearest.shape
    turns = np.zeros((2, w + 2), np.int64).tolist()  # of this row and the last, how large they were
    above: list[int] = [0] * (w + 2)
    for i in range(h):
        given, row = nearest[i].tolist(), [0] * (w + 2)
        ahead = above[1]
        last, before = turns[(i + 1) & 1], turns[i & 1]
        for j in range(w):
            if coder.overrun:
                return
            # The neighbours are told by their turns from the west one, so that the half turn is no seam.
            west = row[j] if j else ahead
            north = west + _turn(above[j + 1] - west) if i else west
            north_west = west + _turn(above[j] - west) if i and j else north
            north_east = north + _turn(above[j + 2] - north) if i and j + 1 < w else north
            guess = (2 * (west + north) + north_east - north_west + 2) >> 2
            rough = abs(west - north_west) + abs(north - north_west) + abs(north - north_east)
            near = last[j + 1] + last[j + 2] + before[j]
            aside = 7 * _within_3(west - guess) + _within_3(north - guess)
            turn = coder.number(_turn(given[j] - guess), _TURN, 12 * _size(near) + _size(rough), aside)
            row[j + 1] = (guess + turn) % ANGLES
            before[j + 1] = min(ANGLES, abs(turn))
        above = row
        nearest[i] = row[1:-1]


def _turn(steps: int) -> int:
    """The same turn between −ANGLES / 2 and ANGLES / 2."""
    return (steps + ANGLES // 2) % ANGLES - ANGLES // 2


def _size(value: int) -> int:
    """0 … 11, finer for small numbers."""
    return value if value < 6 else min(11, 6 + (value - 6) // 4)


def _within_3(value: int) -> int:
    """0 … 6."""
    return max(-3, min(3, value)) + 3


# -------------------------------------------------------------------------------- edges


def edges_bytes(edges: EdgeList, columns: int, rows: int) -> bytes:
    """Edges whose vertices lie on a grid of columns × rows cells, in an order that depends on nothing but them.

    Strengths are rounded to sixteenths. Raises LimitError.
    """
    grid = np.rint(edges.vertices * (columns / edges.width, rows / edges.height)).astype(np.int64)
    strong = edges.strength is not None
    head = _numbers(edges.width, edges.height, columns, rows, len(edges.edges), int(strong))
    coder = Coder()
    if len(edges.edges):
        steps = np.zeros(len(edges.edges), np.int64)
        if edges.strength is not None:
            steps = np.floor(edges.strength * STRENGTHS + 0.5).astype(np.int64)
        _Chains(coder, strong).write(grid, edges.edges, steps)
    return EDGES + head + _finished(coder)


def edges_from(data: bytes) -> EdgeList:
    """What `edges_bytes` wrote, each vertex and edge sound by itself (see `edge_list.check`)."""
    (width, height, columns, rows, count, strong), rest = _header(data, EDGES, 6)
    if not (1 <= width <= edge_list.MAX_SIDE and 1 <= height <= edge_list.MAX_SIDE):
        raise FormatError(f"edges of a frame {width} x {height}")
    if not (1 <= columns <= MAX_GRID and 1 <= rows <= MAX_GRID) or strong > 1:
        raise FormatError(f"edges on a grid of {columns} x {rows}")
    if count > 16 * len(rest) + 64:
        raise FormatError(f"{count} edges in {len(rest)} bytes; truncated")
    chains = _Chains(Coder(rest), bool(strong))
    grid, ends, steps = chains.read(count, columns, rows)
    vertices = np.array(grid, np.float64).reshape(-1, 2) * (width, height) / (columns, rows)
    strength = np.array(steps, np.float64) / STRENGTHS if strong else None
    found = EdgeList(width, height, vertices, np.array(ends, np.int64).reshape(-1, 2), strength)
    edge_list.check(found)
    return found


class _Chains:
    """Edges as chains of steps from grid point to grid point.

    A chain starts at a new point, told by its offset from the start before it, or at an old one. Each
    step is expected to go on in the direction of the one before: its longer coordinate is
    written first, then how far the other is from where that direction would have it.
    """

    def __init__(self, coder: Coder, strong: bool):
        self.coder, self.strong = coder, strong

    def _step(self, dx: int, dy: int, before: tuple[int, int]) -> tuple[int, int]:
        """One step, given (to write) or not (to read), and the step before it, (0, 0) at the start of a chain."""
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

    def write(self, grid: Ints, ends: Ints, steps: Ints) -> None:
        coder = self.coder
        seen: dict[int, int] = {}
        points = grid.tolist()
        last = (0, 0)
        for chain, along in trails(grid, ends):
            strengths = steps[along].tolist()
            x, y = points[chain[0]]
            if chain[0] in seen:
                coder.number(len(seen) - seen[chain[0]], _CHAIN)
            else:
                coder.number(0, _CHAIN)
                coder.number(y - last[1], _DOWN)
                coder.number(x - last[0], _ALONG, min(255, abs(y - last[1])))
                last = (x, y)
                seen[chain[0]] = len(seen)
            before, kind, strength = (0, 0), _NEW, 0
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
                if self.strong:
                    coder.number(strengths[i] - strength, _STRENGTH, strength, int(i > 0))
                    strength = strengths[i]
            coder.number(_END, _STEP, kind, min(len(chain) - 1, 15))

    def read(
        self, count: int, columns: int, rows: int
    ) -> tuple[list[tuple[int, int]], list[tuple[int, int]], list[int]]:
        coder = self.coder
        points: list[tuple[int, int]] = []
        ends: list[tuple[int, int]] = []
        steps: list[int] = []
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
                at, kind, i = to, now, i + 1
                if self.strong:
                    strength += coder.number(0, _STRENGTH, strength, int(i > 1))
                    if not 0 <= strength <= STRENGTHS:
                        raise FormatError(f"edge {len(ends) - 1}: strength {strength}; 0 to {STRENGTHS} is allowed")
                    steps.append(strength)
        _check_end(coder)
        return points, ends, steps


# ------------------------------------------------------------------------------ headers


def _numbers(*values: int) -> bytes:
    out = bytearray()
    for value in values:
        while value > 127:
            out.append(value & 127 | 128)
            value >>= 7
        out.append(value)
    return bytes(out)


def _header(data: bytes, magic: bytes, count: int) -> tuple[list[int], bytes]:
    """The whole numbers after the magic bytes, and what follows them."""
    if data[:4] != magic:
        raise FormatError(f"begins with {data[:4]!r}; {magic!r} is expected")
    at, values = 4, []
    for _ in range(count):
        value = shift = 0
        while True:
            if at >= len(data) or shift > 35:
                raise FormatError("truncated in its header" if at >= len(data) else "a header number is too large")
            value |= (data[at] & 127) << shift
            shift += 7
            at += 1
            if data[at - 1] < 128:
                break
        values.append(value)
    _check_size(len(data) - at)
    return values, data[at:]


def _finished(coder: Coder) -> bytes:
    code: bytes = coder.finish()
    _check_size(len(code))
    return code


def _check_size(size: int) -> None:
    if size > MAX_CODE:
        raise LimitError(f"{size} bytes of code; {MAX_CODE} are allowed")


def _check_end(coder: Coder) -> None:
    if not coder.end() or coder.overrun:
        raise FormatError("truncated or damaged")
    if coder.rest:
        raise FormatError(f"{coder.rest} bytes after its end")
