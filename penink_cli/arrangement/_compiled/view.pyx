# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: a place of the arrangement in a window, and what it takes to describe the photo by it. See junctions.py.

    ┌ halo ─────────────┐
    │  ┌ compared ───┐  │          A site's vertices (•) and what lies `around` them are compared with the photo. The
    │  │     •───────┼──┼───○      halo is as wide as blur reaches: the model is rendered there, and nothing is
    │  │    ╱        │  │          compared. Vertices of the inner box may move. An edge may lead out to a vertex that
    │  └───╱─────────┘  │          stays (○). Then its line, by a normal and an offset, holds the end that moves, the
    └─────╱─────────────┘          more the longer the edge goes on outside.
         ○
"""

from libc.math cimport INFINITY, ceil, floor, fmax, fmin
from penink_cli.ground._compiled.real cimport exponential, logarithm
from penink_cli.arrangement._compiled.place cimport Place
from penink_cli.arrangement._compiled.planar cimport Planar
from penink_cli.arrangement._compiled.regions cimport MOST_MOVED, MOST_SIDE
from penink_cli.arrangement._compiled.window cimport Window

cdef double _REGION = 3.0  # the logarithm of the pixels that its grey is told by
cdef double _BESIDE = 0.5  # pixels outside, where a vertex is still seen
cdef int _CROWDED = 14  # edges in a window: no junction, but texture
cdef double _BEND = 8.0  # what a radian of turning costs: a bevel turns as far as its corner
cdef double _SHARP = 1.65  # radians that the way turns at a thorn
cdef double _ARM = 0.75  # of how far blur reaches: a thorn's shorter edge
cdef double _LOOSE = 0.5  # by which a vertex stays where it is, in noise² a pixel²
cdef double _LINE = 0.015  # of step² a pixel, over the blur: what an edge tells of its end
cdef double _TOLD = 40.0  # pixels: longer edges may be curved


cdef class View(Window):
    """Sees a place of the arrangement through a window, and tells how well it explains the photo.

    near: how far (pixels) blur may have moved things apart; halo: how far it reaches; floor: the least variance of
    what a model leaves unexplained, grey²; unit: pixels; trust: 0 … 1, how much a description's length counts.
    given: the place as it is; pixels: how many are compared; segments: the arrangement's in the window; lines: what is
    known of each: its normal, its offset and the weight of what lies outside. crowded: whether there were too many.
    """

    def __init__(
        self, float[:, ::1] photo, double[::1] taps, double spread, double near, int halo, double least, double unit
    ):
        Window.__init__(self, photo, taps, spread)
        self.near, self.halo, self.floor, self.unit = near, halo, least, unit
        self.given, self.trial = Place(), Place()
        self.trust = 1.0

    def segments_in_view(self, Planar planar, int[::1] site, int[::1] wider, int around) -> tuple:
        """The segments that a site is told by, none where it is not to be settled, and whether it is crowded."""
        cdef bint seen = self.see_site(planar, site, wider, around)
        return [self.segments[k] for k in range(self.given.edges)] if seen else [], self.crowded

    cdef bint see_site(self, Planar planar, int[::1] site, int[::1] wider, int around) noexcept nogil:
        """View the wider site, or at least the site."""
        return self.view(planar, wider, around) or self.view(planar, site, AROUND)

    cdef bint view(self, Planar planar, int[::1] site, int around) noexcept nogil:
        """Open the window around a site and gather the given place: whether it is to be settled."""
        cdef int k, v, count
        cdef bint named
        cdef double x, y
        cdef int height = self.photo.shape[0]
        cdef int width = self.photo.shape[1]
        cdef int free = 0
        cdef double low_x = INFINITY
        cdef double low_y = INFINITY
        cdef double high_x = -INFINITY
        cdef double high_y = -INFINITY
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
            <int>low_y - self.halo,
            <int>low_x - self.halo,
            <int>high_y + self.halo,
            <int>high_x + self.halo,
            self.halo,
        )
        return True

    cdef int vertex_of(self, Planar planar, int name) noexcept nogil:
        """The given place's vertex of that name, entered where it is new."""
        cdef int v
        for v in range(self.given.vertices):
            if self.given.name[v] == name:
                return v
        v = self.given.vertex(planar.vertices[name, 0] * self.unit, planar.vertices[name, 1] * self.unit, name)
        return v

    cdef void know(self, Planar planar, double[::1] step) noexcept nogil:
        """Fill in `lines`; an edge that does not lead out of the window tells nothing."""
        cdef int e, v, u
        cdef double length, outside, across, nx, ny
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

    cdef bint hold(self, Place place, int centre) noexcept nogil:
        """Number the vertices to be moved, as `enumerate`, and hold each where it is and on its lines."""
        cdef int v, k, e, end
        cdef double x, y
        cdef double* line
        cdef double* held
        cdef double w = _LOOSE * self.floor
        if not self.enumerate(place, centre):
            return False
        for v in range(place.vertices):
            k = self.number[v]
            if k >= 0:
                x = place.x[v] - self.left
                y = place.y[v] - self.top
                held = &self.prior[k, 0]
                held[0] = held[2] = w
                held[1] = 0.0
                held[3] = w * x
                held[4] = w * y
                held[5] = w * (x * x + y * y)
        for e in range(place.edges):
            if place.line[e] < 0:
                continue
            line = &self.lines[place.line[e]][0]
            for end in range(2):
                k = self.number[place.b[e] if end else place.a[e]]
                if k >= 0:
                    held = &self.prior[k, 0]
                    w = line[3]
                    held[0] += w * line[0] * line[0]
                    held[1] += w * line[0] * line[1]
                    held[2] += w * line[1] * line[1]
                    held[3] += w * line[0] * line[2]
                    held[4] += w * line[1] * line[2]
                    held[5] += w * line[2] * line[2]
        return True

    cdef double settled(self, Place place, int rounds, int centre, double wanted) noexcept nogil:
        """Move the place's vertices to where the photo wants them: its description length up to a constant.

        Infinite where there are too many regions or vertices, where one has left the view or edges cross, or for
        thorns: sharp points of short edges, which blur cannot show. The search for it is given up where it will not
        be as wanted.
        """
        cdef int v
        cdef double left_over, turn, score
        cdef int vertices = 0
        cdef double arm = 0.0
        if not self.hold(place, centre):
            return INFINITY
        for v in range(place.vertices):
            vertices += place.degree[v] > 0
        score = self.trust * VERTEX * vertices
        left_over = self.settle(
            place, self.trial, rounds, self.pixels * (exponential((wanted - score) / self.pixels) - self.floor)
        )
        if left_over < 0:
            return INFINITY
        score += self.pixels * logarithm(left_over / self.pixels + self.floor) + self.trust * _REGION * self.regions
        if rounds > 0:
            for v in range(place.edges):
                if place.crosses(place.a[v], place.b[v]):
                    return INFINITY
        for v in range(place.vertices):
            if self.number[v] >= 0 and not self.in_view(place, v):
                return INFINITY
            if place.degree[v] == 2 and place.free[v]:
                turn = place.turn(v, &arm)
                if rounds > 0 and turn > _SHARP and arm < _ARM * self.near:
                    return INFINITY
                score += _BEND * turn
        return score

    cdef bint in_view(self, Place place, int v) noexcept nogil:
        """Whether a vertex is among the pixels that are compared, or close by."""
        cdef double x = place.x[v] - self.left
        cdef double y = place.y[v] - self.top
        return (
            self.first_column - _BESIDE <= x <= self.last_column + _BESIDE
            and self.first_row - _BESIDE <= y <= self.last_row + _BESIDE
        )
