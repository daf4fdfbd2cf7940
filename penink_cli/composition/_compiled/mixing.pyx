# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: how much of the differences of a picture a grey keeps. Only `mixing` imports this module."""

from libc.math cimport fabs


def kept(
    const double[::1] grey, const int[::1] one, const int[::1] other, const double[::1] wanted, double whole
) -> int:
    """Of all pairs of cells, by their numbers: the lesser of their grey's difference and the one wanted, all summed up.

    In whole numbers, so many to 1, each rounded down: their sum is the same in any order.
    """
    cdef Py_ssize_t k
    cdef double difference
    cdef long long total = 0
    with nogil:
        for k in range(one.shape[0]):
            difference = fabs(grey[one[k]] - grey[other[k]])
            total += <long long>((difference if difference < wanted[k] else wanted[k]) * whole)
    return total


def mix(
    const float[:, :, ::1] colours, float red, float green, float blue, float[:, ::1] out,
    Py_ssize_t top, Py_ssize_t bottom
) -> None:
    """Rows top … bottom of out (h, w): the sums of colours (h, w, 3) by these weights, from 0 to 1."""
    cdef Py_ssize_t y, x
    cdef float v
    with nogil:
        for y in range(top, bottom):
            for x in range(out.shape[1]):
                v = red * colours[y, x, 0] + green * colours[y, x, 1] + blue * colours[y, x, 2]
                out[y, x] = (v if v < 1.0 else <float>1.0) if v > 0.0 else <float>0.0
