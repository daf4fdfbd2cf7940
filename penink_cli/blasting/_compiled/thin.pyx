# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: crest cells followed to lines. Only `thin` imports this module.

    . x . . .        From the strongest cell a line goes on both ways, always to the free cell beside it that lies
    . . S x .        nearest to straight on, and turns slowly with the crest. Cells beside it across the line are the
    . . . . x        same crest, and free no longer.
"""

import numpy as np
from libc.math cimport rint


def follow(
    unsigned char[:, ::1] free, const long long[:, ::1] seeds, const double[:, ::1] nx, const double[:, ::1] ny
) -> list:
    """Lines of cells, (n, 2) each: row and column.

    free: (rows, columns) what is a crest, used up. seeds: (m, 2) its cells, the strongest first. nx, ny: normals.
    """
    cdef Py_ssize_t k, i, side, r, c
    cdef Py_ssize_t[2] count
    cdef long long[:, :, ::1] path = np.empty((2, seeds.shape[0], 2), np.int64)
    cdef long long[:, ::1] line
    lines = []
    for k in range(seeds.shape[0]):
        r, c = seeds[k, 0], seeds[k, 1]
        if not free[r, c]:
            continue
        free[r, c] = False
        for side in range(2):
            count[side] = walk(free, nx, ny, r, c, -1.0 if side else 1.0, path[side])
        found = np.empty((count[1] + 1 + count[0], 2), np.int64)
        line = found
        for i in range(count[1]):
            line[i, 0], line[i, 1] = path[1, count[1] - 1 - i, 0], path[1, count[1] - 1 - i, 1]
        line[count[1], 0], line[count[1], 1] = r, c
        for i in range(count[0]):
            line[count[1] + 1 + i, 0], line[count[1] + 1 + i, 1] = path[0, i, 0], path[0, i, 1]
        lines.append(found)
    return lines


cdef Py_ssize_t walk(
    unsigned char[:, ::1] free, const double[:, ::1] nx, const double[:, ::1] ny, Py_ssize_t r, Py_ssize_t c,
    double sign, long long[:, ::1] path,
) noexcept nogil:
    """Go on from a cell, one way along the crest; how many cells that is."""
    cdef Py_ssize_t n = 0, dr, dc, row, column, next_row, next_column, side
    cdef double dx = -sign * ny[r, c], dy = sign * nx[r, c], tx, ty, ahead, best
    while True:
        best = 0.45
        next_row = -1
        next_column = -1
        for dr in range(-1, 2):
            for dc in range(-1, 2):
                row, column = r + dr, c + dc
                if 0 <= row < free.shape[0] and 0 <= column < free.shape[1] and free[row, column]:
                    ahead = (dc * dx + dr * dy) / (1.4142135623730951 if dr and dc else 1.0)
                    if ahead > best:
                        best, next_row, next_column = ahead, row, column
        if next_row < 0:
            return n
        for side in range(-1, 2, 2):
            row, column = r + side * <Py_ssize_t>rint(ny[r, c]), c + side * <Py_ssize_t>rint(nx[r, c])
            if row == next_row and column == next_column:
                continue
            if 0 <= row < free.shape[0] and 0 <= column < free.shape[1]:
                free[row, column] = False
        r, c = next_row, next_column
        free[r, c] = False
        path[n, 0], path[n, 1] = r, c
        n += 1
        tx, ty = -ny[r, c], nx[r, c]
        if tx * dx + ty * dy < 0:
            tx, ty = -tx, -ty
        dx, dy = 0.5 * dx + 0.5 * tx, 0.5 * dy + 0.5 * ty
