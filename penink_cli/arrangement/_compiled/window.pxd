cimport cython

from penink_cli.arrangement._compiled.place cimport MOST_VERTICES, Place
from penink_cli.arrangement._compiled.regions cimport MOST_UNKNOWN, Regions


cdef class Window(Regions):
    cdef float[:, ::1] photo
    cdef double spread
    cdef int moved
    cdef Place rendered
    cdef double left_unexplained
    cdef bint nothing_rendered
    cdef int[MOST_VERTICES] number
    cdef double[:, ::1] normal_matrix, kept, prior, step, ends
    cdef double[::1] residual, response, right_hand_side, grey, gradient
    cdef int[MOST_UNKNOWN] starts, stops
    cdef bint enumerate(self, Place place, int centre) noexcept nogil
    cdef int open(self, int top, int left, int bottom, int right, int halo) noexcept nogil
    cdef void accumulate(self, int known, int unknown) noexcept nogil
    cdef void solve(self, int unknown) noexcept nogil
    cdef double render(self, Place place) noexcept nogil
    cdef double render_anew(self, Place place) noexcept nogil
    cdef double grey_at(self, double x, double y) noexcept nogil
    cdef bint splat(self, double x, double y, double* over, int* box) noexcept nogil
    cdef void jacobian(self, Place place, int base) noexcept nogil
    cdef double predicted_gain(self, Place place, int e, double part) noexcept nogil
    cdef double bell(self, double d) noexcept nogil
    cdef double prior_cost(self, Place place) noexcept nogil
    cdef double settle(self, Place place, Place trial, int rounds, double wanted) noexcept nogil
