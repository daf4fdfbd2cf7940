# cython: boundscheck=False, wraparound=False, cdivision=True
"""Plain JSON read in bulk: arrays of numbers, arrays of pairs, lines of a strokes file, strokes of a texture.

A 12-megapixel photograph of grass has a million edges, 63 MB of text: json takes 5 seconds and 1.3 GB for it, these
loops 0.5 seconds and the memory of the result. A stroke's line costs 0.2 µs here and 6 with json, so a third of a
million dots pass between two filters in a tenth of a second.

A number is plain if it has no exponent and at most 15 digits: its digits over a power of ten are one correctly rounded
division, the same double that `float` gives (but zero is never negative). Everything else, right or wrong, is left to
json.

Every text is a bytes object: the zero that Python keeps behind its last byte stops every loop. Every reader below takes
a place in the text and returns the place after what it read, or REFUSED where that is not plain; given REFUSED it
returns REFUSED.
"""

cdef Py_ssize_t REFUSED = -1


cdef inline Py_ssize_t _blank(const unsigned char* text, Py_ssize_t at) noexcept nogil:
    """Skip white space within a line."""
    while text[at] == 32 or text[at] == 9 or text[at] == 13:
        at += 1
    return at


cdef inline Py_ssize_t _blank_lines(const unsigned char* text, Py_ssize_t at) noexcept nogil:
    """Skip white space, newlines too."""
    while text[at] == 32 or text[at] == 10 or text[at] == 13 or text[at] == 9:
        at += 1
    return at


cdef inline Py_ssize_t _literal(const unsigned char* text, Py_ssize_t at, const unsigned char* word) noexcept nogil:
    """Skip white space within a line and `word`."""
    cdef Py_ssize_t k = 0
    if at < 0:
        return REFUSED
    at = _blank(text, at)
    while word[k] != 0:
        if text[at + k] != word[k]:
            return REFUSED
        k += 1
    return at + k


cdef Py_ssize_t _number(const unsigned char* text, Py_ssize_t at, bint whole, double* value) noexcept nogil:
    """Read a number, one without a point if `whole`."""
    cdef double result
    cdef bint negative = False
    cdef long long mantissa = 0
    cdef int digits = 0
    cdef double scale = 1.0
    if at < 0:
        return REFUSED
    if text[at] == 45:  # -
        negative = True
        at += 1
    if text[at] == 48 and 48 <= text[at + 1] <= 57:  # a zero stands alone before the point
        return REFUSED
    while 48 <= text[at] <= 57:
        mantissa = mantissa * 10 + (text[at] - 48)
        digits += 1
        at += 1
        if digits > 15:
            return REFUSED
    if digits == 0:
        return REFUSED
    if text[at] == 46 and not whole:  # .
        at += 1
        if not 48 <= text[at] <= 57:
            return REFUSED
        while 48 <= text[at] <= 57:
            mantissa = mantissa * 10 + (text[at] - 48)
            scale *= 10.0
            digits += 1
            at += 1
            if digits > 15:
                return REFUSED
    result = mantissa / scale
    value[0] = -result if negative and mantissa != 0 else result
    return at


cdef inline Py_ssize_t _within(const unsigned char* text, Py_ssize_t at, double limit, double* value) noexcept nogil:
    """Skip white space within a line and read a number from -limit to limit."""
    if at < 0:
        return REFUSED
    at = _number(text, _blank(text, at), False, value)
    return at if at >= 0 and -limit <= value[0] <= limit else REFUSED


def numbers(const unsigned char[::1] text, Py_ssize_t start, int group, bint whole, double[::1] out) -> tuple[int, int]:
    """Read the array whose opening bracket stands before ``start``: (place after its closing one, numbers read).

    text: not empty. group: 1 for an array of numbers, 2 for an array of pairs. whole: take whole numbers only.
    out: (n,) filled from its beginning. The place is -1 where something is not plain, or more than n numbers come.
    """
    cdef int k
    cdef const unsigned char* data = &text[0]
    cdef Py_ssize_t at = start
    cdef Py_ssize_t filled = 0
    cdef Py_ssize_t room = out.shape[0]
    cdef double value = 0.0
    with nogil:
        at = _blank_lines(data, at)
        if data[at] == 93:  # ]
            at += 1
        else:
            while True:
                if filled + group > room:
                    at = REFUSED
                    break
                if group == 2:
                    if data[at] != 91:  # [
                        at = REFUSED
                        break
                    at = _blank_lines(data, at + 1)
                for k in range(group):
                    if k > 0:
                        at = _blank_lines(data, at)
                        if data[at] != 44:  # ,
                            at = REFUSED
                            break
                        at = _blank_lines(data, at + 1)
                    at = _number(data, at, whole, &value)
                    if at < 0:
                        break
                    out[filled] = value
                    filled += 1
                if at < 0:
                    break
                at = _blank_lines(data, at)
                if group == 2:
                    if data[at] != 93:
                        at = REFUSED
                        break
                    at = _blank_lines(data, at + 1)
                if data[at] == 44:
                    at = _blank_lines(data, at + 1)
                elif data[at] == 93:
                    at += 1
                    break
                else:
                    at = REFUSED
                    break
    return at, filled


cpdef bint agree(double width, double mean) noexcept nogil:
    """Whether a stroke's width may be the mean of its knots' widths: it differs by rounding and 1 % at the most."""
    return -0.0002 - 0.01 * mean <= width - mean <= 0.0002 + 0.01 * mean


