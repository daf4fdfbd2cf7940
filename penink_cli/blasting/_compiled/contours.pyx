# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: the closed lines at which an image passes a level (marching squares). Only `bordered` imports this module.

A crossing is a place between two pixels beside or below each other of which one exceeds the level. In the square of
four pixels a line runs from crossing to crossing, with what exceeds the level to its right:

    .  →  .  →  .
    ↑  #  #  #  ↓     #  exceeds the level
    ↑  #  #  #  ↓
    .  ←  .  ←  .

Where two such pixels touch at their corners alone, lines keep them apart.
"""

from libc.string cimport memcpy

cdef unsigned long long NONE = 0
cdef unsigned long long ALL = 0x0101010101010101


cdef enum:
    LEFT, TOP, RIGHT, BOTTOM

# From which side of a square to which a line runs, and in two of them a second one, by which of its pixels exceed the
# level: 1 and 2 the upper ones, 4 and 8 those below.
cdef int[16][4] JOINS = [
    [0, 0, 0, 0], [TOP, LEFT, 0, 0], [RIGHT, TOP, 0, 0], [RIGHT, LEFT, 0, 0],
    [LEFT, BOTTOM, 0, 0], [TOP, BOTTOM, 0, 0], [RIGHT, TOP, LEFT, BOTTOM], [RIGHT, BOTTOM, 0, 0],
    [BOTTOM, RIGHT, 0, 0], [TOP, LEFT, BOTTOM, RIGHT], [BOTTOM, TOP, 0, 0], [BOTTOM, LEFT, 0, 0],
    [LEFT, RIGHT, 0, 0], [TOP, RIGHT, 0, 0], [LEFT, TOP, 0, 0], [0, 0, 0, 0],
]


cdef inline bint plain(const unsigned char* upper, const unsigned char* lower) noexcept nogil:
    """Whether eight pixels of two rows are all of one kind."""
    cdef unsigned long long a, b
    memcpy(&a, upper, 8)
    memcpy(&b, lower, 8)
    return a == b and (a == NONE or a == ALL)


def cross(
    const float[:, ::1] image, const unsigned char[:, ::1] above, double level, int[:, ::1] known,
    double[:, ::1] places, int[::1] following, int[::1] begins,
) -> int:
    """Find all crossings, and the lines between them; returns how many of these there are.

    image, above: (h, w), and what exceeds the level: nothing along the frame. known: (2, w) room, zeros.
    Out: places (n, 2), row and column of each crossing. following, (n,): the one a line goes to from there. begins:
    (n,) the crossings at which lines begin, in the order of their squares.
    """
    cdef Py_ssize_t h = image.shape[0], w = image.shape[1], i, j
    cdef int count = 0, lines = 0, left, right, top, bottom, kind, k
    cdef int[4] ends
    cdef const unsigned char* upper
    cdef const unsigned char* lower
    with nogil:
        for i in range(h - 1):
            upper = &above[i, 0]
            lower = &above[i + 1, 0]
            left = 0
            j = 0
            while j < w - 1:
                if j + 8 <= w and plain(upper + j, lower + j):
                    j += 7
                    continue
                kind = upper[j] + 2 * upper[j + 1] + 4 * lower[j] + 8 * lower[j + 1]
                if kind == 0 or kind == 15:
                    j += 1
                    continue
                top = known[i & 1, j]
                right = bottom = 0
                if lower[j] != lower[j + 1]:
                    bottom = known[1 - (i & 1), j] = count
                    places[count, 0] = i + 1
                    places[count, 1] = j + part(image[i + 1, j], image[i + 1, j + 1], level)
                    count += 1
                if upper[j + 1] != lower[j + 1]:
                    right = count
                    places[count, 0] = i + part(image[i, j + 1], image[i + 1, j + 1], level)
                    places[count, 1] = j + 1
                    count += 1
                ends[LEFT], ends[TOP], ends[RIGHT], ends[BOTTOM] = left, top, right, bottom
                for k in range(0, 4 if kind == 6 or kind == 9 else 2, 2):
                    following[ends[JOINS[kind][k]]] = ends[JOINS[kind][k + 1]]
                    begins[lines] = ends[JOINS[kind][k]]
                    lines += 1
                left = right
                j += 1
    return lines


cdef inline double part(float a, float b, double level) noexcept nogil:
    """How far from a to b the level is."""
    return (level - <double>a) / (<double>b - <double>a)


def follow(
    const double[:, ::1] places, int[::1] following, const int[::1] begins, int[::1] order, double[:, ::1] out,
    long long[::1] first,
) -> int:
    """Put together the rings of what `cross` has found; returns how many there are.

    order: (n,) room. out: (n + n / 4, 2) row and column of the places of all rings; first: (n / 4 + 1,) where each
    begins. A ring ends where it began: where it leaves the last of its squares. Rings come in the order of their first
    ones. A place that is the same as the one before, as on a pixel that is at the level, is left out.
    """
    cdef Py_ssize_t n = places.shape[0], k, count = 0, rings = 0
    cdef int p, q, last
    first[0] = 0
    with nogil:
        for k in range(n):
            order[begins[k]] = <int>k
        for k in range(n):
            if order[begins[k]] < 0:
                continue
            last = -1
            p = begins[k]
            while order[p] >= 0:
                q = following[p]
                if order[p] > last and not same(places, p, q):
                    last = order[p]
                order[p] = -1
                p = q
            if last < 0:
                continue
            p = following[begins[last]]
            q = p
            out[count, 0], out[count, 1] = places[p, 0], places[p, 1]
            count += 1
            while True:
                p = following[q]
                if not same(places, p, q):
                    out[count, 0], out[count, 1] = places[p, 0], places[p, 1]
                    count += 1
                q = p
                if q == following[begins[last]]:
                    break
            rings += 1
            first[rings] = count
    return rings


cdef inline bint same(const double[:, ::1] places, int p, int q) noexcept nogil:
    return places[p, 0] == places[q, 0] and places[p, 1] == places[q, 1]
