# cython: boundscheck=False, wraparound=False, cdivision=True
"""The reconstruction at single points: the weight that equation 5 gives to each sample under the kernel.

Slower than the tiles of an enlargement, and free of their conditions: any points, any widening of the kernels. Images
are made smaller so (`Points.lattice`); at single points (`Points.scattered`) tests hold the tiles to it.
"""

from penink_cli.reconstruction._compiled.search cimport Finder

import numpy as np

cdef double T1 = 0.5  # below this sum of cubic weights the B-spline is blended in
cdef double T2 = 1e-4  # below this sum of B-spline weights plain convolution is faded in


cdef double smooth(double t) noexcept nogil:
    """S(t) = 3t² − 2t³, clamped."""
    return 0.0 if t <= 0.0 else (1.0 if t >= 1.0 else t * t * (3.0 - 2.0 * t))


cdef int clamp(int k, int n) noexcept nogil:
    """The nearest index that exists."""
    return 0 if k < 0 else (n - 1 if k >= n else k)


cdef class Axis:
    """`kernels.Taps`: of positions along one axis the first sample under the kernel, and the weights of those on."""

    cdef double[::1] where
    cdef int[::1] first
    cdef double[:, ::1] cubic, bspline
    cdef int count  # of weights

    def __init__(self, taps) -> None:
        self.where = taps.where
        self.first = taps.first
        self.cubic = taps.cubic
        self.bspline = taps.bspline
        self.count = <int>taps.cubic.shape[1]


cdef class Points:
    """The reconstruction at points whose places along both axes have the taps given.

    finder: of detours. radius: of the kernel, sample units. only_b: B-spline weights alone.
    """

    cdef Finder finder
    cdef Axis x, y
    cdef double radius
    cdef bint only_b

    def __init__(self, Finder finder, x, y, double radius, bint only_b) -> None:
        self.finder = finder
        self.x = Axis(x)
        self.y = Axis(y)
        self.radius = radius
        self.only_b = only_b

    cdef double weigh(self, Py_ssize_t q, Py_ssize_t p, double* out) except -1 nogil:
        """Weights of the taps at place q along x and p along y, which sum to one; returned, how starved the point is.

        Taps beyond the frame are replicated: the weight of their own place, the visibility and detour of their source.
        """
        cdef int a, b
        cdef double alpha
        cdef double* row
        cdef bint only_b = self.only_b
        cdef int w = self.finder.scene.width
        cdef int h = self.finder.scene.height
        cdef int k = 0
        cdef int nx = self.x.count, ny = self.y.count, j0 = self.x.first[q], i0 = self.y.first[p]
        cdef double* xc = &self.x.cubic[q, 0]
        cdef double* xb = &self.x.bspline[q, 0]
        cdef double* yc = &self.y.cubic[p, 0]
        cdef double* yb = &self.y.bspline[p, 0]
        cdef double sum_c = 0.0, sum_b = 0.0, omega = 0.0, fade = 0.0, norm = 0.0
        cdef int left = clamp(j0, w)
        cdef int right = clamp(j0 + nx - 1, w)
        cdef int top = clamp(i0, h)
        cdef int bottom = clamp(i0 + ny - 1, h)
        if self.finder.scene.n_edges == 0 or not self.finder.attenuate(
            self.x.where[q], self.y.where[p], top, bottom, left, right, self.radius
        ):
            for a in range(ny):
                for b in range(nx):
                    out[k] = yb[a] * xb[b] if only_b else yc[a] * xc[b]
                    k += 1
            return 0.0
        for a in range(ny):
            row = self.finder.alpha + (clamp(i0 + a, h) - top) * (right - left + 1) - left
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
            row = self.finder.alpha + (clamp(i0 + a, h) - top) * (right - left + 1) - left
            for b in range(nx):
                alpha = row[clamp(j0 + b, w)]
                out[k] = norm * alpha * (omega * (yc[a] * xc[b]) + (1.0 - omega) * (yb[a] * xb[b]))
                if fade > 0.0:
                    out[k] += fade * (yb[a] * xb[b] if only_b else yc[a] * xc[b])
                k += 1
        return fade

    def scattered(
        self, Py_ssize_t begin, Py_ssize_t end, long long[:, ::1] index, double[:, ::1] weight, double[::1] starved
    ) -> None:
        """Sample indices, weights and starvation of the points begin … end, point k at place k along both axes."""
        cdef Py_ssize_t k
        cdef int a, b
        cdef int nx = self.x.count, ny = self.y.count
        cdef int w = self.finder.scene.width
        cdef int h = self.finder.scene.height
        with nogil:
            for k in range(begin, end):
                starved[k] = self.weigh(k, k, &weight[k, 0])
                for a in range(ny):
                    for b in range(nx):
                        index[k, a * nx + b] = (
                            <long long>clamp(self.y.first[k] + a, h) * w + clamp(self.x.first[k] + b, w)
                        )

    def lattice(self, double[:, ::1] samples, double[:, ::1] out) -> None:
        """Values at every crossing of the places along x and along y, into out (y's, x's)."""
        cdef Py_ssize_t p, q
        cdef int a, b, i
        cdef double total
        cdef int nx = self.x.count, ny = self.y.count
        cdef int w = self.finder.scene.width
        cdef int h = self.finder.scene.height
        cdef double[::1] weight = np.empty(nx * ny)
        with nogil:
            for p in range(out.shape[0]):
                for q in range(out.shape[1]):
                    self.weigh(q, p, &weight[0])
                    total = 0.0
                    for a in range(ny):
                        i = clamp(self.y.first[p] + a, h)
                        for b in range(nx):
                            total += weight[a * nx + b] * samples[i, clamp(self.x.first[q] + b, w)]
                    out[p, q] = total
