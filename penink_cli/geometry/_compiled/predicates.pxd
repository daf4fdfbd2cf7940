cdef int orient(double ax, double ay, double bx, double by, double cx, double cy) noexcept nogil
