# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Strokes to the lines of a strokes file, in bulk: 0.2 µs a stroke, where repr takes 6."""

import cython

COMPILED = cython.compiled


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
@cython.inline
def _put(out: cython.p_uchar, at: cython.Py_ssize_t, word: cython.p_const_uchar) -> cython.Py_ssize_t:
    k: cython.Py_ssize_t = 0
    while word[k] != 0:
        out[at + k] = word[k]
        k += 1
    return at + k


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _fixed(
    out: cython.p_uchar, at: cython.Py_ssize_t, number: cython.longlong, decimals: cython.int
) -> cython.Py_ssize_t:
    """`number` / 10^decimals with that many decimals."""
    digits = cython.declare(cython.uchar[24])
    n: cython.int = 0
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


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
@cython.inline
def _nearest(value: cython.double) -> cython.longlong:
    """Nearest whole number, halves upwards; by truncation, as the C library's floor is a call."""
    up: cython.double = value + 0.5
    whole: cython.longlong = cython.cast(cython.longlong, up)
    return whole - 1 if up < whole else whole


def put(
    points: cython.const[cython.double][:, ::1],
    first: cython.const[cython.longlong][::1],
    widths: cython.const[cython.double][::1],
    knots: cython.const[cython.double][::1],
    start: cython.Py_ssize_t,
    stop: cython.Py_ssize_t,
    limit: cython.double,
    out: cython.uchar[::1],
) -> int:
    """Write strokes start … stop - 1 as lines into `out`; returns the number of bytes.

    knots: widths at the knots of all strokes; written of a stroke whose own are not all the same as written.
        Empty where no stroke swells.
    out: at least 64 bytes a stroke and 32 a point, 46 where strokes swell, for limit ≤ 10^7.
    Coordinates get 3 decimals, widths 4; that of a stroke is at least 0.0001.
    Returns -1 - i for the first stroke i with a number that is not finite or beyond the limit.
    """
    at: cython.Py_ssize_t = 0
    i: cython.Py_ssize_t
    k: cython.Py_ssize_t
    knot: cython.Py_ssize_t
    last: cython.Py_ssize_t
    swells: cython.bint
    whole: cython.longlong
    buffer: cython.p_uchar = cython.address(out[0])
    with cython.nogil:
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
