# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: pixels that hang together, and how far it is from them to others. Only `masks` imports this module."""

from libc.math cimport sqrt
from libc.stdlib cimport free
from penink_cli.ground._compiled.memory cimport room


def label(const unsigned char[:, ::1] mask, bint corners, int[:, ::1] part) -> int:
    """Number the parts of a mask (h, w) whose pixels touch: 1 … in the order of their first pixels.

    corners: whether those touch that have a corner in common. part: (h, w) the number of each pixel's, 0 for none.
    Returns how many there are.
    """
    cdef Py_ssize_t h = mask.shape[0], w = mask.shape[1], i, j, k, top, row, column, count = 0
    cdef int number = 0
    cdef Py_ssize_t* waiting = NULL
    try:
        waiting = <Py_ssize_t*>room(h * w, sizeof(Py_ssize_t))
        with nogil:
            for i in range(h):
                for j in range(w):
                    part[i, j] = 0
            for i in range(h):
                for j in range(w):
                    if not mask[i, j] or part[i, j]:
                        continue
                    number += 1
                    part[i, j] = number
                    waiting[0] = i * w + j
                    count = 1
                    while count:
                        count -= 1
                        row = waiting[count] // w
                        column = waiting[count] - row * w
                        for top in range(max(0, row - 1), min(h, row + 2)):
                            for k in range(max(0, column - 1), min(w, column + 2)):
                                if not corners and top != row and k != column:
                                    continue
                                if mask[top, k] and not part[top, k]:
                                    part[top, k] = number
                                    waiting[count] = top * w + k
                                    count += 1
        return number
    finally:
        free(waiting)


def boxes(const int[:, ::1] part, int[:, ::1] box) -> None:
    """Fill in first row, one past the last, first column and one past the last (parts, 4) of each part."""
    cdef Py_ssize_t i, j, k
    with nogil:
        for k in range(box.shape[0]):
            box[k, 0], box[k, 1] = <int>part.shape[0], 0
            box[k, 2], box[k, 3] = <int>part.shape[1], 0
        for i in range(part.shape[0]):
            for j in range(part.shape[1]):
                k = part[i, j] - 1
                if k >= 0:
                    box[k, 0], box[k, 1] = min(box[k, 0], <int>i), max(box[k, 1], <int>i + 1)
                    box[k, 2], box[k, 3] = min(box[k, 2], <int>j), max(box[k, 3], <int>j + 1)


def distance(const unsigned char[:, ::1] mask, double[:, ::1] out) -> None:
    """From each pixel of a mask (h, w) to the middle of the nearest one outside of it, pixels; 1e300 for none.

    In a column the nearest one is counted; of each row's pixels those are kept that are nearest to some (Meijster,
    Roerdink and Hesselink 2000). All in whole numbers, so that the nearest is the nearest.
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


def within(const unsigned char[:, ::1] mask, int reach, int most, unsigned char[:, ::1] out) -> None:
    """Which pixels (h, w) one outside the mask is so near to that the square of the distance is `most` at the most.

    reach: pixels, the root of that rounded down, 1000 at the most.
    """
    cdef Py_ssize_t h = mask.shape[0], w = mask.shape[1], i, j, k
    cdef int far = reach + 1, none = 1 << 30, square
    cdef int* down = NULL
    cdef int* squares = NULL
    cdef int* best
    cdef int* left
    cdef int* right
    try:
        down = <int*>room(h * w, sizeof(int))
        squares = <int*>room(2 * w + 2 * reach, sizeof(int))
        best = squares + w + 2 * reach
        with nogil:
            count_down(mask, far, down)
            for j in range(reach):
                squares[j] = squares[reach + w + j] = none
            for i in range(h):
                left = down + i * w
                for j in range(w):
                    square = left[j] * left[j]
                    squares[reach + j] = best[j] = square if left[j] < far else none
                for k in range(1, reach + 1):
                    left = squares + reach - k
                    right = squares + reach + k
                    square = <int>(k * k)
                    for j in range(w):
                        best[j] = min(best[j], min(left[j], right[j]) + square)
                for j in range(w):
                    out[i, j] = best[j] <= most
    finally:
        free(down)
        free(squares)


cdef void count_down(const unsigned char[:, ::1] mask, int far, int* down) noexcept nogil:
    """How far up or down the nearest pixel outside the mask (h, w) is in its column, `far` at the most: (h, w)."""
    cdef Py_ssize_t h = mask.shape[0], w = mask.shape[1], i, j
    cdef int* row
    cdef int* other
    for i in range(h):  # row after row, and not column after column: that many pixels at a time
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
    """For each pixel of a row the one under or over which the nearest lies, so far down: `which`, (w,).

    begin: (w,) room for the pixel from which on each of those kept is the nearest.
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
    j = w - 1  # from the right, so that none of those kept is overwritten before it has been used
    for k in range(count - 1, -1, -1):
        start = which[k]
        for j in range(j, begin[k] - 1, -1):
            which[j] = start
        j = begin[k] - 1
