# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Compiled: a place of the arrangement in a window, and what it takes to describe the photo by it. See junctions.py."""

import cython
from cython.cimports.libc.math import INFINITY, ceil, exp, floor, fmax, fmin, log
from cython.cimports.penink_cli.arrangement._place import Place
from cython.cimports.penink_cli.arrangement._planar import Planar
from cython.cimports.penink_cli.arrangement._regions import MOST_MOVED, MOST_SIDE
from cython.cimports.penink_cli.arrangement._window import Window

COMPILED = cython.compiled

_REGION = cython.declare(cython.double, 3.0)  # the logarithm of the pixels that its grey is told by
_BESIDE = cython.declare(cython.double, 0.5)  # pixels outside, where a vertex is still seen
_CROWDED = cython.declare(cython.int, 14)  # edges in a window: no junction, but texture
_BEND = cython.declare(cython.double, 8.0)  # what a radian of turning costs: a bevel turns as far as its corner
_SHARP = cython.declare(cython.double, 1.65)  # radians that the way turns at a thorn
_ARM = cython.declare(cython.double, 0.75)  # of how far blur reaches: a thorn's shorter edge
_LOOSE = cython.declare(cython.double, 0.5)  # by which a vertex stays where it is, in noise² a pixel²
_LINE = cython.declare(cython.double, 0.015)  # of step² a pixel, over the blur: what an edge tells of its end
_TOLD = cython.declare(cython.double, 40.0)  # pixels: longer edges may be curved


@cython.cclass
class View(Window):
    """Sees a place of the arrangement through a window, and tells how well it explains the photo.

    near: how far (pixels) blur may have moved things apart; halo: how far it reaches; floor: least variance of
    what a model leaves unexplained, grey²; unit: pixels; trust: 0 … 1, how much a description's length counts.
    given: the place as it is; pixels: how many are compared; segments: the arrangement's in the window; lines: what is
    known of each: its normal, its offset and the weight of what lies outside. crowded: whether there were too many.
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
        self.given, self.trial = Place(), Place()
        self.trust = 1.0

    def segments_in_view(
        self, planar: Planar, site: cython.int[::1], wider: cython.int[::1], around: cython.int
    ) -> tuple:
        """The segments that a site is told by, none where it is not to be settled, and whether it is crowded."""
        seen: cython.bint = self.see_site(planar, site, wider, around)
        return [self.segments[k] for k in range(self.given.edges)] if seen else [], self.crowded

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def see_site(
        self, planar: Planar, site: cython.int[::1], wider: cython.int[::1], around: cython.int
    ) -> cython.bint:
        """View the wider site, or at least the site."""
        return self.view(planar, wider, around) or self.view(planar, site, AROUND)

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
        named: cython.bint
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
        for v in range(self.given.vertices):  # in the window, halo and all
            x = self.given.x[v]
            y = self.given.y[v]
            self.given.free[v] = (
                fmax(low_x - x, x - high_x) <= self.halo
                and fmax(low_y - y, y - high_y) <= self.halo
                and 0 < x < width
                and 0 < y < height
            )
        # Through blur a speck looks alike with fewer vertices: it stays as it is.
        self.given.find_leading_out()
        for v in range(self.given.vertices):
            x = self.given.x[v]
            y = self.given.y[v]
            self.given.free[v] = self.given.free[v] and low_x <= x <= high_x and low_y <= y <= high_y
            free += self.given.free[v]
        if free > MOST_MOVED:
            free = 0
            for v in range(self.given.vertices):
                named = False
                for k in range(site.shape[0]):
                    named = named or self.given.name[v] == site[k]
                self.given.free[v] = self.given.free[v] and named
                free += self.given.free[v]
        if free == 0 or free > MOST_MOVED:
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
            outside = fmin(length, _TOLD) - AROUND - 1
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
        score = self.trust * VERTEX * vertices
        left_over = self.settle(
            place, self.trial, rounds, self.pixels * (exp((wanted - score) / self.pixels) - self.floor)
        )
        if left_over < 0:
            return INFINITY
        score += self.pixels * log(left_over / self.pixels + self.floor) + self.trust * _REGION * self.regions
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
