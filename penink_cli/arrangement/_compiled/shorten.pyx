# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: an arrangement's paths as few long segments. See simplification.py.

            m                  A run of a path from a to b becomes the segment a–b where no vertex lies farther
         ·  ·  ·               from that than the tolerance, and where no other segment is in its way. Else it is
      ·           ·            divided at m, the vertex farthest away, and both parts are tried.
    a ─ ─ ─ ─ ─ ─ ─ ─ b

Coordinates are whole units of the grid (`arrangement.planar.UNIT`).
"""

from libc.math cimport floor, sqrt
from penink_cli.arrangement._compiled.planar cimport Planar


def shorten(
    Planar planar, int[::1] path, int[::1] segment, double tolerance, int[:, ::1] stack, unsigned char[::1] kept
) -> None:
    """Replace runs of a path by single segments wherever these stay within tolerance and fit.

    Douglas and Peucker's division, where a run is also divided at its farthest vertex if its
    shortcut would touch another segment, down to the path's own segments, which are live already.

    path: (n,) vertices; segment: (n − 1,) the live segment from each vertex to the next; the
    first segment of a run becomes its shortcut. kept: (n,) filled, 1 where a vertex stays.
    stack: (n, 2) room to work in. tolerance: in the grid's units.
    """
    cdef int first, last, middle, k
    cdef double ax, ay, dx, dy, px, py, length, along, deviation, worst
    cdef Py_ssize_t depth = 1
    stack[0, 0] = 0
    stack[0, 1] = path.shape[0] - 1
    kept[0] = kept[path.shape[0] - 1] = 1
    while depth > 0:
        depth -= 1
        first = stack[depth, 0]
        last = stack[depth, 1]
        if last - first < 2:
            continue
        ax = planar.vertices[path[first], 0]
        ay = planar.vertices[path[first], 1]
        dx = planar.vertices[path[last], 0] - ax
        dy = planar.vertices[path[last], 1] - ay
        length = dx * dx + dy * dy
        worst = -1
        middle = (first + last) // 2
        for k in range(first + 1, last):
            px = planar.vertices[path[k], 0] - ax
            py = planar.vertices[path[k], 1] - ay
            along = (px * dx + py * dy) / length if length > 0 else 0.0
            along = min(1.0, max(0.0, along))
            px -= along * dx
            py -= along * dy
            deviation = px * px + py * py
            if deviation > worst:
                worst = deviation
                middle = k
        if worst <= tolerance * tolerance:
            planar.ignore_none()
            for k in range(first, last):
                planar.ignore(segment[k])
            if planar.fits(path[first], path[last]):
                for k in range(first, last):
                    planar.remove(segment[k])
                planar.ends[segment[first], 0] = path[first]
                planar.ends[segment[first], 1] = path[last]
                planar.add(segment[first])
                planar.ignore_none()
                continue
            planar.ignore_none()
        kept[middle] = 1
        stack[depth, 0] = first
        stack[depth, 1] = middle
        stack[depth + 1, 0] = middle
        stack[depth + 1, 1] = last
        depth += 2


cdef bint _move(Planar planar, int vertex, int[::1] around, int first, int last, long long x, long long y) noexcept:
    """Move a vertex to (x, y) if all its segments, around[first : last], still fit there."""
    cdef int k, added, s
    cdef long long old_x = planar.vertices[vertex, 0]
    cdef long long old_y = planar.vertices[vertex, 1]
    for k in range(first, last):
        planar.remove(around[k])
    planar.vertices[vertex, 0] = x
    planar.vertices[vertex, 1] = y
    for added in range(first, last):
        s = around[added]
        if planar.fits(planar.ends[s, 0], planar.ends[s, 1]):
            planar.add(s)
            continue
        for k in range(first, added):
            planar.remove(around[k])
        planar.vertices[vertex, 0] = old_x
        planar.vertices[vertex, 1] = old_y
        for k in range(first, last):
            planar.add(around[k])
        return False
    return True


def settle(
    Planar planar, int[::1] movable, int[::1] around_first, int[::1] around, int[::1] run_first, int[::1] run_last,
    double[:, ::1] places, double furthest, long long width, long long height, int sweeps,
) -> None:
    """Move vertices to where the segments around them fit the points they stand for best.

    Each in turn goes to its own least-squares optimum with its neighbours held (Gauss-Seidel),
    at most `furthest` from where it started, within the frame (width × height units), and only
    where its segments still fit.

    movable: vertices; those segments are around[around_first[v] : around_first[v + 1]]; segment s
    stands for the points places[run_first[s] : run_last[s] + 1], in units.
    """
    cdef Py_ssize_t m
    cdef int k, r, v, s, other
    cdef double vx, vy, qx, qy, dx, dy, t, length, weight, sum_x, sum_y
    cdef long long x, y
    cdef long long[:, ::1] start = planar.vertices.copy()
    for _ in range(sweeps):
        for m in range(movable.shape[0]):
            v = movable[m]
            vx = planar.vertices[v, 0]
            vy = planar.vertices[v, 1]
            weight = 0.05  # holds what no point pulls
            sum_x = weight * vx
            sum_y = weight * vy
            for k in range(around_first[v], around_first[v + 1]):
                s = around[k]
                other = planar.ends[s, 0] + planar.ends[s, 1] - v
                qx = planar.vertices[other, 0]
                qy = planar.vertices[other, 1]
                dx = qx - vx
                dy = qy - vy
                length = dx * dx + dy * dy
                for r in range(run_first[s], run_last[s] + 1):
                    t = ((places[r, 0] - vx) * dx + (places[r, 1] - vy) * dy) / length
                    if t < 0 or t > 1:
                        continue
                    weight += (1 - t) * (1 - t)
                    sum_x += (1 - t) * (places[r, 0] - t * qx)
                    sum_y += (1 - t) * (places[r, 1] - t * qy)
            vx = sum_x / weight - start[v, 0]
            vy = sum_y / weight - start[v, 1]
            length = vx * vx + vy * vy
            if length > furthest * furthest:
                t = furthest / sqrt(length)
                vx *= t
                vy *= t
            x = start[v, 0] + <long long>floor(vx + 0.5)
            y = start[v, 1] + <long long>floor(vy + 0.5)
            x = min(width - 1, max(1, x))
            y = min(height - 1, max(1, y))
            if x != planar.vertices[v, 0] or y != planar.vertices[v, 1]:
                _move(planar, v, around, around_first[v], around_first[v + 1], x, y)
