cdef class Planar:
    cdef readonly long long[:, ::1] vertices
    cdef readonly int[:, ::1] ends
    cdef readonly unsigned char[::1] live
    cdef int[:, ::1] _head
    cdef int[:, ::1] _entry
    cdef int[::1] _ignored
    cdef int _stamp, _free, _vacant
    cdef long long _cell
    cdef void _span(
        self, long long row, long long ax, long long ay, long long bx, long long by, int* span
    ) noexcept nogil
    cdef void _link(self, Py_ssize_t first) noexcept
    cdef int _extend(self, int needed) except -1
    cpdef int add(self, int s) except -1
    cpdef void remove(self, int s)
    cpdef void ignore_none(self)
    cpdef void ignore(self, int s)
    cpdef bint fits(self, int a, int b)
    cdef int within(self, double left, double top, double right, double bottom, int* found, int most) noexcept nogil
    cdef bint _through(self, int s, double left, double top, double right, double bottom) noexcept nogil
