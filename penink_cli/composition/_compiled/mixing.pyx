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
