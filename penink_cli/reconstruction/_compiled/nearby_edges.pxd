cimport cython

from penink_cli.reconstruction._compiled.pixels cimport Pixels
from penink_cli.reconstruction._compiled.scene cimport Scene

cdef int* zeros(Py_ssize_t n) except NULL nogil


cdef class NearbyEdges(Pixels):
    cdef Scene scene
    cdef float[4] sx
    cdef float[4] sy
    cdef int[4] column
    cdef int[4] row
    cdef int* edge_stamp
    cdef int* vertex_stamp
    cdef int* vertex_place
    cdef int now
    cdef int n_edges, n_vertices, size_edges, size_vertices
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
    cdef void place_in_row(self, int cy, double* py, int ny) noexcept nogil
    cdef void place(self, int cx, double* px, int nx) noexcept nogil
    cdef int gather(self, int radius) except -1 nogil
    cdef int enter_vertex(self, int v) except -1 nogil
    cdef void classify_vertex(self, int k) noexcept nogil
    cdef void classify_edge(self, int k, bint samples_too) noexcept nogil
