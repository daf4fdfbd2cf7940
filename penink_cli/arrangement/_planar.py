# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Compiled: segments on a fine integer grid that never touch but at shared vertices.

Coordinates are whole multiples of `arrangement.planar.UNIT`, so every predicate is exact in 64 bits
(a frame of 2²⁴ units squares to 2⁴⁸). All changes go through `fits`, which is why an
arrangement built here is one by construction.
"""

import cython

COMPILED = cython.compiled

if cython.compiled:
    from cython.cimports.libc.math import floor, sqrt
else:
    from math import floor, sqrt


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


def shorten(
    planar: Planar,
    path: cython.int[::1],
    segment: cython.int[::1],
    tolerance: cython.double,
    stack: cython.int[:, ::1],
    kept: cython.uchar[::1],
) -> None:
    """Replace runs of a path by single segments wherever these stay within tolerance and fit.

    Douglas and Peucker's division, where a run is also divided at its farthest vertex if its
    shortcut would touch another segment, down to the path's own segments, which are live already.

    path: (n,) vertices; segment: (n − 1,) the live segment from each vertex to the next; the
    first segment of a run becomes its shortcut. kept: (n,) filled, 1 where a vertex stays.
    stack: (n, 2) room to work in. tolerance: in the grid's units.
    """
    depth: cython.Py_ssize_t = 1
    first: cython.int
    last: cython.int
    middle: cython.int
    k: cython.int
    ax: cython.double
    ay: cython.double
    dx: cython.double
    dy: cython.double
    px: cython.double
    py: cython.double
    length: cython.double
    along: cython.double
    deviation: cython.double
    worst: cython.double
    stack[0, 0] = 0
    stack[0, 1] = path.shape[0] - 1
    kept[0] = kept[path.shape[0] - 1] = 1
    while depth > 0:
        depth -= 1
        first = stack[depth, 0]
        last = stack[depth, 1]
        if last - first < 2:
            continue
        ax = planar.vertices[path[first], 0]
        ay = planar.vertices[path[first], 1]
        dx = planar.vertices[path[last], 0] - ax
        dy = planar.vertices[path[last], 1] - ay
        length = dx * dx + dy * dy
        worst = -1
        middle = (first + last) // 2
        for k in range(first + 1, last):
            px = planar.vertices[path[k], 0] - ax
            py = planar.vertices[path[k], 1] - ay
            along = (px * dx + py * dy) / length if length > 0 else 0.0
            along = min(1.0, max(0.0, along))
            px -= along * dx
            py -= along * dy
            deviation = px * px + py * py
            if deviation > worst:
                worst = deviation
                middle = k
        if worst <= tolerance * tolerance:
            planar.ignore_none()
            for k in range(first, last):
                planar.ignore(segment[k])
            if planar.fits(path[first], path[last]):
                for k in range(first, last):
                    planar.remove(segment[k])
                planar.ends[segment[first], 0] = path[first]
                planar.ends[segment[first], 1] = path[last]
                planar.add(segment[first])
                planar.ignore_none()
                continue
            planar.ignore_none()
        kept[middle] = 1
        stack[depth, 0] = first
        stack[depth, 1] = middle
        stack[depth + 1, 0] = middle
        stack[depth + 1, 1] = last
        depth += 2


@cython.cfunc
@cython.exceptval(check=False)
def _move(
    planar: Planar,
    vertex: cython.int,
    around: cython.int[::1],
    first: cython.int,
    last: cython.int,
    x: cython.longlong,
    y: cython.longlong,
) -> cython.bint:
    """Move a vertex to (x, y) if all its segments, around[first : last], still fit there."""
    old_x: cython.longlong = planar.vertices[vertex, 0]
    old_y: cython.longlong = planar.vertices[vertex, 1]
    k: cython.int
    added: cython.int
    s: cython.int
    for k in range(first, last):
        planar.remove(around[k])
    planar.vertices[vertex, 0] = x
    planar.vertices[vertex, 1] = y
    for added in range(first, last):
        s = around[added]
        if planar.fits(planar.ends[s, 0], planar.ends[s, 1]):
            planar.add(s)
            continue
        for k in range(first, added):
            planar.remove(around[k])
        planar.vertices[vertex, 0] = old_x
        planar.vertices[vertex, 1] = old_y
        for k in range(first, last):
            planar.add(around[k])
        return False
    return True


def settle(
    planar: Planar,
    movable: cython.int[::1],
    around_first: cython.int[::1],
    around: cython.int[::1],
    run_first: cython.int[::1],
    run_last: cython.int[::1],
    places: cython.double[:, ::1],
    furthest: cython.double,
    width: cython.longlong,
    height: cython.longlong,
    sweeps: cython.int,
) -> None:
    """Move vertices to where the segments around them fit the points they stand for best.

    Each in turn goes to its own least-squares optimum with its neighbours held (Gauss-Seidel),
    at most `furthest` from where it started, within the frame (width × height units), and only
    where its segments still fit.

    movable: vertices; those segments are around[around_first[v] : around_first[v + 1]]; segment s
    stands for the points places[run_first[s] : run_last[s] + 1], in units.
    """
    m: cython.Py_ssize_t
    k: cython.int
    r: cython.int
    v: cython.int
    s: cython.int
    other: cython.int
    vx: cython.double
    vy: cython.double
    qx: cython.double
    qy: cython.double
    dx: cython.double
    dy: cython.double
    t: cython.double
    length: cython.double
    weight: cython.double
    sum_x: cython.double
    sum_y: cython.double
    x: cython.longlong
    y: cython.longlong
    start: cython.longlong[:, ::1] = planar.vertices.copy()
    for _ in range(sweeps):
        for m in range(movable.shape[0]):
            v = movable[m]
            vx = planar.vertices[v, 0]
            vy = planar.vertices[v, 1]
            weight = 0.05  # holds what no point pulls
            sum_x = weight * vx
            sum_y = weight * vy
            for k in range(around_first[v], around_first[v + 1]):
                s = around[k]
                other = planar.ends[s, 0] + planar.ends[s, 1] - v
                qx = planar.vertices[other, 0]
                qy = planar.vertices[other, 1]
                dx = qx - vx
                dy = qy - vy
                length = dx * dx + dy * dy
                for r in range(run_first[s], run_last[s] + 1):
                    t = ((places[r, 0] - vx) * dx + (places[r, 1] - vy) * dy) / length
                    if t < 0 or t > 1:
                        continue
                    weight += (1 - t) * (1 - t)
                    sum_x += (1 - t) * (places[r, 0] - t * qx)
                    sum_y += (1 - t) * (places[r, 1] - t * qy)
            vx = sum_x / weight - start[v, 0]
            vy = sum_y / weight - start[v, 1]
            length = vx * vx + vy * vy
            if length > furthest * furthest:
                t = furthest / sqrt(length)
                vx *= t
                vy *= t
            x = start[v, 0] + cython.cast(cython.longlong, floor(vx + 0.5))
            y = start[v, 1] + cython.cast(cython.longlong, floor(vy + 0.5))
            x = min(width - 1, max(1, x))
            y = min(height - 1, max(1, y))
            if x != planar.vertices[v, 0] or y != planar.vertices[v, 1]:
                _move(planar, v, around, around_first[v], around_first[v + 1], x, y)
