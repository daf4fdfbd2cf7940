cimport cython

# The arithmetic on a scratch's numbers, of which there are some makes: see `fades` and `sums`.
ctypedef void (*Measure)(Scratch scratch, int slot, int ny, double x, double y) noexcept nogil
ctypedef void (*Cover)(Scratch scratch, int s, unsigned long long hidden, int nx, int ny) noexcept nogil
ctypedef void (*Fade)(
    Scratch scratch, int s, unsigned long long hidden, int bends, int ny, int down, int across
) noexcept nogil
ctypedef void (*Paint)(Scratch scratch, int samples, int nx, int ny, void* out, Py_ssize_t stride) noexcept nogil


@cython.final
cdef class Scratch:
    cdef readonly bint single, only_b
    cdef readonly int stored
    cdef double radius, maxval
    cdef Measure measure
    cdef Cover cover
    cdef Fade fade
    cdef Paint paint
    cdef void* room
    cdef char* free_place
    cdef void* bits
    cdef void* ux
    cdef void* uy
    cdef void* kx
    cdef void* ky
    cdef void* weights
    cdef int[2] known_weights
    cdef void* values
    cdef void* distance
    cdef int known
    cdef void* alpha
    cdef void* nodes_room
    cdef void* nodes
    cdef unsigned long long* node_mask
    cdef int* bend
    cdef double* bend_length
    cdef int used, size
    cdef unsigned char[16] shaded_rows
    cdef unsigned char[16] faded_rows
    cdef void* part(self, Py_ssize_t numbers) noexcept nogil
    cdef int another_node(self, unsigned long long seen) except -1 nogil
