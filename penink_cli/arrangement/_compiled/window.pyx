# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: what a few edges would look like through the camera, and where they must lie to look like the photo.

See junctions.py.

        δ ↑    ↑ (1 − t) δ      Vertex v moves aside by δ: what lies the part t along its edge to u moves by (1 − t) δ.
    v ────┼────┼──────── u      Where an edge moves aside by d, the picture changes by d times the step of grey across
          0    t         1      it, blurred: that is the edge's part of the Jacobian.
"""

import numpy as np
from libc.math cimport INFINITY, fabs, sqrt
from penink_cli.arrangement._compiled.place cimport Place
from penink_cli.arrangement._compiled.products cimport add_scaled, add_scaled_twice, dot
from libc.string cimport memcpy, memset
from penink_cli.arrangement._compiled.regions cimport MOST_MOVED, MOST_PIXELS, MOST_SIDE, MOST_UNKNOWN, Regions

cdef double _RIDGE = 1e-4  # holds the grey of a region that no pixel tells of
cdef double _OPTIMISM = 2.0  # times what a step is expected to give, all steps may give at most
cdef double _LONGEST = 0.8  # pixels that a vertex goes in one step


cdef class Window(Regions):
    """A window of a photo and a least-squares model of it: regions of one grey each over a common slope, blurred.

    The unknowns u are first the greys of the regions and the two slopes, then the x and y of each vertex that moves.
    J is the picture's Jacobian in them, r the residual; a Gauss-Newton step solves (JᵀJ + A) u = Jᵀr + b − Ax.

    photo: (h, w) grey 0 … 1. taps: as of `Regions`. spread: standard deviation of the camera's blur and a pixel's width
    together, pixels.
    number: (vertices of the place,) of each its number k among those that move, −1 for the others; moved: how many do.
    design: (unknowns, compared pixels) Jᵀ, of `Regions`. starts, stops: of each unknown, between which pixels it tells.
    residual: (compared pixels,) r, photo less picture. normal_matrix: (unknowns, unknowns) JᵀJ, its upper triangle;
    kept: the same of the regions and slopes.
    right_hand_side: (unknowns,) Jᵀr; `solve` leaves the solution there. gradient: (2 moved,) its part of the vertices.
    prior: (moved, 6) what is known of each vertex otherwise, as A (xx, xy, yy), b (x, y) and c of a cost
    xᵀ A x − 2 bᵀ x + c in grey², x pixels from the window's corner.
    rendered: the place that is rendered, and left_unexplained: what `render` said of it.
    step: (moved, 2) the step of each vertex, pixels. response: (compared pixels,) what a unit bend adds to the picture;
    ends: (2, compared pixels) what an edge's moving sideways at its beginning and at its end adds.
    """

    def __init__(self, float[:, ::1] photo, double[::1] taps, double spread):
        Regions.__init__(self, taps)
        self.photo, self.spread = photo, spread
        self.residual = np.zeros(MOST_PIXELS, np.float64)
        self.normal_matrix = np.zeros((MOST_UNKNOWN, MOST_UNKNOWN), np.float64)
        self.right_hand_side = np.zeros(MOST_UNKNOWN, np.float64)
        self.grey = np.zeros(MOST_UNKNOWN, np.float64)
        self.prior = np.zeros((MOST_MOVED, 6), np.float64)
        self.response = np.zeros(MOST_PIXELS, np.float64)
        self.ends = np.zeros((2, MOST_PIXELS), np.float64)
        self.kept = np.zeros((MOST_UNKNOWN, MOST_UNKNOWN), np.float64)
        self.gradient = np.zeros(2 * MOST_MOVED, np.float64)
        self.step = np.zeros((MOST_MOVED, 2), np.float64)
        self.rendered = Place()
        self.nothing_rendered = True

    def fitted(self, Place place, window: tuple, int halo, int rounds, held: tuple = ()) -> float:
        """What `settle` leaves over when it sees the window (top, left, bottom, right), one row of `held` a vertex."""
        top, left, bottom, right = window
        self.open(top, left, bottom, right, halo)
        self.prior[:, :] = 0.0
        for k, known in enumerate(held):
            for i in range(6):
                self.prior[k, i] = known[i]
        return self.settle(place, Place(), rounds, INFINITY) if self.enumerate(place, -1) else -1.0

    cdef bint enumerate(self, Place place, int centre) noexcept nogil:
        """Number the vertices that are moved: those that are free and have an edge. False for too many.

        centre: if not negative, only this vertex and its neighbours.
        """
        cdef int v
        self.moved = 0
        for v in range(place.vertices):
            self.number[v] = -1
            if place.free[v] and place.degree[v] > 0 and (centre < 0 or v == centre or place.linked(v, centre)):
                if self.moved == MOST_MOVED:
                    return False
                self.number[v] = self.moved
                self.moved += 1
        return True

    cdef int open(self, int top, int left, int bottom, int right, int halo) noexcept nogil:
        """See rows top … bottom, columns left … right: how many pixels are compared, halo within or at a side."""
        cdef int height = self.photo.shape[0]
        cdef int width = self.photo.shape[1]
        self.top = max(0, top)
        self.left = max(0, left)
        self.rows = min(height, bottom) - self.top
        self.columns = min(width, right) - self.left
        self.first_row = 0 if top <= 0 else halo
        self.last_row = self.rows - (0 if bottom >= height else halo)
        self.first_column = 0 if left <= 0 else halo
        self.last_column = self.columns - (0 if right >= width else halo)
        self.wide = self.last_column - self.first_column
        self.count = (self.last_row - self.first_row) * self.wide
        self.nothing_rendered = True
        return self.count

    cdef void accumulate(self, int known, int unknown) noexcept nogil:
        """Normal matrix and right-hand side of the residual, in so many planes of the design.

        Of the first planes, so many as are known, the matrix is kept.
        """
        cdef int a, b, start, stop
        for a in range(unknown):
            start, stop = self.starts[a], self.stops[a]
            self.right_hand_side[a] = dot(&self.design[a, start], &self.residual[start], stop - start)
            for b in range(a, unknown):
                if b < known:
                    self.normal_matrix[a, b] = self.kept[a, b]
                    continue
                start, stop = max(self.starts[a], self.starts[b]), min(self.stops[a], self.stops[b])
                self.normal_matrix[a, b] = dot(&self.design[a, start], &self.design[b, start], stop - start)
            if a >= known:
                self.normal_matrix[a, a] += _RIDGE

    cdef void solve(self, int unknown) noexcept nogil:
        """Solve the normal equations by L D Lᵀ; `right_hand_side` becomes the solution."""
        cdef int k, a, b
        cdef double v
        for a in range(unknown):
            for b in range(a + 1, unknown):
                v = self.normal_matrix[a, b] / self.normal_matrix[a, a]
                for k in range(b, unknown):
                    self.normal_matrix[b, k] -= v * self.normal_matrix[a, k]
                self.right_hand_side[b] -= v * self.right_hand_side[a]
        for a in range(unknown - 1, -1, -1):
            v = self.right_hand_side[a]
            for b in range(a + 1, unknown):
                v -= self.normal_matrix[a, b] * self.right_hand_side[b]
            self.right_hand_side[a] = v / self.normal_matrix[a, a]

    cdef double render(self, Place place) noexcept nogil:
        """Render with the best greys: the sum of squares of the residual; negative where there are too many regions.

        What was rendered last is there still: that is a fifth of all that is asked for.
        """
        if self.nothing_rendered or not self.rendered.looks_like(place):
            self.left_unexplained = self.render_anew(place)
            self.rendered.take(place)
            self.nothing_rendered = False
        return self.left_unexplained

    cdef double render_anew(self, Place place) noexcept nogil:
        """Render, whatever was rendered before."""
        cdef int i, j, k, unknown
        cdef float* row
        cdef double* residual = &self.residual[0]
        cdef double grey
        if not self.part(place):
            return -1.0
        self.see()
        unknown = self.regions + 2
        for i in range(self.last_row - self.first_row):
            row = &self.photo[self.top + self.first_row + i, self.left + self.first_column]
            for j in range(self.wide):
                residual[i * self.wide + j] = row[j] - 0.5
        for k in range(unknown):
            self.starts[k], self.stops[k] = 0, self.count
        self.accumulate(0, unknown)
        for k in range(unknown):
            memcpy(&self.kept[k, 0], &self.normal_matrix[k, 0], unknown * sizeof(double))
        self.solve(unknown)
        for k in range(unknown):
            self.grey[k] = grey = self.right_hand_side[k]
            add_scaled(residual, &self.design[k, 0], -grey, self.count)
        return dot(residual, residual, self.count)

    cdef inline double grey_at(self, double x, double y) noexcept nogil:
        """The grey of the region at a place in the window (pixels)."""
        return self.grey[self.region_at(x, y)]

    cdef bint splat(self, double x, double y, double* over, int* box) noexcept nogil:
        """What a point's bell gives to columns, and the box of pixels (top, bottom, left, right) it reaches."""
        cdef int j
        cdef int reach = 1 + <int>(3.465 * self.spread)  # pixels: beyond, the bell is 0
        if x < -3 or y < -3 or x > self.columns + 3 or y > self.rows + 3:
            return False
        box[0] = max(self.first_row, <int>y - reach)
        box[1] = min(self.last_row, <int>y + reach + 1)
        box[2] = max(self.first_column, <int>x - reach)
        box[3] = min(self.last_column, <int>x + reach + 1)
        if box[0] >= box[1] or box[2] >= box[3]:
            return False
        for j in range(box[2], box[3]):
            over[j - box[2]] = self.bell(fabs(j + 0.5 - x))
        return True

    cdef void jacobian(self, Place place, int base) noexcept nogil:
        """The Jacobian in the vertices' x and y: the design's planes from `base` on.

        An edge that goes sideways by δ adds δ times the step across it, blurred, all along it; what a vertex's
        moving gives a point of its edge fades linearly towards the other end.
        """
        cdef int e, i, j, k, n, p, end, first, last
        cdef double x0, y0, dx, dy, x, y, t, length, step, weight, v
        cdef double[MOST_SIDE] over
        cdef int[4] box
        for k in range(base, base + 2 * self.moved):
            memset(&self.design[k, 0], 0, self.count * sizeof(double))
            self.starts[k], self.stops[k] = self.count, 0
        for e in range(place.edges):
            if self.number[place.a[e]] < 0 and self.number[place.b[e]] < 0:
                continue
            x0 = place.x[place.a[e]] - self.left
            y0 = place.y[place.a[e]] - self.top
            dx = place.x[place.b[e]] - self.left - x0
            dy = place.y[place.b[e]] - self.top - y0
            length = sqrt(dx * dx + dy * dy)
            n = 1 + <int>(2 * length)
            if length < 1e-6:
                continue
            memset(&self.ends[0, 0], 0, self.count * sizeof(double))
            memset(&self.ends[1, 0], 0, self.count * sizeof(double))
            first, last = self.last_row, self.first_row
            for k in range(n):
                t = (k + 0.5) / n
                x = x0 + t * dx
                y = y0 + t * dy
                if not self.splat(x, y, over, box):
                    continue
                # (−dy, dx) / length is to the right of the way on the screen; what it leaves behind is left of it.
                step = self.grey_at(x + 0.4 * dy / length, y - 0.4 * dx / length)
                step -= self.grey_at(x - 0.4 * dy / length, y + 0.4 * dx / length)
                if step == 0.0:
                    continue
                weight = step * length / n / (6.283185307179586 * self.spread * self.spread)
                first, last = min(first, box[0]), max(last, box[1])
                for i in range(box[0], box[1]):
                    v = weight * self.bell(fabs(i + 0.5 - y))
                    p = (i - self.first_row) * self.wide + box[2] - self.first_column
                    add_scaled_twice(&self.ends[0, p], &self.ends[1, p], over, v * (1 - t), v * t, box[3] - box[2])
            if first >= last:
                continue
            first, last = (first - self.first_row) * self.wide, (last - self.first_row) * self.wide
            for end in range(2):
                k = self.number[place.b[e] if end else place.a[e]]
                if k < 0:
                    continue
                k = base + 2 * k
                for j in range(2):
                    weight = dx / length if j else -dy / length
                    add_scaled(&self.design[k + j, first], &self.ends[end, first], weight, last - first)
                    self.starts[k + j] = min(self.starts[k + j], first)
                    self.stops[k + j] = max(self.stops[k + j], last)

    cdef double predicted_gain(self, Place place, int e, double part) noexcept nogil:
        """How much a bend at that part of an edge's way would explain, if what it changes were linear in its size.

        `residual` must be that of the place.
        """
        cdef int i, j, k
        cdef double t, x, y, v, weight, square
        cdef double x0 = place.x[place.a[e]] - self.left
        cdef double y0 = place.y[place.a[e]] - self.top
        cdef double dx = place.x[place.b[e]] - self.left - x0
        cdef double dy = place.y[place.b[e]] - self.top - y0
        cdef double length = sqrt(dx * dx + dy * dy)
        cdef int n = 1 + <int>(2 * length)
        cdef double product
        cdef double[MOST_SIDE] over
        cdef int[4] box
        memset(&self.response[0], 0, self.count * sizeof(double))
        for k in range(n):
            t = (k + 0.5) / n
            x = x0 + t * dx
            y = y0 + t * dy
            if not self.splat(x, y, over, box):
                continue
            weight = self.grey_at(x + 0.4 * dy / length, y - 0.4 * dx / length)
            weight -= self.grey_at(x - 0.4 * dy / length, y + 0.4 * dx / length)
            weight *= t / part if t < part else (1 - t) / (1 - part)
            for i in range(box[0], box[1]):
                v = weight * self.bell(fabs(i + 0.5 - y))
                j = (i - self.first_row) * self.wide + box[2] - self.first_column
                add_scaled(&self.response[j], over, v, box[3] - box[2])
        product = dot(&self.response[0], &self.residual[0], self.count)
        square = dot(&self.response[0], &self.response[0], self.count)
        return product * product / square if square > 0 else 0.0

    cdef inline double bell(self, double d) noexcept nogil:
        """Nearly a Gaussian: a cubic B-spline of the same spread, which needs no exponential."""
        d *= 0.5773502691896258 / self.spread
        if d >= 2:
            return 0.0
        if d >= 1:
            return (2 - d) * (2 - d) * (2 - d) * 0.24077
        return (4 - 6 * d * d + 3 * d * d * d) * 0.24077

    cdef double prior_cost(self, Place place) noexcept nogil:
        """What it costs that vertices are where they are."""
        cdef int v, k
        cdef double x, y
        cdef double total = 0.0
        for v in range(place.vertices):
            k = self.number[v]
            if k >= 0:
                x = place.x[v] - self.left
                y = place.y[v] - self.top
                total += self.prior[k, 0] * x * x + 2 * self.prior[k, 1] * x * y + self.prior[k, 2] * y * y
                total += self.prior[k, 5] - 2 * (self.prior[k, 3] * x + self.prior[k, 4] * y)
        return total

    cdef double settle(self, Place place, Place trial, int rounds, double wanted) noexcept nogil:
        """Move vertices to where the rendered window is most like the photo, by Gauss-Newton steps.

        Those of `number` move; `trial` is room to work in. Returns the sum of squares that is left unexplained and
        what `prior` says; negative where there are too many regions. Gives up where that will not be as low as wanted.
        """
        cdef int v, k, axis, base, at
        cdef double x, y, predicted, length, part, before
        cdef double best = self.render(place)
        cdef double found = best
        if best < 0:
            return best
        best += self.prior_cost(place)
        trial.take(place)
        for _ in range(rounds):
            base = self.regions + 2
            self.jacobian(trial, base)
            self.accumulate(base, base + 2 * self.moved)
            for v in range(place.vertices):
                k = self.number[v]
                if k >= 0:
                    at = base + 2 * k
                    x = place.x[v] - self.left
                    y = place.y[v] - self.top
                    self.normal_matrix[at, at] += self.prior[k, 0]
                    self.normal_matrix[at, at + 1] += self.prior[k, 1]
                    self.normal_matrix[at + 1, at + 1] += self.prior[k, 2]
                    self.right_hand_side[at] += self.prior[k, 3] - self.prior[k, 0] * x - self.prior[k, 1] * y
                    self.right_hand_side[at + 1] += self.prior[k, 4] - self.prior[k, 1] * x - self.prior[k, 2] * y
            for k in range(2 * self.moved):
                self.gradient[k] = self.right_hand_side[base + k]
            self.solve(base + 2 * self.moved)
            predicted = 0.0  # by how much it would become less, if it were linear
            for k in range(2 * self.moved):
                predicted += self.gradient[k] * self.right_hand_side[base + k]
            if best - _OPTIMISM * predicted > wanted:
                break
            for k in range(self.moved):
                length = sqrt(self.right_hand_side[base + 2 * k] ** 2 + self.right_hand_side[base + 2 * k + 1] ** 2)
                part = min(1.0, _LONGEST / max(length, 1e-9))
                for axis in range(2):
                    self.step[k, axis] = part * self.right_hand_side[base + 2 * k + axis]
            part = 1.0  # of the step: all, or half if all makes it worse
            while part > 0.4:
                for v in range(place.vertices):
                    k = self.number[v]
                    if k >= 0:
                        trial.x[v] = place.x[v] + part * self.step[k, 0]
                        trial.y[v] = place.y[v] + part * self.step[k, 1]
                found = self.render(trial)
                if found >= 0:
                    found += self.prior_cost(trial)
                    if found < best:
                        break
                part *= 0.5
            if part <= 0.4:
                break
            for v in range(place.vertices):
                place.x[v] = trial.x[v]
                place.y[v] = trial.y[v]
            before, best = best, found
            if before - best < 5e-3 * best:
                break
        return best
