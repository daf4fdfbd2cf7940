# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: segments on a fine integer grid that never touch but at shared vertices.

    ┌─────┬─────┬─────┐     A segment is entered in each cell of a uniform grid that it runs through. `fits` looks at
    │     │   ──┼── b │     the segments of these cells alone: a–b fits where none of them meets it but at a or b.
    ├─────┼──╱──┼─────┤
    │ a ──┼─    │     │
    └─────┴─────┴─────┘

Coordinates are whole multiples of `arrangement.planar.UNIT`, so every predicate is exact in 64 bits
(a frame of 2²⁴ units squares to 2⁴⁸). All changes go through `fits`, which is why an
arrangement built here is one by construction.

Segments come and go one by one: out and in again takes .3 µs, making the lists of `geometry.edge_index` anew 800
(`python -m tests.benchmarks.edge_index`).
"""

from libc.math cimport floor

import numpy as np


cdef inline int _turn(
    long long ax, long long ay, long long bx, long long by, long long cx, long long cy
) noexcept nogil:
    """Sign of (b − a) × (c − a)."""
    cdef long long cross = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return (cross > 0) - (cross < 0)


cdef class Planar:
    """Segments between vertices, found again by the cells of a uniform grid they run through.

    vertices: (n, 2) int64 units, shared with the caller, who may move a vertex that no live segment uses.
    ends: (m, 2) int32 vertex numbers of each segment; a segment is live between `add` and `remove`. live: (m,) whether.
    head: (rows, columns) the first entry of each cell, −1 for none. entry: (k, 2) a segment, and the cell's next entry
    or the next free one. ignored: (m,) the stamp that says that `fits` is to pass a segment over. cell: units a side.
    """

    def __init__(
        self, long long[:, ::1] vertices, int[:, ::1] ends, unsigned char[::1] live, int[:, ::1] head,
        int[:, ::1] entry, int[::1] ignored, long long cell,
    ) -> None:
        self.vertices = vertices
        self.ends = ends
        self.live = live
        self._head = head
        self._entry = entry
        self._ignored = ignored
        self._cell = cell
        self._stamp = 1
        self._link(0)

    cdef void _span(
        self, long long row, long long ax, long long ay, long long bx, long long by, int* span
    ) noexcept nogil:
        """First and last column of the cells of one row that a segment runs through (one more on rounding)."""
        cdef double x0, x1, slope
        cdef double low = row * self._cell
        cdef double high = low + self._cell
        if ay == by:
            x0 = ax
            x1 = bx
        else:
            slope = <double>(bx - ax) / (by - ay)
            low = max(low, min(ay, by))
            high = min(high, max(ay, by))
            x0 = ax + (low - ay) * slope
            x1 = ax + (high - ay) * slope
        if x0 > x1:
            x0, x1 = x1, x0
        span[0] = max(0, <int>floor((x0 - 1) / self._cell))
        span[1] = min(self._head.shape[1] - 1, <int>floor((x1 + 1) / self._cell))

    cdef void _link(self, Py_ssize_t first) noexcept:
        """Have the entries from `first` on, of which none is in use, be all that are free."""
        cdef Py_ssize_t k
        cdef Py_ssize_t n = self._entry.shape[0]
        for k in range(first, n):
            self._entry[k, 1] = k + 1 if k + 1 < n else self._free if first else -1
        self._free = first
        self._vacant += n - first

    cdef int _extend(self, int needed) except -1:
        """Make room for so many entries more."""
        cdef Py_ssize_t n = self._entry.shape[0]
        more = np.zeros((2 * n + needed, 2), np.int32)
        more[:n] = self._entry
        self._entry = more
        self._link(n)
        return 0

    cpdef int add(self, int s) except -1:
        """Make segment s live. MemoryError, and nothing changed, where there is no room for it."""
        cdef long long row
        cdef int column, entry
        cdef int needed = 0
        cdef int[2] span
        cdef int a = self.ends[s, 0]
        cdef int b = self.ends[s, 1]
        cdef long long ay = self.vertices[a, 1]
        cdef long long by = self.vertices[b, 1]
        for row in range(min(ay, by) // self._cell, max(ay, by) // self._cell + 1):
            self._span(row, self.vertices[a, 0], ay, self.vertices[b, 0], by, span)
            needed += span[1] - span[0] + 1
        if needed > self._vacant:
            self._extend(needed)
        self._vacant -= needed
        for row in range(min(ay, by) // self._cell, max(ay, by) // self._cell + 1):
            self._span(row, self.vertices[a, 0], ay, self.vertices[b, 0], by, span)
            for column in range(span[0], span[1] + 1):
                entry = self._free
                self._free = self._entry[entry, 1]
                self._entry[entry, 0] = s
                self._entry[entry, 1] = self._head[row, column]
                self._head[row, column] = entry
        self.live[s] = 1
        return 0

    cpdef void remove(self, int s):
        """Take segment s out."""
        cdef long long row
        cdef int column, entry, before
        cdef int[2] span
        cdef int a = self.ends[s, 0]
        cdef int b = self.ends[s, 1]
        cdef long long ay = self.vertices[a, 1]
        cdef long long by = self.vertices[b, 1]
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
                self._vacant += 1
        self.live[s] = 0

    cpdef void ignore_none(self):
        """Let `fits` see every live segment again."""
        self._stamp += 1

    cpdef void ignore(self, int s):
        """Let `fits` look through segment s until `ignore_none`."""
        self._ignored[s] = self._stamp

    cpdef bint fits(self, int a, int b):
        """Whether a segment from vertex a to vertex b would meet live segments at shared vertices only."""
        cdef long long cx, cy, dx, dy, row
        cdef int column, entry, s, c, d, swap, at_c, at_d, at_a, at_b
        cdef int[2] span
        cdef long long ax = self.vertices[a, 0]
        cdef long long ay = self.vertices[a, 1]
        cdef long long bx = self.vertices[b, 0]
        cdef long long by = self.vertices[b, 1]
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

    cdef int within(self, double left, double top, double right, double bottom, int* found, int most) noexcept nogil:
        """List the live segments, in order, that go through a rectangle (units): how many; most + 1 where more do."""
        cdef int row, column, entry, place, k, s
        cdef int count = 0
        cdef int first_row = max(0, <int>floor(top / self._cell))
        cdef int last_row = min(self._head.shape[0] - 1, <int>floor(bottom / self._cell))
        cdef int first_column = max(0, <int>floor(left / self._cell))
        cdef int last_column = min(self._head.shape[1] - 1, <int>floor(right / self._cell))
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

    cdef bint _through(self, int s, double left, double top, double right, double bottom) noexcept nogil:
        """Whether a segment goes through a rectangle."""
        cdef double least, most
        cdef double ax = self.vertices[self.ends[s, 0], 0]
        cdef double ay = self.vertices[self.ends[s, 0], 1]
        cdef double bx = self.vertices[self.ends[s, 1], 0]
        cdef double by = self.vertices[self.ends[s, 1], 1]
        cdef double dx = bx - ax
        cdef double dy = by - ay
        if max(ax, bx) < left or min(ax, bx) > right or max(ay, by) < top or min(ay, by) > bottom:
            return False
        least = min(dx * (top - ay), dx * (bottom - ay)) - max(dy * (left - ax), dy * (right - ax))
        most = max(dx * (top - ay), dx * (bottom - ay)) - min(dy * (left - ax), dy * (right - ax))
        return least <= 0 <= most


def insert(Planar planar, int[:, ::1] ends) -> None:
    """Add those segments, in order, that fit; `planar.live` tells which."""
    cdef Py_ssize_t s
    for s in range(ends.shape[0]):
        if planar.fits(ends[s, 0], ends[s, 1]):
            planar.add(s)
