# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: a separable symmetric filter. Only `gaussian` imports this module.

Sums are of doubles in one order and rounded to floats once in each direction, as scipy's are.
"""

from libc.stdlib cimport free
from penink_cli.ground._compiled.memory cimport room


def smooth(const float[:, ::1] grey, const double[::1] weights, float[:, ::1] out) -> None:
    """Filter grey (h, w) down and across into out (h, w). Beyond its sides the picture goes on as it ends.

    weights: (n,) one half of a symmetric filter, the middle weight first.
    """
    cdef Py_ssize_t h = grey.shape[0], w = grey.shape[1], n = weights.shape[0], i, j, k
    cdef const float* above
    cdef const float* below
    cdef double weight
    cdef double* sums = NULL
    cdef float* wide = NULL
    try:
        sums = <double*>room(w, sizeof(double))
        wide = <float*>room(w + 2 * n, sizeof(float))
        with nogil:
            for i in range(h):
                for j in range(w):
                    sums[j] = weights[0] * grey[i, j]
                for k in range(n - 1, 0, -1):
                    weight = weights[k]
                    above, below = &grey[max(0, i - k), 0], &grey[min(h - 1, i + k), 0]
                    for j in range(w):
                        sums[j] += weight * (<double>above[j] + <double>below[j])
                for j in range(w):
                    wide[n + j] = <float>sums[j]
                for j in range(n):
                    wide[j], wide[n + w + j] = wide[n], wide[n + w - 1]
                for j in range(w):
                    sums[j] = weights[0] * wide[n + j]
                for k in range(n - 1, 0, -1):
                    weight = weights[k]
                    for j in range(w):
                        sums[j] += weight * (<double>wide[n + j - k] + <double>wide[n + j + k])
                for j in range(w):
                    out[i, j] = <float>sums[j]
    finally:
        free(sums)
        free(wide)
