# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: pixels that hang together, and how far it is from them to others. Only `masks` imports this module."""

from libc.math cimport sqrt
from libc.stdlib cimport free
from penink_cli.ground._compiled.memory cimport room


def label(const unsigned char[:, ::1] mask, int[:, ::1] part) -> int:
    """Number the parts of a mask (h, w) whose pixels touch, corners too: 1 … in the order of their first pixels.

    part: (h, w) the number of each pixel's, 0 for none. Returns how many there are.
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

    First along columns, then the least over each row: cubic in the side, for windows of a hundred pixels.
    """
    cdef Py_ssize_t h = mask.shape[0], w = mask.shape[1], i, j, k, away
    cdef Py_ssize_t far = h + w
    cdef Py_ssize_t least
    cdef Py_ssize_t* down = NULL
    try:
        down = <Py_ssize_t*>room(h * w, sizeof(Py_ssize_t))
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
                for j in range(w):
                    least = down[i * w + j] * down[i * w + j]
                    k = 1
                    while k < w and k * k < least:
                        if j >= k:
                            least = min(least, k * k + down[i * w + j - k] * down[i * w + j - k])
                        if j + k < w:
                            least = min(least, k * k + down[i * w + j + k] * down[i * w + j + k])
                        k += 1
                    out[i, j] = sqrt(<double>least) if least < far * far else 1e300
    finally:
        free(down)
