cimport cython

@cython.final
cdef class Desk:
    cdef void* bits
    cdef void* ux
    cdef void* uy
    cdef void* kx
    cdef void* ky
    cdef void* weights
    cdef int[2] known_weights
    cdef void* values
    cdef void* spread
    cdef void* distance
    cdef int known
    cdef void* alpha
    cdef void* nodes
    cdef unsigned long long* node_mask
    cdef int* bend
    cdef void* bend_length
    cdef int used, size
    cdef int[8] shaded
    cdef int[8] faded
    cdef int another_node(self, unsigned long long seen) noexcept nogil
