# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled loop: where polylines cross walls. Only `walls` imports this module.

           wall               A polyline of points 0, 1, 2 … crosses at the place 1.4: four tenths of the way from
            ╲                 point 1 to point 2. The sine is that of the angle α between the two.
    0 ─── 1 ─╳α── 2 ─── 3
              ╲
"""

from libc.math cimport fabs, sqrt


def crossings(
    double[:, ::1] points, long long[::1] first, double[:, ::1] walls, long long[::1] begin, long long[::1] items,
    Py_ssize_t columns, Py_ssize_t rows, double left, double top, double cell, long long[::1] who, long long[::1] which,
    double[::1] where, double[::1] sine,
):
    """Crossings of polylines with wall segments (m, 4); returns how many there are, also beyond the room for them.

    The walls near a grid cell (row-major, columns × rows cells from left, top) are items[begin[c] : begin[c + 1]],
    and each is in the list of every cell that its bounding box touches. A crossing is told as the polyline, the wall,
    the place on the polyline counted in points, and the sine of the angle.
    """
    cdef Py_ssize_t i, k, m, w, c0, c1, r0, r1, c, r
    cdef double px, py, dx, dy, ex, ey, det, s, t, lo, hi
    cdef Py_ssize_t n = 0
    cdef Py_ssize_t room = who.shape[0]
    with nogil:
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
                c0 = <Py_ssize_t>((lo - left) / cell) if lo > left else 0
                c1 = <Py_ssize_t>((hi - left) / cell)
                c1 = columns - 1 if c1 >= columns else c1
                lo = py if dy > 0.0 else py + dy
                hi = py + dy if dy > 0.0 else py
                if hi < top or lo >= top + rows * cell:
                    continue
                r0 = <Py_ssize_t>((lo - top) / cell) if lo > top else 0
                r1 = <Py_ssize_t>((hi - top) / cell)
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
