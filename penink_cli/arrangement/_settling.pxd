cimport cython

from penink_cli.arrangement._place cimport MOST_VERTICES, Place
from penink_cli.arrangement._planar cimport Planar
from penink_cli.arrangement._window cimport Window

@cython.final
cdef class Settler(Window):
    cdef double near, floor, unit, score, wanted, left_over
    cdef int halo, pixels
    cdef bint crowded
    cdef bint[MOST_VERTICES] central
    cdef Place given, best, chosen, other, trial
    cdef int[15] segments
    cdef double[15][4] lines
    cdef bint see_site(self, Planar planar, int[::1] site, int[::1] wider, int around) noexcept nogil
    cdef bint view(self, Planar planar, int[::1] site, int around) noexcept nogil
    cdef int vertex_of(self, Planar planar, int name) noexcept nogil
    cdef void know(self, Planar planar, double[::1] step) noexcept nogil
    cdef bint hold(self, Place place, int centre) noexcept nogil
    cdef double settled(self, Place place, int rounds, int centre, double wanted) noexcept nogil
    cdef bint in_view(self, Place place, int v) noexcept nogil
    cdef bint search(self) noexcept nogil
    cdef void consider(self, int rounds, int centre) noexcept nogil
    cdef void merge(self) noexcept nogil
    cdef void join(self) noexcept nogil
    cdef void bend(self) noexcept nogil
    cdef bint within(self, int e) noexcept nogil
    cdef void shrink(self, int a, int b) noexcept nogil
    cdef void meet(self, int v, int e) noexcept nogil
    cdef void bow(self, int e, double part) noexcept nogil
    cdef void drop(self) noexcept nogil
    cdef void link(self) noexcept nogil
    cdef double contrast(self, int u, int v) noexcept nogil
