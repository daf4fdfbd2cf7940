# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: banded least squares for all columns of a picture at once. See fit.py."""


def transposed(int[::1] base, double[:, ::1] weight, float[:, ::1] source, double[:, ::1] out) -> None:
    """Add up out[base[p] + t] += weight[p, t] · source[p] over all rows p."""
    cdef Py_ssize_t p, t, q
    cdef double w
    with nogil:
        for p in range(source.shape[0]):
            for t in range(weight.shape[1]):
                w = weight[p, t]
                if w != 0:
                    for q in range(source.shape[1]):
                        out[base[p] + t, q] += w * source[p, q]


def leave(int[::1] base, double[:, ::1] weight, double[:, ::1] source, float[:, ::1] out) -> None:
    """Subtract weight[p, t] · source[base[p] + t] from out[p], for all rows p: the transpose of `transposed`."""
    cdef Py_ssize_t p, t, q
    cdef double w
    with nogil:
        for p in range(out.shape[0]):
            for t in range(weight.shape[1]):
                w = weight[p, t]
                if w != 0:
                    for q in range(out.shape[1]):
                        out[p, q] -= w * source[base[p] + t, q]


def solve_banded(double[:, ::1] band, double[:, ::1] values) -> None:
    """Solve a symmetric positive definite banded system for every column of values, in place (L D Lᵀ).

    band: (n, k) band[i, d] is the element (i, i + d); destroyed.
    """
    cdef Py_ssize_t i, d, e, q
    cdef double f
    cdef Py_ssize_t n = band.shape[0]
    cdef Py_ssize_t reach = band.shape[1]
    with nogil:
        for i in range(n):
            for d in range(1, min(reach, n - i)):
                f = band[i, d] / band[i, 0]
                for e in range(d, reach):
                    if i + e < n:
                        band[i + d, e - d] -= f * band[i, e]
                for q in range(values.shape[1]):
                    values[i + d, q] -= f * values[i, q]
        for i in range(n - 1, -1, -1):
            f = 1.0 / band[i, 0]
            for q in range(values.shape[1]):
                values[i, q] *= f
            for d in range(1, min(reach, n - i)):
                f = band[i, d] / band[i, 0]
                for q in range(values.shape[1]):
                    values[i, q] -= f * values[i + d, q]
