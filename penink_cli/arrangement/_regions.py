# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Compiled: the regions that a few edges part a window into, and what the camera's pixels see of each.

Sides are told apart at `FINE` points a pixel along each axis.
"""

import cython
import numpy as np
from cython.cimports.libc.math import ceil
from cython.cimports.libc.string import memmove, memset
from cython.cimports.penink_cli.arrangement._place import MOST_EDGES, Place

COMPILED = cython.compiled

SIDE, FINENESS = MOST_SIDE, FINE  # of the widest window, pixels; points a pixel


@cython.cclass
class Regions:
    """A window of a picture, parted.

    taps, sums: (2 r + 1,) what each point gives to a pixel along one axis: the camera's blur over the pixel's width;
    the same summed up. top, left, rows, columns: the window, in pixels; first_row … last_column: those of its pixels
    that are compared with the photo, counted in the window.
    walls: of each point, whether an edge passes below. breaks, columns_of: of each row, how many edges pass between
    its points, and the columns after them: each begins a run. begin, end: runs of each row. start, parent, region:
    first column of each run, a run that it is one with, its region. present: regions of each row; across: what pixels
    see of them in that row.
    design: what each pixel sees of each region, then two slopes; then room for what moves of vertices would change.
    """

    def __init__(self, taps: cython.double[::1]):
        self.taps = taps
        self.sums = np.concatenate([[0.0], np.cumsum(taps)])
        self.walls = np.zeros((MOST_POINTS, MOST_POINTS), np.uint8)
        self.breaks = np.zeros(MOST_POINTS, np.int32)
        self.columns_of = np.zeros((MOST_POINTS, MOST_EDGES + 1), np.int32)
        self.begin, self.end = np.zeros(MOST_POINTS, np.int32), np.zeros(MOST_POINTS, np.int32)
        self.start = np.zeros(MOST_POINTS * (MOST_EDGES + 1) + 2, np.int32)
        self.parent, self.region = np.copy(self.start), np.copy(self.start)
        self.total = np.zeros(MOST_SIDE, np.float64)
        self.present = np.zeros((MOST_POINTS, MOST_REGIONS), np.uint8)
        self.across = np.zeros((MOST_POINTS, MOST_REGIONS, MOST_SIDE), np.float64)
        self.design = np.zeros((MOST_SIDE, MOST_SIDE, MOST_UNKNOWN), np.float64)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def block(self, place: Place) -> cython.void:
        """Note where edges pass between points of a row, and mark where they pass below a point."""
        high: cython.int = self.rows * FINE
        wide: cython.int = self.columns * FINE
        e: cython.int
        i: cython.int
        j: cython.int
        x0: cython.double
        y0: cython.double
        x1: cython.double
        y1: cython.double
        at: cython.double
        for i in range(high):
            self.breaks[i] = 0
            memset(cython.address(self.walls[i, 0]), 0, wide)
        for e in range(place.edges):
            x0 = (place.x[place.a[e]] - self.left) * FINE - 0.5
            y0 = (place.y[place.a[e]] - self.top) * FINE - 0.5
            x1 = (place.x[place.b[e]] - self.left) * FINE - 0.5
            y1 = (place.y[place.b[e]] - self.top) * FINE - 0.5
            if y0 > y1:
                x0, y0, x1, y1 = x1, y1, x0, y0
            if y1 < 0 or y0 >= high or max(x0, x1) < 0 or min(x0, x1) >= wide:
                continue
            i = cython.cast(cython.int, ceil(max(0.0, y0)))
            while i < high and i < y1:
                at = x0 + (i - y0) * ((x1 - x0) / (y1 - y0))
                if 0 < at <= wide - 1:
                    self.interrupt(i, cython.cast(cython.int, ceil(at)))
                i += 1
            if x0 > x1:
                x0, y0, x1, y1 = x1, y1, x0, y0
            j = cython.cast(cython.int, ceil(max(0.0, x0)))
            while j < wide and j < x1:
                at = y0 + (j - x0) * ((y1 - y0) / (x1 - x0))
                if 0 < at < high:
                    i = cython.cast(cython.int, ceil(at)) - 1
                    self.walls[i, j] = 1
                j += 1

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def interrupt(self, i: cython.int, j: cython.int) -> cython.void:
        """Let a run of row i begin with column j."""
        k: cython.int = self.breaks[i]
        while k > 0 and self.columns_of[i, k - 1] > j:
            k -= 1
        if (k > 0 and self.columns_of[i, k - 1] == j) or self.breaks[i] == MOST_EDGES:
            return
        memmove(
            cython.address(self.columns_of[i, k]) + 1,
            cython.address(self.columns_of[i, k]),
            (self.breaks[i] - k) * cython.sizeof(cython.int),
        )
        self.columns_of[i, k] = j
        self.breaks[i] += 1

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def part(self, place: Place) -> cython.bint:
        """Number the regions that edges part; False where there are too many.

        Points of a row between two edges are a run; runs below one another without an edge between are one region.
        """
        i: cython.int
        a: cython.int
        run: cython.int = 0
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

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def hang_together(self, i: cython.int) -> cython.void:
        """Make runs of row i one with those above them where no edge is between."""
        one: cython.int = self.begin[i - 1]
        other: cython.int = self.begin[i]
        j: cython.int
        a: cython.int
        b: cython.int
        one_end: cython.int
        other_end: cython.int
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

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def see(self) -> cython.void:
        """How much of each region each compared pixel sees: the first columns of the design; then the two slopes."""
        reach: cython.int = cython.cast(cython.int, self.taps.shape[0] // 2)
        high: cython.int = self.rows * FINE
        wide: cython.int = self.columns * FINE
        regions: cython.int = self.regions
        i: cython.int
        j: cython.int
        k: cython.int
        d: cython.int
        at: cython.int
        run: cython.int
        first: cython.int
        last: cython.int
        weight: cython.double
        total: cython.p_double
        row: cython.p_double
        for i in range(high):
            for k in range(regions):
                self.present[i, k] = 0
            for run in range(self.begin[i], self.end[i]):
                # The row goes on beyond the window as it ends.
                first = self.start[run] if run > self.begin[i] else -MOST_POINTS
                last = self.start[run + 1] if run + 1 < self.end[i] else wide + MOST_POINTS
                k = self.region[run]
                if not self.present[i, k]:
                    self.present[i, k] = 1
                    memset(cython.address(self.across[i, k, 0]), 0, self.columns * cython.sizeof(cython.double))
                for j in range(
                    max(self.first_column, (first - reach) // FINE - 1 if first > 0 else 0),
                    min(self.last_column, (last + reach) // FINE + 2),
                ):
                    at = FINE * j + FINE // 2 - reach  # the first tap
                    self.across[i, k, j] += self.sums[min(2 * reach + 1, max(0, last - at))]
                    self.across[i, k, j] -= self.sums[min(2 * reach + 1, max(0, first - at))]
        for i in range(self.first_row, self.last_row):
            for k in range(regions):
                total = cython.address(self.total[0])
                for j in range(self.first_column, self.last_column):
                    total[j] = 0.0
                for d in range(-reach, reach + 1):
                    at = min(high - 1, max(0, FINE * i + FINE // 2 + d))
                    if not self.present[at, k]:
                        continue
                    row = cython.address(self.across[at, k, 0])
                    weight = self.taps[d + reach]
                    for j in range(self.first_column, self.last_column):
                        total[j] += weight * row[j]
                for j in range(self.first_column, self.last_column):
                    self.design[i, j, k] = total[j]
            for j in range(self.first_column, self.last_column):
                self.design[i, j, regions] = 0.1 * (i - 0.5 * self.rows)
                self.design[i, j, regions + 1] = 0.1 * (j - 0.5 * self.columns)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def region_at(self, x: cython.double, y: cython.double) -> cython.int:
        """The region at a place in the window (pixels)."""
        i: cython.int = min(self.rows * FINE - 1, max(0, cython.cast(cython.int, y * FINE)))
        j: cython.int = min(self.columns * FINE - 1, max(0, cython.cast(cython.int, x * FINE)))
        run: cython.int = self.begin[i]
        while run + 1 < self.end[i] and self.start[run + 1] <= j:
            run += 1
        return self.region[run]
