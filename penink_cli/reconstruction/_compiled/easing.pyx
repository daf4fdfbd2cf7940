# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: samples relaxed to smooth surfaces within what they were rounded from."""


def relax(
    double[:, ::1] values, const double[:, ::1] low, const double[:, ::1] high, const double[:, ::1] pull,
    const unsigned char[:, ::1] linked, int sweeps, double hurry,
) -> None:
    """Let samples approach the mean of the neighbours that they are linked to, in place, each within its bounds.

    values: (h, w), at first the rounded ones, which those that are pulled come back to. low, high: their bounds; where
    these are one, the sample stays. pull: its weight, where each neighbour's is 1. linked: bits 1 east, 2 south.
    sweeps, hurry: how often, and the factor of over-relaxation. The order of the sums is fixed.
    """
    cdef Py_ssize_t i, j
    cdef int _sweep
    cdef double total, weight, value, rounded
    cdef Py_ssize_t h = values.shape[0]
    cdef Py_ssize_t w = values.shape[1]
    with nogil:
        for _sweep in range(sweeps):
            for i in range(h):
                for j in range(w):
                    if low[i, j] >= high[i, j]:
                        continue
                    rounded = (low[i, j] + high[i, j]) / 2
                    total = pull[i, j] * rounded
                    weight = pull[i, j]
                    if j > 0 and linked[i, j - 1] & 1:
                        total += values[i, j - 1]
                        weight += 1
                    if linked[i, j] & 1:
                        total += values[i, j + 1]
                        weight += 1
                    if i > 0 and linked[i - 1, j] & 2:
                        total += values[i - 1, j]
                        weight += 1
                    if linked[i, j] & 2:
                        total += values[i + 1, j]
                        weight += 1
                    if weight > 0:
                        value = values[i, j] + hurry * (total / weight - values[i, j])
                        values[i, j] = min(max(value, low[i, j]), high[i, j])
