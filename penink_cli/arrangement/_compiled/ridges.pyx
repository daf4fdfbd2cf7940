# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: the pixels on ridges of a picture's gradient (Canny 1986), and how uneven it is. See gradient.py.

Pictures are float32 (h, w), grey of any range. Sums are of doubles in one order and rounded to floats once, as
scipy's are, so that the ridges are those that scikit-image finds.
"""

from libc.math cimport fabsf, sqrtf
from libc.stdlib cimport free
from penink_cli.ground._compiled.memory cimport room


def unevenness(const float[:, ::1] grey, float scale, long long[::1] counts) -> None:
    """Count how large the responses to [[1, -2, 1], [-2, 4, -2], [1, -2, 1]] are, times scale, rounded down.

    counts: (n,) is added to; what is greater counts with the last.
    """
    cdef Py_ssize_t h = grey.shape[0], w = grey.shape[1], n = counts.shape[0], i, j, k
    cdef const float* row
    cdef float* lines = NULL  # three rows of what is across, and one of responses
    cdef float* above
    cdef float* here
    cdef float* below
    cdef float* size
    try:
        lines = <float*>room(4 * w, sizeof(float))
        size = lines + 3 * w
        with nogil:
            for i in range(h):
                row = &grey[i, 0]
                below = lines + w * (i % 3)
                for j in range(1, w - 1):
                    below[j] = row[j - 1] - (row[j] + row[j]) + row[j + 1]  # 2.0 would be a double
                if i < 2:
                    continue
                above, here = lines + w * ((i - 2) % 3), lines + w * ((i - 1) % 3)
                for j in range(1, w - 1):
                    size[j] = fabsf(above[j] - (here[j] + here[j]) + below[j]) * scale
                for j in range(1, w - 1):
                    k = <Py_ssize_t>size[j]
                    counts[k if k < n else n - 1] += 1
    finally:
        free(lines)


def ridges(const float[:, ::1] grey, float least, unsigned char[:, ::1] found) -> int:
    """Mark the pixels, none on the border, whose gradient is the steepest on its own way: how many there are.

    least: of Sobel's gradient. found: (h, w) zeros.
    """
    cdef Py_ssize_t h = grey.shape[0], w = grey.shape[1], i, j
    cdef int count = 0
    cdef float* lines = NULL
    cdef float* x
    cdef float* y
    cdef float* m
    if h < 3 or w < 3:
        return 0
    try:
        lines = <float*>room(9 * w, sizeof(float))  # three rows of x, y and length
        with nogil:
            for i in range(2):
                sobel(grey, i, lines + 3 * w * i)
            for i in range(1, h - 1):
                sobel(grey, i + 1, lines + 3 * w * ((i + 1) % 3))
                x = lines + 3 * w * (i % 3)
                y, m = x + w, x + 2 * w
                for j in range(1, w - 1):
                    if m[j] >= least and steepest(
                        x[j], y[j], m + j, lines + 3 * w * ((i - 1) % 3) + 2 * w + j,
                        lines + 3 * w * ((i + 1) % 3) + 2 * w + j,
                    ):
                        found[i, j] = 1
                        count += 1
        return count
    finally:
        free(lines)


cdef void sobel(const float[:, ::1] grey, Py_ssize_t i, float* out) noexcept nogil:
    """Sobel's gradient of row i: x, y and length, one after the other; beyond the border grey is mirrored."""
    cdef Py_ssize_t w = grey.shape[1], j, left, right, end
    cdef const float* above = &grey[max(0, i - 1), 0]
    cdef const float* here = &grey[i, 0]
    cdef const float* below = &grey[min(grey.shape[0] - 1, i + 1), 0]
    cdef float* x = out
    cdef float* y = out + w
    cdef float* length = out + 2 * w
    for j in range(w):
        y[j] = below[j] - above[j]
    for j in range(1, w - 1):
        x[j] = across(above[j - 1], above[j + 1], here[j - 1], here[j + 1], below[j - 1], below[j + 1])
        length[j] = <float>(2.0 * y[j] + (<double>y[j - 1] + <double>y[j + 1]))
    for end in range(2):
        j = end * (w - 1)
        left, right = max(0, j - 1), min(w - 1, j + 1)
        x[j] = across(above[left], above[right], here[left], here[right], below[left], below[right])
        length[j] = <float>(2.0 * y[j] + (<double>y[left] + <double>y[right]))
    for j in range(w):
        y[j] = length[j]
        length[j] = sqrtf(y[j] * y[j] + x[j] * x[j])


cdef inline float across(float a, float b, float c, float d, float e, float f) noexcept nogil:
    """The weighted sum of three steps to the right, the middle one twice."""
    return <float>(2.0 * <double>(d - c) + (<double>(b - a) + <double>(f - e)))


cdef inline bint steepest(float x, float y, const float* here, const float* above, const float* below) noexcept nogil:
    """Whether no length before and behind a pixel, along its gradient, is greater: each between two neighbours'.

    here, above, below: lengths at the pixel, and in the rows beside it.
    """
    cdef bint falling = (x > 0 and y < 0) or (x < 0 and y > 0)  # up to the right on the screen
    cdef float part
    if fabsf(y) > fabsf(x) or (falling and fabsf(y) == fabsf(x)):
        part = fabsf(x) / fabsf(y)
        if falling:
            return least_between(above[0], above[1], part, here[0]) and least_between(
                below[0], below[-1], part, here[0]
            )
        return least_between(below[0], below[1], part, here[0]) and least_between(above[0], above[-1], part, here[0])
    part = fabsf(y) / fabsf(x)
    if falling:
        return least_between(here[1], above[1], part, here[0]) and least_between(here[-1], below[-1], part, here[0])
    return least_between(here[1], below[1], part, here[0]) and least_between(here[-1], above[-1], part, here[0])


cdef inline bint least_between(float one, float other, float part, float most) noexcept nogil:
    """Whether what lies at that part of the way from one to the other is not more than that."""
    return other * part + one * (1.0 - part) <= most
