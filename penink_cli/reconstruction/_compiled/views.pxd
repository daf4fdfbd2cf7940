cimport cython

from penink_cli.reconstruction._compiled.scene cimport Scene

cdef bint worth(double x, double y, double length, double radius) noexcept nogil


@cython.final
cdef class Views:
    cdef Scene scene
    cdef double reach, radius, window
    cdef int row0, row1
    cdef int* head
    cdef int* node
    cdef int* following
    cdef double* length
    cdef Py_ssize_t room, used, size
    cdef unsigned int* alive
    cdef int* edge_stamp
    cdef int now
    cdef int look(self, int row0, int row1) except -1 nogil
    cdef int look_from(self, int n) except -1 nogil
    cdef void block(self, int n, int e, int c0, int c1, int r0, int r1) noexcept nogil
    cdef int enter(self, int n, int c0, int c1, int r0, int r1) except -1 nogil
