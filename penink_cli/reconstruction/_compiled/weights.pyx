# cython: boundscheck=False, wraparound=False, cdivision=True
"""The reconstruction at single points: the weight that equation 5 gives to each sample under the kernel.

Slower than the tiles of an enlargement, and free of their conditions: any points, any widening of the kernels. Images
are made smaller so (`lattice`); at single points (`scattered`) tests hold the tiles to it.
"""

from penink_cli.reconstruction._compiled.search cimport Finder

cdef double T1 = 0.5  # below this sum of cubic weights the B-spline is blended in
cdef double T2 = 1e-4  # below this sum of B-spline weights plain convolution is faded in


cdef double smooth(double t) noexcept nogil:
    """S(t) = 3t² − 2t³, clamped."""
    return 0.0 if t <= 0.0 else (1.0 if t >= 1.0 else t * t * (3.0 - 2.0 * t))


cdef int clamp(int k, int n) noexcept nogil:
    """The nearest index that exists."""
    return 0 if k < 0 else (n - 1 if k >= n else k)


cdef double weigh(
    Finder finder, double px, double py, int j0, int i0, double* xc, double* xb, int nx, double* yc, double* yb, int ny,
    double r, bint only_b, double* out,
) except -1 nogil:
    """Weights of the ny × nx taps from (row i0, column j0) on, which sum to one; returned, how starved the point is.

    Taps beyond the frame are replicated: the weight of their own place, the visibility and detour of their source.
    """
    cdef int a, b
    cdef double alpha
    cdef double* row
    cdef int w = finder.scene.width
    cdef int h = finder.scene.height
    cdef int k = 0
    cdef double sum_c = 0.0, sum_b = 0.0, omega = 0.0, fade = 0.0, norm = 0.0
    cdef int left = clamp(j0, w)
    cdef int right = clamp(j0 + nx - 1, w)
    cdef int top = clamp(i0, h)
    cdef int bottom = clamp(i0 + ny - 1, h)
    if finder.scene.n_edges == 0 or not finder.attenuate(px, py, top, bottom, left, right, r):
        for a in range(ny):
            for b in range(nx):
                out[k] = yb[a] * xb[b] if only_b else yc[a] * xc[b]
                k += 1
        return 0.0
    for a in range(ny):
        row = finder.alpha + (clamp(i0 + a, h) - top) * (right - left + 1) - left
        for b in range(nx):
            alpha = row[clamp(j0 + b, w)]
            sum_c += alpha * (yc[a] * xc[b])
            sum_b += alpha * (yb[a] * xb[b])
    if not only_b:
        omega = smooth(sum_c / T1)
    fade = 1.0 - smooth(sum_b / T2)
    norm = omega * sum_c + (1.0 - omega) * sum_b
    norm = (1.0 - fade) / norm if norm > 0.0 else 0.0
    for a in range(ny):
        row = finder.alpha + (clamp(i0 + a, h) - top) * (right - left + 1) - left
        for b in range(nx):
            alpha = row[clamp(j0 + b, w)]
            out[k] = norm * alpha * (omega * (yc[a] * xc[b]) + (1.0 - omega) * (yb[a] * xb[b]))
            if fade > 0.0:
                out[k] += fade * (yb[a] * xb[b] if only_b else yc[a] * xc[b])
            k += 1
    return fade


def scattered(
    Finder finder, double[:, ::1] points, int[::1] x_first, double[:, ::1] xc, double[:, ::1] xb, int[::1] y_first,
    double[:, ::1] yc, double[:, ::1] yb, double r, bint only_b, Py_ssize_t begin, Py_ssize_t end,
    long long[:, ::1] index, double[:, ::1] weight, double[::1] starved,
) -> None:
    """Sample indices, weights and starvation of the points begin … end."""
    cdef Py_ssize_t k
    cdef int a, b
    cdef int n = <int>xc.shape[1]
    cdef int w = finder.scene.width
    cdef int h = finder.scene.height
    with nogil:
        for k in range(begin, end):
            starved[k] = weigh(
                finder, points[k, 0], points[k, 1], x_first[k], y_first[k],
                &xc[k, 0], &xb[k, 0], n,
                &yc[k, 0], &yb[k, 0], n,
                r, only_b, &weight[k, 0],
            )  # fmt: skip
            for a in range(n):
                for b in range(n):
                    index[k, a * n + b] = <long long>clamp(y_first[k] + a, h) * w + clamp(x_first[k] + b, w)


def lattice(
    Finder finder, double[:, ::1] samples, double[::1] x, int[::1] x_first, double[:, ::1] xc, double[:, ::1] xb,
    double[::1] y, int[::1] y_first, double[:, ::1] yc, double[:, ::1] yb, double r, bint only_b, double[::1] weight,
    double[:, ::1] out,
) -> None:
    """Values at every crossing of the columns x and the rows y. weight: room for the taps of one point."""
    cdef Py_ssize_t p, q
    cdef int a, b, i
    cdef double total
    cdef int nx = <int>xc.shape[1]
    cdef int ny = <int>yc.shape[1]
    cdef int w = finder.scene.width
    cdef int h = finder.scene.height
    with nogil:
        for p in range(y.shape[0]):
            for q in range(x.shape[0]):
                weigh(
                    finder, x[q], y[p], x_first[q], y_first[p],
                    &xc[q, 0], &xb[q, 0], nx,
                    &yc[p, 0], &yb[p, 0], ny,
                    r, only_b, &weight[0],
                )  # fmt: skip
                total = 0.0
                for a in range(ny):
                    i = clamp(y_first[p] + a, h)
                    for b in range(nx):
                        total += weight[a * nx + b] * samples[i, clamp(x_first[q] + b, w)]
                out[p, q] = total
