# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: means over equal parts of a picture, which need not be whole pixels. See shrinking.py."""


def means(
    const float[:, ::1] picture, const double[::1] down, const double[::1] across, double[::1] sums, float[:, ::1] out
) -> None:
    """Means of picture (h, w), of any range, over the parts out (n, m) of it.

    down, across: (n + 1,), (m + 1,) where the parts begin and end, pixels, from 0 to h and to w, ascending.
    sums: (w + 1,) to work in: of each column within a row of parts, then of all columns before each.
    """
    cdef Py_ssize_t i, j, p, q, last
    cdef double top, bottom, part, running, next_running
    cdef double before, upto
    cdef Py_ssize_t h = picture.shape[0]
    cdef Py_ssize_t w = picture.shape[1]
    with nogil:
        for i in range(out.shape[0]):
            top, bottom = down[i], down[i + 1]
            last = min(h, <Py_ssize_t>bottom + 1)
            for q in range(w):
                sums[q] = 0.0
            for p in range(min(h - 1, <Py_ssize_t>top), last):
                part = min(bottom, <double>(p + 1)) - max(top, <double>p)
                if part <= 0.0:
                    continue
                for q in range(w):
                    sums[q] += part * picture[p, q]
            running = 0.0
            for q in range(w):
                next_running = running + sums[q]
                sums[q] = running
                running = next_running
            sums[w] = running
            before = 0.0
            for j in range(out.shape[1]):
                q = min(w - 1, <Py_ssize_t>across[j + 1])
                upto = sums[q] + (across[j + 1] - q) * (sums[q + 1] - sums[q])
                out[i, j] = <float>((upto - before) / ((bottom - top) * (across[j + 1] - across[j])))
                before = upto
