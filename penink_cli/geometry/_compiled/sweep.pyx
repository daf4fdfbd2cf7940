# cython: boundscheck=False, wraparound=False, cdivision=True
"""A sweep that finds whether any two edges meet other than at a shared vertex (Shamos and Hoey 1976), exactly.

Vertices are visited by x, then y. The edges that the sweep line crosses are kept in their order along it, in a balanced
tree whose split at the visited vertex v yields the edges below it, through it and above it:

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
from libc.string cimport memcpy
from penink_cli.geometry._compiled.predicates cimport orient
from penink_cli.ground._compiled.memory cimport room

cdef int CROSS = 1
cdef int TOUCH = 2
cdef int OVERLAP = 3


cdef class Sweep:
    """The order of edges along the sweep line: node k of the tree is edge k.

    The tree is balanced by height (Adelson-Velsky and Landis 1962), split and joined as Adams 1993 does. A tree that is
    balanced by chance would be smaller code, but who writes the file could choose edges that make it a path.
    """

    cdef double* x
    cdef double* y
    cdef int* start
    cdef int* end
    cdef int* left
    cdef int* right
    cdef int* height
    cdef int* spare

    def __init__(self, double[::1] x, double[::1] y, int[::1] start, int[::1] end):
        cdef Py_ssize_t n = start.shape[0]
        self.x = &x[0]
        self.y = &y[0]
        self.start = &start[0]
        self.end = &end[0]
        self.left = <int*>room(n, sizeof(int))
        self.right = <int*>room(n, sizeof(int))
        self.height = <int*>room(n, sizeof(int))
        self.spare = <int*>room(n, sizeof(int))

    def __dealloc__(self):
        free(self.left)
        free(self.right)
        free(self.height)
        free(self.spare)

    cdef int side(self, int e, int v) noexcept nogil:
        """Side of vertex v along the sweep line as seen from edge e: 1 above, −1 below, 0 on it."""
        cdef int a = self.start[e]
        cdef int b = self.end[e]
        return orient(self.x[a], self.y[a], self.x[b], self.y[b], self.x[v], self.y[v])

    cdef inline int height_of(self, int t) noexcept nogil:
        return self.height[t] if t >= 0 else 0

    cdef inline int node(self, int a, int t, int b) noexcept nogil:
        """The tree of `t` between the trees `a` and `b`, whose heights differ by two at most."""
        self.left[t] = a
        self.right[t] = b
        self.height[t] = max(self.height_of(a), self.height_of(b)) + 1
        return t

    cdef int balanced(self, int a, int t, int b) noexcept nogil:
        """`node` of trees whose heights differ by three at most."""
        cdef int m
        if self.height_of(a) > self.height_of(b) + 2:
            m = self.right[a]
            if self.height_of(self.left[a]) >= self.height_of(m):
                return self.node(self.left[a], a, self.node(m, t, b))
            return self.node(self.node(self.left[a], a, self.left[m]), m, self.node(self.right[m], t, b))
        if self.height_of(b) > self.height_of(a) + 2:
            m = self.left[b]
            if self.height_of(self.right[b]) >= self.height_of(m):
                return self.node(self.node(a, t, m), b, self.right[b])
            return self.node(self.node(a, t, self.left[m]), m, self.node(self.right[m], b, self.right[b]))
        return self.node(a, t, b)

    cdef int link(self, int a, int t, int b) noexcept nogil:
        """One tree of all of `a`, then `t`, then all of `b`. Steps: by how much the heights differ."""
        if self.height_of(a) > self.height_of(b) + 2:
            return self.balanced(self.left[a], a, self.link(self.right[a], t, b))
        if self.height_of(b) > self.height_of(a) + 2:
            return self.balanced(self.link(a, t, self.left[b]), b, self.right[b])
        return self.node(a, t, b)

    cdef int without_lowest(self, int t, int* lowest) noexcept nogil:
        """A tree without its lowest edge, which `lowest` gets."""
        if self.left[t] < 0:
            lowest[0] = t
            return self.right[t]
        return self.balanced(self.without_lowest(self.left[t], lowest), t, self.right[t])

    cdef int join(self, int a, int b) noexcept nogil:
        """One tree of two, all of `a` below all of `b`."""
        cdef int rest
        cdef int lowest = -1
        if a < 0:
            return b
        if b < 0:
            return a
        rest = self.without_lowest(b, &lowest)
        return self.link(a, lowest, rest)

    cdef void split(self, int t, int v, int bound, int* below, int* rest) noexcept nogil:
        """Part a tree: `below` gets the edges for which side(e, v) ≥ bound, those lower on the sweep line."""
        if t < 0:
            below[0] = -1
            rest[0] = -1
        elif self.side(t, v) >= bound:
            self.split(self.right[t], v, bound, below, rest)
            below[0] = self.link(self.left[t], t, below[0])
        else:
            self.split(self.left[t], v, bound, below, rest)
            rest[0] = self.link(rest[0], t, self.right[t])

    cdef int stranger(self, int t, int v) noexcept nogil:
        """An edge of a treap that does not end at v, −1 if all do."""
        cdef int found
        if t < 0:
            return -1
        if self.end[t] != v:
            return t
        found = self.stranger(self.left[t], v)
        return found if found >= 0 else self.stranger(self.right[t], v)

    cdef void by_slope(self, int* leaving, Py_ssize_t n) noexcept nogil:
        """Sort n edges that leave one vertex by slope, exactly, by merging runs of twice the length each time."""
        cdef Py_ssize_t i, j, k, middle, last
        cdef Py_ssize_t begin = 0
        cdef Py_ssize_t run = 1
        while run < n:
            begin = 0
            while begin + run < n:
                middle = begin + run
                last = min(middle + run, n)
                memcpy(self.spare, leaving + begin, run * sizeof(int))
                i, j, k = 0, middle, begin
                while i < run and j < last:
                    if self.side(self.spare[i], self.end[leaving[j]]) >= 0:
                        leaving[k] = self.spare[i]
                        i += 1
                    else:
                        leaving[k] = leaving[j]
                        j += 1
                    k += 1
                memcpy(leaving + k, self.spare + i, (run - i) * sizeof(int))
                begin = last
            run *= 2

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
    cdef int k, e, v, s, low, high
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
            # The edges that leave v come by their slopes rounded: almost always that is their exact order.
            k = first[v] + 1
            while k < first[v + 1]:
                s = sweep.side(leaving[k - 1], end[leaving[k]])
                k += 1
                if s < 0:
                    sweep.by_slope(&leaving[first[v]], first[v + 1] - first[v])
                    k = first[v] + 1
                elif s == 0:
                    kind = OVERLAP
                    one = leaving[k - 2]
                    two = leaving[k - 1]
                    break
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
            if first[v] == first[v + 1]:
                tree = sweep.join(below, above)
            else:
                tree = below
                for k in range(first[v], first[v + 1] - 1):
                    tree = sweep.link(tree, leaving[k], -1)
                tree = sweep.link(tree, leaving[first[v + 1] - 1], above)
    return ("cross" if kind == CROSS else "touch" if kind == TOUCH else "overlap", one, two) if kind else None


def orientation(double ax, double ay, double bx, double by, double cx, double cy):
    """Exact sign of (b − a) × (c − a)."""
    return orient(ax, ay, bx, by, cx, cy)
