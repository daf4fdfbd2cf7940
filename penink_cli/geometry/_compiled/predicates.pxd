from libc.math cimport fabs

cdef int exactly(double ax, double ay, double bx, double by, double cx, double cy) noexcept nogil


cdef inline int orient(double ax, double ay, double bx, double by, double cx, double cy) noexcept nogil:
    """Exact sign of (b − a) × (c − a): 1, −1 or 0. It stands here so that kernels have it without a call."""
    cdef double left = (bx - ax) * (cy - ay)
    cdef double right = (by - ay) * (cx - ax)
    cdef double area = left - right
    cdef double bound = 3.3306690738754716e-16 * (fabs(left) + fabs(right))  # (3 + 16 u) u with u = 2⁻⁵³
    if area > bound:
        return 1
    if area < -bound:
        return -1
    return exactly(ax, ay, bx, by, cx, cy)
