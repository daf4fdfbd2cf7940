cdef class Pixels:
    cdef int nx, ny
    cdef double* px
    cdef double* py
    cdef double step_x, step_y
    cdef int cx, cy
    cdef float mid_x, mid_y, half_x, half_y  # the middle of the pixels within the cell, and their half extent
    cdef void stand_in_row(self, int cy, double* py, int ny) noexcept nogil
    cdef void stand_in_column(self, int cx, double* px, int nx) noexcept nogil
    cdef unsigned long long pixels(self) noexcept nogil
    cdef int box_side(self, double ax, double ay, double bx, double by) noexcept nogil
    cdef unsigned long long half_plane(self, double ax, double ay, double bx, double by, bint from_sample) noexcept nogil
    cdef unsigned long long exactly(self, double ax, double ay, double bx, double by, bint from_sample, unsigned long long m, unsigned long long unsure) noexcept nogil
    cdef double nearest(self, double x, double y) noexcept nogil
    cdef double farthest(self, double x, double y) noexcept nogil
