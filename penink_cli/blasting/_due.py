# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Compiled loops over what is due: low-passing it, and taking new ink from it, without crossing strong steps of tone.

Only `sheet` and the other kernels of this room import this module.
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
    for i in range(top, bottom):
        k = cython.address(kernel[i - y + r, left - x + r])
        g = cython.address(guide[i, left])
        out = cython.address(residual[i, left])
        # a loop of a length known beforehand becomes four vectors; the kernel ends in zeros
        if whole:
            for j in range(16):
                w = ink * k[j]
                out[j] -= w if fabsf(g[j] - here) < step else none
        else:
            for j in range(n):
                w = ink * k[j]
                out[j] -= w if fabsf(g[j] - here) < step else none


def gather(
    error: cython.float[:, ::1], guide: cython.float[:, ::1], kernel: cython.float[:, ::1], step: cython.float,
    out: cython.float[:, ::1], top: cython.Py_ssize_t, bottom: cython.Py_ssize_t,
):
    """out = kernel * error for rows top … bottom, on each cell's own side of any strong step of tone."""
    r: cython.Py_ssize_t = kernel.shape[0] // 2
    y: cython.Py_ssize_t
    x: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    lo: cython.Py_ssize_t
    hi: cython.Py_ssize_t
    w: cython.float
    k: cython.float
    none: cython.float = 0.0
    o: cython.p_float
    e: cython.p_float
    g: cython.p_float
    here: cython.p_float
    with cython.nogil:
        for y in range(top, bottom):
            o = cython.address(out[y, 0])
            here = cython.address(guide[y, 0])
            for x in range(error.shape[1]):
                o[x] = 0.0
            for i in range(-r if y >= r else -y, (r if y + r < error.shape[0] else error.shape[0] - 1 - y) + 1):
                e = cython.address(error[y + i, 0])
                g = cython.address(guide[y + i, 0])
                for j in range(-r, r + 1):
                    k = kernel[i + r, j + r]
                    lo = -j if j < 0 else 0
                    hi = error.shape[1] - j if j > 0 else error.shape[1]
                    for x in range(lo, hi):
                        w = k * e[x + j]
                        o[x] += w if fabsf(g[x + j] - here[x]) < step else none
