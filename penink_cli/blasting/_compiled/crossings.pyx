# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled loop: where polylines cross walls. Only `walls` imports this module.

           wall               A polyline of points 0, 1, 2 … crosses at the place 1.4: four tenths of the way from
            ╲                 point 1 to point 2. The sine is that of the angle α between the two.
    0 ─── 1 ─╳α── 2 ─── 3
              ╲
"""

from libc.math cimport fabs, sqrt


def crossings(
    double[:, ::1] points, long long[::1] first, lines, double cell, long long[::1] who, long long[::1] which,
    double[::1] where, double[::1] sine,
) -> int:
    """Crossings of polylines with the segments of `walls.Walls`; returns how many there are, also beyond the room.

    A crossing is told as the polyline, the wall, the place on the polyline counted in points, and the sine of the
    angle. cell: width and height of the cells that the segments are listed by.
    """
    cdef double[:, ::1] walls = lines.segments
    cdef long long[::1] begin = lines.begin, items = lines.items
    cdef Py_ssize_t columns = lines.columns, rows = lines.rows
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
                if hi < 0.0 or lo >= columns * cell:
                    continue
                c0 = <Py_ssize_t>(lo / cell) if lo > 0.0 else 0
                c1 = <Py_ssize_t>(hi / cell)
                c1 = columns - 1 if c1 >= columns else c1
                lo = py if dy > 0.0 else py + dy
                hi = py + dy if dy > 0.0 else py
                if hi < 0.0 or lo >= rows * cell:
                    continue
                r0 = <Py_ssize_t>(lo / cell) if lo > 0.0 else 0
                r1 = <Py_ssize_t>(hi / cell)
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
