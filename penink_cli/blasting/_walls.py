# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Compiled loop: where polylines cross walls. Only `walls` imports this module."""

import cython
from cython.cimports.libc.math import fabs, sqrt

COMPILED = cython.compiled


def crossings(
    points: cython.double[:, ::1], first: cython.longlong[::1],
    walls: cython.double[:, ::1], begin: cython.longlong[::1], items: cython.longlong[::1],
    columns: cython.Py_ssize_t, rows: cython.Py_ssize_t, left: cython.double, top: cython.double, cell: cython.double,
    who: cython.longlong[::1], which: cython.longlong[::1],
    where: cython.double[::1], sine: cython.double[::1],
) -> cython.Py_ssize_t:
    """Crossings of polylines with wall segments (m, 4); returns how many there are, also beyond the room for them.

    The walls near a grid cell (row-major, columns × rows cells from left, top) are items[begin[c] : begin[c + 1]],
    and each is in the list of every cell that its bounding box touches. A crossing is told as the polyline, the wall,
    the place on the polyline counted in points, and the sine of the angle.
    """
    n: cython.Py_ssize_t = 0
    room: cython.Py_ssize_t = who.shape[0]
    i: cython.Py_ssize_t
    k: cython.Py_ssize_t
    m: cython.Py_ssize_t
    w: cython.Py_ssize_t
    c0: cython.Py_ssize_t
    c1: cython.Py_ssize_t
    r0: cython.Py_ssize_t
    r1: cython.Py_ssize_t
    c: cython.Py_ssize_t
    r: cython.Py_ssize_t
    px: cython.double
    py: cython.double
    dx: cython.double
    dy: cython.double
    ex: cython.double
    ey: cython.double
    det: cython.double
    s: cython.double
    t: cython.double
    lo: cython.double
    hi: cython.double
    with cython.nogil:
        for i in range(first.shape[0] - 1):
            for k in range(first[i], first[i + 1] - 1):
                px = points[k, 0]
                py = points[k, 1]
                dx = points[k + 1, 0] - px
                dy = points[k + 1, 1] - py
                lo = px if dx > 0.0 else px + dx
                hi = px + dx if dx > 0.0 else px
                if hi < left or lo >= left + columns * cell:
                    continue
                c0 = cython.cast(cython.Py_ssize_t, (lo - left) / cell) if lo > left else 0
                c1 = cython.cast(cython.Py_ssize_t, (hi - left) / cell)
                c1 = columns - 1 if c1 >= columns else c1
                lo = py if dy > 0.0 else py + dy
                hi = py + dy if dy > 0.0 else py
                if hi < top or lo >= top + rows * cell:
                    continue
                r0 = cython.cast(cython.Py_ssize_t, (lo - top) / cell) if lo > top else 0
                r1 = cython.cast(cython.Py_ssize_t, (hi - top) / cell)
                r1 = rows - 1 if r1 >= rows else r1
                for r in range(r0, r1 + 1):
                    for c in range(c0, c1 + 1):
                        for m in range(begin[r * columns + c], begin[r * columns + c + 1]):
                            w = items[m]
                            ex = walls[w, 2] - walls[w, 0]
                            ey = walls[w, 3] - walls[w, 1]
                            det = dx * ey - dy * ex
                            if fabs(det) < 1e-12:
                                continue
                            s = ((walls[w, 0] - px) * ey - (walls[w, 1] - py) * ex) / det
                            t = ((walls[w, 0] - px) * dy - (walls[w, 1] - py) * dx) / det
                            # a wall's ends count, and a crossing on a point of the line belongs to what follows
                            if 0.0 <= s < 1.0 and -1e-9 <= t <= 1.0 + 1e-9:
                                if n < room:
                                    who[n] = i
                                    which[n] = w
                                    where[n] = k - first[i] + s
                                    sine[n] = fabs(det) / sqrt((dx * dx + dy * dy) * (ex * ex + ey * ey))
                                n += 1
    return n
