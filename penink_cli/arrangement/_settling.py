# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Compiled: one corner or junction after the other changed until it explains the photo best. See junctions.py."""

import cython
from cython.cimports.libc.math import INFINITY, ceil, exp, floor, fmax, fmin, log
from cython.cimports.penink_cli.arrangement._place import MOST_EDGES, MOST_VERTICES, NEW, Place
from cython.cimports.penink_cli.arrangement._planar import Planar
from cython.cimports.penink_cli.arrangement._regions import MOST_MOVED, MOST_SIDE
from cython.cimports.penink_cli.arrangement._window import Window

COMPILED = cython.compiled

_AROUND = cython.declare(cython.int, 3)  # pixels around the vertices of a place that are compared with the photo
_MARGIN = cython.declare(cython.double, 5.0)  # by which a change may look worse at first glance
_OPTIMISM = cython.declare(cython.double, 2.0)  # times what a bend promises it may give at most
_TELLS = cython.declare(cython.double, 6.0)  # variances that the photo differs by beside a missing edge
_REGION = cython.declare(cython.double, 0.0)  # the logarithm of the pixels that its grey is told by
_BESIDE = cython.declare(cython.double, 0.5)  # pixels outside, where a vertex is still seen
_CROWDED = cython.declare(cython.int, 14)  # edges in a window: no junction, but texture
_BEND = cython.declare(cython.double, 8.0)  # what a radian of turning costs: a bevel turns as far as its corner
_SHARP = cython.declare(cython.double, 1.65)  # radians that the way turns at a thorn
_ARM = cython.declare(cython.double, 0.75)  # of how far blur reaches: a thorn's shorter edge
_BENT = cython.declare(cython.double, 2.0)  # pixels: shorter edges have no bend
_ROUNDS = cython.declare(cython.int, 5)  # of Gauss and Newton, to settle
_GLANCE = cython.declare(cython.int, 2)  # and to tell whether a change is worth it
_STEPS = cython.declare(cython.int, 4)  # changes one after the other at one place
_LOOSE = cython.declare(cython.double, 0.5)  # by which a vertex stays where it is, in noise² a pixel²
_LINE = cython.declare(cython.double, 0.015)  # of step² a pixel, over the blur: what an edge tells of its end
_TOLD = cython.declare(cython.double, 40.0)  # pixels: longer edges may be curved
_VERTEX = cython.declare(cython.double, 1.0)  # the logarithm of the pixels that its two coordinates are told by


