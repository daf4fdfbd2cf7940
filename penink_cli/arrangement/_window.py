# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Compiled: what a few edges would look like through the camera, and where they must lie to look like the photo.

See junctions.py.
"""

import cython
import numpy as np
from cython.cimports.libc.math import INFINITY, fabs, sqrt
from cython.cimports.penink_cli.arrangement._place import Place
from cython.cimports.penink_cli.arrangement._regions import EQUATIONS, MOST_MOVED, MOST_SIDE, MOST_UNKNOWN, Regions

COMPILED = cython.compiled

_RIDGE = cython.declare(cython.double, 1e-4)  # holds the grey of a region that no pixel tells of
_OPTIMISM = cython.declare(cython.double, 2.0)  # times what a step is expected to give, all steps may give at most
_LONGEST = cython.declare(cython.double, 0.8)  # pixels that a vertex goes in one step


@cython.cclass
class Window(Regions):
    """A window of a photo, rendered from edges: regions of one grey each over a common slope, blurred.

    photo: (h, w) grey; taps: as of `Regions`; spread: standard deviation of the camera's blur and a pixel's
    width together, in pixels.
    number: of each vertex of the place among those that are moved, -1 for the others; moved: how many those are.
    held: (MOST_MOVED, 6) what is known of each otherwise, as A (xx, xy, yy), b (x, y) and c of a cost
    xᵀ A x − 2 bᵀ x + c in grey², x counted from the window's corner.
    rest: what the greys do not explain. normal, right: the equations for greys and moves. slope: what `right` was
    of the moves. way: the moves. change: what a bend would add to the picture.
    """

    def __init__(self, photo: cython.float[:, ::1], taps: cython.double[::1], spread: cython.double):
        Regions.__init__(self, taps)
        self.photo, self.spread = photo, spread
        self.rest = np.zeros((MOST_SIDE, MOST_SIDE), np.float64)
        self.normal = np.zeros((MOST_UNKNOWN, MOST_UNKNOWN), np.float64)
        self.right = np.zeros(MOST_UNKNOWN, np.float64)
        self.grey = np.zeros(MOST_UNKNOWN, np.float64)
        self.held = np.zeros((MOST_MOVED, 6), np.float64)
        self.change = np.zeros((MOST_SIDE, MOST_SIDE), np.float64)
        self.slope = np.zeros(2 * MOST_MOVED, np.float64)
        self.way = np.zeros((MOST_MOVED, 2), np.float64)

    def fitted(self, place: Place, window: tuple, halo: cython.int, rounds: cython.int, held: tuple = ()) -> float:
        """What `settle` leaves over when it sees the window (top, left, bottom, right), one row of `held` a vertex."""
        top, left, bottom, right = window
        self.open(top, left, bottom, right, halo)
        self.held[:, :] = 0.0
        for k, known in enumerate(held):
            for i in range(6):
                self.held[k, i] = known[i]
        return self.settle(place, Place(), rounds, INFINITY) if self.enumerate(place, -1) else -1.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def enumerate(self, place: Place, centre: cython.int) -> cython.bint:
        """Number the vertices that are moved: those that are free and have an edge. False for too many.

        centre: if not negative, only this vertex and its neighbours.
        """
        v: cython.int
        self.moved = 0
        for v in range(place.vertices):
            self.number[v] = -1
            if place.free[v] and place.degree[v] > 0 and (centre < 0 or v == centre or place.linked(v, centre)):
                if self.moved == MOST_MOVED:
                    return False
                self.number[v] = self.moved
                self.moved += 1
        return True

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def open(
        self, top: cython.int, left: cython.int, bottom: cython.int, right: cython.int, halo: cython.int
    ) -> cython.int:
        """See rows top … bottom, columns left … right: how many pixels are compared, halo within or at a side."""
        height: cython.int = self.photo.shape[0]
        width: cython.int = self.photo.shape[1]
        self.top = max(0, top)
        self.left = max(0, left)
        self.rows = min(height, bottom) - self.top
        self.columns = min(width, right) - self.left
        self.first_row = 0 if top <= 0 else halo
        self.last_row = self.rows - (0 if bottom >= height else halo)
        self.first_column = 0 if left <= 0 else halo
        self.last_column = self.columns - (0 if right >= width else halo)
        return (self.last_row - self.first_row) * (self.last_column - self.first_column)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def gather(self, unknown: cython.int) -> cython.void:
        """The normal equations of `rest` in the design's columns."""
        i: cython.int
        j: cython.int
        a: cython.int
        b: cython.int
        v: cython.double
        rest: cython.double
        # Arrays of its own, which the compiler knows to be apart: a third faster.
        normal = cython.declare(cython.double[EQUATIONS])
        right = cython.declare(cython.double[MOST_UNKNOWN])
        pixel = cython.declare(cython.double[MOST_UNKNOWN])
        for a in range(unknown):
            right[a] = 0.0
            for b in range(a, unknown):
                normal[a * MOST_UNKNOWN + b] = 0.0
        for i in range(self.first_row, self.last_row):
            for j in range(self.first_column, self.last_column):
                rest = self.rest[i, j]
                for a in range(unknown):
                    pixel[a] = self.design[i, j, a]
                for a in range(unknown):
                    v = pixel[a]
                    if v == 0.0:
                        continue
                    right[a] += v * rest
                    for b in range(a, unknown):
                        normal[a * MOST_UNKNOWN + b] += v * pixel[b]
        for a in range(unknown):
            self.right[a] = right[a]
            for b in range(a, unknown):
                self.normal[a, b] = normal[a * MOST_UNKNOWN + b]
            self.normal[a, a] += _RIDGE

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def solve(self, unknown: cython.int) -> cython.void:
        """Solve them, into `right`."""
        k: cython.int
        a: cython.int
        b: cython.int
        v: cython.double
        for a in range(unknown):  # L D Lᵀ
            for b in range(a + 1, unknown):
                v = self.normal[a, b] / self.normal[a, a]
                for k in range(b, unknown):
                    self.normal[b, k] -= v * self.normal[a, k]
                self.right[b] -= v * self.right[a]
        for a in range(unknown - 1, -1, -1):
            v = self.right[a]
            for b in range(a + 1, unknown):
                v -= self.normal[a, b] * self.right[b]
            self.right[a] = v / self.normal[a, a]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def look(self, place: Place) -> cython.double:
        """Render with the best greys; what is left of the photo stays in `rest`. Its square, negative for none."""
        i: cython.int
        j: cython.int
        k: cython.int
        unknown: cython.int
        total: cython.double = 0.0
        v: cython.double
        if not self.part(place):
            return -1.0
        self.see()
        unknown = self.regions + 2
        for i in range(self.first_row, self.last_row):
            for j in range(self.first_column, self.last_column):
                self.rest[i, j] = self.photo[self.top + i, self.left + j] - 0.5
        self.gather(unknown)
        self.solve(unknown)
        for k in range(unknown):
            self.grey[k] = self.right[k]
        for i in range(self.first_row, self.last_row):
            for j in range(self.first_column, self.last_column):
                v = self.rest[i, j]
                for k in range(unknown):
                    v -= self.design[i, j, k] * self.grey[k]
                self.rest[i, j] = v
                total += v * v
        return total

    @cython.cfunc
    @cython.inline
    @cython.nogil
    @cython.exceptval(check=False)
    def grey_at(self, x: cython.double, y: cython.double) -> cython.double:
        """The grey of the region at a place in the window (pixels)."""
        return self.grey[self.region_at(x, y)]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def yields(self, place: Place, base: cython.int) -> cython.void:
        """The design's columns from base on: how the picture changes as vertices move, x and y of each.

        An edge that goes sideways by δ adds δ times the step across it, blurred, all along it; what a vertex's
        moving gives a point of its edge fades linearly towards the other end.
        """
        e: cython.int
        i: cython.int
        j: cython.int
        k: cython.int
        n: cython.int
        a: cython.int
        b: cython.int
        first: cython.int
        last: cython.int
        x0: cython.double
        y0: cython.double
        dx: cython.double
        dy: cython.double
        x: cython.double
        y: cython.double
        t: cython.double
        length: cython.double
        step: cython.double
        weight: cython.double
        v: cython.double
        reach: cython.int = 1 + cython.cast(cython.int, 3.465 * self.spread)  # pixels: beyond, the bell is 0
        over = cython.declare(cython.double[26])
        for i in range(self.first_row, self.last_row):
            for j in range(self.first_column, self.last_column):
                for k in range(base, base + 2 * MOST_MOVED):
                    self.design[i, j, k] = 0.0
        for e in range(place.edges):
            a = self.number[place.a[e]]
            b = self.number[place.b[e]]
            if a < 0 and b < 0:
                continue
            x0 = place.x[place.a[e]] - self.left
            y0 = place.y[place.a[e]] - self.top
            dx = place.x[place.b[e]] - self.left - x0
            dy = place.y[place.b[e]] - self.top - y0
            length = sqrt(dx * dx + dy * dy)
            n = 1 + cython.cast(cython.int, 3 * length)
            if length < 1e-6:
                continue
            for k in range(n):
                t = (k + 0.5) / n
                x = x0 + t * dx
                y = y0 + t * dy
                if x < -3 or y < -3 or x > self.columns + 3 or y > self.rows + 3:
                    continue
                # (−dy, dx) / length is to the right of the way on the screen; what it leaves behind is left of it.
                step = self.grey_at(x + 0.4 * dy / length, y - 0.4 * dx / length)
                step -= self.grey_at(x - 0.4 * dy / length, y + 0.4 * dx / length)
                if step == 0.0:
                    continue
                weight = step * length / n / (6.283185307179586 * self.spread * self.spread)
                first = max(self.first_column, cython.cast(cython.int, x) - reach)
                last = min(self.last_column, cython.cast(cython.int, x) + reach + 1)
                for j in range(first, last):
                    over[j] = self.bell(fabs(j + 0.5 - x))
                for i in range(
                    max(self.first_row, cython.cast(cython.int, y) - reach),
                    min(self.last_row, cython.cast(cython.int, y) + reach + 1),
                ):
                    v = weight * self.bell(fabs(i + 0.5 - y))
                    for j in range(first, last):
                        if a >= 0:
                            self.design[i, j, base + 2 * a] += v * over[j] * (1 - t) * (-dy / length)
                            self.design[i, j, base + 2 * a + 1] += v * over[j] * (1 - t) * (dx / length)
                        if b >= 0:
                            self.design[i, j, base + 2 * b] += v * over[j] * t * (-dy / length)
                            self.design[i, j, base + 2 * b + 1] += v * over[j] * t * (dx / length)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def promise(self, place: Place, e: cython.int, part: cython.double) -> cython.double:
        """How much a bend at that part of an edge's way would explain, if what it changes were linear in its size.

        `rest` must be what the place leaves over.
        """
        i: cython.int
        j: cython.int
        k: cython.int
        x0: cython.double = place.x[place.a[e]] - self.left
        y0: cython.double = place.y[place.a[e]] - self.top
        dx: cython.double = place.x[place.b[e]] - self.left - x0
        dy: cython.double = place.y[place.b[e]] - self.top - y0
        length: cython.double = sqrt(dx * dx + dy * dy)
        n: cython.int = 1 + cython.cast(cython.int, 2 * length)
        t: cython.double
        x: cython.double
        y: cython.double
        v: cython.double
        weight: cython.double
        product: cython.double = 0.0
        square: cython.double = 0.0
        reach: cython.int = 1 + cython.cast(cython.int, 3.465 * self.spread)
        for i in range(self.first_row, self.last_row):
            for j in range(self.first_column, self.last_column):
                self.change[i, j] = 0.0
        for k in range(n):
            t = (k + 0.5) / n
            x = x0 + t * dx
            y = y0 + t * dy
            if x < -3 or y < -3 or x > self.columns + 3 or y > self.rows + 3:
                continue
            weight = self.grey_at(x + 0.4 * dy / length, y - 0.4 * dx / length)
            weight -= self.grey_at(x - 0.4 * dy / length, y + 0.4 * dx / length)
            weight *= t / part if t < part else (1 - t) / (1 - part)
            for i in range(
                max(self.first_row, cython.cast(cython.int, y) - reach),
                min(self.last_row, cython.cast(cython.int, y) + reach + 1),
            ):
                v = weight * self.bell(fabs(i + 0.5 - y))
                for j in range(
                    max(self.first_column, cython.cast(cython.int, x) - reach),
                    min(self.last_column, cython.cast(cython.int, x) + reach + 1),
                ):
                    self.change[i, j] += v * self.bell(fabs(j + 0.5 - x))
        for i in range(self.first_row, self.last_row):
            for j in range(self.first_column, self.last_column):
                product += self.change[i, j] * self.rest[i, j]
                square += self.change[i, j] * self.change[i, j]
        return product * product / square if square > 0 else 0.0

    @cython.cfunc
    @cython.inline
    @cython.nogil
    @cython.exceptval(check=False)
    def bell(self, d: cython.double) -> cython.double:
        """Nearly a Gaussian: a cubic B-spline of the same spread, which needs no exponential."""
        d *= 0.5773502691896258 / self.spread
        if d >= 2:
            return 0.0
        if d >= 1:
            return (2 - d) * (2 - d) * (2 - d) * 0.24077
        return (4 - 6 * d * d + 3 * d * d * d) * 0.24077

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def held_cost(self, place: Place) -> cython.double:
        """What it costs that vertices are where they are."""
        v: cython.int
        k: cython.int
        x: cython.double
        y: cython.double
        total: cython.double = 0.0
        for v in range(place.vertices):
            k = self.number[v]
            if k >= 0:
                x = place.x[v] - self.left
                y = place.y[v] - self.top
                total += self.held[k, 0] * x * x + 2 * self.held[k, 1] * x * y + self.held[k, 2] * y * y
                total += self.held[k, 5] - 2 * (self.held[k, 3] * x + self.held[k, 4] * y)
        return total

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def settle(self, place: Place, trial: Place, rounds: cython.int, wanted: cython.double) -> cython.double:
        """Move vertices to where the rendered window is most like the photo (Gauss and Newton's steps).

        Those of `number` move; `trial` is room to work in. Returns the sum of squares that is left unexplained and
        what `held` says; negative where there are too many regions. Gives up where that will not be as low as wanted.
        """
        v: cython.int
        k: cython.int
        axis: cython.int
        base: cython.int
        at: cython.int
        x: cython.double
        y: cython.double
        far: cython.double
        part: cython.double
        best: cython.double = self.look(place)
        found: cython.double = best
        if best < 0:
            return best
        best += self.held_cost(place)
        trial.take(place)
        for _ in range(rounds):
            base = self.regions + 2
            self.yields(trial, base)
            self.gather(base + 2 * self.moved)
            for v in range(place.vertices):
                k = self.number[v]
                if k >= 0:
                    at = base + 2 * k
                    x = place.x[v] - self.left
                    y = place.y[v] - self.top
                    self.normal[at, at] += self.held[k, 0]
                    self.normal[at, at + 1] += self.held[k, 1]
                    self.normal[at + 1, at + 1] += self.held[k, 2]
                    self.right[at] += self.held[k, 3] - self.held[k, 0] * x - self.held[k, 1] * y
                    self.right[at + 1] += self.held[k, 4] - self.held[k, 1] * x - self.held[k, 2] * y
            for k in range(2 * self.moved):
                self.slope[k] = self.right[base + k]
            self.solve(base + 2 * self.moved)
            far = 0.0  # by how much it would become less, if it were linear
            for k in range(2 * self.moved):
                far += self.slope[k] * self.right[base + k]
            if best - _OPTIMISM * far > wanted:
                break
            for k in range(self.moved):
                far = sqrt(self.right[base + 2 * k] ** 2 + self.right[base + 2 * k + 1] ** 2)
                part = min(1.0, _LONGEST / max(far, 1e-9))
                for axis in range(2):
                    self.way[k, axis] = part * self.right[base + 2 * k + axis]
            part = 1.0
            while part > 0.4:
                for v in range(place.vertices):
                    k = self.number[v]
                    if k >= 0:
                        trial.x[v] = place.x[v] + part * self.way[k, 0]
                        trial.y[v] = place.y[v] + part * self.way[k, 1]
                found = self.look(trial)
                if found >= 0:
                    found += self.held_cost(trial)
                    if found < best:
                        break
                part *= 0.5
            if part <= 0.4:
                break
            for v in range(place.vertices):
                place.x[v] = trial.x[v]
                place.y[v] = trial.y[v]
            far = best - found
            best = found
            if far < 5e-3 * best:
                break
        return best
