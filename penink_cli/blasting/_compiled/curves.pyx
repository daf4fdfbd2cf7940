# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled loops: points on chains of cubic Béziers, and parts of them. Only `curves` imports this module."""

from penink_cli.ground._compiled.cubics cimport part


def sample(
    double[:, ::1] points, long long[::1] first, long long[::1] pieces, long long[::1] begin, double[:, ::1] out
):
    """Each cubic's start and inner points at equal steps of the parameter, and the last point of each chain.

    first: (n + 1,) where the control points of each chain begin; pieces: for each cubic of all chains; begin: (n + 1,)
    where the samples of each begin in out.
    """
    cdef Py_ssize_t i, p, k, to
    cdef double t, u, a, b, c, d
    cdef Py_ssize_t cubic = 0
    with nogil:
        for i in range(first.shape[0] - 1):
            to = begin[i]
            p = first[i]
            while p + 3 < first[i + 1]:
                for k in range(pieces[cubic]):
                    t = <double>k / pieces[cubic]
                    u = 1.0 - t
                    a = u * u * u
                    b = 3.0 * u * u * t
                    c = 3.0 * u * t * t
                    d = t * t * t
                    out[to, 0] = a * points[p, 0] + b * points[p + 1, 0] + (c * points[p + 2, 0] + d * points[p + 3, 0])
                    out[to, 1] = a * points[p, 1] + b * points[p + 1, 1] + (c * points[p + 2, 1] + d * points[p + 3, 1])
                    to += 1
                cubic += 1
                p += 3
            out[to, 0] = points[p, 0]
            out[to, 1] = points[p, 1]


cdef inline double between(double v, double low, double high) noexcept nogil:
    v = v if v > low else low
    return v if v < high else high


def extents(
    const long long[::1] segments, const long long[::1] run, const long long[::1] curve, double[::1] a, double[::1] b,
    long long[:, ::1] within,
) -> None:
    """Which cubics the parts of curves lie in: within (n, 2) the first and the one past the last.

    segments: (curves + 1,) where each curve's cubics begin; run: (cubics + 1,) where each cubic's samples begin.
    a, b: (n,) from where to where along its curve each part is, in samples: clipped to it.
    """
    cdef Py_ssize_t i, low, high, m, begin, end
    cdef long long base
    with nogil:
        for i in range(curve.shape[0]):
            begin = segments[curve[i]]
            end = segments[curve[i] + 1]
            base = run[begin]
            a[i] = between(a[i], 0.0, <double>(run[end] - base))
            b[i] = between(b[i], a[i], <double>(run[end] - base))
            within[i, 0] = within[i, 1] = begin
            if begin == end:
                continue
            low, high = begin, end - 1  # the last cubic that begins no later than a
            while low < high:
                m = (low + high + 1) // 2
                if run[m] <= base + a[i]:
                    low = m
                else:
                    high = m - 1
            within[i, 0] = low
            high = end - 1  # the last one that begins before b, or that of a
            while low < high:
                m = (low + high + 1) // 2
                if run[m] < base + b[i]:
                    low = m
                else:
                    high = m - 1
            within[i, 1] = low + 1


def cut(
    const double[:, ::1] points, const long long[::1] first, const long long[::1] segments, const long long[::1] run,
    const long long[::1] curve, const double[::1] a, const double[::1] b, const long long[:, ::1] within,
    const long long[::1] begin, double[:, ::1] out,
) -> None:
    """The parts of curves that `extents` has told of: begin (n + 1,) where the control points of each begin in out."""
    cdef Py_ssize_t i, k, to, at
    cdef double t0, t1
    cdef long long base
    with nogil:
        for i in range(curve.shape[0]):
            to = begin[i]
            base = run[segments[curve[i]]]
            at = first[curve[i]] + 3 * (within[i, 0] - segments[curve[i]])
            for k in range(begin[i + 1] - to):
                out[to + k, 0] = points[at + k, 0]
                out[to + k, 1] = points[at + k, 1]
            for k in range(within[i, 0], within[i, 1]):
                t0 = between((a[i] - (run[k] - base)) / (run[k + 1] - run[k]), 0.0, 1.0)
                t1 = between((b[i] - (run[k] - base)) / (run[k + 1] - run[k]), 0.0, 1.0)
                if t0 > 0.0 or t1 < 1.0:
                    part(&points[at, 0], t0, t1, &out[to, 0])
                to += 3
                at += 3
