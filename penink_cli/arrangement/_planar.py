# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Compiled: segments on a fine integer grid that never touch but at shared vertices.

Coordinates are whole multiples of `arrangement.planar.UNIT`, so every predicate is exact in 64 bits
(a frame of 2²⁴ units squares to 2⁴⁸). All changes go through `fits`, which is why an
arrangement built here is one by construction.
"""

import cython

COMPILED = cython.compiled

if cython.compiled:
    from cython.cimports.libc.math import floor
else:
    from math import floor


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _turn(
    ax: cython.longlong,
    ay: cython.longlong,
    bx: cython.longlong,
    by: cython.longlong,
    cx: cython.longlong,
    cy: cython.longlong,
) -> cython.int:
    """Sign of (b − a) × (c − a)."""
    cross: cython.longlong = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return (cross > 0) - (cross < 0)


@cython.cclass
class Planar:
    """Segments between vertices, found again by the cells of a uniform grid they run through.

    vertices: (n, 2) int64 units, shared with the caller, who may move a vertex that no live segment uses.
    ends: (m, 2) int32 vertex numbers of each segment; a segment is live between `add` and `remove`.
    """

    def __init__(
        self,
        vertices: cython.longlong[:, ::1],
        ends: cython.int[:, ::1],
        live: cython.uchar[::1],
        head: cython.int[:, ::1],
        entry: cython.int[:, ::1],
        ignored: cython.int[::1],
        cell: cython.longlong,
    ) -> None:
        self.vertices = vertices
        self.ends = ends
        self.live = live
        self._head = head
        self._entry = entry
        self._ignored = ignored
        self._cell = cell
        self._stamp = 1
        k: cython.Py_ssize_t
        for k in range(entry.shape[0]):
            self._entry[k, 1] = k + 1
        self._entry[entry.shape[0] - 1, 1] = -1
        self._free = 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _span(
        self,
        row: cython.longlong,
        ax: cython.longlong,
        ay: cython.longlong,
        bx: cython.longlong,
        by: cython.longlong,
        span: cython.p_int,
    ) -> cython.void:
        """First and last column of the cells of one row that a segment runs through (one more on rounding)."""
        low: cython.double = row * self._cell
        high: cython.double = low + self._cell
        x0: cython.double
        x1: cython.double
        slope: cython.double
        if ay == by:
            x0 = ax
            x1 = bx
        else:
            slope = cython.cast(cython.double, bx - ax) / (by - ay)
            low = max(low, min(ay, by))
            high = min(high, max(ay, by))
            x0 = ax + (low - ay) * slope
            x1 = ax + (high - ay) * slope
        if x0 > x1:
            x0, x1 = x1, x0
        span[0] = max(0, cython.cast(cython.int, floor((x0 - 1) / self._cell)))
        span[1] = min(self._head.shape[1] - 1, cython.cast(cython.int, floor((x1 + 1) / self._cell)))

    @cython.ccall
    def add(self, s: cython.int) -> cython.bint:
        """Make segment s live. False, and nothing changed, where the grid's entries are used up."""
        a: cython.int = self.ends[s, 0]
        b: cython.int = self.ends[s, 1]
        ay: cython.longlong = self.vertices[a, 1]
        by: cython.longlong = self.vertices[b, 1]
        row: cython.longlong
        column: cython.int
        entry: cython.int
        span = cython.declare(cython.int[2])
        for row in range(min(ay, by) // self._cell, max(ay, by) // self._cell + 1):
            self._span(row, self.vertices[a, 0], ay, self.vertices[b, 0], by, span)
            for column in range(span[0], span[1] + 1):
                entry = self._free
                if entry < 0:
                    raise MemoryError("the grid of segments is full")
                self._free = self._entry[entry, 1]
                self._entry[entry, 0] = s
                self._entry[entry, 1] = self._head[row, column]
                self._head[row, column] = entry
        self.live[s] = 1
        return True

    @cython.ccall
    def remove(self, s: cython.int) -> cython.void:
        """Take segment s out."""
        a: cython.int = self.ends[s, 0]
        b: cython.int = self.ends[s, 1]
        ay: cython.longlong = self.vertices[a, 1]
        by: cython.longlong = self.vertices[b, 1]
        row: cython.longlong
        column: cython.int
        entry: cython.int
        before: cython.int
        span = cython.declare(cython.int[2])
        for row in range(min(ay, by) // self._cell, max(ay, by) // self._cell + 1):
            self._span(row, self.vertices[a, 0], ay, self.vertices[b, 0], by, span)
            for column in range(span[0], span[1] + 1):
                before = -1
                entry = self._head[row, column]
                while entry >= 0 and self._entry[entry, 0] != s:
                    before = entry
                    entry = self._entry[entry, 1]
                if entry < 0:
                    continue
                if before < 0:
                    self._head[row, column] = self._entry[entry, 1]
                else:
                    self._entry[before, 1] = self._entry[entry, 1]
                self._entry[entry, 1] = self._free
                self._free = entry
        self.live[s] = 0

    @cython.ccall
    def ignore_none(self) -> cython.void:
        """Let `fits` see every live segment again."""
        self._stamp += 1

    @cython.ccall
    def ignore(self, s: cython.int) -> cython.void:
        """Let `fits` look through segment s until `ignore_none`."""
        self._ignored[s] = self._stamp

    @cython.ccall
    def fits(self, a: cython.int, b: cython.int) -> cython.bint:
        """Whether a segment from vertex a to vertex b would meet live segments at shared vertices only."""
        ax: cython.longlong = self.vertices[a, 0]
        ay: cython.longlong = self.vertices[a, 1]
        bx: cython.longlong = self.vertices[b, 0]
        by: cython.longlong = self.vertices[b, 1]
        cx: cython.longlong
        cy: cython.longlong
        dx: cython.longlong
        dy: cython.longlong
        row: cython.longlong
        column: cython.int
        entry: cython.int
        s: cython.int
        c: cython.int
        d: cython.int
        swap: cython.int
        at_c: cython.int
        at_d: cython.int
        at_a: cython.int
        at_b: cython.int
        span = cython.declare(cython.int[2])
        if ax == bx and ay == by:
            return False
        for row in range(min(ay, by) // self._cell, max(ay, by) // self._cell + 1):
            self._span(row, ax, ay, bx, by, span)
            for column in range(span[0], span[1] + 1):
                entry = self._head[row, column]
                while entry >= 0:
                    s = self._entry[entry, 0]
                    entry = self._entry[entry, 1]
                    if self._ignored[s] == self._stamp:
                        continue
                    c = self.ends[s, 0]
                    d = self.ends[s, 1]
                    if d in (a, b):
                        swap = c
                        c = d
                        d = swap
                    cx = self.vertices[c, 0]
                    cy = self.vertices[c, 1]
                    dx = self.vertices[d, 0]
                    dy = self.vertices[d, 1]
                    if c in (a, b):
                        if d in (a, b):
                            return False
                        if _turn(ax, ay, bx, by, dx, dy) != 0:
                            continue
                        if c == a and (bx - ax) * (dx - ax) + (by - ay) * (dy - ay) > 0:
                            return False
                        if c == b and (ax - bx) * (dx - bx) + (ay - by) * (dy - by) > 0:
                            return False
                        continue
                    if max(ax, bx) < min(cx, dx) or max(cx, dx) < min(ax, bx):
                        continue
                    if max(ay, by) < min(cy, dy) or max(cy, dy) < min(ay, by):
                        continue
                    at_c = _turn(ax, ay, bx, by, cx, cy)
                    at_d = _turn(ax, ay, bx, by, dx, dy)
                    if at_c * at_d > 0:
                        continue
                    at_a = _turn(cx, cy, dx, dy, ax, ay)
                    at_b = _turn(cx, cy, dx, dy, bx, by)
                    if at_a * at_b > 0:
                        continue
                    return False
        return True

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def within(
        self,
        left: cython.double,
        top: cython.double,
        right: cython.double,
        bottom: cython.double,
        found: cython.p_int,
        most: cython.int,
    ) -> cython.int:
        """List the live segments, in order, that go through a rectangle (units): how many; most + 1 where more do."""
        count: cython.int = 0
        row: cython.int
        column: cython.int
        entry: cython.int
        place: cython.int
        k: cython.int
        s: cython.int
        first_row: cython.int = max(0, cython.cast(cython.int, floor(top / self._cell)))
        last_row: cython.int = min(self._head.shape[0] - 1, cython.cast(cython.int, floor(bottom / self._cell)))
        first_column: cython.int = max(0, cython.cast(cython.int, floor(left / self._cell)))
        last_column: cython.int = min(self._head.shape[1] - 1, cython.cast(cython.int, floor(right / self._cell)))
        for row in range(first_row, last_row + 1):
            for column in range(first_column, last_column + 1):
                entry = self._head[row, column]
                while entry >= 0:
                    s = self._entry[entry, 0]
                    entry = self._entry[entry, 1]
                    if not self._through(s, left, top, right, bottom):
                        continue
                    place = count
                    while place > 0 and found[place - 1] > s:
                        place -= 1
                    if place > 0 and found[place - 1] == s:
                        continue
                    if count == most:
                        return most + 1
                    for k in range(count, place, -1):
                        found[k] = found[k - 1]
                    found[place] = s
                    count += 1
        return count

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _through(
        self,
        s: cython.int,
        left: cython.double,
        top: cython.double,
        right: cython.double,
        bottom: cython.double,
    ) -> cython.bint:
        """Whether a segment goes through a rectangle."""
        ax: cython.double = self.vertices[self.ends[s, 0], 0]
        ay: cython.double = self.vertices[self.ends[s, 0], 1]
        bx: cython.double = self.vertices[self.ends[s, 1], 0]
        by: cython.double = self.vertices[self.ends[s, 1], 1]
        dx: cython.double = bx - ax
        dy: cython.double = by - ay
        least: cython.double
        most: cython.double
        if max(ax, bx) < left or min(ax, bx) > right or max(ay, by) < top or min(ay, by) > bottom:
            return False
        least = min(dx * (top - ay), dx * (bottom - ay)) - max(dy * (left - ax), dy * (right - ax))
        most = max(dx * (top - ay), dx * (bottom - ay)) - min(dy * (left - ax), dy * (right - ax))
        return least <= 0 <= most


def insert(planar: Planar, ends: cython.int[:, ::1]) -> None:
    """Add those segments, in order, that fit; `planar.live` tells which."""
    s: cython.Py_ssize_t
    for s in range(ends.shape[0]):
        if planar.fits(ends[s, 0], ends[s, 1]):
            planar.add(s)
