# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: example strokes placed one after the other where most of the tone is lacking, bent along a field.

Only `stroke_set` imports this module. One thread, one order: each stroke depends on all before it.

    way 1        way 0      From the place • where most of the tone is lacking the field is followed both ways, a point
            v│              a step. An example lies along x. What is u along it and v aside comes to the place u along
      ╭───•──┴─────╮        the way, v at right angles to it. Of a few examples the one is drawn whose ink is lacking
     ╱    └u┘       ╲       most. Its ink is taken from what the cells around lack, and the next place is sought.
    ╱                ╲
"""

from libc.math cimport fabs, sqrt
from penink_cli.blasting._compiled.ink cimport bar

import numpy as np

cdef enum:
    #: Points of a stroke, and steps of a point along the field to either side of its place.
    MOST_POINTS = 256
    MOST_STEPS = 400
    LEVELS = 24

cdef double PAPER = 0.01  # a tone below this wants no stroke
cdef double SOFT = 0.02  # added to the tone that what is lacking is held against
cdef double OVERLAP = 0.15  # what ink over ink counts against a stroke
cdef float SHY = <float>0.7, SHY_BESIDE = <float>0.2  # what a place where no stroke fits lacks less; those beside it
cdef double STRAIGHT_ON = 0.8  # the field breaks where it turns by more than this cosine within a point


cdef class Growth:
    """A bare sheet, what it lacks, and the examples.

    tone: (rows, columns) what is wanted, float32. field: cosine and sine (rows, columns) of twice the angle. cell:
    width and height of a cell, points. examples: `curves.Polylines` along x from 0, points; widths: (n,) what a device
    paints of them. spread: a stroke's ink counts within so many times the square root of its area over the tone.
    largest: the most that an example is scaled.
    """

    cdef const float[:, ::1] tone
    cdef const float[:, ::1] cos2
    cdef const float[:, ::1] sin2
    cdef float[:, ::1] left  # (rows, columns) what of the tone is lacking
    cdef float[:, ::1] shy
    cdef float[::1] top
    cdef Py_ssize_t begin[LEVELS]
    cdef Py_ssize_t rows[LEVELS]
    cdef Py_ssize_t columns[LEVELS]
    cdef int levels
    cdef const double[:, ::1] points
    cdef const long long[::1] first
    cdef const double[::1] widths
    cdef unsigned long long[:, :, ::1] bits  # ink, as in `ink`
    cdef double sx, sy, dx, dy, area, spread
    cdef int steps
    cdef unsigned long long state
    cdef double[:, ::1] line
    cdef double[:, ::1] kept
    cdef double[:, :, ::1] way

    def __init__(self, tone, field, cell, examples, widths, double spread, double largest, seed):
        points, first = examples.points, examples.first
        left = tone.copy()
        self.tone, self.left = tone, left
        self.cos2, self.sin2 = field
        self.dx, self.dy = cell
        self.points, self.first, self.widths = points, first, widths
        self.bits = np.zeros((tone.shape[0], (tone.shape[1] + 7) // 8, 8), np.uint64)
        self.spread = spread
        self.sx, self.sy = 8 / self.dx, 8 / self.dy
        # what the turn may add to it, and one more for what lies between two steps
        reach = np.abs(np.asarray(points)[:, 0]).max(initial=0.0) * largest * 1.1 + 3
        self.steps = min(<int>reach, MOST_STEPS)
        self.shy = np.zeros_like(left)
        self.line, self.kept = np.zeros((MOST_POINTS, 2)), np.zeros((MOST_POINTS, 2))
        self.way = np.zeros((2, MOST_STEPS + 1, 4))
        self.state = (<unsigned long long>seed) * <unsigned long long>2654435761 + <unsigned long long>88172645463325252
        cdef int _k
        for _k in range(8):
            self.chance()
        cdef Py_ssize_t r = self.tone.shape[0], c = self.tone.shape[1], size = 0
        self.levels = 0
        while True:
            self.begin[self.levels], self.rows[self.levels], self.columns[self.levels] = size, r, c
            size += r * c
            self.levels += 1
            if r == 1 and c == 1:
                break
            r, c = (r + 1) // 2, (c + 1) // 2
        self.top = np.zeros(size, np.float32)
        legs = np.diff(np.asarray(points), axis=0)
        length = np.sqrt((legs * legs).sum(axis=1))
        length[np.asarray(first)[1:-1] - 1] = 0
        which = np.repeat(np.arange(len(widths)), np.diff(first))[:-1]
        self.area = float(np.bincount(which, length * np.asarray(widths)[which], len(widths)).mean())
        with nogil:
            self.raise_all(0, self.rows[0] - 1, 0, self.columns[0] - 1)

    cdef double chance(self) noexcept nogil:
        """A number in [0, 1), by xorshift."""
        self.state ^= self.state << 13
        self.state ^= self.state >> 7
        self.state ^= self.state << 17
        return (self.state >> 11) * 1.1102230246251565e-16

    cdef void heading(self, double x, double y, double *hx, double *hy) noexcept nogil:
        """The field's direction at a place, either way: linear between cells, of twice the angle."""
        cdef double u = x / self.dx - 0.5, v = y / self.dy - 0.5, f, g, c, s, length
        cdef Py_ssize_t rows = self.tone.shape[0], columns = self.tone.shape[1], i, j, k, m
        u = min(max(u, 0.0), columns - 1.0)
        v = min(max(v, 0.0), rows - 1.0)
        j, i = <Py_ssize_t>u, <Py_ssize_t>v
        f, g = u - j, v - i
        m, k = min(j + 1, columns - 1), min(i + 1, rows - 1)
        c = (self.cos2[i, j] * (1 - f) + self.cos2[i, m] * f) * (1 - g)
        c += (self.cos2[k, j] * (1 - f) + self.cos2[k, m] * f) * g
        s = (self.sin2[i, j] * (1 - f) + self.sin2[i, m] * f) * (1 - g)
        s += (self.sin2[k, j] * (1 - f) + self.sin2[k, m] * f) * g
        length = sqrt(c * c + s * s)
        if length < 1e-9:
            hx[0], hy[0] = 1.0, 0.0
            return
        c /= length
        s /= length
        if c >= 0:
            hx[0] = sqrt(0.5 * (1 + c))
            hy[0] = 0.5 * s / hx[0]
        else:
            hy[0] = sqrt(0.5 * (1 - c))
            hx[0] = 0.5 * s / hy[0]

    cdef void raise_all(self, Py_ssize_t r0, Py_ssize_t r1, Py_ssize_t c0, Py_ssize_t c1) noexcept nogil:
        """Reckon anew what cells of these rows and columns want, and the maxima over them."""
        cdef Py_ssize_t r, c, a, b, below
        cdef float t, most, value
        cdef int k
        for r in range(r0, r1 + 1):
            for c in range(c0, c1 + 1):
                t = self.tone[r, c]
                value = <float>-1e9
                if t >= PAPER:
                    value = self.left[r, c] / (t + <float>SOFT) - self.shy[r, c]
                self.top[r * self.columns[0] + c] = value
        for k in range(1, self.levels):
            r0, r1, c0, c1 = r0 // 2, r1 // 2, c0 // 2, c1 // 2
            below = self.begin[k - 1]
            for r in range(r0, r1 + 1):
                for c in range(c0, c1 + 1):
                    most = <float>-1e30
                    for a in range(2 * r, min(2 * r + 2, self.rows[k - 1])):
                        for b in range(2 * c, min(2 * c + 2, self.columns[k - 1])):
                            most = max(most, self.top[below + a * self.columns[k - 1] + b])
                    self.top[self.begin[k] + r * self.columns[k] + c] = most

    cdef void neediest(self, Py_ssize_t *row, Py_ssize_t *column) noexcept nogil:
        """The cell that lacks the largest part of its tone; among equals any, by chance."""
        cdef Py_ssize_t r = 0, c = 0, a, b, br, bc
        cdef float most, value
        cdef int k, i, offset
        for k in range(self.levels - 2, -1, -1):
            most, br, bc = <float>-1e30, 2 * r, 2 * c
            offset = <int>(self.chance() * 4)
            for i in range(4):
                a, b = 2 * r + (((i + offset) & 3) >> 1), 2 * c + ((i + offset) & 1)
                if a < self.rows[k] and b < self.columns[k]:
                    value = self.top[self.begin[k] + a * self.columns[k] + b]
                    if value > most:
                        most, br, bc = value, a, b
            r, c = br, bc
        row[0], column[0] = r, c

    cdef double inked(
        self, double x0, double y0, double x1, double y1, double width, bint draw
    ) noexcept nogil:
        """The area that a segment of this width newly inks, square points; it does so where draw is true."""
        cdef int fresh = bar(
            &self.bits[0, 0, 0], self.tone.shape[0], self.tone.shape[1], x0 * self.sx, y0 * self.sy, x1 * self.sx,
            y1 * self.sy, 0.25 * width * (self.sx + self.sy), True, True, draw,
        )
        return fresh / (self.sx * self.sy)

    cdef void ways(self, double x, double y) noexcept nogil:
        """Follow the field from a place both ways, into `way`: as far as any example may reach."""
        cdef double hx, hy, ax, ay, px, py, nx, ny, along
        cdef int side, k
        self.heading(x, y, &hx, &hy)
        if hy < 0:  # downwards, as fur falls
            hx, hy = -hx, -hy
        for side in range(2):
            px, py = x, y
            ax, ay = (-hx, -hy) if side else (hx, hy)
            for k in range(self.steps + 1):
                self.way[side, k, 0], self.way[side, k, 1] = px, py
                self.way[side, k, 2], self.way[side, k, 3] = (-ax, -ay) if side else (ax, ay)
                self.heading(px + 0.5 * ax, py + 0.5 * ay, &nx, &ny)
                along = nx * ax + ny * ay
                if along < 0:
                    nx, ny, along = -nx, -ny, -along
                if along >= STRAIGHT_ON:
                    ax, ay = nx, ny
                px += ax
                py += ay

    cdef int bend(self, int example, double at, double scale, double turn, double flip) noexcept nogil:
        """An example bent along `way`, its place `at` (0 start … 1 end) where that begins, into `line`; its points.

        turn: radians, small. flip: 1 or -1, mirrored.
        """
        cdef Py_ssize_t begin = self.first[example], p
        cdef int n = min(<int>(self.first[example + 1] - begin), MOST_POINTS), side, k, i
        cdef double c = 1 - turn * turn * (0.5 - turn * turn / 24)
        cdef double s = turn * (1 - turn * turn * (1 / 6.0 - turn * turn / 120))
        cdef double longest = 0, u, v, ax, ay, px, py, f
        for i in range(n):
            longest = max(longest, self.points[begin + i, 0])
        at *= longest * scale
        for i in range(n):
            p = begin + i
            u, v = self.points[p, 0] * scale - at, self.points[p, 1] * scale * flip
            u, v = u * c - v * s, u * s + v * c
            side = u < 0
            f = fabs(u)
            k = min(<int>f, self.steps - 1)
            f -= k
            px = self.way[side, k, 0] + (self.way[side, k + 1, 0] - self.way[side, k, 0]) * f
            py = self.way[side, k, 1] + (self.way[side, k + 1, 1] - self.way[side, k, 1]) * f
            ax = self.way[side, k, 2] + (self.way[side, k + 1, 2] - self.way[side, k, 2]) * min(f, 1.0)
            ay = self.way[side, k, 3] + (self.way[side, k + 1, 3] - self.way[side, k, 3]) * min(f, 1.0)
            self.line[i, 0], self.line[i, 1] = px - ay * v, py + ax * v
        return n

    cdef bint cell(self, double x, double y, Py_ssize_t *row, Py_ssize_t *column) noexcept nogil:
        """The cell of a place; whether it is on the sheet."""
        if x < 0 or y < 0:
            return False
        row[0], column[0] = <Py_ssize_t>(y / self.dy), <Py_ssize_t>(x / self.dx)
        return row[0] < self.tone.shape[0] and column[0] < self.tone.shape[1]

    cdef double worth(self, int n, double width) noexcept nogil:
        """How much of what the line lies on is lacking there, of its area; less where there is ink already."""
        cdef double gain = 0, total = 0, fresh, area, x, y
        cdef Py_ssize_t r, c
        cdef int i
        for i in range(n - 1):
            x, y = self.line[i + 1, 0] - self.line[i, 0], self.line[i + 1, 1] - self.line[i, 1]
            area = sqrt(x * x + y * y) * width
            total += area
            if not self.cell(
                0.5 * (self.line[i, 0] + self.line[i + 1, 0]), 0.5 * (self.line[i, 1] + self.line[i + 1, 1]), &r, &c
            ):
                gain -= 0.3 * area
                continue
            fresh = self.inked(
                self.line[i, 0], self.line[i, 1], self.line[i + 1, 0], self.line[i + 1, 1], width, False
            )
            if self.tone[r, c] < PAPER:
                gain -= 2 * fresh
            else:
                gain += fresh * self.left[r, c] / (self.tone[r, c] + SOFT)
            gain -= OVERLAP * max(area - fresh, 0.0)
        return gain / (total + 1e-9)

    cdef void pay(
        self, double x, double y, double ink, Py_ssize_t *r0, Py_ssize_t *r1, Py_ssize_t *c0, Py_ssize_t *c1
    ) noexcept nogil:
        """Take ink (square points) from what is lacking round a place, where the tone is alike; widen the box."""
        cdef Py_ssize_t row, column, r, c, first, last, left, right
        cdef float tone
        cdef double reach, total = 0, away, w
        cdef int turn
        if not self.cell(x, y, &row, &column):
            return
        tone = self.tone[row, column]
        # a bump of the same variance as a Gaussian, and of no libm
        reach = 2.83 * min(max(self.spread * sqrt(self.area / (tone + SOFT)), 1.6), 9.0)
        first = max(0, <Py_ssize_t>((y - reach) / self.dy))
        last = min(self.tone.shape[0] - 1, <Py_ssize_t>((y + reach) / self.dy))
        left = max(0, <Py_ssize_t>((x - reach) / self.dx))
        right = min(self.tone.shape[1] - 1, <Py_ssize_t>((x + reach) / self.dx))
        for turn in range(2):
            for r in range(first, last + 1):
                for c in range(left, right + 1):
                    if fabs(self.tone[r, c] - tone) >= 0.25:
                        continue
                    w = ((r + 0.5) * self.dy - y) * ((r + 0.5) * self.dy - y)
                    away = w + ((c + 0.5) * self.dx - x) * ((c + 0.5) * self.dx - x)
                    w = 1 - away / (reach * reach)
                    if w <= 0:
                        continue
                    if turn:
                        self.left[r, c] -= <float>(w * w * ink)
                    else:
                        total += w * w
            if not turn:
                if total <= 0:
                    return
                ink /= total * self.dx * self.dy
        r0[0], r1[0] = min(r0[0], first), max(r1[0], last)
        c0[0], c1[0] = min(c0[0], left), max(c1[0], right)

    cdef bint draw(self, int n, double width) noexcept nogil:
        """Ink the line and pay for it; whether it inked anything."""
        cdef double ink = 0, run = 0, x, y
        cdef Py_ssize_t r0 = self.tone.shape[0], r1 = -1, c0 = self.tone.shape[1], c1 = -1
        cdef int i
        for i in range(n - 1):
            ink += self.inked(
                self.line[i, 0], self.line[i, 1], self.line[i + 1, 0], self.line[i + 1, 1], width, True
            )
            x, y = self.line[i + 1, 0] - self.line[i, 0], self.line[i + 1, 1] - self.line[i, 1]
            run += sqrt(x * x + y * y)
            if ink <= 0 or (run < 1.5 and i < n - 2):
                continue
            x, y = 0.5 * (self.line[i, 0] + self.line[i + 1, 0]), 0.5 * (self.line[i, 1] + self.line[i + 1, 1])
            self.pay(x, y, ink, &r0, &r1, &c0, &c1)
            ink, run = 0, 0
        if r1 < 0:
            return False
        self.raise_all(r0, r1, c0, c1)
        return True

    def place(self, double stop, double turn, double smallest, double largest, int tries, double[:, ::1] out,
              long long[::1] first, int[::1] which):
        """Place strokes until no cell lacks `stop` of its tone, or there is no more room; how many.

        turn: the most that a stroke is turned from the field, radians. smallest, largest: its scale. tries: examples
        tried for each. out, first, which: filled with the strokes' points and the example of each.
        """
        cdef Py_ssize_t row = 0, column = 0, used = 0, i, r, c
        cdef int n, example, best_n, best_example, _k, placed = 0, failures = 0, room = which.shape[0]
        cdef double x, y, value, best, scale, aside, at, flip
        with nogil:
            first[0] = 0
            while placed < room and used + MOST_POINTS <= out.shape[0]:
                if self.top[self.begin[self.levels - 1]] < stop:
                    break
                self.neediest(&row, &column)
                x = (column + self.chance()) * self.dx
                y = (row + self.chance()) * self.dy
                best, best_n, best_example = -1e30, 0, 0
                self.ways(x, y)
                for _k in range(tries):
                    example = <int>(self.chance() * self.widths.shape[0])
                    scale = smallest + (largest - smallest) * self.chance()
                    aside = self.chance()  # one by one: C leaves open in which order the parts of a sum are called
                    aside += self.chance()
                    aside += self.chance()
                    aside = (aside - 1.5) * turn / 1.5
                    at = 0.2 + 0.6 * self.chance()
                    flip = -1.0 if self.chance() < 0.5 else 1.0
                    n = self.bend(example, at, scale, aside, flip)
                    value = self.worth(n, self.widths[example])
                    if value > best:
                        best, best_n, best_example = value, n, example
                        for i in range(n):
                            self.kept[i, 0], self.kept[i, 1] = self.line[i, 0], self.line[i, 1]
                if best >= 0.6 * stop:
                    for i in range(best_n):
                        self.line[i, 0], self.line[i, 1] = self.kept[i, 0], self.kept[i, 1]
                    if self.draw(best_n, self.widths[best_example]):
                        for i in range(best_n):
                            out[used, 0], out[used, 1] = self.kept[i, 0], self.kept[i, 1]
                            used += 1
                        which[placed] = best_example
                        placed += 1
                        first[placed] = used
                        continue
                # what fits nowhere here will hardly fit beside it
                for r in range(max(row - 1, 0), min(row + 2, self.rows[0])):
                    for c in range(max(column - 1, 0), min(column + 2, self.columns[0])):
                        self.shy[r, c] += SHY if r == row and c == column else SHY_BESIDE
                self.raise_all(
                    max(row - 1, 0), min(row + 1, self.rows[0] - 1), max(column - 1, 0),
                    min(column + 1, self.columns[0] - 1),
                )
                failures += 1
                if failures > 400000:
                    break
        return placed
