# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled loop over the pressure of the hand: how wide each stroke is to be. Only `sheet` imports this module."""

from libc.math cimport sqrt
from penink_cli.blasting._compiled.due cimport splat
from penink_cli.blasting._compiled.ink cimport bar, cell, half_width

import numpy as np


cdef class Seen:
    """Where strokes are pressed.

    bits: the ink, a cell a word; columns: of cells. gain: what a device adds to a stroke, subpixels.
    residual, guide: cells twice as wide and high: what is still due as the eye sees it, and the tone wanted.
    low_pass: what the eye takes in at once, of such cells, see `low_pass.LowPass`.
    """

    cdef unsigned long long[:, :, ::1] bits
    cdef Py_ssize_t columns
    cdef double gain
    cdef float[:, ::1] residual, guide, kernel
    cdef float step
    cdef double[::1] profile

    def __init__(
        self, unsigned long long[:, :, ::1] bits, Py_ssize_t columns, double gain, float[:, ::1] residual,
        float[:, ::1] guide, low_pass,
    ) -> None:
        self.bits = bits
        self.columns = columns
        self.gain = gain
        self.residual = residual
        self.guide = guide
        self.kernel = low_pass.kernel
        self.step = low_pass.step
        self.profile = low_pass.profile


cdef class Drawn:
    """Polylines that are drawn: points (p, 2), where each begins, and its width, which may become any from lightest to
    heaviest; all of it in subpixels.

    fresh: for each point the cells that a subpixel more of width covers newly in the piece that begins there.
    resistance: (n,) what a subpixel more adds to the squared error by itself. Both are reckoned where resistance is
    negative, and left for the next time: they are two thirds of the work and change little with the width.
    """

    cdef double[:, ::1] points
    cdef long long[::1] first
    cdef double[::1] widths, lightest, heaviest, resistance
    cdef float[::1] fresh

    def __init__(
        self, double[:, ::1] points, long long[::1] first, double[::1] widths, double[::1] lightest,
        double[::1] heaviest,
    ) -> None:
        self.points = points
        self.first = first
        self.widths = widths
        self.lightest = lightest
        self.heaviest = heaviest
        self.fresh = np.zeros(len(points), np.float32)
        self.resistance = np.full(len(widths), -1.0)


def press(Seen seen, Drawn drawn, long long[::1] order) -> None:
    """Change the width of each stroke, one after the other in that order, to where the squared error is least.

    drawn.widths are changed. seen.residual is kept up to date to first order only: what a wider stroke newly covers is
    taken to be as bare as the paper was at first, a subpixel on either side of it.
    """
    cdef Py_ssize_t k, i, j, n, p0, x, y
    cdef double dx, dy, d, pull, change
    cdef unsigned long long* ink_bits = &seen.bits[0, 0, 0]
    cdef Py_ssize_t rows = seen.bits.shape[0]
    cdef Py_ssize_t columns = seen.columns
    cdef float[:, ::1] residual = seen.residual
    cdef double[::1] profile = seen.profile
    cdef Py_ssize_t reach = profile.shape[0]
    cdef double[:, ::1] points = drawn.points
    cdef long long[::1] first = drawn.first
    cdef double[::1] widths = drawn.widths, resistance = drawn.resistance
    cdef float[::1] fresh = drawn.fresh
    with nogil:
        for k in range(order.shape[0]):
            i = order[k]
            p0 = first[i]
            n = first[i + 1] - 1 - p0
            if n < 1:
                continue
            if resistance[i] < 0.0:
                resistance[i] = 0.0
                for j in range(p0, p0 + n):
                    dx = points[j + 1, 0] - points[j, 0]
                    dy = points[j + 1, 1] - points[j, 1]
                    x = cell(points[j, 0] + 0.5 * dx)
                    y = cell(points[j, 1] + 0.5 * dy)
                    fresh[j] = 0.0
                    if 0 <= x < columns and 0 <= y < rows:
                        fresh[j] = 0.001953125 * bar(
                            ink_bits, rows, columns, points[j, 0], points[j, 1], points[j + 1, 0], points[j + 1, 1],
                            half_width(widths[i], seen.gain, dx, dy) + 1.0, False, False, False,
                        )  # fmt: skip
                for j in range(p0, p0 + n):
                    resistance[i] += fresh[j] * fresh[j] * profile[0]
                    for x in range(j + 1, p0 + n):
                        dx = points[x, 0] - points[j, 0]
                        dy = points[x, 1] - points[j, 1]
                        d = 0.25 * sqrt(dx * dx + dy * dy)
                        if d >= reach:
                            break
                        resistance[i] += 2.0 * fresh[j] * fresh[x] * profile[<Py_ssize_t>d]
            if resistance[i] < 1e-12:
                continue
            pull = 0.0
            for j in range(p0, p0 + n):
                if fresh[j] > 0.0:
                    x = cell(0.5 * (points[j, 0] + points[j + 1, 0])) >> 1
                    y = cell(0.5 * (points[j, 1] + points[j + 1, 1])) >> 1
                    pull += fresh[j] * residual[y, x]
            change = widths[i] + pull / resistance[i]
            change = min(max(change, drawn.lightest[i]), drawn.heaviest[i])
            change -= widths[i]
            widths[i] += change
            for j in range(n):
                if fresh[p0 + j] > 0.0 and (j & 1 or j == n - 1):
                    d = fresh[p0 + j] + (fresh[p0 + j - 1] if j & 1 else 0.0)
                    d *= change
                    x = cell(0.5 * (points[p0 + j, 0] + points[p0 + j + 1, 0])) >> 1
                    y = cell(0.5 * (points[p0 + j, 1] + points[p0 + j + 1, 1])) >> 1
                    splat(residual, seen.guide, seen.kernel, y, x, <float>d, seen.step)
