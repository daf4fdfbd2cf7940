cimport cython

from penink_cli.arrangement._compiled.place cimport Place
from penink_cli.arrangement._compiled.planar cimport Planar
from penink_cli.arrangement._compiled.window cimport Window

cdef enum:
    AROUND = 3  # pixels around the vertices of a place that are compared with the photo
    VERTEX = 3  # the logarithm of the pixels that a vertex's two coordinates are told by


cdef class View(Window):
    cdef double near, floor, unit, trust
    cdef int halo, pixels
    cdef bint crowded
    cdef Place given, trial
    cdef int[15] segments
    cdef double[15][4] lines
    cdef bint see_site(self, Planar planar, int[::1] site, int[::1] wider, int around) noexcept nogil
    cdef bint view(self, Planar planar, int[::1] site, int around) noexcept nogil
    cdef int vertex_of(self, Planar planar, int name) noexcept nogil
    cdef void know(self, Planar planar, double[::1] step) noexcept nogil
    cdef bint hold(self, Place place, int centre) noexcept nogil
    cdef double settled(self, Place place, int rounds, int centre, double wanted) noexcept nogil
    cdef bint in_view(self, Place place, int v) noexcept nogil
