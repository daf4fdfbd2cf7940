# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The pixels of one tile, up to 8 × 8 of them, and which of them lie on one side of a line.

A set of pixels is a word of 64 bits, pixel (row r, column c) at bit 8 r + c. Which pixels lie on one side of a line
is a *mask*. Nearly every line leaves the whole tile on one side, which four multiplications settle, with slack; only
where it does not are the pixels told apart, and only those next to the line by the exact predicates. So the masks are
exact, however coarse the quick test.
"""

import cython
from cython.cimports.libc.math import fabs
from cython.cimports.penink_cli.reconstruction._lanes import below_zero
from cython.cimports.penink_cli.reconstruction._scene import side_of_query, side_of_vertex

COMPILED = cython.compiled

SLACK = cython.declare(cython.float, 1e-5)  # of the quick tests, in samples: ten times the worst rounding of a float
NEAR = cython.declare(cython.double, 2e-6)  # of the masks, to the numbers added up: several roundings of a float


@cython.cclass
class Pixels:
    """Pixels px[0 … nx] × py[0 … ny], a step apart, sample units, in the cell (row cy, column cx)."""

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def stand_in_row(self, cy: cython.int, py: cython.p_double, ny: cython.int) -> cython.void:
        """Have the rows of pixels py, in the cells below the row cy of samples."""
        self.cy = cy
        self.py = py
        self.ny = ny
        self.middle_y = 0.5 * (py[0] + py[ny - 1])
        self.extent_y = 0.5 * (py[ny - 1] - py[0]) + SLACK
        self.mid_y = cython.cast(cython.float, self.middle_y - cy)
        self.half_y = cython.cast(cython.float, self.extent_y)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def stand_in_column(self, cx: cython.int, px: cython.p_double, nx: cython.int) -> cython.void:
        """Have the columns of pixels px, in the cells right of the column cx of samples."""
        self.cx = cx
        self.px = px
        self.nx = nx
        self.middle_x = 0.5 * (px[0] + px[nx - 1])
        self.extent_x = 0.5 * (px[nx - 1] - px[0]) + SLACK
        self.mid_x = cython.cast(cython.float, self.middle_x - cx)
        self.half_x = cython.cast(cython.float, self.extent_x)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def half_plane(
        self,
        ax: cython.double,
        ay: cython.double,
        bx: cython.double,
        by: cython.double,
        from_sample: cython.bint,
    ) -> cython.ulonglong:
        """The pixels on the positive side of the line from a, a vertex or else a sample, to the vertex b."""
        value: cython.double = (bx - ax) * (self.py[0] - ay) - (by - ay) * (self.px[0] - ax)
        gx: cython.double = -(by - ay) * self.step_x
        gy: cython.double = (bx - ax) * self.step_y
        least: cython.float = 0.0
        near: cython.double = NEAR * (fabs(value) + 8.0 * (fabs(gx) + fabs(gy)))
        k: cython.int
        unsure: cython.ulonglong = 0
        m: cython.ulonglong = ~below_zero(
            cython.cast(cython.float, value), cython.cast(cython.float, gx), cython.cast(cython.float, gy),
            cython.address(least), self.wide,
        )  # fmt: skip
        if least > near:
            return m
        for k in range(64):
            if fabs(value + (k & 7) * gx + (k >> 3) * gy) <= 2.0 * near:
                unsure |= cython.cast(cython.ulonglong, 1) << k
        return self.exactly(ax, ay, bx, by, from_sample, m, unsure)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def exactly(
        self,
        ax: cython.double,
        ay: cython.double,
        bx: cython.double,
        by: cython.double,
        from_sample: cython.bint,
        m: cython.ulonglong,
        unsure: cython.ulonglong,
    ) -> cython.ulonglong:
        """A mask with those of its pixels that are unsure decided by the exact predicates."""
        k: cython.int
        bit: cython.ulonglong
        side: cython.int
        unsure &= self.pixels()
        for k in range(64):
            bit = cython.cast(cython.ulonglong, 1) << k
            if unsure & bit:
                if from_sample:
                    side = side_of_vertex(self.px[k & 7], self.py[k >> 3], ax, ay, bx, by)
                else:
                    side = side_of_query(ax, ay, bx, by, self.px[k & 7], self.py[k >> 3])
                m = m | bit if side > 0 else m & ~bit
        return m
