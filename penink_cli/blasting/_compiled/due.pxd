cdef void splat(
    float[:, ::1] due, float[:, ::1] guide, float[:, ::1] kernel, Py_ssize_t y, Py_ssize_t x, float ink, float step
) noexcept nogil
