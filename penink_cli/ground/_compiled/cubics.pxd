"""The polar form of cubic Béziers, which cuts them at parameters."""


cdef inline void blossom(const double* p, double r, double s, double t, double* out) noexcept nogil:
    """The polar form at r, s, t of a cubic, 4 points x, y: one point."""
    cdef double[6] c
    cdef Py_ssize_t k
    for k in range(6):
        c[k] = p[k] + r * (p[k + 2] - p[k])
    for k in range(4):
        c[k] = c[k] + s * (c[k + 2] - c[k])
    for k in range(2):
        out[k] = c[k] + t * (c[k + 2] - c[k])


cdef inline void part(const double* p, double a, double b, double* out) noexcept nogil:
    """A cubic from a to b, 4 points x, y."""
    blossom(p, a, a, a, out)
    blossom(p, a, a, b, out + 2)
    blossom(p, a, b, b, out + 4)
    blossom(p, b, b, b, out + 6)
