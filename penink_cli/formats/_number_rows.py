# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""JSON arrays of numbers, or of pairs of numbers, read in bulk.

A 12-megapixel photograph of grass has a million edges, 63 MB of text: json takes 5 seconds and
1.3 GB for it, these loops 0.5 seconds and the memory of the result. They take plain numbers (no exponent, at
most 15 digits, so that one correctly rounded division gives the double that `float` gives) and
leave everything else, right or wrong, to json.
"""

import cython

COMPILED = cython.compiled


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
@cython.inline
def _blank(text: cython.p_const_uchar, at: cython.Py_ssize_t) -> cython.Py_ssize_t:
    """Skip white space, as JSON has it."""
    while text[at] == 32 or text[at] == 10 or text[at] == 13 or text[at] == 9:
        at += 1
    return at


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _number(
    text: cython.p_const_uchar, at: cython.Py_ssize_t, whole: cython.bint, value: cython.p_double
) -> cython.Py_ssize_t:
    """Read a number; the place after it, or -1 where there is no plain one."""
    mantissa: cython.longlong = 0
    digits: cython.int = 0
    scale: cython.double = 1.0
    result: cython.double
    negative: cython.bint = False
    if text[at] == 45:  # -
        negative = True
        at += 1
    if text[at] == 48 and 48 <= text[at + 1] <= 57:  # a zero stands alone before the point
        return -1
    while 48 <= text[at] <= 57:
        mantissa = mantissa * 10 + (text[at] - 48)
        digits += 1
        at += 1
        if digits > 15:
            return -1
    if digits == 0:
        return -1
    if text[at] == 46 and not whole:  # .
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
    value[0] = -result if negative else result
    return at


def parse(
    text: cython.const[cython.uchar][::1],  # type: ignore[valid-type]
    start: cython.Py_ssize_t,
    group: cython.int,
    whole: cython.bint,
    out: cython.double[::1],
) -> tuple[int, int]:
    """Read the array whose opening bracket stands before ``start``: (place after its closing one, numbers read).

    text: not empty, its last byte a zero, which stops every loop.
    group: 1 for an array of numbers, 2 for an array of pairs. whole: take whole numbers only. out: room for the
    numbers. The place is -1 where something is not plain, or the room is too small.
    """
    data: cython.p_const_uchar = cython.address(text[0])
    at: cython.Py_ssize_t = start
    filled: cython.Py_ssize_t = 0
    room: cython.Py_ssize_t = out.shape[0]
    value: cython.double = 0.0
    k: cython.int
    with cython.nogil:
        at = _blank(data, at)
        if data[at] == 93:  # ]
            at += 1
        else:
            while True:
                if filled + group > room:
                    at = -1
                    break
                if group == 2:
                    if data[at] != 91:  # [
                        at = -1
                        break
                    at = _blank(data, at + 1)
                for k in range(group):
                    if k > 0:
                        at = _blank(data, at)
                        if data[at] != 44:  # ,
                            at = -1
                            break
                        at = _blank(data, at + 1)
                    at = _number(data, at, whole, cython.address(value))
                    if at < 0:
                        break
                    out[filled] = value
                    filled += 1
                if at < 0:
                    break
                at = _blank(data, at)
                if group == 2:
                    if data[at] != 93:
                        at = -1
                        break
                    at = _blank(data, at + 1)
                if data[at] == 44:
                    at = _blank(data, at + 1)
                elif data[at] == 93:
                    at += 1
                    break
                else:
                    at = -1
                    break
    return at, filled