@cython.final
@cython.cclass
class Settler(Window):
    """Looks at a place through a window, and finds what had better be there.

    near: how far (pixels) blur may have moved things apart; halo: how far it reaches; floor: least variance of
    what a model leaves unexplained, grey²; unit: pixels. given, best: the place before and after; pixels: how
    many are compared; segments: the arrangement's in the window, lines: what is known of each: its normal, its offset
    and the weight of what lies outside.
    """

    def __init__(
        self,
        photo: cython.float[:, ::1],
        taps: cython.double[::1],
        spread: cython.double,
        near: cython.double,
        halo: cython.int,
        floor: cython.double,
        unit: cython.double,
    ):
        Window.__init__(self, photo, taps, spread)
        self.near, self.halo, self.floor, self.unit = near, halo, floor, unit
        self.given, self.best = Place(), Place()
        self.chosen, self.other, self.trial = Place(), Place(), Place()

    def segments_in_view(
        self, planar: Planar, site: cython.int[::1], wider: cython.int[::1], around: cython.int
    ) -> tuple:
        """The segments that a site is told by, none where it is not to be settled, and whether it is crowded."""
        seen: cython.bint = self.see_site(planar, site, wider, around)
        return [self.segments[k] for k in range(self.given.edges)] if seen else [], self.crowded

    def improve(
        self,
        planar: Planar,
        step: cython.double[::1],
        site: cython.int[::1],
        wider: cython.int[::1],
        around: cython.int,
    ) -> tuple | None:
        """What is at a site, and what had better be there; None where that is the same.

        step: (n,) grey step at each vertex. site: vertices that belong together; wider: those and some more,
        if all of it and the pixels around can be looked at.
        """
        better: cython.bint = False
        given: Place
        best: Place
        with cython.nogil:
            if self.see_site(planar, site, wider, around):
                self.know(planar, step)
                better = self.search()
        if not better:
            return None
        given, best = Place(), Place()
        given.take(self.given)
        best.take(self.best)
        return given, best

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def see_site(self, planar: Planar, site: cython.int[::1], wider: cython.int[::1], around: cython.int) -> cython.bint:
        """View the wider site, or at least the site."""
        v: cython.int
        k: cython.Py_ssize_t
        if not self.view(planar, wider, around) and not self.view(planar, site, _AROUND):
            return False
        for v in range(MOST_VERTICES):
            self.central[v] = v >= self.given.vertices
        for v in range(self.given.vertices):
            for k in range(site.shape[0]):
                if self.given.name[v] == site[k]:
                    self.central[v] = True
        return True

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def view(self, planar: Planar, site: cython.int[::1], around: cython.int) -> cython.bint:
        """Open the window around a site and gather the given place: whether it is to be settled."""
        height: cython.int = self.photo.shape[0]
        width: cython.int = self.photo.shape[1]
        k: cython.int
        v: cython.int
        count: cython.int
        free: cython.int = 0
        x: cython.double
        y: cython.double
        low_x: cython.double = INFINITY
        low_y: cython.double = INFINITY
        high_x: cython.double = -INFINITY
        high_y: cython.double = -INFINITY
        for k in range(site.shape[0]):
            x = planar.vertices[site[k], 0] * self.unit
            y = planar.vertices[site[k], 1] * self.unit
            low_x = fmin(low_x, x)
            low_y = fmin(low_y, y)
            high_x = fmax(high_x, x)
            high_y = fmax(high_y, y)
        low_x = floor(low_x) - around
        low_y = floor(low_y) - around
        high_x = ceil(high_x) + around
        high_y = ceil(high_y) + around
        count = planar.within(
            (low_x - self.halo) / self.unit,
            (low_y - self.halo) / self.unit,
            (high_x + self.halo) / self.unit,
            (high_y + self.halo) / self.unit,
            self.segments,
            _CROWDED,
        )
        self.crowded = count > _CROWDED
        if count == 0 or self.crowded or fmax(high_x - low_x, high_y - low_y) + 2 * self.halo > MOST_SIDE:
            return False
        self.given.vertices = 0
        self.given.edges = 0
        for k in range(count):
            self.given.edge(
                self.vertex_of(planar, planar.ends[self.segments[k], 0]),
                self.vertex_of(planar, planar.ends[self.segments[k], 1]),
                self.segments[k],
                k,
            )
        self.given.count()
        for v in range(self.given.vertices):
            x = self.given.x[v]
            y = self.given.y[v]
            self.given.free[v] = low_x <= x <= high_x and low_y <= y <= high_y and 0 < x < width and 0 < y < height
            free += self.given.free[v]
        if free > MOST_MOVED:
            for v in range(self.given.vertices):
                self.given.free[v] = False
            for k in range(site.shape[0]):
                for v in range(self.given.vertices):
                    if self.given.name[v] == site[k]:
                        self.given.free[v] = True
            if site.shape[0] > MOST_MOVED:
                return False
        if self.given.closed():
            return False
        self.pixels = self.open(
            cython.cast(cython.int, low_y) - self.halo,
            cython.cast(cython.int, low_x) - self.halo,
            cython.cast(cython.int, high_y) + self.halo,
            cython.cast(cython.int, high_x) + self.halo,
            self.halo,
        )
        return True

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def vertex_of(self, planar: Planar, name: cython.int) -> cython.int:
        """The given place's vertex of that name, entered where it is new."""
        v: cython.int
        for v in range(self.given.vertices):
            if self.given.name[v] == name:
                return v
        v = self.given.vertex(planar.vertices[name, 0] * self.unit, planar.vertices[name, 1] * self.unit, name)
        return v

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def know(self, planar: Planar, step: cython.double[::1]) -> cython.void:
        """Fill in `lines`; an edge that does not lead out of the window tells nothing."""
        e: cython.int
        v: cython.int
        u: cython.int
        length: cython.double
        outside: cython.double
        across: cython.double
        nx: cython.double
        ny: cython.double
        for e in range(self.given.edges):
            v = self.given.a[e] if self.given.free[self.given.a[e]] else self.given.b[e]
            u = self.given.a[e] + self.given.b[e] - v
            length = self.given.apart(u, v)
            outside = fmin(length, _TOLD) - _AROUND - 1
            if self.given.free[v] == self.given.free[u] or outside <= 0:
                self.given.line[e] = -1
                continue
            nx = (self.given.y[v] - self.given.y[u]) / length
            ny = (self.given.x[u] - self.given.x[v]) / length
            across = fmax(step[self.given.name[v]], step[self.given.name[u]])
            self.lines[e][0] = nx
            self.lines[e][1] = ny
            self.lines[e][2] = nx * (self.given.x[v] - self.left) + ny * (self.given.y[v] - self.top)
            self.lines[e][3] = _LINE * across * across * outside / self.spread

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def hold(self, place: Place, centre: cython.int) -> cython.bint:
        """Number the vertices to be moved, as `enumerate`, and hold each where it is and on its lines."""
        v: cython.int
        k: cython.int
        e: cython.int
        end: cython.int
        x: cython.double
        y: cython.double
        w: cython.double = _LOOSE * self.floor
        line: cython.p_double
        held: cython.p_double
        if not self.enumerate(place, centre):
            return False
        for v in range(place.vertices):
            k = self.number[v]
            if k >= 0:
                x = place.x[v] - self.left
                y = place.y[v] - self.top
                held = cython.address(self.held[k, 0])
                held[0] = held[2] = w
                held[1] = 0.0
                held[3] = w * x
                held[4] = w * y
                held[5] = w * (x * x + y * y)
        for e in range(place.edges):
            if place.line[e] < 0:
                continue
            line = cython.address(self.lines[place.line[e]][0])
            for end in range(2):
                k = self.number[place.b[e] if end else place.a[e]]
                if k >= 0:
                    held = cython.address(self.held[k, 0])
                    w = line[3]
                    held[0] += w * line[0] * line[0]
                    held[1] += w * line[0] * line[1]
                    held[2] += w * line[1] * line[1]
                    held[3] += w * line[0] * line[2]
                    held[4] += w * line[1] * line[2]
                    held[5] += w * line[2] * line[2]
        return True

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def settled(self, place: Place, rounds: cython.int, centre: cython.int, wanted: cython.double) -> cython.double:
        """Move the place's vertices to where the photo wants them: its description length up to a constant.

        Infinite where there are too many regions or vertices, where one has left the view or edges cross, or for
        thorns: sharp points of short edges, which blur cannot show. The search for it is given up where it will not
        be as wanted.
        """
        vertices: cython.int = 0
        v: cython.int
        left_over: cython.double
        turn: cython.double
        arm: cython.double = 0.0
        score: cython.double
        if not self.hold(place, centre):
            return INFINITY
        for v in range(place.vertices):
            vertices += place.degree[v] > 0
        score = _VERTEX * vertices
        left_over = self.settle(
            place, self.trial, rounds, self.pixels * (exp((wanted - score) / self.pixels) - self.floor)
        )
        if left_over < 0:
            return INFINITY
        score += self.pixels * log(left_over / self.pixels + self.floor) + _REGION * self.regions
        if rounds > 0:
            for v in range(place.edges):
                if place.crosses(place.a[v], place.b[v]):
                    return INFINITY
        for v in range(place.vertices):
            if self.number[v] >= 0 and not self.in_view(place, v):
                return INFINITY
            if place.degree[v] == 2 and place.free[v]:
                turn = place.turn(v, cython.address(arm))
                if rounds > 0 and turn > _SHARP and arm < _ARM * self.near:
                    return INFINITY
                score += _BEND * turn
        return score

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def in_view(self, place: Place, v: cython.int) -> cython.bint:
        """Whether a vertex is among the pixels that are compared, or close by."""
        x: cython.double = place.x[v] - self.left
        y: cython.double = place.y[v] - self.top
        return (
            self.first_column - _BESIDE <= x <= self.last_column + _BESIDE
            and self.first_row - _BESIDE <= y <= self.last_row + _BESIDE
        )

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def search(self) -> cython.bint:
        """From the given place by single changes to the best: whether that is another."""
        best_score: cython.double
        score: cython.double
        unchanged: cython.bint
        turn: cython.int
        self.best.take(self.given)
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

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def consider(self, rounds: cython.int, centre: cython.int) -> cython.void:
        """Settle `other`, or only around a vertex, and choose it if it is better than what is chosen."""
        score: cython.double = self.settled(self.other, rounds, centre, fmin(self.score, self.wanted))
        if score < self.score:
            self.score = score
            self.chosen.take(self.other)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def merge(self) -> cython.void:
        """Try short edges as points: where the edges beyond would cross, or at the busier end, or between."""
        e: cython.int
        for e in range(self.best.edges):
            if (
                self.within(e)
                and self.best.apart(self.best.a[e], self.best.b[e]) < self.near
                and (self.central[self.best.a[e]] or self.central[self.best.b[e]])
            ):
                self.shrink(self.best.a[e], self.best.b[e])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def within(self, e: cython.int) -> cython.bint:
        """Whether all of an edge may be moved."""
        return self.best.free[self.best.a[e]] and self.best.free[self.best.b[e]]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def shrink(self, a: cython.int, b: cython.int) -> cython.void:
        """Try the edge from a to b as a point."""
        busier: cython.int = self.best.degree[a] - self.best.degree[b]
        x: cython.double = 0.0
        y: cython.double = 0.0
        if (
            self.best.degree[a] == 2
            and self.best.degree[b] == 2
            and self.best.meeting(a, b, cython.address(x), cython.address(y))
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

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def join(self) -> cython.void:
        """Try open ends at the vertices and edges near them."""
        v: cython.int
        e: cython.int
        for v in range(self.best.vertices):
            if self.best.free[v] and self.best.degree[v] == 1:
                for e in range(self.best.edges):
                    if self.best.a[e] != v and self.best.b[e] != v:
                        self.meet(v, e)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def meet(self, v: cython.int, e: cython.int) -> cython.void:
        """Try an open end at an edge's nearer vertex, and at the edge."""
        a: cython.int = self.best.a[e]
        b: cython.int = self.best.b[e]
        part: cython.double = self.best.foot(v, e)
        x: cython.double = self.best.x[a] + part * (self.best.x[b] - self.best.x[a])
        y: cython.double = self.best.y[a] + part * (self.best.y[b] - self.best.y[a])
        u: cython.int = a if part < 0.5 else b
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

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def bend(self) -> cython.void:
        """Try a vertex more in an edge: in its middle, or, where it leads out of view, close to the end in view."""
        e: cython.int
        a: cython.int
        b: cython.int
        length: cython.double
        self.left_over = self.look(self.best)
        for e in range(self.best.edges):
            a = self.best.a[e]
            b = self.best.b[e]
            length = self.best.apart(a, b)
            if self.best.free[a] and self.best.free[b] and length > _BENT:
                self.bow(e, 0.5)
            elif self.best.free[a] and length > 2 * _BENT:
                self.bow(e, fmin(0.5, _AROUND / length))
            elif self.best.free[b] and length > 2 * _BENT:
                self.bow(e, 1 - fmin(0.5, _AROUND / length))

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def bow(self, e: cython.int, part: cython.double) -> cython.void:
        """Try a vertex more at that part of an edge's way."""
        a: cython.int = self.best.a[e]
        b: cython.int = self.best.b[e]
        v: cython.int
        gain: cython.double
        rest: cython.double = self.left_over / self.pixels + self.floor
        if self.best.edges == MOST_EDGES:
            return
        gain = fmin(self.left_over, _OPTIMISM * self.promise(self.best, e, part)) / self.pixels
        if self.pixels * log(rest / (rest - gain)) < _VERTEX:
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
            self.look(self.best)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def drop(self) -> cython.void:
        """Try a vertex of two edges less, where both are in view: outside much tells against it."""
        u: cython.int
        v: cython.int
        for v in range(self.best.vertices):
            if (
                self.best.free[v]
                and self.central[v]
                and self.best.degree[v] == 2
                and self.best.free[self.best.other(v, -1, 0)]
                and self.best.free[self.best.other(v, -1, 1)]
            ):
                self.other.take(self.best)
                u = self.other.pass_by(v)
                self.consider(_GLANCE, u)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def link(self) -> cython.void:
        """Try an edge more between two vertices that are close, where the sides of it look different."""
        u: cython.int
        v: cython.int
        self.left_over = self.look(self.best)
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
                    self.look(self.best)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def contrast(self, u: cython.int, v: cython.int) -> cython.double:
        """What an edge from u to v might explain, grey²: by what the photo differs beside it from what is seen."""
        k: cython.int
        i: cython.int
        j: cython.int
        side: cython.int
        x: cython.double
        y: cython.double
        length: cython.double = self.best.apart(u, v)
        nx: cython.double = (self.best.y[u] - self.best.y[v]) / length
        ny: cython.double = (self.best.x[v] - self.best.x[u]) / length
        n: cython.int = 1 + cython.cast(cython.int, length)
        total: cython.double = 0.0
        for k in range(n):
            for side in range(-1, 2, 2):
                x = self.best.x[u] + (k + 0.5) / n * (self.best.x[v] - self.best.x[u]) + side * nx - self.left
                y = self.best.y[u] + (k + 0.5) / n * (self.best.y[v] - self.best.y[u]) + side * ny - self.top
                i = min(self.last_row - 1, max(self.first_row, cython.cast(cython.int, floor(y))))
                j = min(self.last_column - 1, max(self.first_column, cython.cast(cython.int, floor(x))))
                total += side * self.rest[i, j]
        return total * total / (2 * n)
