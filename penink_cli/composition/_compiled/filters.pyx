# cython: boundscheck=False, wraparound=False, cdivision=True
"""Loops over the rows of a picture: means over areas, separable symmetric filters, linear enlarging.

Each number is a sum in one fixed order, whichever rows a call is given, so the bytes do not depend on how threads share
the rows.
"""

from libc.stdlib cimport free, malloc

cdef extern from "filters.h" nogil:
    void symmetric(const float** before, const float** after, float* weight, Py_ssize_t n, float* out, Py_ssize_t width)
    void bytes_summed(
        const unsigned char** row, float* part, Py_ssize_t n, float whole, float* out, Py_ssize_t width
    )
    void bytes_divided(
        const unsigned char** row, float* part, Py_ssize_t n, float whole, float* out, Py_ssize_t width
    )
    void shorts_summed(
        const unsigned short** row, float* part, Py_ssize_t n, float whole, float* out, Py_ssize_t width
    )
    void shorts_divided(
        const unsigned short** row, float* part, Py_ssize_t n, float whole, float* out, Py_ssize_t width
    )
    void floats_summed(
        const float** row, float* part, Py_ssize_t n, float whole, float* out, Py_ssize_t width
    )
    void gathered(
        float* row, float* part, Py_ssize_t* begin, Py_ssize_t* column, float area, float* out, Py_ssize_t w,
        Py_ssize_t channels
    )
    int best_lanes()
    int lanes

ctypedef const unsigned char const_uchar
ctypedef const unsigned short const_ushort
ctypedef const float const_float

ctypedef fused stored:
    const_uchar
    const_ushort
    const_float


def take_lanes(int wanted) -> int:
    """Use vectors of so many bytes, 16 or 32, or the most that this processor has; the numbers are the same."""
    global lanes
    lanes = min(wanted, best_lanes())
    return lanes


take_lanes(32)


def shrink(
    stored[:, :, ::1] values, float scale, float whole, float[:, :, ::1] out, Py_ssize_t top, Py_ssize_t bottom
):
    """Rows top … bottom of out (h, w, channels): the means of values (H, W, channels) over each pixel, times scale.

    whole: divides values that are whole numbers, before anything else.
    """
    cdef Py_ssize_t rows = values.shape[0], columns = values.shape[1], channels = values.shape[2]
    cdef Py_ssize_t h = out.shape[0], w = out.shape[1], long_row = columns * channels
    cdef Py_ssize_t y, x, r, k, n, q, first, last
    cdef double down = <double>rows / h, across = <double>columns / w, low, high
    cdef float part, area = <float>(scale / (down * across))
    cdef Py_ssize_t most = <Py_ssize_t>down + 2  # rows that a pixel covers
    cdef float *sums = <float *>malloc((long_row + most) * sizeof(float))
    cdef float *row_parts = sums + long_row
    cdef stored **covered = <stored **>malloc(most * sizeof(void *))
    # For each pixel of a row its first column, and the place in `parts` of its columns' parts: the same in all rows.
    cdef Py_ssize_t *begin = <Py_ssize_t *>malloc((2 * w + 1) * sizeof(Py_ssize_t))
    cdef float *parts = <float *>malloc((columns + 2 * w) * sizeof(float))
    cdef Py_ssize_t *column = begin + w + 1
    if sums == NULL or covered == NULL or begin == NULL or parts == NULL:
        free(sums)
        free(covered)
        free(begin)
        free(parts)
        raise MemoryError
    with nogil:
        q = 0
        for x in range(w):
            low, high = x * across, (x + 1) * across
            first, last = <Py_ssize_t>low, min(<Py_ssize_t>high, columns - 1)
            column[x], begin[x] = first, q
            for k in range(first, last + 1):
                part = <float>(min(high, k + 1.0) - max(low, <double>k))
                if part > 0:  # the last column may only touch the pixel
                    parts[q] = part
                    q += 1
        begin[w] = q
        for y in range(top, bottom):
            low, high = y * down, (y + 1) * down
            first, last = <Py_ssize_t>low, min(<Py_ssize_t>high, rows - 1)
            n = 0
            for r in range(first, last + 1):
                part = <float>(min(high, r + 1.0) - max(low, <double>r))
                if part > 0:
                    row_parts[n], covered[n] = part, &values[r, 0, 0]
                    n += 1
            if stored is const_uchar:
                if whole == 1:
                    bytes_summed(covered, row_parts, n, whole, sums, long_row)
                else:
                    bytes_divided(covered, row_parts, n, whole, sums, long_row)
            elif stored is const_ushort:
                if whole == 1:
                    shorts_summed(covered, row_parts, n, whole, sums, long_row)
                else:
                    shorts_divided(covered, row_parts, n, whole, sums, long_row)
            else:
                floats_summed(covered, row_parts, n, whole, sums, long_row)
            gathered(sums, parts, begin, column, area, &out[y, 0, 0], w, channels)
    free(sums)
    free(covered)
    free(begin)
    free(parts)


cdef inline Py_ssize_t within(Py_ssize_t i, Py_ssize_t n) noexcept nogil:
    """The place from 0 to n - 1 that place i falls on when the frame is mirrored at its sides, as often as needed."""
    cdef Py_ssize_t period = 2 * n
    i = i % period
    if i < 0:
        i += period
    return period - 1 - i if i >= n else i


