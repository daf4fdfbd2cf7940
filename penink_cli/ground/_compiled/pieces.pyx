# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: strokes that swell in pieces of one width. Only `model` imports this module."""

from penink_cli.ground._compiled.cubics cimport part


def split(
    const double[:, ::1] points, const long long[::1] cubic, const double[::1] begin, const double[::1] end,
    const long long[::1] count, double[:, ::1] out, double[::1] widths,
) -> None:
    """Cut each cubic, whose points begin at `cubic` (n,), into `count` pieces, 4 points each in out.

    begin, end: (n,) the width where each begins and ends; widths: out, that in the middle of each piece.
    """
    cdef Py_ssize_t i, to = 0
    cdef long long k
    cdef double n
    with nogil:
        for i in range(cubic.shape[0]):
            n = <double>count[i]
            for k in range(count[i]):
                part(&points[cubic[i], 0], k / n, (k + 1) / n, &out[4 * to, 0])
                widths[to] = begin[i] + (end[i] - begin[i]) * (k + 0.5) / n
                to += 1
