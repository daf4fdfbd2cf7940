"""What `products.h` sums."""

cdef extern from "products.h" nogil:
    double dot(const double* a, const double* b, int count) noexcept
    void add_scaled(double* out, const double* numbers, double weight, int count) noexcept
