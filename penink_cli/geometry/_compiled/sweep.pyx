# cython: boundscheck=False, wraparound=False, cdivision=True
"""A sweep that finds whether any two edges meet other than at a shared vertex (Shamos and Hoey 1976), exactly.

Vertices are visited by x, then y. The edges that the sweep line crosses are kept in their order along it, in a treap
whose split at the visited vertex v yields the edges below it, through it and above it:

    ─────────────┼────── high      above    begins with `high`, the neighbour of v on that side
                 │
    through ─────v────── leaving   through  edges that end at v; another one that goes through v is wrong
                 │╲                leaving  edges that start at v, by slope; they take the place of `through`
    ─────────────┼──╲─── low       below    ends with `low`, the neighbour of v on that side
      sweep line, y grows      drawn with y upwards: what is "above" has the larger y

As long as nothing wrong has been seen the order is true, and the leftmost wrong meeting is always one of: an edge
through a vertex that is not its end, two edges leaving a vertex in one direction, two neighbours that cross.
"""

from libc.stdlib cimport free
from penink_cli.geometry._compiled.predicates cimport orient
from penink_cli.ground._compiled.memory cimport room

cdef int CROSS = 1
cdef int TOUCH = 2
cdef int OVERLAP = 3


cdef class Sweep:
    """The order of edges along the sweep line: node k of the treap is edge k."""

    cdef double* x
    cdef double* y
    cdef int* start
    cdef int* end
    cdef int* left
    cdef int* right
    cdef unsigned int* priority

    def __init__(self, double[::1] x, double[::1] y, int[::1] start, int[::1] end):
        cdef Py_ssize_t k
        cdef unsigned int h
        cdef Py_ssize_t n = start.shape[0]
        self.x = &x[0]
        self.y = &y[0]
        self.start = &start[0]
        self.end = &end[0]
        self.left = <int*>room(n, sizeof(int))
        self.right = <int*>room(n, sizeof(int))
        self.priority = <unsigned int*>room(n, sizeof(unsigned int))
        for k in range(n):  # an integer hash, so that no input can be built to unbalance the treap by its order alone
            h = <unsigned int>k * <unsigned int>2654435769 + 1
            h ^= h >> 15
            h = h * <unsigned int>2246822519
            h ^= h >> 13
            self.priority[k] = h

    def __dealloc__(self):
        free(self.left)
        free(self.right)
        free(self.priority)

    cdef int side(self, int e, int v) noexcept nogil:
        """Side of vertex v along the sweep line as seen from edge e: 1 above, −1 below, 0 on it."""
        cdef int a = self.start[e]
        cdef int b = self.end[e]
        return orient(self.x[a], self.y[a], self.x[b], self.y[b], self.x[v], self.y[v])

    cdef void split(self, int t, int v, int bound, int* below, int* rest) noexcept nogil:
        """Part a treap: `below` gets the edges for which side(e, v) ≥ bound, those lower on the sweep line."""
        if t < 0:
            below[0] = -1
            rest[0] = -1
        elif self.side(t, v) >= bound:
            below[0] = t
            self.split(self.right[t], v, bound, &self.right[t], rest)
        else:
            rest[0] = t
            self.split(self.left[t], v, bound, below, &self.left[t])

    cdef int join(self, int a, int b) noexcept nogil:
        """One treap of two, all of `a` below all of `b`."""
        if a < 0:
            return b
        if b < 0:
            return a
        if self.priority[a] > self.priority[b]:
            self.right[a] = self.join(self.right[a], b)
            return a
        self.left[b] = self.join(a, self.left[b])
        return b

    cdef int stranger(self, int t, int v) noexcept nogil:
        """An edge of a treap that does not end at v, −1 if all do."""
        cdef int found
        if t < 0:
            return -1
        if self.end[t] != v:
            return t
        found = self.stranger(self.left[t], v)
        return found if found >= 0 else self.stranger(self.right[t], v)

    cdef bint crossing(self, int e, int f) noexcept nogil:
        """Whether two neighbours meet elsewhere than at a shared vertex."""
        if (
            e < 0
            or f < 0
            or self.start[e] == self.start[f]
            or self.end[e] == self.end[f]
            or self.start[e] == self.end[f]
            or self.end[e] == self.start[f]
        ):
            return False
        return (
            self.side(e, self.start[f]) * self.side(e, self.end[f]) <= 0
            and self.side(f, self.start[e]) * self.side(f, self.end[e]) <= 0
        )


def find(
    double[::1] x, double[::1] y, int[::1] order, int[::1] start, int[::1] end, int[::1] leaving, int[::1] first
) -> tuple[str, int, int] | None:
    """The first wrong meeting: its kind (cross, touch, overlap), an edge, and an edge or for touch a vertex; or None.

    x, y: (n,) vertices, no two alike. order: (n,) vertices by x, then y.
    start, end: (m,) the ends of each edge, start first in that order.
    leaving: (m,) edges by start vertex, then roughly by slope; those of vertex v begin at first[v].
    """
    cdef Py_ssize_t i
    cdef int k, j, e, v, s, low, high
    cdef Py_ssize_t n = order.shape[0]
    cdef int tree = -1, below = -1, through = -1, above = -1, kind = 0, one = -1, two = -1
    if start.shape[0] == 0:
        return None
    cdef Sweep sweep = Sweep(x, y, start, end)
    with nogil:
        for i in range(n):
            v = order[i]
            sweep.split(tree, v, 1, &below, &through)
            sweep.split(through, v, 0, &through, &above)
            e = sweep.stranger(through, v)
            if e >= 0:
                kind = TOUCH
                one = e
                two = v
                break
            # The edges leaving v by slope, exactly; they come almost sorted.
            for k in range(first[v] + 1, first[v + 1]):
                e = leaving[k]
                j = k
                while j > first[v]:
                    s = sweep.side(leaving[j - 1], end[e])
                    if s > 0:
                        break
                    if s == 0:
                        kind = OVERLAP
                        one = leaving[j - 1]
                        two = e
                        break
                    leaving[j] = leaving[j - 1]
                    j -= 1
                if kind:
                    break
                leaving[j] = e
            if kind:
                break
            low = below
            while low >= 0 and sweep.right[low] >= 0:
                low = sweep.right[low]
            high = above
            while high >= 0 and sweep.left[high] >= 0:
                high = sweep.left[high]
            if first[v] == first[v + 1]:
                if sweep.crossing(low, high):
                    kind = CROSS
                    one = low
                    two = high
                    break
            else:
                if sweep.crossing(low, leaving[first[v]]):
                    kind = CROSS
                    one = low
                    two = leaving[first[v]]
                    break
                if sweep.crossing(leaving[first[v + 1] - 1], high):
                    kind = CROSS
                    one = leaving[first[v + 1] - 1]
                    two = high
                    break
            tree = below
            for k in range(first[v], first[v + 1]):
                e = leaving[k]
                sweep.left[e] = -1
                sweep.right[e] = -1
                tree = sweep.join(tree, e)
            tree = sweep.join(tree, above)
    return ("cross" if kind == CROSS else "touch" if kind == TOUCH else "overlap", one, two) if kind else None


def orientation(double ax, double ay, double bx, double by, double cx, double cy):
    """Exact sign of (b − a) × (c − a)."""
    return orient(ax, ay, bx, by, cx, cy)
