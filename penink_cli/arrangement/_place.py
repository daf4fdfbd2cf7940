# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Compiled: a few edges in a window, and the changes that may be made to them."""

import cython
import numpy as np
from cython.cimports.libc.math import INFINITY, atan2, fabs, sqrt

COMPILED = cython.compiled


@cython.final
@cython.cclass
class Place:
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

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def take(self, other: Place) -> cython.void:
        """Be like the other."""
        k: cython.int
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

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def vertex(self, x: cython.double, y: cython.double, name: cython.int) -> cython.int:
        """A vertex more, which is not free: its number; -1 where there is no room."""
        v: cython.int = self.vertices
        if v == MOST_VERTICES:
            return -1
        self.x[v] = x
        self.y[v] = y
        self.name[v] = name
        self.free[v] = False
        self.degree[v] = 0
        self.vertices += 1
        return v

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def edge(self, a: cython.int, b: cython.int, segment: cython.int, line: cython.int) -> cython.void:
        """An edge more, for which there must be room."""
        self.a[self.edges] = a
        self.b[self.edges] = b
        self.segment[self.edges] = segment
        self.line[self.edges] = line
        self.edges += 1

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def count(self) -> cython.void:
        """Find the degrees."""
        k: cython.int
        for k in range(self.vertices):
            self.degree[k] = 0
        for k in range(self.edges):
            self.degree[self.a[k]] += 1
            self.degree[self.b[k]] += 1

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def apart(self, u: cython.int, v: cython.int) -> cython.double:
        """How far two vertices are from each other, pixels."""
        return self.from_place(v, self.x[u], self.y[u])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def from_place(self, v: cython.int, x: cython.double, y: cython.double) -> cython.double:
        """How far a vertex is from x, y, pixels."""
        return sqrt((self.x[v] - x) * (self.x[v] - x) + (self.y[v] - y) * (self.y[v] - y))

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def foot(self, v: cython.int, e: cython.int) -> cython.double:
        """The part 0 … 1 of an edge where it is nearest to vertex v."""
        dx: cython.double = self.x[self.b[e]] - self.x[self.a[e]]
        dy: cython.double = self.y[self.b[e]] - self.y[self.a[e]]
        part: cython.double = (self.x[v] - self.x[self.a[e]]) * dx + (self.y[v] - self.y[self.a[e]]) * dy
        return min(1.0, max(0.0, part / max(1e-12, dx * dx + dy * dy)))

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def other(self, v: cython.int, but: cython.int, skip: cython.int) -> cython.int:
        """The neighbour of v after the first `skip`, not counting one; -1 for none."""
        e: cython.int
        u: cython.int
        for e in range(self.edges):
            if self.a[e] == v or self.b[e] == v:
                u = self.a[e] + self.b[e] - v
                if u != but:
                    if skip == 0:
                        return u
                    skip -= 1
        return -1

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def linked(self, u: cython.int, v: cython.int) -> cython.bint:
        """Whether there is an edge from u to v."""
        e: cython.int
        for e in range(self.edges):
            if (self.a[e] == u and self.b[e] == v) or (self.a[e] == v and self.b[e] == u):
                return True
        return False

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def side(self, u: cython.int, v: cython.int, w: cython.int) -> cython.double:
        """Positive where w is to the right of the way from u to v on the screen."""
        return (self.x[v] - self.x[u]) * (self.y[w] - self.y[u]) - (self.y[v] - self.y[u]) * (self.x[w] - self.x[u])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def crosses(self, u: cython.int, v: cython.int) -> cython.bint:
        """Whether the straight way from u to v crosses an edge."""
        e: cython.int
        a: cython.int
        b: cython.int
        for e in range(self.edges):
            a = self.a[e]
            b = self.b[e]
            if a == u or a == v or b == u or b == v:
                continue
            if self.side(u, v, a) * self.side(u, v, b) <= 0 and self.side(a, b, u) * self.side(a, b, v) <= 0:
                return True
        return False

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def find_leading_out(self) -> cython.void:
        """Leave free only vertices that hang together with one that is not: the others are of a speck."""
        e: cython.int
        a: cython.int
        b: cython.int
        v: cython.int
        more: cython.bint = True
        out = cython.declare(cython.bint[MOST_VERTICES])
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

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def turn(self, v: cython.int, arm: cython.p_double) -> cython.double:
        """How far the way turns at a vertex of two edges, radians, and how long the shorter one (pixels) is.

        An edge that ends at a junction has no end that could be told from it: its length is infinite.
        """
        u: cython.int = self.other(v, -1, 0)
        w: cython.int = self.other(v, -1, 1)
        ux: cython.double = self.x[v] - self.x[u]
        uy: cython.double = self.y[v] - self.y[u]
        wx: cython.double = self.x[w] - self.x[v]
        wy: cython.double = self.y[w] - self.y[v]
        arm[0] = INFINITY
        if self.degree[u] < 3:
            arm[0] = self.apart(u, v)
        if self.degree[w] < 3:
            arm[0] = min(arm[0], self.apart(w, v))
        return fabs(atan2(ux * wy - uy * wx, ux * wx + uy * wy))

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def unite(self, a: cython.int, b: cython.int, x: cython.double, y: cython.double) -> cython.void:
        """Vertices a and b as one, a, at x, y; of two edges that become one the first stays."""
        e: cython.int
        k: cython.int
        p: cython.int
        q: cython.int
        kept: cython.int = 0
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

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def pass_by(self, v: cython.int) -> cython.int:
        """Link the two neighbours of v, which is gone then; one of them."""
        u: cython.int = self.other(v, -1, 0)
        x: cython.double = self.x[u]
        y: cython.double = self.y[u]
        self.unite(u, v, x, y)
        return u

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def split(self, e: cython.int, v: cython.int) -> cython.void:
        """Lead an edge through vertex v; what is known of its line stays with the part that leads out of view."""
        b: cython.int = self.b[e]
        line: cython.int = self.line[e]
        self.b[e] = v
        if line >= 0 and not self.free[b]:
            self.edge(v, b, NEW, line)
            self.line[e] = -1
        else:
            self.edge(v, b, NEW, -1)
        self.count()

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def meeting(self, a: cython.int, b: cython.int, x: cython.p_double, y: cython.p_double) -> cython.bint:
        """Whether the ways into a and b meet if they go on, and where; each has one edge beside their common one."""
        before: cython.int = self.other(a, b, 0)
        after: cython.int = self.other(b, a, 0)
        ux: cython.double = self.x[a] - self.x[before]
        uy: cython.double = self.y[a] - self.y[before]
        vx: cython.double = self.x[b] - self.x[after]
        vy: cython.double = self.y[b] - self.y[after]
        dx: cython.double = self.x[b] - self.x[a]
        dy: cython.double = self.y[b] - self.y[a]
        across: cython.double = ux * vy - uy * vx
        s: cython.double
        if fabs(across) < 0.2 * sqrt((ux * ux + uy * uy) * (vx * vx + vy * vy)):
            return False
        s = (dx * vy - dy * vx) / across
        x[0] = self.x[a] + s * ux
        y[0] = self.y[a] + s * uy
        return s >= 0 and (dx * uy - dy * ux) / across >= 0
