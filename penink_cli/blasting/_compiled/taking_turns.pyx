# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled loops: the lines beside lines; two sides for the members of a graph, such that neighbours differ.

Only `taking_turns` imports this module.
"""

from libc.math cimport fabs


def mark(
    double[:, ::1] points, int[::1] which, int[::1] some, Py_ssize_t columns, Py_ssize_t rows, double left, double top,
    double cell, int[::1] there,
):
    """Put the nearest of `some` samples, in order, into each cell that their lines pass, four places a sample."""
    cdef Py_ssize_t k, n
    cdef int i, after, x, y
    cdef double part
    with nogil:
        for k in range(some.shape[0]):
            i = some[k]
            after = i + 1 if i + 1 < points.shape[0] and which[i + 1] == which[i] else i
            for n in range(4):
                part = 0.25 * n
                x = <int>((points[i, 0] + part * (points[after, 0] - points[i, 0]) - left) / cell)
                y = <int>((points[i, 1] + part * (points[after, 1] - points[i, 1]) - top) / cell)
                if 0 <= x < columns and 0 <= y < rows:
                    there[y * columns + x] = i if n < 2 else after


cdef int _next(
    double[:, ::1] points, double[:, ::1] normals, int[::1] which, int[::1] there, Py_ssize_t columns,
    Py_ssize_t rows, double left, double top, double cell, double first, double step, Py_ssize_t probes, int near,
    int i,
) noexcept nogil:
    """The sample of another line that is met first from sample i: along its normal, or against it by a negative step.

    there: (rows · columns) a sample in each cell, which are so wide, from left, top; -1 for none. which: the line of
    each sample. A line is looked for at so many places, a step apart, from first on; on the same line only samples
    further than near count. Returns -1 if there is none.
    """
    cdef Py_ssize_t n
    cdef int hit, x, y
    cdef double way
    for n in range(probes):
        way = first + n * step
        x = <int>((points[i, 0] + way * normals[i, 0] - left) / cell)
        y = <int>((points[i, 1] + way * normals[i, 1] - top) / cell)
        if x < 0 or y < 0 or x >= columns or y >= rows:
            continue
        hit = there[y * columns + x]
        if hit >= 0 and (which[hit] != which[i] or hit - i > near or i - hit > near):
            return hit
    return -1


def beside(
    double[:, ::1] points, double[:, ::1] normals, int[::1] which, int[::1] there, Py_ssize_t columns,
    Py_ssize_t rows, double left, double top, double cell, double first, double step, Py_ssize_t probes, int near,
    int[::1] some, int[:, ::1] out,
):
    """The sample (n, 2) of another line next to each of `some` samples, on both sides, see `_next`."""
    cdef Py_ssize_t k
    with nogil:
        for k in range(some.shape[0]):
            out[k, 0] = _next(
                points, normals, which, there, columns, rows, left, top, cell, first, step, probes, near, some[k]
            )
            out[k, 1] = _next(
                points, normals, which, there, columns, rows, left, top, cell, -first, -step, probes, near, some[k]
            )


def distances(
    double[:, ::1] points, double[:, ::1] normals, int[::1] which, int[::1] there, Py_ssize_t columns,
    Py_ssize_t rows, double left, double top, double cell, double first, double step, Py_ssize_t probes, int near,
    double least, double most, double usual, double alike, double[::1] apart, double[::1] more, unsigned char[::1] both,
):
    """How far it is from each sample to the next lines: the mean of both sides, and how much more to the normal's side.

    both: out, whether there are two, within so small an angle (its cosine); elsewhere apart is as usual, more nought.
    Each distance is along the mean of both normals, so that it does not matter how far along its line the other sample
    is; it is taken to lie between least and most.
    """
    cdef Py_ssize_t i, side
    cdef int hit
    cdef double cosine, x, y, d
    cdef double[2] away
    with nogil:
        for i in range(points.shape[0]):
            both[i] = 1
            for side in range(2):
                d = 1.0 - 2.0 * side
                hit = _next(
                    points, normals, which, there, columns, rows, left, top, cell, d * first, d * step, probes, near,
                    <int>i,
                )
                cosine = 0.0
                if hit >= 0:
                    cosine = normals[i, 0] * normals[hit, 0] + normals[i, 1] * normals[hit, 1]
                if fabs(cosine) <= alike:
                    both[i] = 0
                    break
                d = -1.0 if cosine < 0.0 else 1.0
                x = normals[i, 0] + d * normals[hit, 0]
                y = normals[i, 1] + d * normals[hit, 1]
                d = 0.5 * fabs((points[hit, 0] - points[i, 0]) * x + (points[hit, 1] - points[i, 1]) * y)
                away[side] = least if d < least else (most if d > most else d)
            apart[i] = 0.5 * (away[0] + away[1]) if both[i] else usual
            more[i] = away[0] - away[1] if both[i] else 0.0


cdef inline int _root(int[::1] parent, signed char[::1] side, int i) noexcept nogil:
    """The root of i's tree; on return i hangs from it directly, and side[i] is whether it differs from it."""
    cdef int root = i, up
    cdef signed char differs = 0, rest
    while parent[root] != root:
        differs ^= side[root]
        root = parent[root]
    while parent[i] != root and i != root:
        up = parent[i]
        rest = differs ^ side[i]
        parent[i] = root
        side[i] = differs
        differs = rest
        i = up
    return root


def join(int[::1] a, int[::1] b, signed char[::1] differ, int[::1] parent, signed char[::1] side):
    """Sides (n,), 0 or 1, that the links a, b ask for, which come the weightiest first: later ones may not be heard.

    differ: (m,) whether two that are linked are to be on different sides. parent: (n,) scratch, 0, 1, 2 …
    """
    cdef Py_ssize_t k
    cdef int p, q
    with nogil:
        for k in range(a.shape[0]):
            p = _root(parent, side, a[k])
            q = _root(parent, side, b[k])
            if p != q:
                # a root's own side is nought until it hangs from another
                side[q] = differ[k] ^ side[a[k]] ^ side[b[k]]
                parent[q] = p
        for k in range(parent.shape[0]):
            _root(parent, side, <int>k)


def settle(
    long long[::1] begin, int[::1] other, float[::1] weight, signed char[::1] side, Py_ssize_t rounds
):
    """Let each change sides where its links (other[begin[i] : begin[i + 1]]) ask for it, a few rounds.

    weight: of each link, positive where both are to be on one side. Returns how many changed.
    """
    cdef Py_ssize_t _r, i, k
    cdef Py_ssize_t changed = 0
    cdef float asks
    with nogil:
        for _r in range(rounds):
            for i in range(side.shape[0]):
                asks = <float>0.0
                for k in range(begin[i], begin[i + 1]):
                    asks += weight[k] if side[other[k]] == side[i] else -weight[k]
                if asks < <float>0.0:
                    side[i] ^= 1
                    changed += 1
    return changed
