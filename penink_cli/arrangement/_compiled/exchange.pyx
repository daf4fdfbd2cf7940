# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: where an arrangement may be looked at again, and a place in it exchanged for a better one.

    old   │         new   │         Segments of the old place that the new one lacks or moves are taken out and
       ───•  •───      ───•───      vertices are moved. Then the new place's segments are put in, one after the other.
          │               │         Each must fit: none may cross what is there. If one does not, all is put back as it
                                    was.
"""

import numpy as np
from libc.math cimport floor
from penink_cli.arrangement._compiled.place cimport Place
from penink_cli.arrangement._compiled.planar cimport Planar


def beside(Planar planar, int[::1] vertices, double near, unsigned char[::1] found) -> None:
    """Fill found (n,): whether an edge that is not its own comes within near (units) of each vertex."""
    cdef Py_ssize_t k
    cdef int v, e, s, count
    cdef double x, y, dx, dy, px, py, part
    cdef int[65] segments
    for k in range(vertices.shape[0]):
        v = vertices[k]
        x = planar.vertices[v, 0]
        y = planar.vertices[v, 1]
        found[k] = 0
        count = planar.within(x - near, y - near, x + near, y + near, segments, 64)
        for e in range(min(count, 64)):
            s = segments[e]
            if planar.ends[s, 0] == v or planar.ends[s, 1] == v:
                continue
            px = x - planar.vertices[planar.ends[s, 0], 0]
            py = y - planar.vertices[planar.ends[s, 0], 1]
            dx = planar.vertices[planar.ends[s, 1], 0] - planar.vertices[planar.ends[s, 0], 0]
            dy = planar.vertices[planar.ends[s, 1], 1] - planar.vertices[planar.ends[s, 0], 1]
            part = min(1.0, max(0.0, (px * dx + py * dy) / (dx * dx + dy * dy)))
            px -= part * dx
            py -= part * dy
            if px * px + py * py < near * near:
                found[k] = 1
                break


def cluster(double[:, ::1] at, double near, int[::1] group) -> None:
    """Fill group (n,): the first of the places (n, 2) that each hangs together with, by steps shorter than near."""
    cdef int k, other, i, j, a, b
    cdef double dx, dy
    cdef Py_ssize_t n = at.shape[0]
    if n == 0:
        return
    cdef int[:, ::1] cells = np.floor(np.asarray(at) / near).astype(np.int32)
    cdef int[:, ::1] head = np.full(np.max(cells, axis=0) + 3, -1, np.int32)
    cdef int[::1] following = np.full(n, -1, np.int32)
    for k in range(n):
        group[k] = k
        for i in range(cells[k, 0], cells[k, 0] + 3):  # a cell of room on each side
            for j in range(cells[k, 1], cells[k, 1] + 3):
                other = head[i, j]
                while other >= 0:
                    dx = at[other, 0] - at[k, 0]
                    dy = at[other, 1] - at[k, 1]
                    if dx * dx + dy * dy < near * near:
                        a = k
                        while group[a] != a:
                            a = group[a]
                        b = other
                        while group[b] != b:
                            b = group[b]
                        group[max(a, b)] = min(a, b)
                    other = following[other]
        following[k] = head[cells[k, 0] + 1, cells[k, 1] + 1]
        head[cells[k, 0] + 1, cells[k, 1] + 1] = k
    for k in range(n):
        group[k] = group[group[k]]


cdef class Exchange:
    """Exchanges places of one arrangement.

    segments, vertices: those not in use, of which the first `segment` and `vertex` have been taken. unit: pixels.
    """

    cdef Planar planar
    cdef int[::1] segments
    cdef int[::1] vertices
    cdef Py_ssize_t segment
    cdef Py_ssize_t vertex
    cdef double unit
    cdef double right
    cdef double bottom

    def __init__(self, Planar planar, int[::1] segments, int[::1] vertices, double unit, double right, double bottom):
        self.planar, self.segments, self.vertices = planar, segments, vertices
        self.segment = self.vertex = 0
        self.unit, self.right, self.bottom = unit, right, bottom

    def exchange(self, Place old, Place new) -> list:
        """Put the new place where the old one is, if that is there still and the new one fits: the vertices moved.

        Vertices and edges of both stand in the same order; new ones have no name, or no segment.
        """
        cdef int k, e, s, v, placed
        cdef Planar planar = self.planar
        cdef Py_ssize_t segment = self.segment
        cdef Py_ssize_t vertex = self.vertex
        if not self._there(old):
            return []
        for v in range(new.vertices):
            if new.name[v] < 0 and new.degree[v] > 0:
                if vertex == self.vertices.shape[0]:
                    return []
                new.name[v] = self.vertices[vertex]
                vertex += 1
        moved = [
            v
            for v in range(new.vertices)
            if new.degree[v] > 0 and (v >= old.vertices or new.x[v] != old.x[v] or new.y[v] != old.y[v])
        ]
        at = {}
        for k in range(old.edges):
            at[old.segment[k]] = k
        touched, stays = [], set()
        for e in range(new.edges):
            s = new.segment[e]
            if s >= 0:
                k = at[s]
                if old.a[k] == new.a[e] and old.b[k] == new.b[e] and new.a[e] not in moved and new.b[e] not in moved:
                    stays.add(s)
                    continue
            else:
                if segment == self.segments.shape[0]:
                    return []
                new.segment[e] = self.segments[segment]
                segment += 1
            touched.append(e)
        removed = [s for s in at if s not in stays]
        if not removed and not touched:
            return []
        spots = [(planar.vertices[new.name[v], 0], planar.vertices[new.name[v], 1]) for v in moved]
        for s in removed:
            planar.remove(s)
        for v in moved:
            planar.vertices[new.name[v], 0] = <long long>min(self.right, max(1.0, floor(new.x[v] / self.unit + 0.5)))
            planar.vertices[new.name[v], 1] = <long long>min(self.bottom, max(1.0, floor(new.y[v] / self.unit + 0.5)))
        planar.ignore_none()
        placed = 0
        for e in touched:
            if not planar.fits(new.name[new.a[e]], new.name[new.b[e]]):
                break
            planar.ends[new.segment[e], 0] = new.name[new.a[e]]
            planar.ends[new.segment[e], 1] = new.name[new.b[e]]
            planar.add(new.segment[e])
            placed += 1
        else:
            self.segment, self.vertex = segment, vertex
            return [new.name[v] for v in moved]
        for e in touched[:placed]:
            planar.remove(new.segment[e])
        for v, (x, y) in zip(moved, spots):
            planar.vertices[new.name[v], 0] = x
            planar.vertices[new.name[v], 1] = y
        for s in removed:
            k = at[s]
            planar.ends[s, 0] = old.name[old.a[k]]
            planar.ends[s, 1] = old.name[old.b[k]]
            planar.add(s)
        return []

    cdef bint _there(self, Place old):
        """Whether the arrangement has that place."""
        cdef int k
        for k in range(old.edges):
            if not self.planar.live[old.segment[k]]:
                return False
            if self.planar.ends[old.segment[k], 0] != old.name[old.a[k]]:
                return False
            if self.planar.ends[old.segment[k], 1] != old.name[old.b[k]]:
                return False
        for k in range(old.vertices):
            if old.x[k] != self.planar.vertices[old.name[k], 0] * self.unit:
                return False
            if old.y[k] != self.planar.vertices[old.name[k], 1] * self.unit:
                return False
        return True
