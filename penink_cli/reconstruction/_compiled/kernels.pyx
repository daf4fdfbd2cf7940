# cython: boundscheck=False, wraparound=False, cdivision=True
"""The two reconstruction kernels of appendix A, and the tables of taps made of them."""

from libc.math cimport fabs, floor


cdef double cubic(double x) noexcept nogil:
    """Equation 8 with a = −½: cubic convolution; zero from |x| = 2 on."""
    x = fabs(x)
    if x < 1.0:
        return (1.5 * x - 2.5) * x * x + 1.0
    if x < 2.0:
        return ((-0.5 * x + 2.5) * x - 4.0) * x + 2.0
    return 0.0


cdef double bspline(double x) noexcept nogil:
    """Equation 9, the Parzen window: never negative; zero from |x| = 2 on."""
    x = fabs(x)
    if x < 1.0:
        return ((3.0 * x - 6.0) * x * x + 4.0) / 6.0
    if x < 2.0:
        x = 2.0 - x
        return x * x * x / 6.0
    return 0.0


def fill_taps(double[::1] where, double widening, int[::1] first, double[:, ::1] c, double[:, ::1] b) -> None:
    """For each position the first sample under the kernels and their weights, those of one position summing to one.

    where: (n,) positions in sample units. widening: 1, or the inverse scale below scale 1.
    first: (n,) filled with floor(x − 2·widening) + 1; c, b: (n, taps) filled.
    """
    cdef Py_ssize_t k, t
    cdef double x, sum_c, sum_b
    with nogil:
        for k in range(where.shape[0]):
            first[k] = <int>floor(where[k] - 2.0 * widening) + 1
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


def lay_tiles(double[::1] where, int most, int[::1] cell, int[::1] first):
    """Cut ascending positions into tiles of at most `most` of one cell each; how many there are.

    cell, first: (n,), (n + 1,) filled with the cell of each tile and its first position; last comes n.
    """
    cdef int k, c
    cdef int n = 0
    for k in range(<int>where.shape[0]):
        c = <int>floor(where[k])
        if n == 0 or c != cell[n - 1] or k - first[n - 1] == most:
            cell[n] = c
            first[n] = k
            n += 1
    first[n] = <int>where.shape[0]
    return n
