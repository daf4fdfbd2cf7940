cimport cython

from penink_cli.reconstruction._pixels cimport Pixels
from penink_cli.reconstruction._scene cimport Scene
from penink_cli.reconstruction._search cimport Finder

@cython.final
cdef class Tile(Pixels):
    cdef Finder finder
    cdef Scene scene
    cdef int gather_radius
    cdef float[16] sx
    cdef float[16] sy
    cdef int[4] column
    cdef int[4] row
    cdef int all_visible, all_hidden
    cdef unsigned long long[16] hidden
    cdef int* edge_stamp
    cdef int* vertex_stamp
    cdef int* vertex_place
    cdef int* node_stamp
    cdef int* node_place
    cdef int now
    cdef int n_edges, n_vertices, size_edges, size_vertices
    cdef bint gathered_wide
    cdef int* edge
    cdef int* edge_a
    cdef int* edge_b
    cdef int* tile_side
    cdef int* sample_side
    cdef int* partial
    cdef int* has_side_mask
    cdef unsigned long long* side_mask
    cdef int* vertex
    cdef float* lx
    cdef float* ly
    cdef int* positive
    cdef int* negative
    cdef int* has_line
    cdef unsigned long long* line
    cdef void place(self, int cx, int cy, double* px, int nx, double* py, int ny) noexcept nogil
    cdef bint see(self) noexcept nogil
    cdef unsigned long long node_mask(self, int node) noexcept nogil
    cdef void gather(self, int radius) noexcept nogil
    cdef int enter_vertex(self, int v) noexcept nogil
    cdef void classify_vertex(self, int k) noexcept nogil
    cdef void classify_edge(self, int k) noexcept nogil
    cdef unsigned long long edge_mask(self, int k) noexcept nogil
    cdef unsigned long long line_mask(self, int k, int sample) noexcept nogil
