# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled loops over what is due: low-passing it, and taking new ink from it, without crossing strong steps of tone.

Only `low_pass` and the other kernels of this room import this module.
"""

from libc.math cimport fabsf
from libc.string cimport memcpy

cdef extern from "due.h" nogil:
    int best_lanes()
    int lanes
    void splat_block(
        float* residual, float* guide, long wide, float* kernel, long rows, float here, float ink, float step
    )
    void weigh(float* out, float* rows, long apart, float* line, long n, long blocks)
    void weigh_beside(float* out, float* values, float* guide, long wide, float* kernel, long n, float step)


def take_lanes(int wanted) -> int:
    """Take the make for vectors of so many bytes, 16 or 32, or what this processor has: the same numbers by both."""
    global lanes
    lanes = min(wanted, best_lanes())
    return lanes


take_lanes(32)


cdef void splat(
    float[:, ::1] residual, float[:, ::1] guide, float[:, ::1] kernel, Py_ssize_t y, Py_ssize_t x, float ink, float step
) noexcept nogil:
    """Take ink (cells) at cell (y, x) from the residual around it, on this side of any strong step of tone."""
    cdef Py_ssize_t i, j
    cdef float* k
    cdef float* g
    cdef float* out
    cdef float w
    cdef Py_ssize_t r = kernel.shape[0] // 2
    cdef Py_ssize_t top = y - r if y > r else 0
    cdef Py_ssize_t bottom = y + r + 1 if y + r + 1 < residual.shape[0] else residual.shape[0]
    cdef Py_ssize_t left = x - r if x > r else 0
    cdef Py_ssize_t right = x + r + 1 if x + r + 1 < residual.shape[1] else residual.shape[1]
    cdef float here = guide[y, x]
    cdef float none = 0.0  # a literal would be a double, and the loop four times slower
    cdef Py_ssize_t n = right - left
    cdef bint whole = x >= r and x - r + 16 <= residual.shape[1]
    if whole:  # the kernel ends in zeros
        splat_block(
            &residual[top, left], &guide[top, left], residual.shape[1], &kernel[top - y + r, 0], bottom - top, here,
            ink, step,
        )
        return
    for i in range(top, bottom):
        k = &kernel[i - y + r, left - x + r]
        g = &guide[i, left]
        out = &residual[i, left]
        for j in range(n):
            w = ink * k[j]
            out[j] -= w if fabsf(g[j] - here) < step else none


def gather(
    float[:, ::1] values, float[:, ::1] guide, float[:, ::1] kernel, float[::1] line, float step,
    unsigned char[:, ::1] plain, float[:, ::1] scratch, float[:, ::1] out, Py_ssize_t top, Py_ssize_t bottom,
):
    """out = kernel * values for rows top … bottom, on each cell's own side of any strong step of tone.

    values, guide: padded by the kernel's reach on all sides, and on to the right to whole blocks of 16 cells and one.
    line: (2 r + 1,) what the kernel is the outer square of. plain: (rows, blocks) where no step is in reach: there rows
    and columns are done one after the other, a sixteenth of the work.
    scratch: (bottom - top + 2 r + 1, as wide as values).
    """
    cdef Py_ssize_t y, a, b
    cdef float* row
    cdef Py_ssize_t r = kernel.shape[0] // 2
    cdef Py_ssize_t columns = out.shape[1]
    cdef Py_ssize_t blocks = plain.shape[1]
    cdef Py_ssize_t wide = values.shape[1]
    with nogil:
        for y in range(bottom - top + 2 * r):
            weigh(&scratch[y, 0], &values[top + y, 0], 1, &line[0], 2 * r + 1, blocks)
        row = &scratch[bottom - top + 2 * r, 0]
        for y in range(top, bottom):
            a = 0
            while a < blocks:
                b = a + 1
                if plain[y, a]:
                    while b < blocks and plain[y, b]:
                        b += 1
                    weigh(row, &scratch[y - top, 16 * a], wide, &line[0], 2 * r + 1, b - a)
                else:
                    weigh_beside(
                        row, &values[y, 16 * a], &guide[y, 16 * a], wide, &kernel[0, 0], 2 * r + 1, step
                    )
                memcpy(&out[y, 16 * a], row, sizeof(float) * (min(16 * b, columns) - 16 * a))
                a = b
