# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled loops that try strokes out one after the other and draw of each what is worth drawing.

    tone still due     ▁▂▅▇▇▆▂▁▁▁▃▆▇▇▅▂▁
    the candidate      ─────────────────    a polyline in pieces of about a cell
    what is drawn        ──────   ───────   the runs of pieces that gain most

**Where a line ends**: a piece gains what its ink takes from the squared error of the tone that the eye sees, and loses
where the error grows. Each run costs a fixed amount besides, and has a least length. A dynamic programme over two
states, pen up and pen down, chooses the runs of the largest sum (`Trial.runs`). Walls have cut the candidate before;
a run that ends at a wall may be shorter.

Lengths are in subpixels, ink in cells (see `ink`). Only `sheet` imports this module.
"""

from libc.math cimport ceil, sqrt
from penink_cli.blasting._compiled.due cimport splat
from penink_cli.blasting._compiled.ink cimport bar, cell, half_width, stroke

import numpy as np

#: Lighter than this is paper white. What ink gains, per cell, that belongs in a light place.
cdef double PAPER = 0.002
cdef double WORTH = 0.05


cdef class Target:
    """What strokes are tried against.

    bits: the ink, a cell a word. residual, guide, weight: (rows, columns) cells: what is still due as the eye sees it,
    the tone wanted, and how much of the eye's kernel lies on the sheet. kernel, step, profile: of `low_pass.LowPass`.
    gain: what a device adds to a stroke, subpixels.
    """

    cdef unsigned long long[:, :, ::1] bits
    cdef float[:, ::1] residual, guide, weight, kernel
    cdef float step
    cdef double[::1] profile
    cdef double gain
    cdef Py_ssize_t rows, columns

    def __init__(
        self, unsigned long long[:, :, ::1] bits, float[:, ::1] residual, float[:, ::1] guide, float[:, ::1] weight,
        low_pass, double gain,
    ) -> None:
        self.bits = bits
        self.residual = residual
        self.guide = guide
        self.weight = weight
        self.kernel = low_pass.kernel
        self.step = low_pass.step
        self.profile = low_pass.profile
        self.gain = gain
        self.rows = residual.shape[0]
        self.columns = residual.shape[1]


cdef class Tried:
    """Polylines that may be drawn: points (p, 2), and of each where it begins, its width, bit 0 and 1 for a wall at its
    start and end, and the tone at which it is known to belong in a light place.
    """

    cdef double[:, ::1] points
    cdef long long[::1] first
    cdef double[::1] widths, enters
    cdef unsigned char[::1] walls

    def __init__(
        self, double[:, ::1] points, long long[::1] first, double[::1] widths, unsigned char[::1] walls,
        double[::1] enters,
    ) -> None:
        self.points = points
        self.first = first
        self.widths = widths
        self.walls = walls
        self.enters = enters


cdef class Terms:
    """`sheet.Terms`, its lengths in subpixels: pitch of them are a point."""

    cdef bint whole, strict
    cdef double cost, caution, lenience, shortest, shortest_wall, spacing
    cdef double[::1] shifts

    def __init__(self, terms, double pitch) -> None:
        self.whole = terms.whole
        self.strict = terms.strict
        self.cost = terms.cost
        self.caution = terms.caution
        self.lenience = terms.lenience
        self.shortest = terms.shortest_pt * pitch
        self.shortest_wall = terms.shortest_wall_pt * pitch
        self.spacing = terms.spacing_pt * pitch
        self.shifts = np.asarray(terms.shifts, np.float64)


cdef class Trial:
    """One polyline after the other, tried and drawn: point p0 to p1, moved by (ox, oy), at the width.

    ink, own, due, fresh: of each piece its new ink (cells), the tone that the stroke itself would add, the tone still
    due there, and room. total, best, start: of `runs`.
    """

    cdef Tried lines
    cdef Terms terms
    cdef Py_ssize_t i, p0, p1
    cdef double ox, oy
    cdef double[::1] ink, own, due, fresh, total, best
    cdef long long[::1] start

    def __init__(self, Tried lines, Terms terms, Py_ssize_t longest) -> None:
        self.lines = lines
        self.terms = terms
        self.ink, self.own, self.due, self.fresh, self.total, self.best = np.empty((6, longest))
        self.start = np.empty(longest, np.int64)

    cdef void draw(self, Target target, Py_ssize_t p0, Py_ssize_t p1) noexcept nogil:
        """Ink the points p0 … p1, and take what is new from the residual."""
        cdef Py_ssize_t i, x, y
        cdef Py_ssize_t n = p1 - p0
        cdef float ink = 0.0
        cdef double[:, ::1] points = self.lines.points
        stroke(
            &target.bits[0, 0, 0], target.rows, target.columns, &points[p0, 0], n, self.ox, self.oy,
            self.lines.widths[self.i], target.gain, &self.fresh[0], 0, target.rows,
        )
        for i in range(n if n > 0 else 1):
            ink += <float>self.fresh[i]
            # two points to a splat: they are about a cell apart and the kernel is much wider
            if ink > 0.0 and (i & 1 or i >= n - 1):
                x = cell(points[p0 + i, 0] + self.ox)
                y = cell(points[p0 + i, 1] + self.oy)
                if 0 <= x < target.columns and 0 <= y < target.rows:
                    splat(target.residual, target.guide, target.kernel, y, x, ink * 0.015625, target.step)
                ink = 0.0

    cdef Py_ssize_t gains(self, Target target) noexcept nogil:
        """Fill in ink, due and own of each piece; returns their number. A dot is one piece."""
        cdef Py_ssize_t i, j, x, y
        cdef double dx, dy, mx, my, d, tone
        cdef double[:, ::1] points = self.lines.points
        cdef double[::1] ink = self.ink, own = self.own, due = self.due, share = self.fresh
        cdef double[::1] profile = target.profile
        cdef unsigned long long* bits = &target.bits[0, 0, 0]
        cdef Py_ssize_t rows = target.rows, columns = target.columns, p0 = self.p0, p1 = self.p1
        cdef double ox = self.ox, oy = self.oy, gain = target.gain
        cdef double width = self.lines.widths[self.i], enters = self.lines.enters[self.i]
        cdef double lenience = self.terms.lenience
        cdef Py_ssize_t n = p1 - p0 if p1 > p0 else 1
        cdef Py_ssize_t q = p0
        cdef Py_ssize_t reach = profile.shape[0]
        for i in range(n):
            q = p0 + i
            if p1 == p0:
                mx = points[q, 0] + ox
                my = points[q, 1] + oy
                ink[i] = bar(
                    bits, rows, columns, mx, my, mx, my, half_width(width, gain, 0.0, 0.0), True, False, False
                )
            else:
                dx = points[q + 1, 0] - points[q, 0]
                dy = points[q + 1, 1] - points[q, 1]
                ink[i] = bar(
                    bits, rows, columns, points[q, 0] + ox, points[q, 1] + oy,
                    points[q + 1, 0] + ox, points[q + 1, 1] + oy, half_width(width, gain, dx, dy), False, False, False
                )
                mx = points[q, 0] + 0.5 * dx + ox
                my = points[q, 1] + 0.5 * dy + oy
            ink[i] *= 0.015625
            x = cell(mx)
            y = cell(my)
            x = 0 if x < 0 else (columns - 1 if x >= columns else x)
            y = 0 if y < 0 else (rows - 1 if y >= rows else y)
            # where part of the kernel is cut off, less is due for the same want of ink: both sides at full weight
            due[i] = target.residual[y, x] / target.weight[y, x] + lenience * target.guide[y, x]
            tone = target.guide[y, x]
            share[i] = tone if due[i] > 0.0 and tone > PAPER and tone > enters else 1e30
            own[i] = 0.0
        # the kernel along the stroke, by distance in quarter cells; pieces are 1/16 … 1 cell or so apart
        for i in range(n):
            own[i] += ink[i] * profile[0]
            for j in range(i + 1, n):
                dx = points[p0 + j, 0] - points[p0 + i, 0]
                dy = points[p0 + j, 1] - points[p0 + i, 1]
                d = 0.5 * sqrt(dx * dx + dy * dy)
                if d >= reach:
                    break
                own[i] += ink[j] * profile[<Py_ssize_t>d]
                own[j] += ink[i] * profile[<Py_ssize_t>d]
            # where it is light a stroke is darker than what it stands for, as far as the kernel reaches: by the rule of
            # the least error none would ever be drawn, so one that is known to belong there is worth its ink
            if share[i] < own[i] and 2.0 * due[i] - WORTH < own[i]:
                own[i] = 2.0 * due[i] - WORTH
        return n

    cdef double runs(self, Py_ssize_t n, Py_ssize_t shortest, Py_ssize_t shortest_wall) noexcept nogil:
        """The runs of pieces worth drawing: the two states are pen up and pen down.

        best[j] is the largest gain of what lies before point j, with the pen up there, and
        start[j] where the run ends that ends at j began (-1: none ends there). A run is at
        least `shortest` pieces long, or `shortest_wall` where it ends at a wall.
        """
        cdef double[::1] ink = self.ink, own = self.own, due = self.due, total = self.total, best = self.best
        cdef long long[::1] start = self.start
        cdef double cost = self.terms.cost, caution = self.terms.caution
        cdef bint wall0 = self.lines.walls[self.i] & 1
        cdef bint wall1 = (self.lines.walls[self.i] & 2) != 0
        cdef Py_ssize_t i, j, need
        cdef double v
        cdef double opened = -1e30
        cdef Py_ssize_t where = 0
        total[0] = 0.0
        best[0] = 0.0
        start[0] = -1
        for j in range(1, n + 1):
            total[j] = total[j - 1] + ink[j - 1] * (2.0 * due[j - 1] - caution * own[j - 1])
            best[j] = best[j - 1]
            start[j] = -1
            i = j - shortest
            if i >= 0 and best[i] - total[i] > opened:
                opened = best[i] - total[i]
                where = i
            if i >= 0 and total[j] + opened - cost > best[j]:
                best[j] = total[j] + opened - cost
                start[j] = where
            if wall0 and j >= shortest_wall and total[j] - cost > best[j]:
                best[j] = total[j] - cost
                start[j] = 0
            if wall1 and j == n:
                need = shortest_wall if shortest_wall < shortest else shortest
                for i in range(0, n - need + 1):
                    v = total[n] - total[i] + best[i] - cost
                    if v > best[n]:
                        best[n] = v
                        start[n] = i
        return best[n]


def place(
    Target target, Tried lines, Terms terms, long long[::1] order, long long[:, :, ::1] runs, double[:, ::1] moved
) -> None:
    """Try the polylines named in order, one after the other, and draw of each what is worth drawing.

    runs: (n, most, 2) out, points first … last of each run of polyline i, -1 where there is none.
    moved: (n, 2) out, the move chosen.
    """
    cdef Py_ssize_t k, i, j, m, n, p0, p1, found, least, least_wall
    cdef double nx, ny, d, value, good, bx, by, long
    cdef Py_ssize_t most = runs.shape[1]
    cdef double[:, ::1] points = lines.points
    cdef long long[::1] first = lines.first
    cdef bint whole = terms.whole, strict = terms.strict
    cdef Py_ssize_t longest = 0
    for k in range(first.shape[0] - 1):
        longest = max(longest, first[k + 1] - first[k])
    cdef Trial trial = Trial(lines, terms, longest + 2)
    with nogil:
        for k in range(order.shape[0]):
            i = order[k]
            p0 = first[i]
            p1 = first[i + 1] - 1
            trial.i = i
            trial.p0 = p0
            trial.p1 = p1
            nx = -(points[p1, 1] - points[p0, 1])
            ny = points[p1, 0] - points[p0, 0]
            d = sqrt(nx * nx + ny * ny)
            if d > 1e-9:
                nx /= d
                ny /= d
            else:
                nx = 0.0
                ny = 1.0
            # lengths of runs become numbers of pieces; a loop is much longer than its ends are apart
            n = p1 - p0
            long = 0.0
            for j in range(p0, p1):
                long += sqrt((points[j + 1, 0] - points[j, 0]) ** 2 + (points[j + 1, 1] - points[j, 1]) ** 2)
            if long > 1.2 * d:
                d = long
            least = 1
            least_wall = 1
            if n > 0:
                d = d / n if d > 1e-9 else 8.0
                least = <Py_ssize_t>ceil(terms.shortest / d)
                least_wall = <Py_ssize_t>ceil(terms.shortest_wall / d)
                least = max(least, 1)
                least_wall = max(least_wall, 1)
                if least > n and not whole and not strict and lines.walls[i] == 0:
                    continue
            good = 0.0
            bx = 0.0
            by = 0.0
            m = -1
            for j in range(terms.shifts.shape[0]):
                trial.ox = nx * terms.shifts[j] * terms.spacing
                trial.oy = ny * terms.shifts[j] * terms.spacing
                n = trial.gains(target)
                if not whole and not strict:
                    value = trial.runs(n, least, least_wall)
                elif not strict:
                    value = -terms.cost
                    for found in range(n):
                        value += trial.ink[found] * (2.0 * trial.due[found] - terms.caution * trial.own[found])
                else:
                    value = 1.0
                    for found in range(n):
                        if trial.due[found] < trial.own[found]:
                            value = -1.0
                            break
                if value > good:
                    good = value
                    bx = trial.ox
                    by = trial.oy
                    m = j
            if m < 0:
                continue
            trial.ox = bx
            trial.oy = by
            moved[i, 0] = bx
            moved[i, 1] = by
            if whole or strict:
                runs[i, 0, 0] = p0
                runs[i, 0, 1] = p1
                trial.draw(target, p0, p1)
                continue
            if m != terms.shifts.shape[0] - 1:
                n = trial.gains(target)
                trial.runs(n, least, least_wall)
            j = n
            found = 0
            while j > 0 and found < most:
                if trial.start[j] < 0 or trial.best[j] == trial.best[j - 1]:
                    j -= 1
                    continue
                runs[i, found, 0] = p0 + trial.start[j]
                runs[i, found, 1] = p0 + j
                trial.draw(target, p0 + trial.start[j], p0 + j)
                found += 1
                j = trial.start[j]
