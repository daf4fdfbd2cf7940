# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: a few edges in a window, and the changes that may be made to them.

    unite(a, b)              pass_by(v)            split(e, v)             meeting(a, b)

    ╲     ╱     ╲ ╱             v                        v                      ×
     a───b   →   a            ╱   ╲   →  u───w   u──e──w → u─v─w              ╱   ╲     the ways into a and b
    ╱     ╲     ╱ ╲          u     w                                         a─────b    meet at × if they go on
"""

import numpy as np
from libc.math cimport INFINITY, fabs, sqrt
from penink_cli.ground._compiled.real cimport angle_of


cdef class Place:
    """Vertices and edges of the arrangement in a window; a vertex that no edge has is gone.

    x, y: positions in pixels. name: the arrangement's vertex, or NEW. free: whether it may be moved: it and all
    its edges are in view. degree: how many edges meet there, by `count`.
    a, b: vertices of each edge. segment: the arrangement's, or NEW. line: number of what is known of the edge's
    line, or -1.
    """

    def __init__(self, at=(), ends=(), free=()):
        for k, (x, y) in enumerate(at):
            self.vertex(x, y, k)
            self.free[k] = k in free
        for k, (a, b) in enumerate(ends):
            self.edge(a, b, k, -1)
        self.count()

    def at(self):
        """Positions (n, 2) of all vertices, those that are gone included."""
        return np.array([(self.x[v], self.y[v]) for v in range(self.vertices)]).reshape(-1, 2)

    def ends(self):
        """Vertices (m, 2) of the edges."""
        return np.array([(self.a[e], self.b[e]) for e in range(self.edges)]).reshape(-1, 2)

    cdef void take(self, Place other) noexcept nogil:
        """Be like the other."""
        cdef int k
        self.vertices = other.vertices
        self.edges = other.edges
        for k in range(other.vertices):
            self.x[k] = other.x[k]
            self.y[k] = other.y[k]
            self.name[k] = other.name[k]
            self.free[k] = other.free[k]
            self.degree[k] = other.degree[k]
        for k in range(other.edges):
            self.a[k] = other.a[k]
            self.b[k] = other.b[k]
            self.segment[k] = other.segment[k]
            self.line[k] = other.line[k]

    cdef bint looks_like(self, Place other) noexcept nogil:
        """Whether the other has the same edges between the same positions."""
        cdef int k
        if self.vertices != other.vertices or self.edges != other.edges:
            return False
        for k in range(self.vertices):
            if self.x[k] != other.x[k] or self.y[k] != other.y[k]:
                return False
        for k in range(self.edges):
            if self.a[k] != other.a[k] or self.b[k] != other.b[k]:
                return False
        return True

    cdef int vertex(self, double x, double y, int name) noexcept nogil:
        """A vertex more, which is not free: its number; -1 where there is no room."""
        cdef int v = self.vertices
        if v == MOST_VERTICES:
            return -1
        self.x[v] = x
        self.y[v] = y
        self.name[v] = name
        self.free[v] = False
        self.degree[v] = 0
        self.vertices += 1
        return v

    cdef void edge(self, int a, int b, int segment, int line) noexcept nogil:
        """An edge more, for which there must be room."""
        self.a[self.edges] = a
        self.b[self.edges] = b
        self.segment[self.edges] = segment
        self.line[self.edges] = line
        self.edges += 1

    cdef void count(self) noexcept nogil:
        """Find the degrees."""
        cdef int k
        for k in range(self.vertices):
            self.degree[k] = 0
        for k in range(self.edges):
            self.degree[self.a[k]] += 1
            self.degree[self.b[k]] += 1

    cdef double apart(self, int u, int v) noexcept nogil:
        """How far two vertices are from each other, pixels."""
        return self.from_place(v, self.x[u], self.y[u])

    cdef double from_place(self, int v, double x, double y) noexcept nogil:
        """How far a vertex is from x, y, pixels."""
        return sqrt((self.x[v] - x) * (self.x[v] - x) + (self.y[v] - y) * (self.y[v] - y))

    cdef double foot(self, int v, int e) noexcept nogil:
        """The part 0 … 1 of an edge where it is nearest to vertex v."""
        cdef double dx = self.x[self.b[e]] - self.x[self.a[e]]
        cdef double dy = self.y[self.b[e]] - self.y[self.a[e]]
        cdef double part = (self.x[v] - self.x[self.a[e]]) * dx + (self.y[v] - self.y[self.a[e]]) * dy
        return min(1.0, max(0.0, part / max(1e-12, dx * dx + dy * dy)))

    cdef int other(self, int v, int but, int skip) noexcept nogil:
        """The neighbour of v after the first `skip`, not counting one; -1 for none."""
        cdef int e, u
        for e in range(self.edges):
            if self.a[e] == v or self.b[e] == v:
                u = self.a[e] + self.b[e] - v
                if u != but:
                    if skip == 0:
                        return u
                    skip -= 1
        return -1

    cdef bint linked(self, int u, int v) noexcept nogil:
        """Whether there is an edge from u to v."""
        cdef int e
        for e in range(self.edges):
            if (self.a[e] == u and self.b[e] == v) or (self.a[e] == v and self.b[e] == u):
                return True
        return False

    cdef double side(self, int u, int v, int w) noexcept nogil:
        """Positive where w is to the right of the way from u to v on the screen."""
        return (self.x[v] - self.x[u]) * (self.y[w] - self.y[u]) - (self.y[v] - self.y[u]) * (self.x[w] - self.x[u])

    cdef bint crosses(self, int u, int v) noexcept nogil:
        """Whether the straight way from u to v crosses an edge."""
        cdef int e, a, b
        for e in range(self.edges):
            a = self.a[e]
            b = self.b[e]
            if a == u or a == v or b == u or b == v:
                continue
            if self.side(u, v, a) * self.side(u, v, b) <= 0 and self.side(a, b, u) * self.side(a, b, v) <= 0:
                return True
        return False

    cdef void find_leading_out(self) noexcept nogil:
        """Leave free only vertices that hang together with one that is not: the others are of a speck."""
        cdef int e, a, b, v
        cdef bint[MOST_VERTICES] out
        cdef bint more = True
        for v in range(self.vertices):
            out[v] = not self.free[v]
        while more:
            more = False
            for e in range(self.edges):
                a = self.a[e]
                b = self.b[e]
                if out[a] != out[b]:
                    out[a] = out[b] = True
                    more = True
        for v in range(self.vertices):
            self.free[v] = self.free[v] and out[v]

    cdef double turn(self, int v, double* arm) noexcept nogil:
        """How far the way turns at a vertex of two edges, radians, and how long the shorter one (pixels) is.

        An edge that ends at a junction has no end that could be told from it: its length is infinite.
        """
        cdef int u = self.other(v, -1, 0)
        cdef int w = self.other(v, -1, 1)
        cdef double ux = self.x[v] - self.x[u]
        cdef double uy = self.y[v] - self.y[u]
        cdef double wx = self.x[w] - self.x[v]
        cdef double wy = self.y[w] - self.y[v]
        arm[0] = INFINITY
        if self.degree[u] < 3:
            arm[0] = self.apart(u, v)
        if self.degree[w] < 3:
            arm[0] = min(arm[0], self.apart(w, v))
        return fabs(angle_of(ux * wx + uy * wy, ux * wy - uy * wx))

    cdef void unite(self, int a, int b, double x, double y) noexcept nogil:
        """Vertices a and b as one, a, at x, y; of two edges that become one the first stays."""
        cdef int e, k, p, q
        cdef int kept = 0
        for e in range(self.edges):
            p = a if self.a[e] == b else self.a[e]
            q = a if self.b[e] == b else self.b[e]
            if p == q:
                continue
            for k in range(kept):
                if (self.a[k] == p and self.b[k] == q) or (self.a[k] == q and self.b[k] == p):
                    break
            else:
                self.a[kept] = p
                self.b[kept] = q
                self.segment[kept] = self.segment[e]
                self.line[kept] = self.line[e]
                kept += 1
        self.edges = kept
        if self.name[a] == NEW:
            self.name[a] = self.name[b]
        self.x[a] = x
        self.y[a] = y
        self.count()

    cdef int pass_by(self, int v) noexcept nogil:
        """Link the two neighbours of v, which is gone then; one of them."""
        cdef int u = self.other(v, -1, 0)
        cdef double x = self.x[u]
        cdef double y = self.y[u]
        self.unite(u, v, x, y)
        return u

    cdef void split(self, int e, int v) noexcept nogil:
        """Lead an edge through vertex v; what is known of its line stays with the part that leads out of view."""
        cdef int b = self.b[e]
        cdef int line = self.line[e]
        self.b[e] = v
        if line >= 0 and not self.free[b]:
            self.edge(v, b, NEW, line)
            self.line[e] = -1
        else:
            self.edge(v, b, NEW, -1)
        self.count()

    cdef bint meeting(self, int a, int b, double* x, double* y) noexcept nogil:
        """Whether the ways into a and b meet if they go on, and where; each has one edge beside their common one."""
        cdef double s
        cdef int before = self.other(a, b, 0)
        cdef int after = self.other(b, a, 0)
        cdef double ux = self.x[a] - self.x[before]
        cdef double uy = self.y[a] - self.y[before]
        cdef double vx = self.x[b] - self.x[after]
        cdef double vy = self.y[b] - self.y[after]
        cdef double dx = self.x[b] - self.x[a]
        cdef double dy = self.y[b] - self.y[a]
        cdef double across = ux * vy - uy * vx
        if fabs(across) < 0.2 * sqrt((ux * ux + uy * uy) * (vx * vx + vy * vy)):
            return False
        s = (dx * vy - dy * vx) / across
        x[0] = self.x[a] + s * ux
        y[0] = self.y[a] + s * uy
        return s >= 0 and (dx * uy - dy * ux) / across >= 0
