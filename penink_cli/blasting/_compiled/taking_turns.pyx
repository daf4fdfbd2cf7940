# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled loops: the lines beside lines; two sides for the members of a graph, such that neighbours differ.

Only `taking_turns` imports this module.
"""

from libc.math cimport fabs


#: The search for the next line across, in parts of the distance of lines: where it begins and its step; how many steps.
cdef double _NEAREST = 0.5, _STEP = 0.14
cdef int _PROBES = 11
#: The bounds within which the distance of two lines is believed, in parts of the usual one.
cdef double _LEAST = 0.4, _MOST = 2.0
#: The least cosine of the angle between two lines that count as beside each other.
cdef double _ALIKE_COSINE = 0.8
#: The same, for a page, by the names that they have there.
SEARCH = {
    "NEAREST": _NEAREST, "PROBE_STEP": _STEP, "PROBES": _PROBES, "LEAST_APART": _LEAST, "MOST_APART": _MOST,
    "ALIKE_COSINE": _ALIKE_COSINE,
}  # fmt: skip


cdef class Neighbours:
    """Lines about so far apart as spacing, and a grid in which those beside a line are found.

        ┌─────┬─────┬─────┐      Each cell holds a sample of the line that passes it (a, b), or none. From sample i of
        │  a──┼──a──┼──a  │      line b the cells along its normal are looked at, from half a spacing on: the first
        ├─────┼──↑──┼─────┤      that holds another line's sample tells the next line on that side. Against the
        │     │  ┊  │     │      normal it is the same. A ring or a spiral may be beside itself: samples of the same
        ├─────┼──┊──┼─────┤      line count where they are further than `near` along it.
        │  b──┼──i──┼──b  │
        └─────┴─────┴─────┘

    points: (p, 2) samples, one line after the other; normals: (p, 2) unit vectors; which: (p,) the line of each. there:
    (rows, columns) the sample in each cell, -1 for none; cells are `cell` wide, from left, top. All lengths are in the
    unit of spacing.
    """

    cdef double[:, ::1] points, normals
    cdef int[::1] which
    cdef int[:, ::1] there
    cdef double left, top, cell, spacing
    cdef int near

    def __init__(
        self, double[:, ::1] points, double[:, ::1] normals, int[::1] which, int[:, ::1] there, double left, double top,
        double cell, double spacing, int near,
    ) -> None:
        self.points = points
        self.normals = normals
        self.which = which
        self.there = there
        self.left = left
        self.top = top
        self.cell = cell
        self.spacing = spacing
        self.near = near

    def mark(self, int[::1] some) -> None:
        """Put the nearest of `some` samples, in order, into each cell that their lines pass, four places a sample.

        Cells of a line share edges, so that no ray of steps shorter than a cell slips through a corner.
        """
        cdef Py_ssize_t k, n
        cdef int i, after, x, y, x_before, y_before
        cdef double part
        cdef double[:, ::1] points = self.points
        with nogil:
            for k in range(some.shape[0]):
                i = some[k]
                after = i + 1 if i + 1 < points.shape[0] and self.which[i + 1] == self.which[i] else i
                x_before = y_before = -1
                for n in range(5 if after != i else 1):
                    part = 0.25 * n
                    x = <int>((points[i, 0] + part * (points[after, 0] - points[i, 0]) - self.left) / self.cell)
                    y = <int>((points[i, 1] + part * (points[after, 1] - points[i, 1]) - self.top) / self.cell)
                    if x < 0 or y < 0 or x >= self.there.shape[1] or y >= self.there.shape[0]:
                        continue
                    if n < 4:
                        self.there[y, x] = i if n < 2 else after
                    if x_before >= 0 and x_before != x and y_before != y:
                        self.there[y, x_before] = i if n < 2 else after
                    x_before = x
                    y_before = y

    cdef int next(self, int i, double side) noexcept nogil:
        """The sample of another line that is met first from sample i, on one side (1, -1) along its normal; or -1."""
        cdef Py_ssize_t n
        cdef int hit, x, y, gap
        cdef double way
        cdef double first = side * (_NEAREST * self.spacing)
        cdef double step = side * (_STEP * self.spacing)
        cdef double at_x = self.points[i, 0], at_y = self.points[i, 1]
        cdef double normal_x = self.normals[i, 0], normal_y = self.normals[i, 1]
        for n in range(_PROBES):
            way = first + n * step
            x = <int>((at_x + way * normal_x - self.left) / self.cell)
            y = <int>((at_y + way * normal_y - self.top) / self.cell)
            if x < 0 or y < 0 or x >= self.there.shape[1] or y >= self.there.shape[0]:
                continue
            hit = self.there[y, x]
            gap = hit - i
            if hit >= 0 and (self.which[hit] != self.which[i] or gap > self.near or -gap > self.near):
                return hit
        return -1

    def beside(self, int[::1] some, int[:, ::1] out) -> None:
        """Fill (n, 2): the sample of another line next to each of `some` samples, on both sides, -1 for none."""
        cdef Py_ssize_t k
        with nogil:
            for k in range(some.shape[0]):
                out[k, 0] = self.next(some[k], 1.0)
                out[k, 1] = self.next(some[k], -1.0)

    def distances(self, double[::1] apart, double[::1] more, unsigned char[::1] both) -> None:
        """How far each sample is from the next lines: the mean of both sides, and how much more to the normal's side.

        both: out, whether there are two, within a small angle; elsewhere apart is the spacing, more nought.
        A distance is measured along the mean of both normals. So it does not matter how far along its line the other
        sample is.
        """
        cdef Py_ssize_t i, side
        cdef int hit
        cdef double cosine, x, y, d
        cdef double[2] away
        cdef double[:, ::1] points = self.points, normals = self.normals
        with nogil:
            for i in range(points.shape[0]):
                both[i] = 1
                for side in range(2):
                    hit = self.next(<int>i, 1.0 - 2.0 * side)
                    cosine = 0.0
                    if hit >= 0:
                        cosine = normals[i, 0] * normals[hit, 0] + normals[i, 1] * normals[hit, 1]
                    if fabs(cosine) <= _ALIKE_COSINE:
                        both[i] = 0
                        break
                    d = -1.0 if cosine < 0.0 else 1.0
                    x = normals[i, 0] + d * normals[hit, 0]
                    y = normals[i, 1] + d * normals[hit, 1]
                    d = 0.5 * fabs((points[hit, 0] - points[i, 0]) * x + (points[hit, 1] - points[i, 1]) * y)
                    away[side] = min(_MOST * self.spacing, max(_LEAST * self.spacing, d))
                apart[i] = 0.5 * (away[0] + away[1]) if both[i] else self.spacing
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
