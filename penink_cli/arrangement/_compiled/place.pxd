cimport cython

cdef enum:
    MOST_VERTICES = 48
    MOST_EDGES = 32
    NEW = -1


@cython.final
cdef class Place:
    cdef int vertices, edges
    cdef double[MOST_VERTICES] x
    cdef double[MOST_VERTICES] y
    cdef int[MOST_VERTICES] name
    cdef bint[MOST_VERTICES] free
    cdef int[MOST_VERTICES] degree
    cdef int[MOST_EDGES] a
    cdef int[MOST_EDGES] b
    cdef int[MOST_EDGES] segment
    cdef int[MOST_EDGES] line
    cdef void take(self, Place other) noexcept nogil
    cdef bint looks_like(self, Place other) noexcept nogil
    cdef int vertex(self, double x, double y, int name) noexcept nogil
    cdef void edge(self, int a, int b, int segment, int line) noexcept nogil
    cdef void count(self) noexcept nogil
    cdef double apart(self, int u, int v) noexcept nogil
    cdef double from_place(self, int v, double x, double y) noexcept nogil
    cdef double foot(self, int v, int e) noexcept nogil
    cdef int other(self, int v, int but, int skip) noexcept nogil
    cdef bint linked(self, int u, int v) noexcept nogil
    cdef double side(self, int u, int v, int w) noexcept nogil
    cdef bint crosses(self, int u, int v) noexcept nogil
    cdef void find_leading_out(self) noexcept nogil
    cdef double turn(self, int v, double* arm) noexcept nogil
    cdef void unite(self, int a, int b, double x, double y) noexcept nogil
    cdef void split(self, int e, int v) noexcept nogil
    cdef bint meeting(self, int a, int b, double* x, double* y) noexcept nogil
    cdef int pass_by(self, int v) noexcept nogil
