cimport cython

@cython.final
cdef class Desk:
    cdef double* bits  # 256 × 8: a byte as eight numbers, 0 or 1 for each bit
    cdef float* bits_single
    cdef double* alpha  # 16 × 64: attenuation of each sample
    cdef float* alpha_single
    cdef double* nodes  # (size) × 64: distance from each pixel to a node, FAR where that is hidden
    cdef float* nodes_single
    cdef unsigned long long* node_mask
    cdef int used, size
    cdef unsigned char[16] shaded  # for each sample the set of rows of pixels of which some do not see it
    cdef unsigned char[16] mixed  # those of them where its attenuation is not zero throughout
    cdef int another_node(self, unsigned long long seen) noexcept nogil
