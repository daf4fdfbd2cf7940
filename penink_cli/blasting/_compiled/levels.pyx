# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled loops: level lines of a phase on a grid, a band of rows at a time. Only `level_lines` imports this module.

A quad of nodes is two triangles, so that each node has three links of its own:

    p --0-- .
    | \\
    1   2
    |     \\
    .       .

Along a link the phase changes by about what is predicted, so of all that it may have changed by (it is known but for
whole turns) the one nearest to that is taken. A triangle whose three changes do not add up to nought holds a
singularity, and lines end there.
"""

from libc.math cimport fabsf, floorf

import numpy as np

#: Crossings that one link may have: beyond them lines do not go on into the next band.
cdef enum:
    PER_LINK = 16
#: Changes of phase round a triangle may miss nought by this; at a singularity it is a whole turn.
cdef float RESIDUE = <float>0.3


cdef inline float _near(float x) noexcept nogil:
    """x less the whole number nearest to it."""
    return x - floorf(x + <float>0.5)


cdef inline float _first(float a, float b) noexcept nogil:
    """The first whole number passed from a, or from a + b, upwards."""
    return floorf(a if b > 0.0 else a + b) + <float>1.0


cdef class Band:
    """Node rows low … high of a field, and the level lines of its phase that cross its links.

    field: `phase.Field`. phase: (rows, columns). level: 0 or 1/2; others are not the same seen from the other side.
    change, sign: (high - low + 1, columns, 3) how much the phase changes along each link, and whether it runs the same
    way at both ends; sign is nought where there is no link. begin: where the crossings of each link start.
    """

    cdef const float[:, ::1] phase
    cdef const float[:, ::1] nx
    cdef const float[:, ::1] ny
    cdef const float[:, ::1] density
    cdef double left, top, dx, dy
    cdef float level
    cdef Py_ssize_t low, high, count
    cdef float[:, :, ::1] change
    cdef signed char[:, :, ::1] sign
    cdef int[::1] begin

    def __init__(self, field, const float[:, ::1] phase, float level, Py_ssize_t low, Py_ssize_t high) -> None:
        self.phase = phase
        self.nx, self.ny, self.density = field.nx, field.ny, field.density
        self.left, self.top, self.dx, self.dy = field.nodes.left, field.nodes.top, field.nodes.dx, field.nodes.dy
        self.level = level
        self.low = low
        self.high = high
        self.count = 0
        shape = high - low + 1, phase.shape[1], 3
        self.change = np.empty(shape, np.float32)
        self.sign = np.empty(shape, np.int8)
        self.begin = np.empty(shape[0] * shape[1] * 3 + 1, np.int32)

    def cross(self, const unsigned char[:, ::1] wanted) -> None:
        """Find the changes of phase along all links, and how many level lines cross each.

        wanted: a link between two nodes that are not is none. Of the last row only links to the right are looked at: it
        is the next band's first one.
        """
        cdef const float[:, ::1] phase = self.phase
        cdef const float[:, ::1] nx = self.nx
        cdef const float[:, ::1] ny = self.ny
        cdef const float[:, ::1] density = self.density
        cdef float dx = <float>self.dx, dy = <float>self.dy, level = self.level
        cdef Py_ssize_t low = self.low, high = self.high
        cdef float[:, :, ::1] change = self.change
        cdef signed char[:, :, ::1] sign = self.sign
        cdef int[::1] begin = self.begin
        cdef Py_ssize_t columns = phase.shape[1]
        cdef Py_ssize_t j, i, k, q, p, r
        cdef Py_ssize_t n = 0
        cdef Py_ssize_t at = 0
        cdef float s, predicted, a, b
        with nogil:
            for j in range(low, high + 1):
                r = j - low
                for i in range(columns):
                    for k in range(3):
                        begin[at] = <int>n
                        at += 1
                        sign[r, i, k] = 0
                        change[r, i, k] = 0.0
                        q = j + (k > 0)
                        p = i + (k != 1)
                        if p >= columns or q > high or not (wanted[j, i] or wanted[q, p]):
                            continue
                        s = <float>-1.0 if nx[j, i] * nx[q, p] + ny[j, i] * ny[q, p] < 0.0 else <float>1.0
                        predicted = <float>0.0
                        if k != 1:
                            predicted = (density[j, i] * nx[j, i] + s * density[q, p] * nx[q, p]) * dx
                        if k > 0:
                            predicted = predicted + (density[j, i] * ny[j, i] + s * density[q, p] * ny[q, p]) * dy
                        predicted = <float>0.5 * predicted
                        a = phase[j, i] - level
                        b = predicted + _near(s * phase[q, p] - phase[j, i] - predicted)
                        sign[r, i, k] = <signed char>s
                        change[r, i, k] = b
                        n += <Py_ssize_t>fabsf(floorf(a + b) - floorf(a))
            begin[at] = <int>n
        self.count = n

    def places(self) -> tuple[np.ndarray, np.ndarray]:
        """Where the crossings are (n, 2), and border (n,).

        border: the number of each that is on the first row of the band, in that row, `PER_LINK` to a link; more by
        `PER_LINK` × columns on the last row; -2 for one on a diagonal link, -1 for all others.
        """
        cdef const float[:, ::1] phase = self.phase
        cdef float level = self.level
        cdef Py_ssize_t low = self.low
        cdef const float[:, :, ::1] change = self.change
        cdef const int[::1] begin = self.begin
        cdef double left = self.left, top = self.top, dx = self.dx, dy = self.dy
        cdef float[:, ::1] place = np.empty((self.count, 2), np.float32)
        cdef int[::1] border = np.empty(self.count, np.int32)
        cdef Py_ssize_t rows = change.shape[0]
        cdef Py_ssize_t columns = change.shape[1]
        cdef Py_ssize_t r, i, k, x, link, m
        cdef float a, t, whole
        with nogil:
            for r in range(rows):
                for i in range(columns):
                    for k in range(3):
                        link = 3 * (r * columns + i) + k
                        if begin[link] == begin[link + 1]:
                            continue
                        a = phase[low + r, i] - level
                        whole = _first(a, change[r, i, k])
                        for x in range(begin[link], begin[link + 1]):
                            m = x - begin[link]
                            t = (whole + <float>m - a) / change[r, i, k]
                            place[x, 0] = <float>(left + dx * (i + (t if k != 1 else <float>0.0)))
                            place[x, 1] = <float>(top + dy * (low + r + (t if k > 0 else <float>0.0)))
                            border[x] = -2 if k == 2 else -1
                            if k == 0 and m < PER_LINK and (r == 0 or r == rows - 1):
                                border[x] = <int>(PER_LINK * (i if r == 0 else columns + i) + m)
        return np.asarray(place), np.asarray(border)

    def pairs(self) -> np.ndarray:
        """Which two crossings (n, 2) each is joined to within the triangles on its two sides, -1 for none."""
        cdef const float[:, ::1] phase = self.phase
        cdef float level = self.level
        cdef Py_ssize_t low = self.low
        cdef const float[:, :, ::1] change = self.change
        cdef const signed char[:, :, ::1] sign = self.sign
        cdef const int[::1] begin = self.begin
        cdef int[:, ::1] beside = np.empty((self.count, 2), np.int32)
        cdef Py_ssize_t columns = change.shape[1]
        cdef Py_ssize_t r, i, h, k, m, n, x
        cdef Py_ssize_t[3] e
        cdef Py_ssize_t[2] c
        cdef float[3] a
        cdef float[3] own
        cdef float[3] s
        cdef float lo, hi, v
        cdef const float *b = &change[0, 0, 0]
        cdef const signed char *g = &sign[0, 0, 0]
        with nogil:
            for x in range(beside.shape[0]):
                beside[x, 0] = -1
                beside[x, 1] = -1
            for r in range(change.shape[0] - 1):
                for i in range(columns - 1):
                    for h in range(2):
                        # the right and the left triangle: from the corner to a node beside it, on, and straight there
                        e[0] = 3 * (r * columns + i) + h
                        e[1] = 3 * ((r + h) * columns + i + 1 - h) + 1 - h
                        e[2] = 3 * (r * columns + i) + 2
                        n = (begin[e[0] + 1] - begin[e[0]]) + (begin[e[1] + 1] - begin[e[1]])
                        if n + (begin[e[2] + 1] - begin[e[2]]) < 2 or g[e[0]] * g[e[1]] * g[e[2]] <= 0:
                            continue
                        s[0] = <float>1.0
                        s[1] = g[e[0]]
                        s[2] = <float>1.0
                        if fabsf(b[e[0]] + s[1] * b[e[1]] - b[e[2]]) > RESIDUE:
                            continue
                        # phases where the links start: as they see themselves, and as the corner sees them
                        own[0] = phase[low + r, i] - level
                        own[1] = phase[low + r + h, i + 1 - h] - level
                        own[2] = own[0]
                        a[0] = own[0]
                        a[1] = own[0] + b[e[0]]
                        a[2] = own[0]
                        lo = a[0]
                        hi = a[0]
                        for k in range(2):
                            v = a[k] + s[k] * b[e[k]]
                            lo = v if v < lo else lo
                            hi = v if v > hi else hi
                        v = floorf(lo) + <float>1.0
                        while v <= hi:
                            m = 0
                            for k in range(3):
                                x = <Py_ssize_t>(
                                    floorf(own[k] + s[k] * (v - a[k]) + <float>0.5) - _first(own[k], b[e[k]])
                                )
                                if 0 <= x < begin[e[k] + 1] - begin[e[k]] and m < 2:
                                    c[m] = begin[e[k]] + x
                                    m += 1
                            if m == 2:
                                for k in range(2):
                                    x = c[k]
                                    if beside[x, 0] < 0:
                                        beside[x, 0] = <int>c[1 - k]
                                    elif beside[x, 1] < 0:
                                        beside[x, 1] = <int>c[1 - k]
                            v = v + <float>1.0
        return np.asarray(beside)


def follow(
    int[:, ::1] beside, const float[:, ::1] place, const int[::1] border,
    float[:, ::1] points, int[::1] first, int[:, ::1] ends,
):
    """Lines of crossings that are beside each other; returns how many. beside is used up.

    Crossings of diagonal links only lead on, for there are enough others, unless a line ends at one.
    points: (p, 2) of all lines, a ring's last one being its first. first: where each line starts in it.
    ends: (lines, 2) what border says of a line's ends, -2 for both of a ring.
    """
    cdef Py_ssize_t x, before, after, start, turn
    cdef Py_ssize_t n = 0
    cdef Py_ssize_t lines = 0
    with nogil:
        first[0] = 0
        for turn in range(2):
            for start in range(beside.shape[0]):
                # lines with ends, then the rings that are left
                if beside[start, 0] < 0 or (turn == 0 and beside[start, 1] >= 0):
                    continue
                x = start
                before = -1
                while True:
                    after = beside[x, 0] if beside[x, 0] != before else beside[x, 1]
                    if border[x] != -2 or (turn == 0 and (after < 0 or before < 0)):
                        points[n, 0] = place[x, 0]
                        points[n, 1] = place[x, 1]
                        n += 1
                    beside[x, 0] = -1
                    beside[x, 1] = -1
                    if after < 0 or after == start:
                        break
                    before = x
                    x = after
                if turn == 1:
                    if n - first[lines] < 4:
                        n = first[lines]
                        continue
                    points[n, 0] = points[first[lines], 0]
                    points[n, 1] = points[first[lines], 1]
                    n += 1
                ends[lines, 0] = (border[start] if border[start] >= 0 else -1) if turn == 0 else -2
                ends[lines, 1] = (border[x] if border[x] >= 0 else -1) if turn == 0 else -2
                lines += 1
                first[lines] = <int>n
    return lines


def gather(
    const float[:, ::1] points, const long long[::1] begin, const long long[::1] count, const long long[::1] step,
    float[:, ::1] out,
):
    """Runs of points one after the other: of run k count[k] points from begin[k] on by step[k], 1 or -1."""
    cdef Py_ssize_t k, p
    cdef Py_ssize_t n = 0
    with nogil:
        for k in range(begin.shape[0]):
            p = begin[k]
            for _ in range(count[k]):
                out[n, 0] = points[p, 0]
                out[n, 1] = points[p, 1]
                n += 1
                p += step[k]
