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
    order: cython.longlong[::1], fresh: cython.float[::1], resistance: cython.double[::1],
):
    """Change the width of each stroke, one after the other, to where the squared error is least.

    widths: (n,) in and out, subpixels, between lightest and heaviest. The residual, whose cells are twice as wide and
    high as those of bits, is kept up to date to first order only: what a wider stroke newly covers is taken to be as
    bare as the paper was at first, a subpixel on either side of it.

    fresh: for each point the cells that a subpixel more of width covers newly in the piece that begins there;
    resistance: (n,) what a subpixel more adds to the squared error by itself. Both are reckoned where resistance is
    negative, and left for the next time: they are two thirds of the work and change little with the width.
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
    change: cython.double
    reach: cython.Py_ssize_t = profile.shape[0]
    with cython.nogil:
        for k in range(order.shape[0]):
            i = order[k]
            p0 = first[i]
            n = first[i + 1] - 1 - p0
            if n < 1:
                continue
            if resistance[i] < 0.0:
                resistance[i] = 0.0
                for j in range(p0, p0 + n):
                    dx = points[j + 1, 0] - points[j, 0]
                    dy = points[j + 1, 1] - points[j, 1]
                    x = cell(points[j, 0] + 0.5 * dx)
                    y = cell(points[j, 1] + 0.5 * dy)
                    fresh[j] = 0.0
                    if 0 <= x < columns and 0 <= y < rows:
                        fresh[j] = 0.001953125 * bar(
                            ink_bits, rows, columns, points[j, 0], points[j, 1], points[j + 1, 0], points[j + 1, 1],
                            half_width(widths[i], gain, dx, dy) + 1.0, False, False, False,
                        )  # fmt: skip
                for j in range(p0, p0 + n):
                    resistance[i] += fresh[j] * fresh[j] * profile[0]
                    for x in range(j + 1, p0 + n):
                        dx = points[x, 0] - points[j, 0]
                        dy = points[x, 1] - points[j, 1]
                        d = 0.25 * sqrt(dx * dx + dy * dy)
                        if d >= reach:
                            break
                        resistance[i] += 2.0 * fresh[j] * fresh[x] * profile[cython.cast(cython.Py_ssize_t, d)]
            if resistance[i] < 1e-12:
                continue
            pull = 0.0
            for j in range(p0, p0 + n):
                if fresh[j] > 0.0:
                    x = cell(0.5 * (points[j, 0] + points[j + 1, 0])) >> 1
                    y = cell(0.5 * (points[j, 1] + points[j + 1, 1])) >> 1
                    pull += fresh[j] * residual[y, x]
            change = widths[i] + pull / resistance[i]
            change = lightest[i] if change < lightest[i] else (heaviest[i] if change > heaviest[i] else change)
            change -= widths[i]
            widths[i] += change
            for j in range(n):
                if fresh[p0 + j] > 0.0 and (j & 1 or j == n - 1):
                    d = fresh[p0 + j] + (fresh[p0 + j - 1] if j & 1 else 0.0)
                    d *= change
                    x = cell(0.5 * (points[p0 + j, 0] + points[p0 + j + 1, 0])) >> 1
                    y = cell(0.5 * (points[p0 + j, 1] + points[p0 + j + 1, 1])) >> 1
                    splat(residual, guide, kernel, y, x, cython.cast(cython.float, d), step)
