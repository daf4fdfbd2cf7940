# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled loops over ink: painting strokes on a sheet of bits, or counting what they would newly cover.

Everything here is in *subpixels*, eight to the side of a cell (see `sheet`). A sheet of rows × columns cells is one
bit a subpixel, `bits[cell row, columns of cells by eights, subpixel row]`: a word is 64 subpixels of one row, the
leftmost in the lowest bit, and the eight rows of a cell lie in one line of the cache.

Only `sheet` and the other kernels of this room import this module. Nothing here uses a transcendental function or a sum
whose order could depend on anything but the input, so the bytes are the same everywhere.
"""

from libc.math cimport fabs, sqrt
from penink_cli.blasting._compiled.rows cimport Outline, bits_set, meet_rows, whole_places

from penink_cli.ground.device import EDGE

#: What a device adds to the width of a stroke times |cos θ| + |sin θ|, in its pixels; see `ground.device` for dots.
cdef double EDGE_GAIN = EDGE
cdef double PI = 3.141592653589793
#: Words with the first n bits set.
cdef unsigned long long[65] UP_TO
for _bits in range(65):
    UP_TO[_bits] = (1 << _bits) - 1


cdef inline unsigned long long _by_bytes(unsigned long long word) noexcept nogil:
    """The number of bits set in each byte of a word, in that byte."""
    cdef unsigned long long ones = 0x5555555555555555, pairs = 0x3333333333333333, halves = 0x0F0F0F0F0F0F0F0F
    word -= (word >> 1) & ones
    word = (word & pairs) + ((word >> 2) & pairs)
    return (word + (word >> 4)) & halves


cdef int bar(
    unsigned long long* bits, Py_ssize_t rows, Py_ssize_t columns, double x0, double y0, double x1, double y1, double r,
    bint cap0, bint cap1, bint write,
) noexcept nogil:
    """Ink, or count what is bare of, the bar of half width r from (x0, y0) to (x1, y1), with the caps asked for.

    It is convex, so each row of subpixels meets it in one interval: the hull of what
    the row meets of the rectangle and of the two discs.
    """
    cdef double low, high, left, right, d, h
    cdef Py_ssize_t row, last, column, base, count, n
    cdef float[16] lo, hi
    cdef int[16] c0, c1
    cdef unsigned long long[17] bare
    cdef Outline sides
    cdef unsigned long long* word
    cdef unsigned long long mask
    cdef Py_ssize_t across = (columns + 7) >> 3
    cdef double ux = x1 - x0
    cdef double uy = y1 - y0
    cdef double length = sqrt(ux * ux + uy * uy)
    cdef int total = 0
    rows *= 8
    columns *= 8
    sides.end_rate = 0.0
    sides.side_rate = 0.0
    sides.end_hi = 1e30
    sides.side_lo = -1e30
    sides.side_hi = 1e30
    if length > 1e-9:
        ux /= length
        uy /= length
        # a bar along a row or a column is tilted by nothing that shows
        if fabs(ux) < 1e-7:
            ux = 1e-7
        if fabs(uy) < 1e-7:
            uy = 1e-7
        h = length / ux
        sides.end_rate = -uy / ux
        sides.end_lo = h if h < 0.0 else 0.0
        sides.end_hi = 0.0 if h < 0.0 else h
        h = fabs(r / uy)
        sides.side_rate = ux / uy
        sides.side_lo = -h
        sides.side_hi = h
    else:
        sides.end_lo = 1e30
        ux = 1.0
        uy = 1.0
    h = r if (cap0 or cap1) else r * fabs(ux)
    low = (y0 if y0 < y1 else y1) - h
    high = (y1 if y0 < y1 else y0) + h
    h = r if (cap0 or cap1) else r * fabs(uy)
    left = (x0 if x0 < x1 else x1) - h
    right = (x1 if x0 < x1 else x0) + h
    if high <= 0.0 or low >= rows or right <= 0.0 or left >= columns:
        return 0
    # rounding is by truncation, for what is not negative: ceil is a call where SSE 4.1 may not be assumed
    row = <Py_ssize_t>(low + 0.5) if low > 0.5 else 0
    last = <Py_ssize_t>(high + 0.5) if high < rows else rows
    column = (<Py_ssize_t>left if left > 0.0 else 0) >> 6
    columns = columns if columns < right + 1.0 else <Py_ssize_t>right + 1
    while row < last:
        count = 16 if row + 16 <= last else last - row
        meet_rows(&sides, row + 0.5 - y0, count, lo, hi)
        if cap0 or cap1:
            for n in range(count):
                if not lo[n] < hi[n]:
                    lo[n] = 1e30
                    hi[n] = -1e30
                d = row + n + 0.5 - y0
                if cap0 and fabs(d) < r:
                    h = sqrt(r * r - d * d)
                    lo[n] = -h if -h < lo[n] else lo[n]
                    hi[n] = h if h > hi[n] else hi[n]
                d = row + n + 0.5 - y1
                if cap1 and fabs(d) < r:
                    h = sqrt(r * r - d * d)
                    lo[n] = x1 - x0 - h if x1 - x0 - h < lo[n] else lo[n]
                    hi[n] = x1 - x0 + h if x1 - x0 + h > hi[n] else hi[n]
        # word by word of the rows: a stroke is a few subpixels wide, so this is one nearly always
        base = column
        while 64 * base < columns:
            h = columns - 64 * base if columns < 64 * base + 64 else 64.0
            whole_places(lo, x0 - 64 * base + 0.5, h, count, c0)
            whole_places(hi, x0 - 64 * base + 0.5, h, count, c1)
            word = bits + ((row >> 3) * across + base) * 8
            bare[count] = 0
            for n in range(count):
                mask = UP_TO[c1[n]] & ~UP_TO[c0[n]]
                bare[n] = mask & ~word[row & 7]
                if write:
                    word[row & 7] |= mask
                row += 1
                if row & 7 == 0:
                    word += 8 * across
            row -= count
            total += bits_set(bare, count)
            base += 1
        row += count
    return total


cdef Py_ssize_t cell(double subpixels) noexcept nogil:
    """The row or column of cells that a place is in; -1 before the first."""
    return <Py_ssize_t>(subpixels * 0.125) if subpixels >= 0.0 else -1


cdef double half_width(double width, double gain, double dx, double dy) noexcept nogil:
    """Half the width that the device paints, see `sheet.Sheet`."""
    cdef double length = sqrt(dx * dx + dy * dy)
    if length < 1e-9:
        gain *= EDGE_GAIN
        return 0.5 * sqrt(width * width + (8.0 * gain * width + 4.0 * gain * gain) / PI)
    return 0.5 * (width + EDGE_GAIN * gain * (fabs(dx) + fabs(dy)) / length)


cdef bint lies_in(
    double y0, double y1, double reach, Py_ssize_t rows, Py_ssize_t band, Py_ssize_t height
) noexcept nogil:
    """Whether what reaches so far above and below y0 … y1 lies in a band of so many rows; for band -1 in two."""
    cdef Py_ssize_t low = cell((y0 if y0 < y1 else y1) - reach)
    cdef Py_ssize_t high = cell((y1 if y0 < y1 else y0) + reach)
    low = min(max(low, 0), rows - 1) // height
    high = min(max(high, 0), rows - 1) // height
    return low != high if band < 0 else low == band and high == band


cdef long long stroke(
    unsigned long long* bits, Py_ssize_t rows, Py_ssize_t columns, double* points, Py_ssize_t n, double ox, double oy,
    double width, double gain, double* fresh, Py_ssize_t band, Py_ssize_t height,
) noexcept nogil:
    """Ink a polyline of n pieces (none is a dot), n + 1 points x, y, moved by (ox, oy).

    fresh: out, how many subpixels each piece newly inks; may be NULL. Returns their sum.
    band, height: of `paint_band`, 0 and all rows for all pieces.
    """
    cdef Py_ssize_t i
    cdef double dx, dy, turn
    cdef bint cap
    cdef int new
    cdef long long total = 0
    cdef double ex = 0.0, ey = 0.0
    # more than half of what is painted, and than is rounded
    cdef double reach = 0.53 * (width + 1.5 * gain) + 1.0
    if n == 0:
        if height < rows and not lies_in(points[1] + oy, points[1] + oy, reach, rows, band, height):
            return 0
        new = bar(bits, rows, columns, points[0] + ox, points[1] + oy, points[0] + ox, points[1] + oy,
                  half_width(width, gain, 0.0, 0.0), True, False, True)
        if fresh != NULL:
            fresh[0] = new
        return new
    for i in range(n):
        dx = points[2 * i + 2] - points[2 * i]
        dy = points[2 * i + 3] - points[2 * i + 1]
        # the square of the sine of the turn from the piece before
        turn = dx * ey - dy * ex
        turn = turn * turn / ((dx * dx + dy * dy) * (ex * ex + ey * ey) + 1e-12)
        # a joint needs a disc only where the line turns by more than some 2 degrees
        cap = i == 0 or turn > 0.001
        ex = dx
        ey = dy
        if height < rows and not lies_in(points[2 * i + 1] + oy, points[2 * i + 3] + oy, reach, rows, band, height):
            continue
        # an arc is longer than its chord by a 24th of that square
        new = bar(bits, rows, columns, points[2 * i] + ox, points[2 * i + 1] + oy,
                  points[2 * i + 2] + ox, points[2 * i + 3] + oy,
                  half_width(width, gain, dx, dy) * (1.0 + turn / 24.0), cap, i + 1 == n, True)
        if fresh != NULL:
            fresh[i] = new
        total += new
    return total


def paint(
    unsigned long long[:, :, ::1] bits, Py_ssize_t columns, double[:, ::1] points, long long[::1] first,
    double[::1] widths, double gain, long long[::1] fresh,
):
    """Ink polylines one after the other. columns: of cells. fresh: (n,) out, how many subpixels each newly inks."""
    cdef Py_ssize_t i, p
    with nogil:
        for i in range(fresh.shape[0]):
            p = first[i]
            fresh[i] = stroke(&bits[0, 0, 0], bits.shape[0], columns, &points[p, 0],
                              first[i + 1] - 1 - p, 0.0, 0.0, widths[i], gain, NULL, 0, bits.shape[0])


def paint_band(
    unsigned long long[:, :, ::1] bits, Py_ssize_t columns, double[:, ::1] points, long long[::1] first,
    double[::1] widths, double gain, Py_ssize_t band, Py_ssize_t height,
):
    """Ink those pieces of polylines that lie in one band of so many rows of cells, or for band -1 in two of them."""
    cdef Py_ssize_t i, p
    with nogil:
        for i in range(widths.shape[0]):
            p = first[i]
            stroke(&bits[0, 0, 0], bits.shape[0], columns, &points[p, 0],
                   first[i + 1] - 1 - p, 0.0, 0.0, widths[i], gain, NULL, band, height)


def cover(unsigned long long[:, :, ::1] bits, float[:, ::1] out):
    """Which part of each cell is inked, 0 … 1, into out (rows, columns)."""
    cdef Py_ssize_t y, x, i
    cdef unsigned long long counts
    with nogil:
        for y in range(out.shape[0]):
            for x in range(bits.shape[1]):
                # a byte for each of eight cells, in which their rows' bits add up to 64 at the most
                counts = 0
                for i in range(8):
                    counts += _by_bytes(bits[y, x, i])
                for i in range(8 * x, min(8 * x + 8, out.shape[1])):
                    out[y, i] = <float>(counts & 255) * 0.015625
                    counts >>= 8
