cdef Py_ssize_t cell(double subpixels) noexcept nogil
cdef double half_width(double width, double gain, double dx, double dy) noexcept nogil
cdef int bar(
    unsigned long long* bits, Py_ssize_t rows, Py_ssize_t columns, double x0, double y0, double x1, double y1, double r,
    bint cap0, bint cap1, bint write,
) noexcept nogil
cdef long long stroke(
    unsigned long long* bits, Py_ssize_t rows, Py_ssize_t columns, double* points, Py_ssize_t n, double ox, double oy,
    double width, double gain, double* fresh, Py_ssize_t band, Py_ssize_t height,
) noexcept nogil
