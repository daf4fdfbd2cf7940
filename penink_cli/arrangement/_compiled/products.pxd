"""What `products.h` sums."""

cdef extern from "products.h" nogil:
    double dot(const double* a, const double* b, int count) noexcept
    void add_scaled(double* out, const double* numbers, double weight, int count) noexcept
    void add_scaled_twice(
        double* out, double* more, const double* numbers, double weight, double other, int count
    ) noexcept
    ctypedef const double* Row "const double *"
    void weighted_rows(double* out, const Row* rows, const double* weights, int n, int width) noexcept
