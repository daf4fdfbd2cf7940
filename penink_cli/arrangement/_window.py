# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Compiled: what a few edges would look like through the camera, and where they must lie to look like the photo.

See junctions.py.
"""

import cython
import numpy as np

COMPILED = cython.compiled

if cython.compiled:
    from cython.cimports.libc.math import ceil, fabs, sqrt
else:
    from math import ceil, fabs, sqrt

FINE = 3  # points a pixel, along each axis, that tell sides apart
MOST_SIDE = 26  # pixels of a window
MOST_REGIONS = 12
MOST_MOVED = 8  # vertices
_FINE = cython.declare(cython.int, 3)
_SIDE = cython.declare(cython.int, 26)
_REGIONS = cython.declare(cython.int, 12)
_MOVED = cython.declare(cython.int, 8)
_ROOM = cython.declare(cython.int, 3 * 26)
_UNKNOWN = cython.declare(cython.int, 12 + 2 + 16)
_RIDGE = cython.declare(cython.double, 1e-4)  # holds the grey of a region that no pixel tells of
_LONGEST = cython.declare(cython.double, 0.8)  # pixels that a vertex goes in one step


@cython.cclass
class Window:
    """A window of a photo, rendered from edges: regions of one grey each over a common slope, blurred.

    photo: (h, w) grey; taps: (2 r + 1,) the camera's blur and the pixel's area, in points of a `_FINE`-th of
    a pixel; spread: standard deviation of both, in pixels.
    """

    _photo: cython.float[:, ::1]
    _taps: cython.double[::1]
    _spread: cython.double
    _top: cython.int
    _left: cython.int
    _rows: cython.int
    _columns: cython.int
    _inner: cython.int[::1]  # rows and columns (from, to) that are compared with the photo, counted in the window
    _walls: cython.uchar[:, ::1]
    _label: cython.int[:, ::1]  # the run of each point
    _begin: cython.int[::1]  # first run and last + 1 of each row
    _end: cython.int[::1]
    _start: cython.int[::1]  # first column, a run that it is one with, and region of each run
    _parent: cython.int[::1]
    _region: cython.int[::1]
    _sums: cython.double[::1]
    _total: cython.double[::1]
    _across: cython.double[:, :, ::1]
    _design: cython.double[:, :, ::1]
    _rest: cython.double[:, ::1]
    _normal: cython.double[:, ::1]
    _right: cython.double[::1]
    _grey: cython.double[::1]
    _regions: cython.int

    def __init__(self, photo: cython.float[:, ::1], taps: cython.double[::1], spread: cython.double):
        self._photo, self._taps, self._spread = photo, taps, spread
        self._inner = np.zeros(4, np.int32)
        self._walls = np.zeros((_ROOM, _ROOM), np.uint8)
        self._label = np.zeros((_ROOM, _ROOM), np.int32)
        self._begin, self._end = np.zeros(_ROOM, np.int32), np.zeros(_ROOM, np.int32)
        self._start = np.zeros(_ROOM * _ROOM + 2, np.int32)
        self._parent, self._region = self._start.copy(), self._start.copy()
        self._sums = np.concatenate([[0.0], np.cumsum(taps)])
        self._total = np.zeros(_SIDE, np.float64)
        self._across = np.zeros((_ROOM, _REGIONS, _SIDE), np.float64)
        self._design = np.zeros((_SIDE, _SIDE, _UNKNOWN), np.float64)
        self._rest = np.zeros((_SIDE, _SIDE), np.float64)
        self._normal = np.zeros((_UNKNOWN, _UNKNOWN), np.float64)
        self._right = np.zeros(_UNKNOWN, np.float64)
        self._grey = np.zeros(_UNKNOWN, np.float64)

    def place(self, top: cython.int, left: cython.int, bottom: cython.int, right: cython.int, halo: cython.int) -> int:
        """See rows top … bottom, columns left … right: how many pixels are compared, halo within or at a side."""
        height: cython.int = self._photo.shape[0]
        width: cython.int = self._photo.shape[1]
        self._top, self._left = max(0, top), max(0, left)
        self._rows = min(height, bottom) - self._top
        self._columns = min(width, right) - self._left
        self._inner[0] = 0 if top <= 0 else halo
        self._inner[1] = self._rows - (0 if bottom >= height else halo)
        self._inner[2] = 0 if left <= 0 else halo
        self._inner[3] = self._columns - (0 if right >= width else halo)
        return (self._inner[1] - self._inner[0]) * (self._inner[3] - self._inner[2])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _block(self, ends: cython.int[:, ::1], vertices: cython.double[:, ::1]) -> cython.void:
        """Mark the steps to the right (1) and down (2) between points that cross an edge."""
        high: cython.int = self._rows * _FINE
        wide: cython.int = self._columns * _FINE
        e: cython.Py_ssize_t
        i: cython.int
        j: cython.int
        x0: cython.double
        y0: cython.double
        x1: cython.double
        y1: cython.double
        at: cython.double
        for i in range(high):
            for j in range(wide):
                self._walls[i, j] = 0
        for e in range(ends.shape[0]):
            x0 = (vertices[ends[e, 0], 0] - self._left) * _FINE - 0.5
            y0 = (vertices[ends[e, 0], 1] - self._top) * _FINE - 0.5
            x1 = (vertices[ends[e, 1], 0] - self._left) * _FINE - 0.5
            y1 = (vertices[ends[e, 1], 1] - self._top) * _FINE - 0.5
            if y0 > y1:
                x0, y0, x1, y1 = x1, y1, x0, y0
            if y1 < 0 or y0 >= high or max(x0, x1) < 0 or min(x0, x1) >= wide:
                continue
            i = cython.cast(cython.int, ceil(max(0.0, y0)))
            while i < high and i < y1:
                at = x0 + (i - y0) * ((x1 - x0) / (y1 - y0))
                if 0 < at < wide:
                    j = cython.cast(cython.int, ceil(at)) - 1
                    self._walls[i, j] |= 1
                i += 1
            if x0 > x1:
                x0, y0, x1, y1 = x1, y1, x0, y0
            j = cython.cast(cython.int, ceil(max(0.0, x0)))
            while j < wide and j < x1:
                at = y0 + (j - x0) * ((y1 - y0) / (x1 - x0))
                if 0 < at < high:
                    i = cython.cast(cython.int, ceil(at)) - 1
                    self._walls[i, j] |= 2
                j += 1

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _fill(self) -> cython.bint:
        """Number the regions that edges part; False where there are too many.

        Points between two walls of a row are a run; runs below one another without a wall between are one region.
        """
        high: cython.int = self._rows * _FINE
        wide: cython.int = self._columns * _FINE
        i: cython.int
        j: cython.int
        a: cython.int
        b: cython.int
        run: cython.int = 0
        above: cython.int
        for i in range(high):
            self._begin[i] = run
            self._start[run] = 0
            self._parent[run] = run
            above = -1
            for j in range(wide):
                if j and self._walls[i, j - 1] & 1:
                    run += 1
                    self._start[run] = j
                    self._parent[run] = run
                    above = -1
                self._label[i, j] = run
                if i and self._walls[i - 1, j] & 2 == 0 and self._label[i - 1, j] != above:
                    above = self._label[i - 1, j]
                    a = above
                    while self._parent[a] != a:
                        a = self._parent[a]
                    b = run
                    while self._parent[b] != b:
                        b = self._parent[b]
                    self._parent[max(a, b)] = min(a, b)
            run += 1
            self._start[run] = wide  # of the row above: overwritten by the next one's first run
            self._end[i] = run
        self._regions = 0
        for a in range(run):  # a run's parent comes before it
            if self._parent[a] == a:
                if self._regions == _REGIONS:
                    return False
                self._region[a] = self._regions
                self._regions += 1
            else:
                self._region[a] = self._region[self._parent[a]]
        return True

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _shares(self) -> cython.void:
        """How much of each region each compared pixel sees: the first columns of the design; then the two slopes."""
        reach: cython.int = cython.cast(cython.int, self._taps.shape[0] // 2)
        high: cython.int = self._rows * _FINE
        wide: cython.int = self._columns * _FINE
        regions: cython.int = self._regions
        i: cython.int
        j: cython.int
        k: cython.int
        d: cython.int
        at: cython.int
        run: cython.int
        first: cython.int
        last: cython.int
        weight: cython.double
        total: cython.p_double
        row: cython.p_double
        for i in range(high):
            for k in range(regions):
                for j in range(self._inner[2], self._inner[3]):
                    self._across[i, k, j] = 0.0
            for run in range(self._begin[i], self._end[i]):
                # The row goes on beyond the window as it ends.
                first = self._start[run] if run > self._begin[i] else -_ROOM
                last = self._start[run + 1] if run + 1 < self._end[i] else wide + _ROOM
                k = self._region[run]
                for j in range(
                    max(self._inner[2], (first - reach) // _FINE - 1 if first > 0 else 0),
                    min(self._inner[3], (last + reach) // _FINE + 2),
                ):
                    at = _FINE * j + _FINE // 2 - reach  # the first tap
                    self._across[i, k, j] += self._sums[min(2 * reach + 1, max(0, last - at))]
                    self._across[i, k, j] -= self._sums[min(2 * reach + 1, max(0, first - at))]
        for i in range(self._inner[0], self._inner[1]):
            for k in range(regions):
                total = cython.address(self._total[0])
                for j in range(self._inner[2], self._inner[3]):
                    total[j] = 0.0
                for d in range(-reach, reach + 1):
                    row = cython.address(self._across[min(high - 1, max(0, _FINE * i + _FINE // 2 + d)), k, 0])
                    weight = self._taps[d + reach]
                    for j in range(self._inner[2], self._inner[3]):
                        total[j] += weight * row[j]
                for j in range(self._inner[2], self._inner[3]):
                    self._design[i, j, k] = total[j]
            for j in range(self._inner[2], self._inner[3]):
                self._design[i, j, regions] = 0.1 * (i - 0.5 * self._rows)
                self._design[i, j, regions + 1] = 0.1 * (j - 0.5 * self._columns)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _gather(self, unknown: cython.int) -> cython.void:
        """The normal equations of `_rest` in the design's columns."""
        i: cython.int
        j: cython.int
        a: cython.int
        b: cython.int
        v: cython.double
        for a in range(unknown):
            self._right[a] = 0.0
            for b in range(a, unknown):
                self._normal[a, b] = 0.0
        for i in range(self._inner[0], self._inner[1]):
            for j in range(self._inner[2], self._inner[3]):
                for a in range(unknown):
                    v = self._design[i, j, a]
                    if v == 0.0:
                        continue
                    self._right[a] += v * self._rest[i, j]
                    for b in range(a, unknown):
                        self._normal[a, b] += v * self._design[i, j, b]
        for a in range(unknown):
            self._normal[a, a] += _RIDGE

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _solve(self, unknown: cython.int) -> cython.void:
        """Solve them, into `_right`."""
        k: cython.int
        a: cython.int
        b: cython.int
        v: cython.double
        for a in range(unknown):  # L D Lᵀ
            for b in range(a + 1, unknown):
                v = self._normal[a, b] / self._normal[a, a]
                for k in range(b, unknown):
                    self._normal[b, k] -= v * self._normal[a, k]
                self._right[b] -= v * self._right[a]
        for a in range(unknown - 1, -1, -1):
            v = self._right[a]
            for b in range(a + 1, unknown):
                v -= self._normal[a, b] * self._right[b]
            self._right[a] = v / self._normal[a, a]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _look(self, ends: cython.int[:, ::1], vertices: cython.double[:, ::1]) -> cython.double:
        """Render with the best greys; what is left of the photo stays in `_rest`. Its square, negative for none."""
        i: cython.int
        j: cython.int
        k: cython.int
        unknown: cython.int
        total: cython.double = 0.0
        v: cython.double
        self._block(ends, vertices)
        if not self._fill():
            return -1.0
        self._shares()
        unknown = self._regions + 2
        for i in range(self._inner[0], self._inner[1]):
            for j in range(self._inner[2], self._inner[3]):
                self._rest[i, j] = self._photo[self._top + i, self._left + j] - 0.5
        self._gather(unknown)
        self._solve(unknown)
        for k in range(unknown):
            self._grey[k] = self._right[k]
        for i in range(self._inner[0], self._inner[1]):
            for j in range(self._inner[2], self._inner[3]):
                v = self._rest[i, j]
                for k in range(unknown):
                    v -= self._design[i, j, k] * self._grey[k]
                self._rest[i, j] = v
                total += v * v
        return total

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _side(self, x: cython.double, y: cython.double) -> cython.double:
        """The grey of the region at a place in the window (pixels)."""
        i: cython.int = min(self._rows * _FINE - 1, max(0, cython.cast(cython.int, y * _FINE)))
        j: cython.int = min(self._columns * _FINE - 1, max(0, cython.cast(cython.int, x * _FINE)))
        return self._grey[self._region[self._label[i, j]]]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _yield(
        self, ends: cython.int[:, ::1], vertices: cython.double[:, ::1], number: cython.int[::1], base: cython.int
    ) -> cython.void:
        """The design's columns from base on: how the picture changes as vertices move, x and y of each.

        An edge that goes sideways by δ adds δ times the step across it, blurred, all along it; what a vertex's
        moving gives a point of its edge fades linearly towards the other end.
        """
        e: cython.Py_ssize_t
        i: cython.int
        j: cython.int
        k: cython.int
        n: cython.int
        a: cython.int
        b: cython.int
        first: cython.int
        last: cython.int
        x0: cython.double
        y0: cython.double
        dx: cython.double
        dy: cython.double
        x: cython.double
        y: cython.double
        t: cython.double
        length: cython.double
        step: cython.double
        weight: cython.double
        v: cython.double
        reach: cython.int = 1 + cython.cast(cython.int, 3.465 * self._spread)  # pixels: beyond, the bell is 0
        over = cython.declare(cython.double[26])
        for i in range(self._inner[0], self._inner[1]):
            for j in range(self._inner[2], self._inner[3]):
                for k in range(base, base + 2 * _MOVED):
                    self._design[i, j, k] = 0.0
        for e in range(ends.shape[0]):
            a = number[ends[e, 0]]
            b = number[ends[e, 1]]
            if a < 0 and b < 0:
                continue
            x0 = vertices[ends[e, 0], 0] - self._left
            y0 = vertices[ends[e, 0], 1] - self._top
            dx = vertices[ends[e, 1], 0] - self._left - x0
            dy = vertices[ends[e, 1], 1] - self._top - y0
            length = sqrt(dx * dx + dy * dy)
            n = 1 + cython.cast(cython.int, 3 * length)
            if length < 1e-6:
                continue
            for k in range(n):
                t = (k + 0.5) / n
                x = x0 + t * dx
                y = y0 + t * dy
                if x < -3 or y < -3 or x > self._columns + 3 or y > self._rows + 3:
                    continue
                # (−dy, dx) / length is to the right of the way on the screen; what it leaves behind is left of it.
                step = self._side(x + 0.4 * dy / length, y - 0.4 * dx / length)
                step -= self._side(x - 0.4 * dy / length, y + 0.4 * dx / length)
                if step == 0.0:
                    continue
                weight = step * length / n / (6.283185307179586 * self._spread * self._spread)
                first = max(self._inner[2], cython.cast(cython.int, x) - reach)
                last = min(self._inner[3], cython.cast(cython.int, x) + reach + 1)
                for j in range(first, last):
                    over[j] = self._bell(fabs(j + 0.5 - x))
                for i in range(
                    max(self._inner[0], cython.cast(cython.int, y) - reach),
                    min(self._inner[1], cython.cast(cython.int, y) + reach + 1),
                ):
                    v = weight * self._bell(fabs(i + 0.5 - y))
                    for j in range(first, last):
                        if a >= 0:
                            self._design[i, j, base + 2 * a] += v * over[j] * (1 - t) * (-dy / length)
                            self._design[i, j, base + 2 * a + 1] += v * over[j] * (1 - t) * (dx / length)
                        if b >= 0:
                            self._design[i, j, base + 2 * b] += v * over[j] * t * (-dy / length)
                            self._design[i, j, base + 2 * b + 1] += v * over[j] * t * (dx / length)

    @cython.cfunc
    @cython.inline
    @cython.nogil
    @cython.exceptval(check=False)
    def _bell(self, d: cython.double) -> cython.double:
        """Nearly a Gaussian: a cubic B-spline of the same spread, which needs no exponential."""
        d *= 0.5773502691896258 / self._spread
        if d >= 2:
            return 0.0
        if d >= 1:
            return (2 - d) * (2 - d) * (2 - d) * 0.24077
        return (4 - 6 * d * d + 3 * d * d * d) * 0.24077

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _held(
        self, vertices: cython.double[:, ::1], number: cython.int[::1], held: cython.double[:, ::1]
    ) -> cython.double:
        """What it costs that vertices are where they are: xᵀ A x − 2 bᵀ x + c, summed."""
        v: cython.Py_ssize_t
        k: cython.int
        x: cython.double
        y: cython.double
        total: cython.double = 0.0
        for v in range(vertices.shape[0]):
            k = number[v]
            if k >= 0:
                x = vertices[v, 0] - self._left
                y = vertices[v, 1] - self._top
                total += held[k, 0] * x * x + 2 * held[k, 1] * x * y + held[k, 2] * y * y
                total += held[k, 5] - 2 * (held[k, 3] * x + held[k, 4] * y)
        return total

    def settle(
        self,
        ends: cython.int[:, ::1],
        vertices: cython.double[:, ::1],
        number: cython.int[::1],
        moved: cython.int,
        held: cython.double[:, ::1],
        rounds: cython.int,
    ) -> float:
        """Move vertices to where the rendered window is most like the photo (Gauss and Newton's steps).

        ends: (m, 2) vertices of the edges; vertices: (n, 2) x and y in the photo's pixels, changed; number: (n,)
        0 … moved − 1 for those that may be moved, at most `MOST_MOVED`, -1 for the others. held: (moved, 6) what is
        known of each otherwise, as A (xx, xy, yy), b (x, y) and c of a cost xᵀ A x − 2 bᵀ x + c in grey², x counted
        from the window's corner.

        Returns the sum of squares that is left unexplained and those costs; negative where there are too many regions.
        """
        n: cython.Py_ssize_t = vertices.shape[0]
        v: cython.Py_ssize_t
        k: cython.int
        axis: cython.int
        base: cython.int
        at: cython.int
        x: cython.double
        y: cython.double
        best: cython.double
        found: cython.double
        far: cython.double
        part: cython.double
        trial: cython.double[:, ::1] = np.empty((n, 2))
        way: cython.double[:, ::1] = np.zeros((_MOVED, 2))
        with cython.nogil:
            best = self._look(ends, vertices)
            if best >= 0:
                best += self._held(vertices, number, held)
            for _ in range(rounds):
                if best < 0:
                    break
                base = self._regions + 2
                self._yield(ends, vertices, number, base)
                self._gather(base + 2 * moved)
                for v in range(n):
                    k = number[v]
                    if k >= 0:
                        at = base + 2 * k
                        x = vertices[v, 0] - self._left
                        y = vertices[v, 1] - self._top
                        self._normal[at, at] += held[k, 0]
                        self._normal[at, at + 1] += held[k, 1]
                        self._normal[at + 1, at + 1] += held[k, 2]
                        self._right[at] += held[k, 3] - held[k, 0] * x - held[k, 1] * y
                        self._right[at + 1] += held[k, 4] - held[k, 1] * x - held[k, 2] * y
                self._solve(base + 2 * moved)
                for k in range(moved):
                    far = sqrt(self._right[base + 2 * k] ** 2 + self._right[base + 2 * k + 1] ** 2)
                    part = min(1.0, _LONGEST / max(far, 1e-9))
                    for axis in range(2):
                        way[k, axis] = part * self._right[base + 2 * k + axis]
                part = 1.0
                while part > 0.4:
                    for v in range(n):
                        for axis in range(2):
                            trial[v, axis] = vertices[v, axis]
                            if number[v] >= 0:
                                trial[v, axis] += part * way[number[v], axis]
                    found = self._look(ends, trial)
                    if found >= 0:
                        found += self._held(trial, number, held)
                        if found < best:
                            break
                    part *= 0.5
                if part <= 0.4:
                    break
                vertices[:, :] = trial
                far = best - found
                best = found
                if far < 5e-3 * best:
                    break
        return best