def across(const float[:, ::1] values, float[::1] weights, float[:, ::1] out, Py_ssize_t top, Py_ssize_t bottom):
    """Rows top … bottom of out (h, w): values (h, w) filtered along rows; weights: (n,) from the middle outwards."""
    cdef Py_ssize_t w = values.shape[1], n = weights.shape[0], y, x, k
    cdef float *wide = <float *>malloc((w + 2 * n) * sizeof(float))
    cdef float *middle = wide + n
    cdef const float **before = <const float **>malloc(2 * n * sizeof(void *))
    cdef const float **after = before + n
    if wide == NULL or before == NULL:
        free(wide)
        free(before)
        raise MemoryError
    with nogil:
        for k in range(n):
            before[k], after[k] = middle - k, middle + k
        for y in range(top, bottom):
            for x in range(w):
                middle[x] = values[y, x]
            for k in range(n):
                middle[-1 - k] = values[y, within(-1 - k, w)]
                middle[w + k] = values[y, within(w + k, w)]
            symmetric(before, after, &weights[0], n, &out[y, 0], w)
    free(wide)
    free(before)


def down(const float[:, ::1] values, float[::1] weights, float[:, ::1] out, Py_ssize_t top, Py_ssize_t bottom):
    """Rows top … bottom of out (h, w): values (h, w) filtered along columns; weights: (n,) from the middle outwards."""
    cdef Py_ssize_t h = values.shape[0], w = values.shape[1], n = weights.shape[0], y, k
    cdef const float **before = <const float **>malloc(2 * n * sizeof(void *))
    cdef const float **after = before + n
    if before == NULL:
        raise MemoryError
    with nogil:
        for y in range(top, bottom):
            for k in range(n):
                before[k], after[k] = &values[within(y - k, h), 0], &values[within(y + k, h), 0]
            symmetric(before, after, &weights[0], n, &out[y, 0], w)
    free(before)


def enlarge(const float[:, ::1] values, float[:, ::1] out, Py_ssize_t top, Py_ssize_t bottom):
    """Rows top … bottom of out (h, w): values (rows, columns) of the same frame, linear in between."""
    cdef Py_ssize_t rows = values.shape[0], columns = values.shape[1], h = out.shape[0], w = out.shape[1], y, x, i, k
    cdef double at
    cdef float share, here, step
    cdef const float *above
    cdef const float *below
    cdef float *row
    cdef float *mixed = <float *>malloc(columns * sizeof(float))
    cdef float *shares = <float *>malloc(w * sizeof(float))
    cdef Py_ssize_t *begin = <Py_ssize_t *>malloc((columns + 1) * sizeof(Py_ssize_t))  # the first x from column i on
    if mixed == NULL or shares == NULL or begin == NULL:
        free(mixed)
        free(shares)
        free(begin)
        raise MemoryError
    with nogil:
        i = 0
        for x in range(w):
            at = min(max((x + 0.5) * columns / w - 0.5, 0.0), columns - 1.0)
            k = max(0, min(<Py_ssize_t>at, columns - 2))
            shares[x] = <float>(at - k)
            while i <= k:
                begin[i] = x
                i += 1
        while i <= columns:
            begin[i] = w
            i += 1
        for y in range(top, bottom):
            at = min(max((y + 0.5) * rows / h - 0.5, 0.0), rows - 1.0)
            i = max(0, min(<Py_ssize_t>at, rows - 2))
            share = <float>(at - i)
            above, below = &values[i, 0], &values[min(i + 1, rows - 1), 0]
            for x in range(columns):
                mixed[x] = above[x] + share * (below[x] - above[x])
            row = &out[y, 0]
            for i in range(columns):
                here = mixed[i]
                step = mixed[min(i + 1, columns - 1)] - here
                for x in range(begin[i], begin[i + 1]):
                    row[x] = here + shares[x] * step
    free(mixed)
    free(shares)
    free(begin)


def look_up(
    const float[:, :] values, const float[::1] table, const float[::1] rising, float low, float scale,
    float[:, ::1] out, Py_ssize_t top, Py_ssize_t bottom
):
    """Rows top … bottom of out (h, w): a function of values (h, w), linear between the numbers of its table.

    table: (n + 1,) the function at even steps, constant beyond its ends. rising: (n + 1,) each number's difference to
    the next. low: the value at the table's first number. scale: steps to a unit.
    """
    cdef Py_ssize_t y, x, i
    cdef float at, most = <float>(table.shape[0] - 1)
    with nogil:
        for y in range(top, bottom):
            for x in range(values.shape[1]):
                at = (values[y, x] - low) * scale
                at = (at if at < most else most) if at > 0.0 else <float>0.0
                i = <Py_ssize_t>at
                out[y, x] = (at - i) * rising[i] + table[i]


def histogram(const float[:, ::1] values, const float[:, ::1] weights, long long[::1] counts):
    """Add to counts (n,) the weights, in 4096ths, of the values in each of n even steps from 0 to 1.

    values: (h, w); those beyond 0 … 1 count with the first and the last step. weights: (h, w), rounded half up, or
    empty for 1 each.
    """
    cdef Py_ssize_t y, x, i, n = counts.shape[0]
    cdef float steps = <float>n
    cdef bint weighted = weights.shape[0] > 0
    with nogil:
        for y in range(values.shape[0]):
            for x in range(values.shape[1]):
                i = <Py_ssize_t>(values[y, x] * steps)
                i = 0 if i < 0 else (n - 1 if i >= n else i)
                counts[i] += <long long>(weights[y, x] * <float>4096.0 + <float>0.5) if weighted else 4096
