# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: points along chains of edges, the corners of these, and which places of a sheet are close to ink.

Only `outlines` imports this module.
"""

import numpy as np
from libc.math cimport INFINITY, ceil, floor, sqrt


def resampled(const double[:, ::1] vertices, double step):
    """Points (n, 2) along a polyline, its vertices among them, no further apart than step."""
    cdef Py_ssize_t i, k, count, n = 0, m = vertices.shape[0] - 1
    cdef double dx, dy, part
    cdef double[:, ::1] points
    cdef long long[::1] counts = np.empty(m, np.int64)
    for i in range(m):
        dx, dy = vertices[i + 1, 0] - vertices[i, 0], vertices[i + 1, 1] - vertices[i, 1]
        counts[i] = max(1, <long long>ceil(sqrt(dx * dx + dy * dy) / step))
        n += counts[i]
    found = np.empty((n + 1, 2))
    points = found
    n = 0
    for i in range(m):
        dx, dy = vertices[i + 1, 0] - vertices[i, 0], vertices[i + 1, 1] - vertices[i, 1]
        count = counts[i]
        for k in range(count):
            part = <double>k / count
            points[n, 0], points[n, 1] = vertices[i, 0] + part * dx, vertices[i, 1] + part * dy
            n += 1
    points[n, 0], points[n, 1] = vertices[m, 0], vertices[m, 1]
    return found


def corners(const double[:, ::1] points, bint ring, Py_ssize_t arm, double least) -> list:
    """Points that are corners, in order: of those within an arm of each other the one of the sharpest bend.

    points: (n, 2), the last of a ring being its first. arm: how many points to each side tell of a bend; least: the
    cosine of the gentlest that is a corner.
    """
    cdef Py_ssize_t i, k, before, after, best, n = points.shape[0]
    cdef Py_ssize_t begin = 0 if ring else arm, end = n - 1 if ring else n - arm
    cdef double ax, ay, bx, by, sharpest
    cdef double[::1] cosine
    if n < 2 * arm + 1:
        return []
    cosine = np.full(n, INFINITY)
    for i in range(begin, end):
        before, after = i - arm, i + arm
        if before < 0:
            before += n - 1
        if after >= n:
            after -= n - 1
        bx, by = points[i, 0] - points[before, 0], points[i, 1] - points[before, 1]
        ax, ay = points[after, 0] - points[i, 0], points[after, 1] - points[i, 1]
        cosine[i] = (bx * ax + by * ay) / max(sqrt((bx * bx + by * by) * (ax * ax + ay * ay)), 1e-12)
    found = []
    while True:
        best, sharpest = -1, least
        for i in range(begin, end):
            if cosine[i] < sharpest:
                best, sharpest = i, cosine[i]
        if best < 0:
            return sorted(found)
        found.append(best)
        for k in range(max(begin, best - arm), min(end, best + arm + 1)):
            cosine[k] = INFINITY


cdef inline Py_ssize_t _cell(double place, double side, Py_ssize_t count) noexcept nogil:
    """The row or column of cells that a place is in, of which there are three more before it and after the last."""
    cdef double at = floor(place / side) + 3
    return 2 if at < 2 else (count - 3 if at > count - 3 else <Py_ssize_t>at)


def take(const double[:, ::1] points, double side, unsigned char[:, ::1] taken) -> None:
    """Mark the cells within two of those that points (n, 2) are in, in a disc: all but the corners of a square of 5."""
    cdef Py_ssize_t i, row, column, y, x, wide
    for i in range(points.shape[0]):
        row = _cell(points[i, 1], side, taken.shape[0])
        column = _cell(points[i, 0], side, taken.shape[1])
        for y in range(-2, 3):
            wide = 1 if y == -2 or y == 2 else 2
            for x in range(-wide, wide + 1):
                taken[row + y, column + x] = True


def free(const double[:, ::1] points, double side, const unsigned char[:, ::1] taken, unsigned char[::1] out) -> bool:
    """Which of the points (n, 2) are in cells that are not marked; whether all are."""
    cdef Py_ssize_t i
    cdef bint every = True
    for i in range(points.shape[0]):
        out[i] = not taken[_cell(points[i, 1], side, taken.shape[0]), _cell(points[i, 0], side, taken.shape[1])]
        every &= out[i]
    return every
