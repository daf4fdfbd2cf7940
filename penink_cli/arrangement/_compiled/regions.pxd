cimport cython

from penink_cli.arrangement._compiled.place cimport Place

cdef enum:
    FINE = 3
    MOST_SIDE = 26
    MOST_POINTS = 78
    MOST_REGIONS = 12
    MOST_MOVED = 8
    MOST_UNKNOWN = 30  # regions, two slopes, two ways for each vertex
    MOST_PIXELS = 676  # of the widest window


cdef class Regions:
    cdef double[::1] taps, sums
    cdef int top, left, rows, columns
    cdef int first_row, last_row, first_column, last_column, wide, count
    cdef unsigned char[:, ::1] walls, present
    cdef int[:, ::1] columns_of
    cdef int[::1] breaks, begin, end, start, parent, region
    cdef double[:, ::1] left_of
    cdef double[:, :, ::1] across
    cdef double[:, ::1] design
    cdef int regions
    cdef void block(self, Place place) noexcept nogil
    cdef void interrupt(self, int i, int j) noexcept nogil
    cdef void hang_together(self, int i) noexcept nogil
    cdef bint part(self, Place place) noexcept nogil
    cdef void see_along(self, int i) noexcept nogil
    cdef const double* seen_left_of(self, int column) noexcept nogil
    cdef void see(self) noexcept nogil
    cdef int region_at(self, double x, double y) noexcept nogil
