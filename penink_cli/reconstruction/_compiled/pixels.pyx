# cython: boundscheck=False, wraparound=False, cdivision=True
"""The pixels of one tile, up to 8 × 8 of them, and which of them lie on one side of a line.

A set of pixels is a word of 64 bits, pixel (row r, column c) at bit 8 r + c. Which pixels lie on one side of a line
is a *mask*. Nearly every line leaves the whole tile on one side, which four multiplications settle, with slack; only
where it does not are the pixels told apart, and only those next to the line by the exact predicates. So the masks are
exact, however coarse the quick test.
"""

from libc.math cimport fabs
from penink_cli.reconstruction._compiled.lanes cimport negative_pixels
from penink_cli.reconstruction._compiled.scene cimport side_of_query, side_of_vertex

cdef float SLACK = 1e-5  # of the quick tests, in samples: ten times the worst rounding of a float
cdef double NEAR = 2e-6  # of the masks, to the numbers added up: several roundings of a float


cdef class Pixels:
    """Pixels px[0 … nx] × py[0 … ny], a step apart, sample units, in the cell (row cy, column cx)."""

    cdef void stand_in_row(self, int cy, double* py, int ny) noexcept nogil:
        """Have the rows of pixels py, in the cells below the row cy of samples."""
        self.cy = cy
        self.py = py
        self.ny = ny
        self.middle_y = 0.5 * (py[0] + py[ny - 1])
        self.extent_y = 0.5 * (py[ny - 1] - py[0]) + SLACK
        self.mid_y = <float>(self.middle_y - cy)
        self.half_y = <float>self.extent_y

    cdef void stand_in_column(self, int cx, double* px, int nx) noexcept nogil:
        """Have the columns of pixels px, in the cells right of the column cx of samples."""
        self.cx = cx
        self.px = px
        self.nx = nx
        self.middle_x = 0.5 * (px[0] + px[nx - 1])
        self.extent_x = 0.5 * (px[nx - 1] - px[0]) + SLACK
        self.mid_x = <float>(self.middle_x - cx)
        self.half_x = <float>self.extent_x

    cdef unsigned long long half_plane(
        self, double ax, double ay, double bx, double by, bint from_sample
    ) noexcept nogil:
        """The pixels on the positive side of the line from a, a vertex or else a sample, to the vertex b."""
        cdef int k
        cdef double value = (bx - ax) * (self.py[0] - ay) - (by - ay) * (self.px[0] - ax)
        cdef double gx = -(by - ay) * self.step_x
        cdef double gy = (bx - ax) * self.step_y
        cdef float least = 0.0
        cdef double near = NEAR * (fabs(value) + 8.0 * (fabs(gx) + fabs(gy)))
        cdef unsigned long long unsure = 0
        cdef unsigned long long m = ~negative_pixels(
            <float>value, <float>gx, <float>gy,
            &least, self.wide,
        )
        if least > near:
            return m
        for k in range(64):
            if fabs(value + (k & 7) * gx + (k >> 3) * gy) <= 2.0 * near:
                unsure |= <unsigned long long>1 << k
        return self.exactly(ax, ay, bx, by, from_sample, m, unsure)

    cdef unsigned long long exactly(
        self, double ax, double ay, double bx, double by, bint from_sample, unsigned long long m,
        unsigned long long unsure,
    ) noexcept nogil:
        """A mask with those of its pixels that are unsure decided by the exact predicates."""
        cdef int k, side
        cdef unsigned long long bit
        unsure &= self.pixels()
        for k in range(64):
            bit = <unsigned long long>1 << k
            if unsure & bit:
                if from_sample:
                    side = side_of_vertex(self.px[k & 7], self.py[k >> 3], ax, ay, bx, by)
                else:
                    side = side_of_query(ax, ay, bx, by, self.px[k & 7], self.py[k >> 3])
                m = m | bit if side > 0 else m & ~bit
        return m
