# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Compiled loop over the pressure of the hand: how wide each stroke is to be. Only `sheet` imports this module."""

import cython
from cython.cimports.libc.math import sqrt
from cython.cimports.penink_cli.blasting._due import splat
from cython.cimports.penink_cli.blasting._ink import bar, cell, half_width

COMPILED = cython.compiled


def press(
    bits: cython.ulonglong[:, :, ::1], columns: cython.Py_ssize_t, gain: cython.double,
    residual: cython.float[:, ::1], guide: cython.float[:, ::1], kernel: cython.float[:, ::1], step: cython.float,
    profile: cython.double[::1],
    points: cython.double[:, ::1], first: cython.longlong[::1], widths: cython.double[::1],
    lightest: cython.double[::1], heaviest: cython.double[::1],
    order: cython.longlong[::1], scratch: cython.double[:, ::1],
):
    """Change the width of each stroke, one after the other, to where the squared error is least.

    widths: (n,) in and out, subpixels, between lightest and heaviest. The residual, whose cells are twice as wide and
    high as those of counts, is kept up to date to first order only: what a wider stroke newly covers is taken to be as
    bare as the paper is now, a subpixel on either side of it.
    """
    ink_bits: cython.p_ulonglong = cython.address(bits[0, 0, 0])
    rows: cython.Py_ssize_t = bits.shape[0]
    k: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    n: cython.Py_ssize_t
    p0: cython.Py_ssize_t
    x: cython.Py_ssize_t
    y: cython.Py_ssize_t
    dx: cython.double
    dy: cython.double
    d: cython.double
    pull: cython.double
    resistance: cython.double
    change: cython.double
    reach: cython.Py_ssize_t = profile.shape[0]
    # cells that a subpixel more of width covers newly, by piece; and where the piece is
    fresh = scratch[0]
    mx = scratch[1]
    my = scratch[2]
    with cython.nogil:
        for k in range(order.shape[0]):
            i = order[k]
            p0 = first[i]
            n = first[i + 1] - 1 - p0
            if n < 1:
                continue
            pull = 0.0
            resistance = 0.0
            for j in range(n):
                dx = points[p0 + j + 1, 0] - points[p0 + j, 0]
                dy = points[p0 + j + 1, 1] - points[p0 + j, 1]
                mx[j] = points[p0 + j, 0] + 0.5 * dx
                my[j] = points[p0 + j, 1] + 0.5 * dy
                x = cell(mx[j])
                y = cell(my[j])
                if x < 0 or y < 0 or x >= columns or y >= rows:
                    fresh[j] = 0.0
                    continue
                fresh[j] = 0.001953125 * bar(
                    ink_bits, rows, columns,
                    points[p0 + j, 0], points[p0 + j, 1], points[p0 + j + 1, 0], points[p0 + j + 1, 1],
                    half_width(widths[i], gain, dx, dy) + 1.0, False, False, False,
                )  # fmt: skip
                x >>= 1
                y >>= 1
                pull += fresh[j] * residual[y, x]
            for j in range(n):
                resistance += fresh[j] * fresh[j] * profile[0]
                for x in range(j + 1, n):
                    dx = mx[x] - mx[j]
                    dy = my[x] - my[j]
                    d = 0.25 * sqrt(dx * dx + dy * dy)
                    if d >= reach:
                        break
                    resistance += 2.0 * fresh[j] * fresh[x] * profile[cython.cast(cython.Py_ssize_t, d)]
            if resistance < 1e-12:
                continue
            change = widths[i] + pull / resistance
            change = lightest[i] if change < lightest[i] else (heaviest[i] if change > heaviest[i] else change)
            change -= widths[i]
            widths[i] += change
            for j in range(n):
                if fresh[j] > 0.0 and (j & 1 or j == n - 1):
                    d = fresh[j] + (fresh[j - 1] if j & 1 else 0.0)
                    d *= change
                    x = cell(mx[j]) >> 1
                    y = cell(my[j]) >> 1
                    splat(residual, guide, kernel, y, x, cython.cast(cython.float, d), step)
