# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled loop: points on chains of cubic Béziers. Only `curves` imports this module."""


def sample(
    double[:, ::1] points, long long[::1] first, long long[::1] pieces, long long[::1] begin, double[:, ::1] out
):
    """Each cubic's start and inner points at equal steps of the parameter, and the last point of each chain.

    first: (n + 1,) where the control points of each chain begin; pieces: for each cubic of all chains; begin: (n + 1,)
    where the samples of each begin in out.
    """
    cdef Py_ssize_t i, p, k, to
    cdef double t, u, a, b, c, d
    cdef Py_ssize_t cubic = 0
    with nogil:
        for i in range(first.shape[0] - 1):
            to = begin[i]
            p = first[i]
            while p + 3 < first[i + 1]:
                for k in range(pieces[cubic]):
                    t = <double>k / pieces[cubic]
                    u = 1.0 - t
                    a = u * u * u
                    b = 3.0 * u * u * t
                    c = 3.0 * u * t * t
                    d = t * t * t
                    out[to, 0] = a * points[p, 0] + b * points[p + 1, 0] + (c * points[p + 2, 0] + d * points[p + 3, 0])
                    out[to, 1] = a * points[p, 1] + b * points[p + 1, 1] + (c * points[p + 2, 1] + d * points[p + 3, 1])
                    to += 1
                cubic += 1
                p += 3
            out[to, 0] = points[p, 0]
            out[to, 1] = points[p, 1]
