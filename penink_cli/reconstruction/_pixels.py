# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The pixels of one tile, up to 8 × 8 of them, and which of them lie on one side of a line.

A set of pixels is a word of 64 bits, pixel (row r, column c) at bit 8 r + c. Which pixels lie on one side of a line
is a *mask*. Nearly every line leaves the whole tile on one side, which four multiplications settle, with slack; only
where it does not are the pixels told apart, and only those next to the line by the exact predicates. So the masks are
exact, however coarse the quick test.
"""

import cython
from cython.cimports.libc.math import fabs, sqrt
from cython.cimports.penink_cli.reconstruction._lanes import (
    Four,
    all_four,
    beyond_in_columns,
    beyond_in_rows,
    close_four,
    four_at,
    less_four,
    lowest,
    more_four,
)
from cython.cimports.penink_cli.reconstruction._scene import side_of_query, side_of_vertex

COMPILED = cython.compiled

ALL = cython.declare(cython.ulonglong, 0xFFFFFFFFFFFFFFFF)
ROW = cython.declare(cython.ulonglong, 0xFF)
COLUMN = cython.declare(cython.ulonglong, 0x0101010101010101)
SLACK = cython.declare(cython.float, 1e-5)  # of the quick tests, in samples: ten times the worst rounding of a float
NEAR = cython.declare(cython.float, 2e-5)  # of the masks, in pixels: ten times the worst rounding of a float
RAMP = cython.declare(cython.float[8])  # 0 … 7


@cython.cfunc
def tabulate() -> cython.void:
    """Fill the table above."""
    k: cython.int
    for k in range(8):
        RAMP[k] = k


tabulate()


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
        self.mid_y = cython.cast(cython.float, 0.5 * (py[0] + py[ny - 1]) - cy)
        self.half_y = cython.cast(cython.float, 0.5 * (py[ny - 1] - py[0])) + SLACK

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def stand_in_column(self, cx: cython.int, px: cython.p_double, nx: cython.int) -> cython.void:
        """Have the columns of pixels px, in the cells right of the column cx of samples."""
        self.cx = cx
        self.px = px
        self.nx = nx
        self.mid_x = cython.cast(cython.float, 0.5 * (px[0] + px[nx - 1]) - cx)
        self.half_x = cython.cast(cython.float, 0.5 * (px[nx - 1] - px[0])) + SLACK

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def pixels(self) -> cython.ulonglong:
        """The set of all pixels of the tile."""
        m: cython.ulonglong = COLUMN * (ROW >> (8 - self.nx))
        return m if self.ny == 8 else m & ((cython.cast(cython.ulonglong, 1) << (8 * self.ny)) - 1)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def box_side(self, ax: cython.double, ay: cython.double, bx: cython.double, by: cython.double) -> cython.int:
        """On which side of the line a → b the whole tile lies; 0 where it does not, or nearly not."""
        dx: cython.double = bx - ax
        dy: cython.double = by - ay
        value: cython.double = dx * (self.cy + self.mid_y - ay) - dy * (self.cx + self.mid_x - ax)
        extent: cython.double = fabs(dx) * self.half_y + fabs(dy) * self.half_x
        return 1 if value > extent else (-1 if -value > extent else 0)

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
        by_rows: cython.bint = fabs(gx) >= fabs(gy)
        main: cython.double = gx if by_rows else gy
        minor: cython.double = gy if by_rows else gx
        start: Four
        slope: Four
        first: Four
        second: Four
        near: cython.int
        j: cython.int
        m: cython.ulonglong = 0
        if main == 0.0:  # a is b: every pixel is a tie
            return self.exactly(ax, ay, bx, by, from_sample, m, ALL)
        # Along line j of pixels the sign changes at v = start + j·slope; pixels beyond have the sign of main.
        main = 1.0 / main
        start = all_four(cython.cast(cython.float, -value * main))
        slope = all_four(cython.cast(cython.float, -minor * main))
        first = start + four_at(RAMP) * slope
        second = start + four_at(RAMP + 4) * slope
        # Far from the pixels it is not near one: 8.25 and −0.75 stand for all that is beyond them.
        first = less_four(more_four(first, all_four(-0.75)), all_four(8.25))
        second = less_four(more_four(second, all_four(-0.75)), all_four(8.25))
        m = beyond_in_rows(first, second) if by_rows else beyond_in_columns(first, second)
        if main < 0.0:
            m = ~m
        near = close_four(first, NEAR) | (close_four(second, NEAR) << 4)
        while near:
            j = lowest(near)
            near &= near - 1
            m = self.exactly(ax, ay, bx, by, from_sample, m, ROW << (8 * j) if by_rows else COLUMN << j)
        return m

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

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def nearest(self, x: cython.double, y: cython.double) -> cython.double:
        """Distance from a point to the box of the tile, or a little less."""
        dx: cython.double = fabs(self.cx + self.mid_x - x) - self.half_x
        dy: cython.double = fabs(self.cy + self.mid_y - y) - self.half_y
        dx = 0.0 if dx < 0.0 else dx
        dy = 0.0 if dy < 0.0 else dy
        return sqrt(dx * dx + dy * dy)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def farthest(self, x: cython.double, y: cython.double) -> cython.double:
        """Distance from a point to the farthest corner of the tile, or a little more."""
        dx: cython.double = fabs(self.cx + self.mid_x - x) + self.half_x
        dy: cython.double = fabs(self.cy + self.mid_y - y) + self.half_y
        return sqrt(dx * dx + dy * dy)
