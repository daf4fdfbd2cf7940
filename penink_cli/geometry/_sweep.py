# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""A sweep that finds whether any two edges meet other than at a shared vertex (Shamos and Hoey 1976), exactly.

Vertices are visited by x, then y. The edges that the sweep line crosses are kept in their order along it, in a treap
whose split at the visited vertex yields the edges below it, through it and above it. As long as nothing wrong has been
seen the order is true, and the leftmost wrong meeting is always one of: an edge through a vertex that is not its end,
two edges leaving a vertex in one direction, two neighbours that cross.
"""

import cython
from cython.cimports.libc.stdlib import free, malloc
from cython.cimports.penink_cli.geometry._predicates import orient

COMPILED = cython.compiled

CROSS = cython.declare(cython.int, 1)
TOUCH = cython.declare(cython.int, 2)
OVERLAP = cython.declare(cython.int, 3)


@cython.cclass
class Sweep:
    """The order of edges along the sweep line: node k of the treap is edge k."""

    x: cython.p_double
    y: cython.p_double
    start: cython.p_int
    end: cython.p_int
    left: cython.p_int
    right: cython.p_int
    priority: cython.p_uint

    def __init__(self, x: cython.double[::1], y: cython.double[::1], start: cython.int[::1], end: cython.int[::1]):
        n: cython.Py_ssize_t = start.shape[0]
        k: cython.Py_ssize_t
        h: cython.uint
        self.x = cython.address(x[0])
        self.y = cython.address(y[0])
        self.start = cython.address(start[0])
        self.end = cython.address(end[0])
        self.left = cython.cast(cython.p_int, malloc(n * cython.sizeof(cython.int)))
        self.right = cython.cast(cython.p_int, malloc(n * cython.sizeof(cython.int)))
        self.priority = cython.cast(cython.p_uint, malloc(n * cython.sizeof(cython.uint)))
        for k in range(n):  # an integer hash, so that no input can be built to unbalance the treap by its order alone
            h = cython.cast(cython.uint, k) * cython.cast(cython.uint, 2654435769) + 1
            h ^= h >> 15
            h = h * cython.cast(cython.uint, 2246822519)
            h ^= h >> 13
            self.priority[k] = h

    def __dealloc__(self):
        free(self.left)
        free(self.right)
        free(self.priority)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def side(self, e: cython.int, v: cython.int) -> cython.int:
        """Side of vertex v along the sweep line as seen from edge e: 1 above, −1 below, 0 on it."""
        a: cython.int = self.start[e]
        b: cython.int = self.end[e]
        return orient(self.x[a], self.y[a], self.x[b], self.y[b], self.x[v], self.y[v])

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def split(
        self, t: cython.int, v: cython.int, bound: cython.int, below: cython.p_int, rest: cython.p_int
    ) -> cython.void:
        """Part a treap: `below` gets the edges for which side(e, v) ≥ bound, those lower on the sweep line."""
        if t < 0:
            below[0] = -1
            rest[0] = -1
        elif self.side(t, v) >= bound:
            below[0] = t
            self.split(self.right[t], v, bound, cython.address(self.right[t]), rest)
        else:
            rest[0] = t
            self.split(self.left[t], v, bound, below, cython.address(self.left[t]))

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def join(self, a: cython.int, b: cython.int) -> cython.int:
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

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def stranger(self, t: cython.int, v: cython.int) -> cython.int:
        """An edge of a treap that does not end at v, −1 if all do."""
        found: cython.int
        if t < 0:
            return -1
        if self.end[t] != v:
            return t
        found = self.stranger(self.left[t], v)
        return found if found >= 0 else self.stranger(self.right[t], v)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def crossing(self, e: cython.int, f: cython.int) -> cython.bint:
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
    x: cython.double[::1],
    y: cython.double[::1],
    order: cython.int[::1],
    start: cython.int[::1],
    end: cython.int[::1],
    leaving: cython.int[::1],
    first: cython.int[::1],
) -> tuple[str, int, int] | None:
    """The first wrong meeting: its kind (cross, touch, overlap), an edge, and an edge or for touch a vertex; or None.

    x, y: (n,) vertices, no two alike. order: (n,) vertices by x, then y.
    start, end: (m,) the ends of each edge, start first in that order.
    leaving: (m,) edges by start vertex, then roughly by slope; those of vertex v begin at first[v].
    """
    n: cython.Py_ssize_t = order.shape[0]
    i: cython.Py_ssize_t
    k: cython.int
    j: cython.int
    e: cython.int
    v: cython.int
    s: cython.int
    tree: cython.int = -1
    below: cython.int = -1
    through: cython.int = -1
    above: cython.int = -1
    low: cython.int
    high: cython.int
    kind: cython.int = 0
    one: cython.int = -1
    two: cython.int = -1
    if start.shape[0] == 0:
        return None
    sweep: Sweep = Sweep(x, y, start, end)
    with cython.nogil:
        for i in range(n):
            v = order[i]
            sweep.split(tree, v, 1, cython.address(below), cython.address(through))
            sweep.split(through, v, 0, cython.address(through), cython.address(above))
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


def orientation(
    ax: cython.double, ay: cython.double, bx: cython.double, by: cython.double, cx: cython.double, cy: cython.double
) -> cython.int:
    """Exact sign of (b − a) × (c − a)."""
    return orient(ax, ay, bx, by, cx, cy)
