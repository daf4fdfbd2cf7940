cimport cython
from libc.math cimport fabs, sqrt


cdef class Pixels:
    cdef public bint wide
    cdef int nx, ny
    cdef double* px
    cdef double* py
    cdef double step_x, step_y
    cdef int cx, cy
    cdef double middle_x, middle_y, extent_x, extent_y  # the middle of the pixels, and their half extent with slack
    cdef float mid_x, mid_y, half_x, half_y  # the same within the cell
    cdef void stand_in_row(self, int cy, double* py, int ny) noexcept nogil
    cdef void stand_in_column(self, int cx, double* px, int nx) noexcept nogil
    cdef unsigned long long half_plane(
        self, double ax, double ay, double bx, double by, bint from_sample
    ) noexcept nogil
    cdef unsigned long long exactly(
        self, double ax, double ay, double bx, double by, bint from_sample, unsigned long long m,
        unsigned long long unsure,
    ) noexcept nogil

    # Called so often that a call from another module would cost more than they do: they are inlined there.

    @cython.final
    cdef inline unsigned long long pixels(self) noexcept nogil:  # the set of all pixels of the tile
        return (0x0101010101010101ULL * (0xFFU >> (8 - self.nx))) & (0xFFFFFFFFFFFFFFFFULL >> (64 - 8 * self.ny))

    @cython.final
    cdef inline int box_side(self, double ax, double ay, double bx, double by) noexcept nogil:
        # on which side of the line a → b the whole tile lies; 0 where it does not, or nearly not
        cdef double dx = bx - ax
        cdef double dy = by - ay
        cdef double value = dx * (self.middle_y - ay) - dy * (self.middle_x - ax)
        cdef double extent = fabs(dx) * self.extent_y + fabs(dy) * self.extent_x
        return 1 if value > extent else (-1 if -value > extent else 0)

    @cython.final
    cdef inline bint beyond(self, double x, double y, double limit) noexcept nogil:
        # whether the box of the tile is that far from a point; not in doubt by less than the box's slack
        cdef double dx = fabs(self.middle_x - x) - self.extent_x
        cdef double dy = fabs(self.middle_y - y) - self.extent_y
        dx += fabs(dx)  # twice what is above zero, without a branch
        dy += fabs(dy)
        return dx * dx + dy * dy >= 4.0 * limit * limit

    @cython.final
    cdef inline double farthest(self, double x, double y) noexcept nogil:
        # distance from a point to the farthest corner of the tile, or a little more
        cdef double dx = fabs(self.middle_x - x) + self.extent_x
        cdef double dy = fabs(self.middle_y - y) + self.extent_y
        return sqrt(dx * dx + dy * dy)
