cimport cython

from penink_cli.reconstruction._compiled.search cimport Finder
from penink_cli.reconstruction._compiled.nearby_edges cimport NearbyEdges


@cython.final
cdef class Tile(NearbyEdges):
    cdef Finder finder
    cdef int gather_radius
    cdef bint gathered_wide
    cdef unsigned long long[16] hidden
    cdef int shaded
    cdef int* node_stamp
    cdef int* node_place
    cdef bint see(self) except -1 nogil
    cdef int node_mask(self, int node, unsigned long long* seen) except -1 nogil
    cdef unsigned long long edge_mask(self, int k) noexcept nogil
    cdef void draw_lines(self, int k, int samples) noexcept nogil
