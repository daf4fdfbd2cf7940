# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: connected parts of a mask, and distances to the nearest pixel outside. Only `masks` imports this module."""

from libc.math cimport sqrt
from libc.stdlib cimport free
from libc.string cimport memchr, memset
from penink_cli.ground._compiled.memory cimport room


def label(const unsigned char[:, ::1] mask, bint corners, int[:, ::1] part) -> int:
    """Number the parts of a mask (h, w) whose pixels touch: 1 … in the order of their first pixels.

    corners: whether pixels with nothing but a corner in common touch. part: (h, w) the number of each pixel's part, 0
    outside the mask. Returns the number of parts.

    Every run of a row gets the number of what it touches in the row above, or a new one. Where a run touches several
    numbers, all go under the least. The least number of a part is that of its first pixel's run.

        1 1 . 2 .
        1 . . 2 .    number  1 2 3
        1 1 1 1 .    under   1 1 3    since the third row joins 2 to 1
        . . . . .
        . 3 3 3 .
    """
    cdef Py_ssize_t h = mask.shape[0], w = mask.shape[1], i, j, k, begin, last
    cdef int count = 0, number, above
    cdef int* under = NULL
    cdef const unsigned char* row
    try:
        under = <int*>room(h * ((w + 1) // 2) + 1, sizeof(int))
        with nogil:
            under[0] = 0
            for i in range(h):
                row = &mask[i, 0]
                memset(&part[i, 0], 0, w * sizeof(int))
                j = from_here(row, 1, 0, w)
                while j < w:
                    begin = j
                    j = from_here(row, 0, j, w)
                    number = 0
                    if i > 0:
                        last = min(w, j + corners)
                        k = from_here(row - w, 1, max(0, begin - corners), last)
                        while k < last:
                            above = part[i - 1, k]
                            number = joined(under, number, above) if number else root(under, above)
                            k = from_here(row - w, 1, from_here(row - w, 0, k, last), last)
                    if not number:
                        count += 1
                        under[count] = number = count
                    for k in range(begin, j):
                        part[i, k] = number
                    j = from_here(row, 1, j, w)
            number = 0
            for k in range(1, count + 1):  # a number lies under lesser ones only, which have their final numbers
                if under[k] == k:
                    number += 1
                    under[k] = number
                else:
                    under[k] = under[under[k]]
            for i in range(h if number < count else 0):
                row = &mask[i, 0]
                j = from_here(row, 1, 0, w)
                while j < w:
                    begin = j
                    j = from_here(row, 0, j, w)
                    above = under[part[i, begin]]
                    for k in range(begin, j):
                        part[i, k] = above
                    j = from_here(row, 1, j, w)
        return number
    finally:
        free(under)


cdef inline Py_ssize_t from_here(const unsigned char* row, int wanted, Py_ssize_t j, Py_ssize_t w) noexcept nogil:
    """The first pixel from j on that is in the mask, or is not; w for none."""
    cdef const void* found = memchr(row + j, wanted, w - j)
    return <const unsigned char*>found - row if found is not NULL else w


cdef inline int root(int* under, int number) noexcept nogil:
    """The least number of the part that a number belongs to. The numbers on the way there are moved up by a step."""
    while under[number] != number:
        under[number] = under[under[number]]
        number = under[number]
    return number


cdef inline int joined(int* under, int a, int b) noexcept nogil:
    """The least number of two parts, which are one from now on."""
    a, b = root(under, a), root(under, b)
    if a < b:
        under[b] = a
        return a
    under[a] = b
    return b


def boxes(const int[:, ::1] part, int[:, ::1] box) -> None:
    """Fill in (parts, 4) each part's first row, the row past its last, its first column, the column past its last."""
    cdef Py_ssize_t h = part.shape[0], w = part.shape[1], i, j, k, begin
    with nogil:
        for k in range(box.shape[0]):
            box[k, 0], box[k, 1] = <int>h, 0
            box[k, 2], box[k, 3] = <int>w, 0
        for i in range(h):
            j = 0
            while j < w:
                k = part[i, j] - 1
                begin = j
                while j < w and part[i, j] == k + 1:
                    j += 1
                if k >= 0:
                    box[k, 0], box[k, 1] = min(box[k, 0], <int>i), <int>i + 1
                    box[k, 2], box[k, 3] = min(box[k, 2], <int>begin), max(box[k, 3], <int>j)


def sizes(const int[:, ::1] part, const unsigned char[:, ::1] mask, long long[::1] size) -> None:
    """Add to size[k] how many pixels of part k, (h, w), are in the mask, from number 0 on."""
    cdef Py_ssize_t i, j
    cdef int here, count
    with nogil:
        for i in range(part.shape[0]):
            here = count = 0  # a run of one part is added at once: each addition would wait for the one before
            for j in range(part.shape[1]):
                if part[i, j] != here:
                    size[here] += count
                    here = part[i, j]
                    count = 0
                count += mask[i, j]
            size[here] += count


def distance(const unsigned char[:, ::1] mask, double[:, ::1] out) -> None:
    """Distances in pixels from each pixel of a mask (h, w) to the nearest pixel outside; 1e300 where there is none.

    The nearest pixel is found first within each column; of those in a row the lower envelope of parabolas picks the
    nearest (Meijster, Roerdink and Hesselink 2000). Comparisons are of whole numbers, which no rounding can upset.
    """
    cdef Py_ssize_t h = mask.shape[0], w = mask.shape[1], i, j, away, far = h + w
    cdef int* down = NULL
    cdef Py_ssize_t* kept = NULL
    try:
        down = <int*>room(h * w, sizeof(int))
        kept = <Py_ssize_t*>room(2 * w, sizeof(Py_ssize_t))
        with nogil:
            count_down(mask, <int>far, down)
            for i in range(h):
                nearest(down + i * w, w, kept, kept + w)
                for j in range(w):
                    away = down[i * w + kept[j]]
                    away = away * away + (j - kept[j]) * (j - kept[j])
                    out[i, j] = sqrt(<double>away) if away < far * far else 1e300
    finally:
        free(down)
        free(kept)


def within(
    const unsigned char[:, ::1] mask, const unsigned char[::1] reaches, unsigned char[:, ::1] down,
    Py_ssize_t top, unsigned char[:, ::1] out,
) -> None:
    """Of the rows from `top` on, which pixels (rows, w) one outside the mask (h, w) is near to.

    reaches: (reach + 1,) how far up or down it may be where it is 0, 1, … pixels to the side; the first is the most,
    254 at the most. down: (rows + 2 reach, w + 2 reach), room. All is counted in octets, as many of which as can be fit
    into a vector.
    """
    cdef Py_ssize_t h = mask.shape[0], w = mask.shape[1], rows = out.shape[0], reach = reaches.shape[0] - 1, i, j, k
    cdef Py_ssize_t begin = max(0, top - reach), end = min(h, top + rows + reach)
    cdef unsigned char most
    cdef unsigned char* middle
    cdef unsigned char* left
    cdef unsigned char* right
    cdef unsigned char* here
    with nogil:
        memset(&down[0, 0], 255, down.shape[0] * down.shape[1])
        count_near(mask, begin, end, reaches[0] + 1, &down[0, reach], down.shape[1])
        for i in range(rows):
            middle = &down[top + i - begin, reach]
            here = &out[i, 0]
            most = reaches[0]
            for j in range(w):
                here[j] = middle[j] <= most
            for k in range(1, reach + 1):
                left = middle - k
                right = middle + k
                most = reaches[k]
                for j in range(w):
                    here[j] |= min(left[j], right[j]) <= most


cdef void count_near(
    const unsigned char[:, ::1] mask, Py_ssize_t begin, Py_ssize_t end, unsigned char far, unsigned char* down,
    Py_ssize_t wide,
) noexcept nogil:
    """As `count_down`, of the rows begin … end − 1 of the mask alone, in 8 bits: (end − begin, w)."""
    cdef Py_ssize_t w = mask.shape[1], i, j
    cdef const unsigned char* here
    cdef unsigned char* row
    cdef unsigned char* other
    for i in range(end - begin):
        here = &mask[begin + i, 0]
        row = down + i * wide
        other = row - wide
        if i > 0:
            for j in range(w):
                row[j] = min(far, <unsigned char>(other[j] + 1)) & <unsigned char>(-here[j])  # 0 where that is 0
        else:
            for j in range(w):
                row[j] = far & <unsigned char>(-here[j])
    for i in range(end - begin - 2, -1, -1):
        row = down + i * wide
        other = row + wide
        for j in range(w):
            row[j] = min(row[j], <unsigned char>(other[j] + 1))


cdef void count_down(const unsigned char[:, ::1] mask, int far, int* down) noexcept nogil:
    """Fill in (h, w) how far the nearest pixel outside the mask is in each pixel's column, `far` at the most."""
    cdef Py_ssize_t h = mask.shape[0], w = mask.shape[1], i, j
    cdef int* row
    cdef int* other
    for i in range(h):  # row after row, not column after column: the loops over a row vectorise
        row = down + i * w
        other = row - w
        for j in range(w):
            row[j] = far
        if i > 0:
            for j in range(w):
                row[j] = min(far, other[j] + 1)
        for j in range(w):
            row[j] = row[j] if mask[i, j] else 0
    for i in range(h - 2, -1, -1):
        row = down + i * w
        other = row + w
        for j in range(w):
            row[j] = min(row[j], other[j] + 1)


cdef void nearest(const int* down, Py_ssize_t w, Py_ssize_t* which, Py_ssize_t* begin) noexcept nogil:
    """Fill in `which` (w,): for each pixel of a row the column in which its nearest pixel outside the mask lies.

    down: (w,) how far that pixel lies up or down in each column. begin: (w,) room to work in: the column from which on
    each column that is kept is the nearest.
    """
    cdef Py_ssize_t count = 0, j, k, start
    for j in range(w):
        start = 0
        while count:
            k = which[count - 1]
            # from `start` on j is nearer than k, rounded up
            start = j * j - k * k + <Py_ssize_t>down[j] * down[j] - <Py_ssize_t>down[k] * down[k]
            start = 0 if start <= 0 else (start + 2 * (j - k) - 1) // (2 * (j - k))
            if start > begin[count - 1]:
                break
            count -= 1
            start = 0
        if count == 0 or start < w:
            which[count], begin[count] = j, start
            count += 1
    j = w - 1  # from the right, so that no column kept is overwritten before it has been used
    for k in range(count - 1, -1, -1):
        start = which[k]
        for j in range(j, begin[k] - 1, -1):
            which[j] = start
        j = begin[k] - 1
