# cython: boundscheck=False, wraparound=False, cdivision=True
"""Strokes to the lines of a strokes file, in bulk: 0.2 µs a stroke, where Python's repr takes 6."""


cdef inline Py_ssize_t _put(unsigned char* out, Py_ssize_t at, const unsigned char* word) noexcept nogil:
    """Write a word; the place behind it."""
    cdef Py_ssize_t k = 0
    while word[k] != 0:
        out[at + k] = word[k]
        k += 1
    return at + k


cdef Py_ssize_t _fixed(unsigned char* out, Py_ssize_t at, long long number, int decimals) noexcept nogil:
    """Write `number` / 10^decimals with that many decimals; the place behind it."""
    cdef unsigned char[24] digits
    cdef int n = 0
    if number < 0:
        out[at] = 45
        at += 1
        number = -number
    while number > 0 or n <= decimals:
        digits[n] = 48 + number % 10
        number //= 10
        n += 1
    while n > 0:
        n -= 1
        out[at] = digits[n]
        at += 1
        if n == decimals and n > 0:
            out[at] = 46
            at += 1
    return at


cdef inline long long _nearest(double value) noexcept nogil:
    """The nearest whole number, halves upwards; by truncation, since the C library's floor costs a call."""
    cdef double up = value + 0.5
    cdef long long whole = <long long>up
    return whole - 1 if up < whole else whole


def put(
    const double[:, ::1] points, const long long[::1] first, const double[::1] widths, const double[::1] knots,
    Py_ssize_t start, Py_ssize_t stop, double limit, unsigned char[::1] out,
) -> int:
    """Write strokes start … stop - 1 as lines into `out`: the number of bytes.

    points (p, 2), first (s + 1,), widths (s,): as of `Strokes`, points on paper. knots: (n,) widths at the knots of all
        strokes, empty where no stroke swells. A stroke whose knots' widths, rounded, are all equal is written without.
    limit: the largest coordinate and width, at most 10^7.
    out: at least 64 bytes a stroke and 32 a point, 46 where strokes swell.

    Coordinates get 3 decimals, widths 4; a stroke's width is at least 0.0001.
    Returns -1 - i for the first stroke i with a number that is not finite, beyond the limit, or a width of 0.
    """
    cdef Py_ssize_t i, k, knot, last
    cdef bint swells
    cdef long long whole
    cdef Py_ssize_t at = 0
    cdef unsigned char* buffer = &out[0]
    with nogil:
        for i in range(start, stop):
            if not 0.0 < widths[i] <= limit:
                at = -1 - i
                break
            whole = _nearest(widths[i] * 10000.0)
            at = _put(buffer, at, b'{"width": ')
            at = _fixed(buffer, at, whole if whole > 0 else 1, 4)
            at = _put(buffer, at, b', "points": [')
            for k in range(first[i], first[i + 1]):
                if not (-limit <= points[k, 0] <= limit and -limit <= points[k, 1] <= limit):
                    at = -1 - i
                    break
                if k > first[i]:
                    at = _put(buffer, at, b", ")
                buffer[at] = 91
                at = _fixed(buffer, at + 1, _nearest(points[k, 0] * 1000.0), 3)
                at = _put(buffer, at, b", ")
                at = _fixed(buffer, at, _nearest(points[k, 1] * 1000.0), 3)
                buffer[at] = 93
                at += 1
            if at < 0:
                break
            buffer[at] = 93
            at += 1
            if knots.shape[0] > 0:
                knot = (first[i] + 2 * i) // 3
                last = (first[i + 1] + 2 * i + 2) // 3
                swells = False
                for k in range(knot, last):
                    if not 0.0 <= knots[k] <= limit:
                        at = -1 - i
                        break
                    swells = swells or _nearest(knots[k] * 10000.0) != _nearest(knots[knot] * 10000.0)
                if at < 0:
                    break
                if swells:
                    at = _put(buffer, at, b', "widths": [')
                    for k in range(knot, last):
                        if k > knot:
                            at = _put(buffer, at, b", ")
                        at = _fixed(buffer, at, _nearest(knots[k] * 10000.0), 4)
                    buffer[at] = 93
                    at += 1
            at = _put(buffer, at, b"}\n")
    return at
