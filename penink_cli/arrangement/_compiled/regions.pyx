# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: the regions that a few edges part a window into, and what the camera's pixels see of each.

Sides are told apart at `FINE` points a pixel along each axis.

    a a a a│b b b      Where an edge passes between two points of a row, one run ends and another begins: a and b. A
    a a a a│b b b      run of the next row hangs together with a run above unless an edge passes below every point that
    ───────┘           they share: c with b, not with a. Runs that hang together are one region. A pixel sees of each
    c c c c c c c      region what the camera's blur gives it of the region's points.
"""

import numpy as np
from libc.math cimport ceil
from libc.string cimport memmove, memset
from penink_cli.arrangement._compiled.place cimport MOST_EDGES, Place
from penink_cli.arrangement._compiled.products cimport Row, add_scaled, weighted_rows

SIDE, FINENESS = MOST_SIDE, FINE  # of the widest window, pixels; points a pixel


cdef class Regions:
    """A window of a picture, parted.

    taps, sums: (2 r + 1,) what each point gives to a pixel along one axis: the camera's blur over the pixel's width;
    the same summed up. top, left, rows, columns: the window, in pixels; first_row … last_column: those of its pixels
    that are compared with the photo, counted in the window; wide, count: how many these are in a row, and in all.
    walls: of each point, whether an edge passes below. breaks, columns_of: of each row, how many edges pass between
    its points, and the columns after them: each begins a run. begin, end: runs of each row. start, parent, region:
    first column of each run, a run that it is one with, its region. present: regions of each row; across: what the
    compared pixels of that row's points see of them. left_of: what pixel j sees of a row left of the column
    FINE q + f, at [f, MOST_SIDE - q + j].
    design: of each unknown a plane of the compared pixels, row after row: first what each sees of each region, then two
    slopes, then room for what moves of vertices would change.
    """

    def __init__(self, double[::1] taps):
        self.taps = taps
        self.sums = np.concatenate([[0.0], np.cumsum(taps)])
        self.walls = np.zeros((MOST_POINTS, MOST_POINTS), np.uint8)
        self.breaks = np.zeros(MOST_POINTS, np.int32)
        self.columns_of = np.zeros((MOST_POINTS, MOST_EDGES + 1), np.int32)
        self.begin, self.end = np.zeros(MOST_POINTS, np.int32), np.zeros(MOST_POINTS, np.int32)
        self.start = np.zeros(MOST_POINTS * (MOST_EDGES + 1) + 2, np.int32)
        self.parent, self.region = np.copy(self.start), np.copy(self.start)
        reach = len(taps) // 2
        points = FINE * np.arange(MOST_SIDE, -MOST_SIDE - 1, -1) - FINE // 2 + reach
        at = np.clip(points + np.arange(FINE)[:, None], 0, 2 * reach + 1)
        self.left_of = np.ascontiguousarray(np.asarray(self.sums)[at])
        self.present = np.zeros((MOST_POINTS, MOST_REGIONS), np.uint8)
        self.across = np.zeros((MOST_POINTS, MOST_REGIONS, MOST_SIDE), np.float64)
        self.design = np.zeros((MOST_UNKNOWN, MOST_PIXELS), np.float64)

    cdef void block(self, Place place) noexcept nogil:
        """Note where edges pass between points of a row, and mark where they pass below a point."""
        cdef int e, i, j
        cdef double x0, y0, x1, y1, at
        cdef int high = self.rows * FINE
        cdef int wide = self.columns * FINE
        for i in range(high):
            self.breaks[i] = 0
            memset(&self.walls[i, 0], 0, wide)
        for e in range(place.edges):
            x0 = (place.x[place.a[e]] - self.left) * FINE - 0.5
            y0 = (place.y[place.a[e]] - self.top) * FINE - 0.5
            x1 = (place.x[place.b[e]] - self.left) * FINE - 0.5
            y1 = (place.y[place.b[e]] - self.top) * FINE - 0.5
            if y0 > y1:
                x0, y0, x1, y1 = x1, y1, x0, y0
            if y1 < 0 or y0 >= high or max(x0, x1) < 0 or min(x0, x1) >= wide:
                continue
            i = <int>ceil(max(0.0, y0))
            while i < high and i < y1:
                at = x0 + (i - y0) * ((x1 - x0) / (y1 - y0))
                if 0 < at <= wide - 1:
                    self.interrupt(i, <int>ceil(at))
                i += 1
            if x0 > x1:
                x0, y0, x1, y1 = x1, y1, x0, y0
            j = <int>ceil(max(0.0, x0))
            while j < wide and j < x1:
                at = y0 + (j - x0) * ((y1 - y0) / (x1 - x0))
                if 0 < at < high:
                    i = <int>ceil(at) - 1
                    self.walls[i, j] = 1
                j += 1

    cdef void interrupt(self, int i, int j) noexcept nogil:
        """Let a run of row i begin with column j."""
        cdef int k = self.breaks[i]
        while k > 0 and self.columns_of[i, k - 1] > j:
            k -= 1
        if (k > 0 and self.columns_of[i, k - 1] == j) or self.breaks[i] == MOST_EDGES:
            return
        memmove(&self.columns_of[i, k] + 1, &self.columns_of[i, k], (self.breaks[i] - k) * sizeof(int))
        self.columns_of[i, k] = j
        self.breaks[i] += 1

    cdef bint part(self, Place place) noexcept nogil:
        """Number the regions that edges part; False where there are too many.

        Points of a row between two edges are a run; runs below one another without an edge between are one region.
        """
        cdef int i, a
        cdef int run = 0
        self.block(place)
        for i in range(self.rows * FINE):
            self.begin[i] = run
            for a in range(self.breaks[i] + 1):
                self.start[run] = self.columns_of[i, a - 1] if a > 0 else 0
                self.parent[run] = run
                run += 1
            self.start[run] = self.columns * FINE  # overwritten by the next row's first run
            self.end[i] = run
            if i > 0:
                self.hang_together(i)
        self.regions = 0
        for a in range(run):  # a run's parent comes before it
            if self.parent[a] == a:
                if self.regions == MOST_REGIONS:
                    return False
                self.region[a] = self.regions
                self.regions += 1
            else:
                self.region[a] = self.region[self.parent[a]]
        return True

    cdef void hang_together(self, int i) noexcept nogil:
        """Make runs of row i one with those above them where no edge is between."""
        cdef int j, a, b, one_end, other_end
        cdef int one = self.begin[i - 1]
        cdef int other = self.begin[i]
        while one < self.end[i - 1] and other < self.end[i]:
            one_end = self.start[one + 1] if one + 1 < self.end[i - 1] else self.columns * FINE
            other_end = self.start[other + 1]
            for j in range(max(self.start[one], self.start[other]), min(one_end, other_end)):
                if not self.walls[i - 1, j]:
                    a = one
                    while self.parent[a] != a:
                        a = self.parent[a]
                    b = other
                    while self.parent[b] != b:
                        b = self.parent[b]
                    self.parent[max(a, b)] = min(a, b)
                    break
            if one_end <= other_end:
                one += 1
            if other_end <= one_end:
                other += 1

    cdef void see_along(self, int i) noexcept nogil:
        """What the compared pixels see of each region along row i of points: the row goes on beyond the window."""
        cdef int j, k, run
        cdef int wide = self.wide
        cdef double everything = self.sums[self.sums.shape[0] - 1]
        cdef bint more
        cdef double* row
        cdef const double* low
        cdef const double* high
        for k in range(self.regions):
            self.present[i, k] = 0
        low = NULL
        for run in range(self.begin[i], self.end[i]):
            k = self.region[run]
            row = &self.across[i, k, 0]
            high = self.seen_left_of(self.start[run + 1]) if run + 1 < self.end[i] else NULL
            more = self.present[i, k]
            self.present[i, k] = 1
            if low == NULL and high == NULL:
                for j in range(wide):
                    row[j] = everything
            elif low == NULL:
                for j in range(wide):
                    row[j] = high[j]
            elif high == NULL and more:
                for j in range(wide):
                    row[j] += everything - low[j]
            elif high == NULL:
                for j in range(wide):
                    row[j] = everything - low[j]
            elif more:
                for j in range(wide):
                    row[j] += high[j] - low[j]
            else:
                for j in range(wide):
                    row[j] = high[j] - low[j]
            low = high

    cdef inline const double* seen_left_of(self, int column) noexcept nogil:
        """What the compared pixels of a row see of it left of a column of points."""
        return &self.left_of[column % FINE, MOST_SIDE - column // FINE + self.first_column]

    cdef void see(self) noexcept nogil:
        """How much of each region each compared pixel sees: the first planes of the design; then the two slopes.

        All that a pixel sees is 1, so that the first region is what the others leave.
        """
        cdef int i, j, k, d, n, at, first
        cdef Row[MOST_POINTS] rows
        cdef double[MOST_POINTS] weights
        cdef double* plane
        cdef double* rest
        cdef int reach = <int>(self.taps.shape[0] // 2)
        cdef int high = self.rows * FINE
        cdef int wide = self.wide
        cdef int regions = self.regions
        first = max(0, FINE * self.first_row + FINE // 2 - reach)
        for i in range(first, min(high, FINE * (self.last_row - 1) + FINE // 2 + reach + 1)):
            self.see_along(i)
        for i in range(self.last_row - self.first_row):
            rest = &self.design[0, i * wide]
            for j in range(wide):
                rest[j] = 1.0
            for k in range(1, regions):
                plane = &self.design[k, i * wide]
                n = 0
                for d in range(-reach, reach + 1):
                    at = min(high - 1, max(0, FINE * (self.first_row + i) + FINE // 2 + d))
                    if self.present[at, k]:
                        rows[n], weights[n] = &self.across[at, k, 0], self.taps[d + reach]
                        n += 1
                weighted_rows(plane, rows, weights, n, wide)
                add_scaled(rest, plane, -1.0, wide)
            plane = &self.design[regions, i * wide]
            rest = &self.design[regions + 1, i * wide]
            for j in range(wide):
                plane[j] = 0.1 * (self.first_row + i - 0.5 * self.rows)
                rest[j] = 0.1 * (self.first_column + j - 0.5 * self.columns)

    cdef int region_at(self, double x, double y) noexcept nogil:
        """The region at a place in the window (pixels)."""
        cdef int i = min(self.rows * FINE - 1, max(0, <int>(y * FINE)))
        cdef int j = min(self.columns * FINE - 1, max(0, <int>(x * FINE)))
        cdef int run = self.begin[i]
        while run + 1 < self.end[i] and self.start[run + 1] <= j:
            run += 1
        return self.region[run]
