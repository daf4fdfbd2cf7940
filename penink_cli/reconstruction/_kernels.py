# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The two reconstruction kernels of appendix A, and the tables of taps made of them."""

import cython
from cython.cimports.libc.math import fabs, floor

COMPILED = cython.compiled


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def cubic(x: cython.double) -> cython.double:
    """Equation 8 with a = −½: cubic convolution; zero from |x| = 2 on."""
    x = fabs(x)
    if x < 1.0:
        return (1.5 * x - 2.5) * x * x + 1.0
    if x < 2.0:
        return ((-0.5 * x + 2.5) * x - 4.0) * x + 2.0
    return 0.0


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def bspline(x: cython.double) -> cython.double:
    """Equation 9, the Parzen window: never negative; zero from |x| = 2 on."""
    x = fabs(x)
    if x < 1.0:
        return ((3.0 * x - 6.0) * x * x + 4.0) / 6.0
    if x < 2.0:
        x = 2.0 - x
        return x * x * x / 6.0
    return 0.0


def fill_taps(
    where: cython.double[::1],
    widening: cython.double,
    first: cython.int[::1],
    c: cython.double[:, ::1],
    b: cython.double[:, ::1],
) -> None:
    """For each position the first sample under the kernels and their weights, those of one position summing to one.

    where: (n,) positions in sample units. widening: 1, or the inverse scale below scale 1.
    first: (n,) filled with floor(x − 2·widening) + 1; c, b: (n, taps) filled.
    """
    k: cython.Py_ssize_t
    t: cython.Py_ssize_t
    x: cython.double
    sum_c: cython.double
    sum_b: cython.double
    with cython.nogil:
        for k in range(where.shape[0]):
            first[k] = cython.cast(cython.int, floor(where[k] - 2.0 * widening)) + 1
            sum_c = 0.0
            sum_b = 0.0
            for t in range(c.shape[1]):
                x = where[k] - (first[k] + t)
                if widening > 1.0:
                    x /= widening
                c[k, t] = cubic(x)
                b[k, t] = bspline(x)
                sum_c += c[k, t]
                sum_b += b[k, t]
            if widening > 1.0:  # at widening 1 the sums are one already
                for t in range(c.shape[1]):
                    c[k, t] /= sum_c
                    b[k, t] /= sum_b


def lay_tiles(where: cython.double[::1], most: cython.int, cell: cython.int[::1], first: cython.int[::1]) -> cython.int:
    """Cut ascending positions into tiles of at most `most` of one cell each; how many there are.

    cell, first: (n,), (n + 1,) filled with the cell of each tile and its first position; last comes n.
    """
    k: cython.int
    n: cython.int = 0
    c: cython.int
    for k in range(cython.cast(cython.int, where.shape[0])):
        c = cython.cast(cython.int, floor(where[k]))
        if n == 0 or c != cell[n - 1] or k - first[n - 1] == most:
            cell[n] = c
            first[n] = k
            n += 1
    first[n] = cython.cast(cython.int, where.shape[0])
    return n
