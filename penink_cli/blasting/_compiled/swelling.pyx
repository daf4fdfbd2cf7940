# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled loop: ink of strokes that swell, on a sheet of bits. Only `sheet` imports this module. Units as in `ink`.

    ·───────·
    k0      k1─────·        Each segment is a quadrangle whose corners lie to both sides of its knots, half the
    ·───────·      k2       width away, where the next one begins; a stroke's ends are discs.
             ╲─────·
"""

from libc.math cimport fabs, sqrt
from penink_cli.blasting._compiled.ink cimport bar

from penink_cli.ground.device import FILLED

#: What a device adds to the width of a shape that it fills times |cos θ| + |sin θ|, in its pixels.
cdef double EDGE_GAIN = FILLED


cdef inline Py_ssize_t _place(double x, Py_ssize_t most) noexcept nogil:
    """The first subpixel whose centre is not left of x, from 0 to most."""
    if x <= 0.5:
        return 0
    return most if x >= most + 0.5 else <Py_ssize_t>(x + 0.5)


cdef void _quad(
    unsigned long long* bits, Py_ssize_t rows, Py_ssize_t columns, double[4] xs, double[4] ys
) noexcept nogil:
    """Ink what lies within four corners, in their order round it."""
    cdef Py_ssize_t across = (columns + 7) >> 3
    cdef double low = ys[0], high = ys[0], x, y, left, right
    cdef double[4] rate
    cdef Py_ssize_t k, m, row, last, a, b, base
    cdef unsigned long long mask
    cdef unsigned long long* word
    rows *= 8
    columns *= 8
    for k in range(4):
        m = (k + 1) & 3
        low = ys[k] if ys[k] < low else low
        high = ys[k] if ys[k] > high else high
        rate[k] = (xs[m] - xs[k]) / (ys[m] - ys[k]) if ys[m] != ys[k] else 0.0
    row = _place(low, rows)
    last = _place(high, rows)
    while row < last:
        y = row + 0.5
        left = 1e30
        right = -1e30
        for k in range(4):
            m = (k + 1) & 3
            if (ys[k] <= y) != (ys[m] <= y):
                x = xs[k] + (y - ys[k]) * rate[k]
                left = x if x < left else left
                right = x if x > right else right
        a = _place(left, columns)
        b = _place(right, columns)
        word = bits + ((row >> 3) * across) * 8 + (row & 7)
        while a < b:
            base = a >> 6
            mask = (<unsigned long long>-1) << (a & 63)
            if b < 64 * base + 64:
                mask &= ~((<unsigned long long>-1) << (b & 63))
            word[8 * base] |= mask
            a = 64 * base + 64
        row += 1


def swell(
    unsigned long long[:, :, ::1] bits, Py_ssize_t columns, double[:, ::1] knots, long long[::1] first,
    double[::1] widths, double gain,
):
    """Ink strokes one after the other. columns: of cells. knots (k, 2) with the widths (k,) there, first (n + 1,)."""
    cdef Py_ssize_t rows = bits.shape[0]
    cdef Py_ssize_t i, k, p, q
    cdef double dx, dy, length, r
    cdef double[4] xs
    cdef double[4] ys
    cdef unsigned long long* ink = &bits[0, 0, 0]
    with nogil:
        for i in range(first.shape[0] - 1):
            for k in range(first[i], first[i + 1]):
                p = k - 1 if k > first[i] else k
                q = k + 1 if k + 1 < first[i + 1] else k
                dx = knots[q, 0] - knots[p, 0]
                dy = knots[q, 1] - knots[p, 1]
                length = sqrt(dx * dx + dy * dy)
                if length < 1e-9:
                    dx = 1.0
                    dy = 0.0
                    length = 1.0
                dx /= length
                dy /= length
                r = 0.5 * (widths[k] + EDGE_GAIN * gain * (fabs(dx) + fabs(dy)))
                if p == k or q == k:
                    bar(ink, rows, columns, knots[k, 0], knots[k, 1], knots[k, 0], knots[k, 1], r, True, False, True)
                xs[2] = knots[k, 0] - dy * r
                ys[2] = knots[k, 1] + dx * r
                xs[3] = knots[k, 0] + dy * r
                ys[3] = knots[k, 1] - dx * r
                if p < k:
                    _quad(ink, rows, columns, xs, ys)
                xs[0] = xs[3]
                ys[0] = ys[3]
                xs[1] = xs[2]
                ys[1] = ys[2]
