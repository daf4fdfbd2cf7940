# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: one corner or junction after the other changed until it explains the photo best. See junctions.py.

What it is worth (`python -m tests.benchmarks.worth junctions`), with settling and without: 95 % of edges in rendered
scenes lie within .12 to .31 pixels of the truth, else .12 to .35; .1 to .2 % of their length is false, else .2 to .7 %;
28 of 28 T-junctions close, else 26 to 28. Photographs need 13 to 23 % fewer edges and come back as well (+.1, 0 and
−.2 dB near edges). It takes half to a third of detection's time.

The changes that are tried, each of which must be worth more than it costs:

    merge ╲     ╱    ╲ ╱     join     │      │     drop   •        bend          •       link  •        •
           •───•  →   •          ──•  │ → ───•           ╱ ╲  → ──      ───── → ╱ ╲                 →   │
          ╱     ╲    ╱ ╲              │      │          •   •                  •   •           •        •
"""

from libc.math cimport INFINITY, fabs, floor, fmax, fmin
from penink_cli.ground._compiled.real cimport logarithm
from penink_cli.arrangement._compiled.place cimport MOST_EDGES, NEW, Place
from penink_cli.arrangement._compiled.planar cimport Planar
from penink_cli.arrangement._compiled.view cimport AROUND, VERTEX, View

cdef double _MARGIN = 5.0  # by which a change may look worse at first glance
cdef double _OPTIMISM = 2.0  # times what a bend promises it may give at most
cdef double _TELLS = 6.0  # variances that the photo differs by beside a missing edge
cdef double _EXPLAINED = 0.5  # of what was left over may still be with an edge more
cdef double _STEP = 0.03  # grey that the sides of a missing edge differ by at least
cdef double _FLAT = 4.0  # times the noise: where more is left over, regions are not flat
cdef double _BENT = 2.0  # pixels: shorter edges have no bend
cdef int _ROUNDS = 5  # of Gauss and Newton, to settle
cdef int _GLANCE = 2  # and to tell whether a change is worth it
cdef int _STEPS = 4  # changes one after the other at one place


cdef class Settler(View):
    """Finds what had better be at a place.

    best: what is known to be best, with left_over to explain; chosen, score: the best of the changes to it;
    other: the change that is considered; wanted: the score that it must have to be of interest.
    """

    def __init__(
        self, float[:, ::1] photo, double[::1] taps, double spread, double near, int halo, double least, double unit
    ):
        View.__init__(self, photo, taps, spread, near, halo, least, unit)
        self.best, self.chosen, self.other = Place(), Place(), Place()

    def improve(self, Planar planar, double[::1] step, int[::1] site, int[::1] wider, int around) -> tuple | None:
        """What is at a site, and what had better be there; None where that is the same.

        step: (n,) grey step at each vertex. site: vertices that belong together; wider: those and some more,
        if all of it and the pixels around can be looked at.
        """
        cdef Place given, best
        cdef bint better = False
        with nogil:
            if self.see_site(planar, site, wider, around):
                self.know(planar, step)
                better = self.search()
        if not better:
            return None
        given, best = Place(), Place()
        given.take(self.given)
        best.take(self.best)
        return given, best

    cdef bint search(self) noexcept nogil:
        """From the given place by single changes to the best: whether that is another."""
        cdef double best_score, score
        cdef bint unchanged
        cdef int turn
        self.best.take(self.given)
        self.left_over = self.render(self.best)
        self.trust = fmin(1.0, _FLAT * self.pixels * self.floor / fmax(1e-12, self.left_over))
        best_score = self.settled(self.best, 0, -1, INFINITY)
        if best_score == INFINITY:
            return False
        for turn in range(_STEPS):
            self.score = INFINITY
            self.wanted = INFINITY
            if turn == 0:
                self.other.take(self.best)
                self.consider(_ROUNDS, -1)
            score = self.score
            self.wanted = best_score + _MARGIN
            self.merge()
            self.join()
            self.drop()
            self.link()
            if self.score >= best_score - 1:
                self.bend()
            unchanged = turn == 0 and self.score == score
            if self.score == INFINITY:
                return turn > 0
            if not unchanged:
                self.other.take(self.chosen)
                score = self.settled(self.other, _ROUNDS, -1, INFINITY)
                if score < INFINITY:
                    self.score = score
                    self.chosen.take(self.other)
            if self.score >= best_score - 1:
                return turn > 0
            best_score = self.score
            self.best.take(self.chosen)
        return True

    cdef void consider(self, int rounds, int centre) noexcept nogil:
        """Settle `other`, or only around a vertex, and choose it if it is better than what is chosen."""
        cdef double wanted = fmin(self.score, self.wanted)
        cdef double score = self.settled(self.other, rounds, centre, wanted)
        if score < wanted:
            self.score = score
            self.chosen.take(self.other)

    cdef void merge(self) noexcept nogil:
        """Try short edges as points: where the edges beyond would cross, or at the busier end, or between."""
        cdef int e
        for e in range(self.best.edges):
            if self.within(e) and self.best.apart(self.best.a[e], self.best.b[e]) < self.near:
                self.shrink(self.best.a[e], self.best.b[e])

    cdef bint within(self, int e) noexcept nogil:
        """Whether all of an edge may be moved."""
        return self.best.free[self.best.a[e]] and self.best.free[self.best.b[e]]

    cdef void shrink(self, int a, int b) noexcept nogil:
        """Try the edge from a to b as a point."""
        cdef int busier = self.best.degree[a] - self.best.degree[b]
        cdef double x = 0.0, y = 0.0
        if (
            self.best.degree[a] == 2
            and self.best.degree[b] == 2
            and self.best.meeting(a, b, &x, &y)
            and self.best.from_place(a, x, y) + self.best.from_place(b, x, y) < 3 * self.near
        ):
            self.other.take(self.best)
            self.other.unite(a, b, x, y)
            self.consider(_GLANCE, a)
        x = 0.5 * (self.best.x[a] + self.best.x[b])
        y = 0.5 * (self.best.y[a] + self.best.y[b])
        if busier != 0:
            x = self.best.x[a if busier > 0 else b]
            y = self.best.y[a if busier > 0 else b]
        self.other.take(self.best)
        self.other.unite(a, b, x, y)
        self.consider(_GLANCE, a)

    cdef void join(self) noexcept nogil:
        """Try open ends at the vertices and edges near them."""
        cdef int v, e
        for v in range(self.best.vertices):
            if self.best.free[v] and self.best.degree[v] == 1:
                for e in range(self.best.edges):
                    if self.best.a[e] != v and self.best.b[e] != v:
                        self.meet(v, e)

    cdef void meet(self, int v, int e) noexcept nogil:
        """Try an open end at an edge's nearer vertex, and at the edge."""
        cdef int a = self.best.a[e]
        cdef int b = self.best.b[e]
        cdef double part = self.best.foot(v, e)
        cdef double x = self.best.x[a] + part * (self.best.x[b] - self.best.x[a])
        cdef double y = self.best.y[a] + part * (self.best.y[b] - self.best.y[a])
        cdef int u = a if part < 0.5 else b
        if self.best.from_place(v, x, y) > self.near:
            return
        if self.best.free[u] and self.best.apart(u, v) < self.near:
            self.other.take(self.best)
            self.other.unite(u, v, self.best.x[u], self.best.y[u])
            self.consider(_GLANCE, u)
        if 0 < part < 1 and self.best.edges < MOST_EDGES:
            self.other.take(self.best)
            self.other.x[v] = x
            self.other.y[v] = y
            self.other.split(e, v)
            self.consider(_GLANCE, v)

    cdef void bend(self) noexcept nogil:
        """Try a vertex more in an edge: in its middle, or, where it leads out of view, close to the end in view."""
        cdef int e, a, b
        cdef double length
        for e in range(self.best.edges):
            a = self.best.a[e]
            b = self.best.b[e]
            length = self.best.apart(a, b)
            if self.best.free[a] and self.best.free[b] and length > _BENT:
                self.bow(e, 0.5)
            elif self.best.free[a] and length > 2 * _BENT:
                self.bow(e, fmin(0.5, AROUND / length))
            elif self.best.free[b] and length > 2 * _BENT:
                self.bow(e, 1 - fmin(0.5, AROUND / length))

    cdef void bow(self, int e, double part) noexcept nogil:
        """Try a vertex more at that part of an edge's way."""
        cdef int v
        cdef double gain, rest
        cdef int a = self.best.a[e]
        cdef int b = self.best.b[e]
        if self.best.edges == MOST_EDGES:
            return
        self.left_over = self.render(self.best)
        rest = self.left_over / self.pixels + self.floor
        gain = fmin(self.left_over, _OPTIMISM * self.predicted_gain(self.best, e, part)) / self.pixels
        if self.pixels * logarithm(rest / (rest - gain)) < VERTEX:
            return
        self.other.take(self.best)
        v = self.other.vertex(
            self.best.x[a] + part * (self.best.x[b] - self.best.x[a]),
            self.best.y[a] + part * (self.best.y[b] - self.best.y[a]),
            NEW,
        )
        if v >= 0:
            self.other.free[v] = True
            self.other.split(e, v)
            self.consider(_GLANCE, v)

    cdef void drop(self) noexcept nogil:
        """Try a vertex of two edges less, where both are in view: outside much tells against it."""
        cdef int u, v
        for v in range(self.best.vertices):
            if (
                self.best.free[v]
                and self.best.degree[v] == 2
                and self.best.free[self.best.other(v, -1, 0)]
                and self.best.free[self.best.other(v, -1, 1)]
            ):
                self.other.take(self.best)
                u = self.other.pass_by(v)
                self.consider(_GLANCE, u)

    cdef void link(self) noexcept nogil:
        """Try an edge more between two vertices that are close, where its sides look different and it explains much."""
        cdef double rest
        cdef int u, v
        cdef double wanted = self.wanted
        self.left_over = self.render(self.best)
        rest = self.left_over / self.pixels
        self.wanted += self.pixels * logarithm((_EXPLAINED * rest + self.floor) / (rest + self.floor)) - _MARGIN
        for u in range(self.best.vertices):
            for v in range(u):
                if (
                    self.best.free[u]
                    and self.best.free[v]
                    and self.best.degree[u] > 0
                    and self.best.degree[v] > 0
                    and 1 < self.best.apart(u, v) < self.near
                    and self.best.edges < MOST_EDGES
                    and not self.best.linked(u, v)
                    and not self.best.crosses(u, v)
                    and self.pixels * self.contrast(u, v) > _TELLS * self.left_over
                ):
                    self.other.take(self.best)
                    self.other.edge(u, v, NEW, -1)
                    self.other.count()
                    self.consider(_GLANCE, u)
        self.wanted = wanted

    cdef double contrast(self, int u, int v) noexcept nogil:
        """What an edge from u to v might explain, grey²: by how the photo beside it differs from what is rendered."""
        cdef int k, i, j, side
        cdef double x, y
        cdef double length = self.best.apart(u, v)
        cdef double nx = (self.best.y[u] - self.best.y[v]) / length
        cdef double ny = (self.best.x[v] - self.best.x[u]) / length
        cdef int n = 1 + <int>length
        cdef double total = 0.0
        self.render(self.best)
        for k in range(n):
            for side in range(-1, 2, 2):
                x = self.best.x[u] + (k + 0.5) / n * (self.best.x[v] - self.best.x[u]) + side * nx - self.left
                y = self.best.y[u] + (k + 0.5) / n * (self.best.y[v] - self.best.y[u]) + side * ny - self.top
                i = min(self.last_row - 1, max(self.first_row, <int>floor(y)))
                j = min(self.last_column - 1, max(self.first_column, <int>floor(x)))
                total += side * self.residual[(i - self.first_row) * self.wide + j - self.first_column]
        return total * total / (2 * n) if fabs(total) > _STEP * n else 0.0
