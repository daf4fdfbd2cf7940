# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Compiled loops over what is due: low-passing it, and taking new ink from it, without crossing strong steps of tone.

Only `low_pass` and the other kernels of this room import this module.
"""

import cython
from cython.cimports.libc.math import fabsf

COMPILED = cython.compiled


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def splat(
    residual: cython.float[:, ::1], guide: cython.float[:, ::1], kernel: cython.float[:, ::1],
    y: cython.Py_ssize_t, x: cython.Py_ssize_t, ink: cython.float, step: cython.float,
) -> cython.void:
    """Take ink (cells) at cell (y, x) from the residual around it, on this side of any strong step of tone."""
    r: cython.Py_ssize_t = kernel.shape[0] // 2
    top: cython.Py_ssize_t = y - r if y > r else 0
    bottom: cython.Py_ssize_t = y + r + 1 if y + r + 1 < residual.shape[0] else residual.shape[0]
    left: cython.Py_ssize_t = x - r if x > r else 0
    right: cython.Py_ssize_t = x + r + 1 if x + r + 1 < residual.shape[1] else residual.shape[1]
    here: cython.float = guide[y, x]
    none: cython.float = 0.0  # a literal would be a double, and the loop four times slower
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    n: cython.Py_ssize_t = right - left
    whole: cython.bint = x >= r and x - r + 16 <= residual.shape[1]
    k: cython.p_float
    g: cython.p_float
    out: cython.p_float
    w: cython.float
    part: cython.float[16]
    if whole:
        for i in range(top, bottom):
            k = cython.address(kernel[i - y + r, left - x + r])
            g = cython.address(guide[i, left])
            out = cython.address(residual[i, left])
            # loops of a length known beforehand, into an array that can be no other's, become four vectors: a quarter
            # of the instructions of one that writes straight to the residual; the kernel ends in zeros
            for j in range(16):
                part[j] = cython.cast(cython.float, fabsf(g[j] - here) < step) * (ink * k[j])
            for j in range(16):
                out[j] -= part[j]
        return
    for i in range(top, bottom):
        k = cython.address(kernel[i - y + r, left - x + r])
        g = cython.address(guide[i, left])
        out = cython.address(residual[i, left])
        for j in range(n):
            w = ink * k[j]
            out[j] -= w if fabsf(g[j] - here) < step else none


def gather(
    values: cython.float[:, ::1], guide: cython.float[:, ::1], kernel: cython.float[:, ::1], line: cython.float[::1],
    step: cython.float, plain: cython.uchar[:, ::1], scratch: cython.float[:, ::1], out: cython.float[:, ::1],
    top: cython.Py_ssize_t, bottom: cython.Py_ssize_t,
):
    """out = kernel * values for rows top … bottom, on each cell's own side of any strong step of tone.

    values, guide: padded by the kernel's reach on all sides, and on to the right to whole blocks of 16 cells and one.
    line: (2 r + 1,) what the kernel is the outer square of. plain: (rows, blocks) where no step is in reach: there rows
    and columns are done one after the other, a sixteenth of the work.
    scratch: (bottom - top + 2 r + 1, as wide as values).
    """
    r: cython.Py_ssize_t = kernel.shape[0] // 2
    columns: cython.Py_ssize_t = out.shape[1]
    y: cython.Py_ssize_t
    x: cython.Py_ssize_t
    a: cython.Py_ssize_t
    b: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    n: cython.Py_ssize_t
    k: cython.float
    m: cython.float
    v: cython.float
    w: cython.float
    none: cython.float = 0.0
    o: cython.p_float
    e: cython.p_float
    g: cython.p_float
    here: cython.p_float
    with cython.nogil:
        n = 16 * plain.shape[1]
        for y in range(bottom - top + 2 * r):
            o = cython.address(scratch[y, 0])
            for x in range(n):
                o[x] = 0.0
            for j in range(2 * r + 1):
                k = line[j]
                e = cython.address(values[top + y, j])
                for x in range(n):
                    o[x] += k * e[x]
        o = cython.address(scratch[bottom - top + 2 * r, 0])
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
                        e = cython.address(scratch[y - top + i, 16 * a])
                        for x in range(n):
                            o[x] += k * e[x]
                else:
                    here = cython.address(guide[y + r, 16 * a + r])
                    for i in range(2 * r + 1):
                        # two at a time: rows of the kernel end in zeros
                        for j in range(0, 2 * r + 1, 2):
                            k = kernel[i, j]
                            m = kernel[i, j + 1]
                            e = cython.address(values[y + i, 16 * a + j])
                            g = cython.address(guide[y + i, 16 * a + j])
                            for x in range(n):
                                v = k * e[x]
                                w = m * e[x + 1]
                                v = v if fabsf(g[x] - here[x]) < step else none
                                w = w if fabsf(g[x + 1] - here[x]) < step else none
                                o[x] += v + w
                here = cython.address(out[y, 16 * a])
                for x in range(n if 16 * b <= columns else columns - 16 * a):
                    here[x] = o[x]
                a = b
