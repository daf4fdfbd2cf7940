cimport cython

from penink_cli.reconstruction._compiled.scene cimport Scene
from penink_cli.reconstruction._compiled.views cimport Views


@cython.final
# What the members hold is said in search.pyx.
cdef class Finder:
    cdef readonly Scene scene
    cdef int row0, row1
    cdef bint closed, looks
    cdef Views views
    cdef double reach, radius, from_x, from_y
    cdef int* start
    cdef int* count
    cdef int* pool_node
    cdef double* pool_length
    cdef Py_ssize_t room, pool_used, pool_size
    cdef double* distance
    cdef int* stamp
    cdef int now
    cdef int* heap_node
    cdef double* heap_key
    cdef int heap_used, heap_size
    cdef int* done
    cdef int n_done
    cdef double* alpha
    cdef int alpha_size
    cdef int push(self, int node, double key) except -1 nogil
    cdef int first_bends(self, double qx, double qy, double reach) except -1 nogil
    cdef int spread(self, double reach) except -1 nogil
    cdef int bends_of(self, int i, int j) except -1 nogil
    cdef bint attenuate(self, double px, double py, int i0, int i1, int j0, int j1, double r) except -1 nogil
    cdef double last_leg(self, double qx, double qy, double limit) noexcept nogil
    cdef double length(self, double px, double py, double qx, double qy, double limit) except -1 nogil
