cdef double cubic(double x) noexcept nogil
cdef double bspline(double x) noexcept nogil
