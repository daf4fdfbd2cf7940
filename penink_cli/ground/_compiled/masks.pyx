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
    cdef Py_ssize_t h = mask.shape[0], w = mask.shape[1], i, j, k, top, at, count = 0
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
                        at = waiting[count]
                        for top in range(max(0, at // w - 1), min(h, at // w + 2)):
                            for k in range(max(0, at % w - 1), min(w, at % w + 2)):
                                if not corners and top != at // w and k != at % w:
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
    cdef Py_ssize_t* down = NULL
    cdef Py_ssize_t* kept = NULL
    try:
        down = <Py_ssize_t*>room(h * w, sizeof(Py_ssize_t))
        kept = <Py_ssize_t*>room(2 * w, sizeof(Py_ssize_t))
        with nogil:
            for j in range(w):
                away = far
                for i in range(h):
                    away = 0 if not mask[i, j] else min(far, away + 1)
                    down[i * w + j] = away
                for i in range(h - 1, -1, -1):
                    away = 0 if not mask[i, j] else min(far, away + 1)
                    down[i * w + j] = min(down[i * w + j], away)
            for i in range(h):
                nearest(down + i * w, w, kept, kept + w)
                for j in range(w):
                    away = down[i * w + kept[j]]
                    away = away * away + (j - kept[j]) * (j - kept[j])
                    out[i, j] = sqrt(<double>away) if away < far * far else 1e300
    finally:
        free(down)
        free(kept)


cdef void nearest(const Py_ssize_t* down, Py_ssize_t w, Py_ssize_t* which, Py_ssize_t* begin) noexcept nogil:
    """For each pixel of a row the one under or over which the nearest lies, so far down: `which`, (w,).

    begin: (w,) room for the pixel from which on each of those kept is the nearest.
    """
    cdef Py_ssize_t count = 0, j, k, start
    for j in range(w):
        start = 0
        while count:
            k = which[count - 1]
            # from `start` on j is nearer than k, rounded up
            start = j * j + down[j] * down[j] - k * k - down[k] * down[k]
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
