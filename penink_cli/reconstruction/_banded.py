# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Compiled: banded least squares for all columns of a picture at once. See fit.py."""

import cython

COMPILED = cython.compiled


def transposed(
    base: cython.int[::1], weight: cython.double[:, ::1], source: cython.float[:, ::1], out: cython.double[:, ::1]
) -> None:
    """Add up out[base[p] + t] += weight[p, t] · source[p] over all rows p."""
    p: cython.Py_ssize_t
    t: cython.Py_ssize_t
    q: cython.Py_ssize_t
    w: cython.double
    with cython.nogil:
        for p in range(source.shape[0]):
            for t in range(weight.shape[1]):
                w = weight[p, t]
                if w != 0:
                    for q in range(source.shape[1]):
                        out[base[p] + t, q] += w * source[p, q]


def leave(
    base: cython.int[::1], weight: cython.double[:, ::1], source: cython.double[:, ::1], out: cython.float[:, ::1]
) -> None:
    """Subtract weight[p, t] · source[base[p] + t] from out[p], for all rows p: the transpose of `transposed`."""
    p: cython.Py_ssize_t
    t: cython.Py_ssize_t
    q: cython.Py_ssize_t
    w: cython.double
    with cython.nogil:
        for p in range(out.shape[0]):
            for t in range(weight.shape[1]):
                w = weight[p, t]
                if w != 0:
                    for q in range(out.shape[1]):
                        out[p, q] -= w * source[base[p] + t, q]


def solve_banded(band: cython.double[:, ::1], values: cython.double[:, ::1]) -> None:
    """Solve a symmetric positive definite banded system for every column of values, in place (L D Lᵀ).

    band: (n, k) band[i, d] is the element (i, i + d); destroyed.
    """
    n: cython.Py_ssize_t = band.shape[0]
    reach: cython.Py_ssize_t = band.shape[1]
    i: cython.Py_ssize_t
    d: cython.Py_ssize_t
    e: cython.Py_ssize_t
    q: cython.Py_ssize_t
    f: cython.double
    with cython.nogil:
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
