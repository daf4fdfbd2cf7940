# cython: boundscheck=False, wraparound=False, cdivision=True
"""How much of the differences of colours a grey keeps, and the grey of a mix. Only `mixing` imports this module."""

from libc.math cimport fabs


def kept(
    const double[::1] grey, const int[::1] one, const int[::1] other, const double[::1] wanted, double whole
) -> int:
    """The sum, over all pairs of cells, of the lesser of their difference in grey and the difference wanted.

    grey: (c,). one, other: (p,) numbers of the cells of each pair. wanted: (p,). The sum is of whole numbers, `whole`
    to 1, each rounded down, so that it is the same in any order.
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
    """Rows top … bottom of out (h, w): colours (h, w, 3) weighed by red, green and blue, clipped to 0 … 1."""
    cdef Py_ssize_t y, x
    cdef float v
    with nogil:
        for y in range(top, bottom):
            for x in range(out.shape[1]):
                v = red * colours[y, x, 0] + green * colours[y, x, 1] + blue * colours[y, x, 2]
                out[y, x] = (v if v < 1.0 else <float>1.0) if v > 0.0 else <float>0.0