cdef Py_ssize_t _points(
    const unsigned char* text, Py_ssize_t at, double limit, double* points, long long* count
) noexcept nogil:
    """Read the array of the control points of a chain of cubics; REFUSED unless there are 3k + 1."""
    cdef long long n = 0
    at = _literal(text, at, b"[")
    while True:
        at = _literal(text, at, b"[")
        at = _within(text, at, limit, points + 2 * n)
        at = _literal(text, at, b",")
        at = _within(text, at, limit, points + 2 * n + 1)
        at = _literal(text, at, b"]")
        if at < 0:
            return REFUSED
        n += 1
        at = _blank(text, at)
        if text[at] != 44:  # ,
            break
        at += 1
    count[0] = n
    return _literal(text, at, b"]") if n % 3 == 1 else REFUSED


cdef Py_ssize_t _stroke(
    const unsigned char* text, Py_ssize_t at, double limit, double* points, double* width, double* knots,
    long long* count, bint* swells,
) noexcept nogil:
    """Read one line with its newline, its members in the order of `strokes.Writer`.

    knots: filled with the width at each knot, which is the stroke's where the line has no widths.
    """
    cdef long long k
    cdef long long n = 0
    cdef double total = 0.0
    at = _literal(text, at, b"{")
    at = _literal(text, at, b'"width"')
    at = _literal(text, at, b":")
    at = _within(text, at, limit, width)
    if at < 0 or not width[0] > 0.0:
        return REFUSED
    at = _literal(text, at, b",")
    at = _literal(text, at, b'"points"')
    at = _literal(text, at, b":")
    at = _points(text, at, limit, points, &n)
    if at < 0:
        return REFUSED
    at = _blank(text, at)
    if text[at] == 44:  # ,
        at = _literal(text, at + 1, b'"widths"')
        at = _literal(text, at, b":")
        at = _literal(text, at, b"[")
        for k in range((n + 2) // 3):
            if k > 0:
                at = _literal(text, at, b",")
            at = _within(text, at, limit, knots + k)
            if at < 0 or knots[k] < 0.0:
                return REFUSED
            total += knots[k]
        at = _literal(text, at, b"]")
        if not agree(width[0], total / ((n + 2) // 3)):
            return REFUSED
        swells[0] = True
    else:
        for k in range((n + 2) // 3):
            knots[k] = width[0]
    at = _literal(text, at, b"}")
    at = _literal(text, at, b"\n")
    count[0] = n
    return at


def strokes(
    const unsigned char[::1] text, Py_ssize_t start, double limit, double[:, ::1] points, long long[::1] counts,
    double[::1] widths, double[::1] knots,
) -> tuple[int, int, int, bool]:
    """Read strokes' lines from `start` until the end or the first line that is not plain.

    text: whole lines, the last one too ended by a newline.
    limit: the largest width and coordinate allowed.
    points (≥ bytes / 6, 2), counts and widths (≥ bytes / 28), and knots (≥ bytes / 6), the widths at all knots, are
    filled from their beginning.
    Returns where it stopped, the number of strokes and of points, and whether any stroke has widths at its knots.
    """
    cdef Py_ssize_t following
    cdef Py_ssize_t at = start
    cdef Py_ssize_t end = text.shape[0]
    cdef Py_ssize_t read = 0, used = 0
    cdef bint swells = False
    if end == 0 or text[end - 1] != 10:
        raise ValueError("the text must end with a newline")
    with nogil:
        while at < end:
            following = _stroke(
                &text[0], at, limit, &points[used, 0],
                &widths[read], &knots[(used + 2 * read) // 3],
                &counts[read], &swells,
            )  # fmt: skip
            if following < 0:
                break
            at = following
            used += <Py_ssize_t>counts[read]
            read += 1
    return at, read, used, swells


def prioritized(
    const unsigned char[::1] text, Py_ssize_t start, double limit, double least, double[:, ::1] points,
    long long[::1] counts, double[::1] priorities, double[::1] widths,
) -> tuple[int, int, int]:
    """Read the array of a texture's strokes whose opening bracket stands before `start`.

    text: not empty. limit: the largest width and coordinate allowed; least: the least width.
    points (≥ opening brackets, 2), counts, priorities and widths (≥ opening braces) are filled from their beginning.
    Returns the place after the closing bracket, -1 where something is not plain, the numbers of strokes and of points.
    """
    cdef const unsigned char* data = &text[0]
    cdef Py_ssize_t at = start, read = 0, used = 0
    with nogil:
        while True:
            at = _literal(data, _blank_lines(data, at), b"{")
            at = _literal(data, at, b'"priority"')
            at = _literal(data, at, b":")
            at = _within(data, at, 1e15, &priorities[read])
            at = _literal(data, at, b",")
            at = _literal(data, at, b'"width"')
            at = _literal(data, at, b":")
            at = _within(data, at, limit, &widths[read])
            at = _literal(data, at, b",")
            at = _literal(data, at, b'"points"')
            at = _literal(data, at, b":")
            if at < 0 or widths[read] < least:
                at = REFUSED
                break
            at = _points(data, at, limit, &points[used, 0], &counts[read])
            at = _literal(data, at, b"}")
            if at < 0:
                break
            used += <Py_ssize_t>counts[read]
            read += 1
            at = _blank_lines(data, at)
            if data[at] != 44:  # ,
                at = _literal(data, at, b"]")
                break
            at += 1
    return at, read, used
