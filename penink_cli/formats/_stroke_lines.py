# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The lines of a strokes file, in bulk: numbers to text and plain lines back to numbers.

json and repr need 8 µs a stroke between them; these loops need 0.2, which is what lets a
third of a million dots pass between two filters in the blink of an eye.

Numbers are exact both ways: at most 15 digits over a power of ten is one correctly
rounded division, the same double that `float` gives.
"""

import cython

COMPILED = cython.compiled


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
@cython.inline
def _blank(text: cython.p_const_uchar, at: cython.Py_ssize_t) -> cython.Py_ssize_t:
    """Skip what JSON calls white space within a line."""
    while text[at] == 32 or text[at] == 9 or text[at] == 13:
        at += 1
    return at


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
@cython.inline
def _literal(text: cython.p_const_uchar, at: cython.Py_ssize_t, word: cython.p_const_uchar) -> cython.Py_ssize_t:
    """Skip white space and `word`; -1 if something else stands there."""
    k: cython.Py_ssize_t = 0
    at = _blank(text, at)
    while word[k] != 0:
        if text[at + k] != word[k]:
            return -1
        k += 1
    return at + k


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _number(text: cython.p_const_uchar, at: cython.Py_ssize_t, value: cython.p_double) -> cython.Py_ssize_t:
    """A JSON number without exponent and of at most 15 digits; -1 for anything else."""
    negative: cython.bint = False
    mantissa: cython.longlong = 0
    digits: cython.int = 0
    scale: cython.double = 1.0
    result: cython.double
    at = _blank(text, at)
    if text[at] == 45:  # -
        negative = True
        at += 1
    if text[at] == 48:  # a zero stands alone before the point
        digits = 1
        at += 1
    else:
        while 48 <= text[at] <= 57:
            mantissa = mantissa * 10 + (text[at] - 48)
            digits += 1
            at += 1
            if digits > 15:
                return -1
        if digits == 0:
            return -1
    if text[at] == 46:  # .
        at += 1
        if not 48 <= text[at] <= 57:
            return -1
        while 48 <= text[at] <= 57:
            mantissa = mantissa * 10 + (text[at] - 48)
            scale *= 10.0
            digits += 1
            at += 1
            if digits > 15:
                return -1
    result = mantissa / scale
    value[0] = -result if negative and mantissa != 0 else result
    return at


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _stroke(
    text: cython.p_const_uchar,
    at: cython.Py_ssize_t,
    limit: cython.double,
    points: cython.p_double,
    width: cython.p_double,
    count: cython.p_longlong,
) -> cython.Py_ssize_t:
    """One line, its newline included, the members in our order; -1 if it is anything else."""
    n: cython.longlong = 0
    at = _literal(text, at, b"{")
    if at < 0:
        return -1
    at = _literal(text, at, b'"width"')
    if at < 0:
        return -1
    at = _literal(text, at, b":")
    if at < 0:
        return -1
    at = _number(text, at, width)
    if at < 0 or not 0.0 < width[0] <= limit:
        return -1
    at = _literal(text, at, b",")
    if at < 0:
        return -1
    at = _literal(text, at, b'"points"')
    if at < 0:
        return -1
    at = _literal(text, at, b":")
    if at < 0:
        return -1
    at = _literal(text, at, b"[")
    if at < 0:
        return -1
    while True:
        at = _literal(text, at, b"[")
        if at < 0:
            return -1
        at = _number(text, at, points + 2 * n)
        if at < 0 or not -limit <= points[2 * n] <= limit:
            return -1
        at = _literal(text, at, b",")
        if at < 0:
            return -1
        at = _number(text, at, points + 2 * n + 1)
        if at < 0 or not -limit <= points[2 * n + 1] <= limit:
            return -1
        at = _literal(text, at, b"]")
        if at < 0:
            return -1
        n += 1
        at = _blank(text, at)
        if text[at] == 44:  # ,
            at += 1
        else:
            break
    if n % 3 != 1:
        return -1
    at = _literal(text, at, b"]")
    if at < 0:
        return -1
    at = _literal(text, at, b"}")
    if at < 0:
        return -1
    at = _blank(text, at)
    if text[at] != 10:
        return -1
    count[0] = n
    return at + 1


def parse(
    text: cython.const[cython.uchar][::1],
    start: cython.Py_ssize_t,
    limit: cython.double,
    points: cython.double[:, ::1],
    counts: cython.longlong[::1],
    widths: cython.double[::1],
) -> tuple[int, int, int]:
    """Parse lines from `start` until the end or the first line that is not plain.

    text: whole lines; its last byte is a newline (which is what stops every inner loop).
    limit: the largest width and coordinate allowed.
    points (≥ bytes / 6, 2), counts and widths (≥ bytes / 28) are filled from their beginning.
    Returns where it stopped, the number of strokes and of points.
    """
    at: cython.Py_ssize_t = start
    end: cython.Py_ssize_t = text.shape[0]
    strokes: cython.Py_ssize_t = 0
    used: cython.Py_ssize_t = 0
    following: cython.Py_ssize_t
    if end == 0 or text[end - 1] != 10:
        raise ValueError("the text must end with a newline")
    with cython.nogil:
        while at < end:
            following = _stroke(
                cython.address(text[0]), at, limit, cython.address(points[used, 0]),
                cython.address(widths[strokes]), cython.address(counts[strokes]),
            )  # fmt: skip
            if following < 0:
                break
            at = following
            used += cython.cast(cython.Py_ssize_t, counts[strokes])
            strokes += 1
    return at, strokes, used


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
    start: cython.Py_ssize_t,
    stop: cython.Py_ssize_t,
    limit: cython.double,
    out: cython.uchar[::1],
) -> int:
    """Write strokes start … stop - 1 as lines into `out`; returns the number of bytes.

    out: at least 48 bytes a stroke and 32 a point for limit ≤ 10^7.
    Coordinates get 3 decimals, widths 4 and at least 0.0001.
    Returns -1 - i for the first stroke i with a number that is not finite or beyond the limit.
    """
    at: cython.Py_ssize_t = 0
    i: cython.Py_ssize_t
    k: cython.Py_ssize_t
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
            at = _put(buffer, at, b"]}\n")
    return at
