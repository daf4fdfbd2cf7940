# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: least squares against what a camera saw of a reconstruction that is a matrix. See fit.py."""


cdef extern from "fit_rows.h" nogil:
    void see_row(
        const float* weight, const int* base, const float* samples, Py_ssize_t stride, float* out, Py_ssize_t n
    )
    void unsee_row(
        const float* weight, const int* base, float* samples, Py_ssize_t stride, const float* pixels, Py_ssize_t n
    )


cdef void _see(
    float[:, :, ::1] weight, int* x_base, int* y_base, float[:, ::1] samples, float[:, ::1] out
) noexcept nogil:
    """Pixels of a block from its samples; the bases are counted from the block's first sample."""
    cdef Py_ssize_t p
    for p in range(weight.shape[0]):
        see_row(&weight[p, 0, 0], x_base, &samples[y_base[p], 0], samples.shape[1], &out[p, 0], weight.shape[1])


cdef void _unsee(
    float[:, :, ::1] weight, int* x_base, int* y_base, float[:, ::1] pixels, float[:, ::1] out
) noexcept nogil:
    """The transpose of `_see`."""
    cdef Py_ssize_t p
    out[:, :] = 0
    for p in range(weight.shape[0]):
        unsee_row(&weight[p, 0, 0], x_base, &out[y_base[p], 0], out.shape[1], &pixels[p, 0], weight.shape[1])


cdef inline Py_ssize_t _reflected(Py_ssize_t i, Py_ssize_t n) noexcept nogil:
    """Index i of (d c b a | a b c d | d c b a), which keeps the blur its own transpose."""
    while i < 0 or i >= n:
        i = -1 - i if i < 0 else 2 * n - 1 - i
    return i


cdef void _blur(float[::1] kernel, float[:, ::1] pixels, float[:, ::1] room) noexcept nogil:
    """Convolve pixels with a symmetric kernel (its centre first) along both axes, in place."""
    cdef Py_ssize_t p, q, d, a, b
    cdef float k
    cdef Py_ssize_t h = pixels.shape[0]
    cdef Py_ssize_t w = pixels.shape[1]
    cdef Py_ssize_t reach = kernel.shape[0] - 1
    if reach == 0:
        return
    for p in range(h):
        for q in range(w):
            room[p, q] = kernel[0] * pixels[p, q]
        for d in range(1, reach + 1):
            k = kernel[d]
            a = _reflected(p - d, h)
            b = _reflected(p + d, h)
            for q in range(w):
                room[p, q] += k * (pixels[a, q] + pixels[b, q])
    for p in range(h):
        for q in range(w):
            pixels[p, q] = kernel[0] * room[p, q]
        for d in range(1, reach + 1):
            k = kernel[d]
            for q in range(min(d, w)):
                pixels[p, q] += k * (room[p, _reflected(q - d, w)] + room[p, _reflected(q + d, w)])
            for q in range(d, w - d):
                pixels[p, q] += k * (room[p, q - d] + room[p, q + d])
            for q in range(max(d, w - d), w):
                pixels[p, q] += k * (room[p, _reflected(q - d, w)] + room[p, _reflected(q + d, w)])


cdef double _square(float[:, ::1] v) noexcept nogil:
    """‖v‖²."""
    cdef Py_ssize_t i, j
    cdef float row
    cdef double total = 0.0
    for i in range(v.shape[0]):
        row = 0.0
        for j in range(v.shape[1]):
            row += v[i, j] * v[i, j]
        total += row
    return total


def solve(
    float[:, :, ::1] weight, int[::1] x_base, int[::1] y_base, float[::1] kernel, float[:, ::1] photo, float hold,
    int steps, float[:, ::1] samples, float[:, :, ::1] room, float[:, :, ::1] pixel_room,
) -> None:
    """Conjugate gradients for ‖B R s − photo‖² + hold ‖s − s₀‖² over one block, samples being s₀ and then s.

    samples: at least 5 × 5; weight, x_base, y_base: as of `rows.rows`, the bases counted from the first sample.
    room: (3, rows, columns) of samples; pixel_room: (2, rows, columns) of pixels; to work in.
    """
    cdef Py_ssize_t i, j
    cdef double square, next_square
    cdef float step, turn
    cdef int* columns = &x_base[0]
    cdef int* rows = &y_base[0]
    cdef float[:, ::1] g = room[0]
    cdef float[:, ::1] way = room[1]
    cdef float[:, ::1] change = room[2]
    cdef float[:, ::1] seen = pixel_room[0]
    cdef float[:, ::1] spare = pixel_room[1]
    with nogil:
        _see(weight, columns, rows, samples, seen)
        _blur(kernel, seen, spare)
        for i in range(photo.shape[0]):
            for j in range(photo.shape[1]):
                seen[i, j] = photo[i, j] - seen[i, j]
        _blur(kernel, seen, spare)
        _unsee(weight, columns, rows, seen, g)
        way[:, :] = g
        square = _square(g)
        for _ in range(steps):
            if square < 1e-14:
                break
            _see(weight, columns, rows, way, seen)
            _blur(kernel, seen, spare)
            step = <float>(square / (_square(seen) + hold * _square(way)))
            _blur(kernel, seen, spare)
            _unsee(weight, columns, rows, seen, change)
            for i in range(g.shape[0]):
                for j in range(g.shape[1]):
                    samples[i, j] += step * way[i, j]
                    g[i, j] -= step * (change[i, j] + hold * way[i, j])
            next_square = _square(g)
            turn = <float>(next_square / square)
            for i in range(g.shape[0]):
                for j in range(g.shape[1]):
                    way[i, j] = g[i, j] + turn * way[i, j]
            square = next_square
