# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled loops over what is due: low-passing it, and taking new ink from it, without crossing strong steps of tone.

Only `low_pass` and the other kernels of this room import this module.
"""

from libc.math cimport fabsf


cdef void splat(
    float[:, ::1] residual, float[:, ::1] guide, float[:, ::1] kernel, Py_ssize_t y, Py_ssize_t x, float ink, float step
) noexcept nogil:
    """Take ink (cells) at cell (y, x) from the residual around it, on this side of any strong step of tone."""
    cdef Py_ssize_t i, j
    cdef float* k
    cdef float* g
    cdef float* out
    cdef float w
    cdef float[16] part
    cdef Py_ssize_t r = kernel.shape[0] // 2
    cdef Py_ssize_t top = y - r if y > r else 0
    cdef Py_ssize_t bottom = y + r + 1 if y + r + 1 < residual.shape[0] else residual.shape[0]
    cdef Py_ssize_t left = x - r if x > r else 0
    cdef Py_ssize_t right = x + r + 1 if x + r + 1 < residual.shape[1] else residual.shape[1]
    cdef float here = guide[y, x]
    cdef float none = 0.0  # a literal would be a double, and the loop four times slower
    cdef Py_ssize_t n = right - left
    cdef bint whole = x >= r and x - r + 16 <= residual.shape[1]
    if whole:
        for i in range(top, bottom):
            k = &kernel[i - y + r, left - x + r]
            g = &guide[i, left]
            out = &residual[i, left]
            # loops of a length known beforehand, into an array that can be no other's, become four vectors: a quarter
            # of the instructions of one that writes straight to the residual; the kernel ends in zeros
            for j in range(16):
                part[j] = <float>(fabsf(g[j] - here) < step) * (ink * k[j])
            for j in range(16):
                out[j] -= part[j]
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
    cdef Py_ssize_t y, x, a, b, i, j, n
    cdef float k, m, v, w
    cdef float* o
    cdef float* e
    cdef float* g
    cdef float* here
    cdef Py_ssize_t r = kernel.shape[0] // 2
    cdef Py_ssize_t columns = out.shape[1]
    cdef float none = 0.0
    with nogil:
        n = 16 * plain.shape[1]
        for y in range(bottom - top + 2 * r):
            o = &scratch[y, 0]
            for x in range(n):
                o[x] = 0.0
            for j in range(2 * r + 1):
                k = line[j]
                e = &values[top + y, j]
                for x in range(n):
                    o[x] += k * e[x]
        o = &scratch[bottom - top + 2 * r, 0]
        for y in range(top, bottom):
            a = 0
            while a < plain.shape[1]:
                b = a + 1
                while b < plain.shape[1] and plain[y, b] == plain[y, a]:
                    b += 1
                n = 16 * (b - a)
                for x in range(n):
                    o[x] = 0.0
                if plain[y, a]:
                    for i in range(2 * r + 1):
                        k = line[i]
                        e = &scratch[y - top + i, 16 * a]
                        for x in range(n):
                            o[x] += k * e[x]
                else:
                    here = &guide[y + r, 16 * a + r]
                    for i in range(2 * r + 1):
                        # two at a time: rows of the kernel end in zeros
                        for j in range(0, 2 * r + 1, 2):
                            k = kernel[i, j]
                            m = kernel[i, j + 1]
                            e = &values[y + i, 16 * a + j]
                            g = &guide[y + i, 16 * a + j]
                            for x in range(n):
                                v = k * e[x]
                                w = m * e[x + 1]
                                v = v if fabsf(g[x] - here[x]) < step else none
                                w = w if fabsf(g[x + 1] - here[x]) < step else none
                                o[x] += v + w
                here = &out[y, 16 * a]
                for x in range(n if 16 * b <= columns else columns - 16 * a):
                    here[x] = o[x]
                a = b
