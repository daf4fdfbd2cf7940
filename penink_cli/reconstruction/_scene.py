# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Which points see each other past the discontinuity edges (section 2.2).

Everything is in sample units: sample (row i, column j) is the point (j, i). Decisions are
exact. A *query* (output pixel or sample) stands for p + (ε, ε²), so it is never on an edge,
on a vertex or in line with one; a tie goes by the sign of the next power of ε.
"""

import cython
from cython.cimports.libc.stdlib import free
from cython.cimports.penink_cli.geometry._predicates import orient

COMPILED = cython.compiled

PAD = 1e-7
MANY = cython.declare(cython.int, 4096)  # edges from which on they are numbered by their place,
FAR = cython.declare(cython.double, 8.0)  # if this far lies between one vertex and the next in the mean: not in chains
FEW = cython.declare(cython.int, 3)  # edges in a row of cells that are looked at without finding the cells


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def tie(x: cython.double, y: cython.double) -> cython.int:
    """Sign of (x, y) × (ε, ε²) reversed in no way: −sign(y), else sign(x)."""
    if y != 0.0:
        return -1 if y > 0.0 else 1
    if x != 0.0:
        return 1 if x > 0.0 else -1
    return 0


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def side_of_query(
    ax: cython.double, ay: cython.double, bx: cython.double, by: cython.double, qx: cython.double, qy: cython.double
) -> cython.int:
    """Side of the line of the vertices a → b on which the query q lies."""
    s: cython.int = orient(ax, ay, bx, by, qx, qy)
    return s if s != 0 else tie(bx - ax, by - ay)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def side_of_vertex(
    px: cython.double, py: cython.double, qx: cython.double, qy: cython.double, ax: cython.double, ay: cython.double
) -> cython.int:
    """Side of the line of the queries p → q on which the vertex a lies."""
    s: cython.int = orient(px, py, qx, qy, ax, ay)
    return s if s != 0 else -tie(qx - px, qy - py)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def span(
    ax: cython.double,
    ay: cython.double,
    bx: cython.double,
    by: cython.double,
    row: cython.int,
    left: cython.p_double,
    right: cython.p_double,
) -> cython.void:
    """The x range of a segment within one row of cells, a little too wide."""
    x0: cython.double = ax
    x1: cython.double = bx
    low: cython.double = row - PAD
    high: cython.double = row + 1 + PAD
    if ay < low:
        x0 = ax + (bx - ax) * ((low - ay) / (by - ay))
    elif ay > high:
        x0 = ax + (bx - ax) * ((high - ay) / (by - ay))
    if by < low:
        x1 = ax + (bx - ax) * ((low - ay) / (by - ay))
    elif by > high:
        x1 = ax + (bx - ax) * ((high - ay) / (by - ay))
    left[0] = (x0 if x0 < x1 else x1) - PAD
    right[0] = (x1 if x0 < x1 else x0) + PAD


@cython.final  # calls are direct, and inlined
@cython.cclass
class Scene:
    """Edges in sample units, bucketed by unit cell; the nodes, and the arcs between them up to `reach` long.

    A new one holds the edges alone: `_cells.sort_edges` and then `_nodes.find` fill in the rest.
    """

    def __init__(self, vertices, edges, width: cython.int, height: cython.int, reach: cython.double):
        import numpy as np

        self.width = width
        self.height = height
        self.reach = reach
        self.n_edges = len(edges)
        self.n_vertices = len(vertices)
        self.gw = width + 1
        self.gh = height + 1
        x = np.ascontiguousarray(vertices[:, 0], np.float64)
        y = np.ascontiguousarray(vertices[:, 1], np.float64)
        a = np.ascontiguousarray(edges[:, 0], np.intc)
        b = np.ascontiguousarray(edges[:, 1], np.intc)
        if self.n_edges > MANY and np.abs(np.diff(y)).mean() > FAR:
            order = by_place(x, y, width, height)
            rank = np.empty_like(order)
            rank[order] = np.arange(len(order), dtype=np.intc)
            x, y, a, b = x[order], y[order], rank[a], rank[b]
            order = by_place(x[a], y[a], width, height)
            a, b = a[order], b[order]
        self.arrays = [x, y, a, b]
        if self.n_edges:
            self.vx = doubles(x)
            self.vy = doubles(y)
            self.ea = ints(a)
            self.eb = ints(b)

    def __dealloc__(self):
        free(self.arc_to)
        free(self.arc_length)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def row_of(self, y: cython.double) -> cython.int:
        """Row of the grid of cells, in range; row 0 is the half cell along the border."""
        y += 1.0  # what rounding does here is far within the padding of the cells
        return 0 if y < 0.0 else (self.gh - 1 if y >= self.gh else cython.cast(cython.int, y))

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def column_of(self, x: cython.double) -> cython.int:
        """Column of the grid of cells, in range."""
        x += 1.0
        return 0 if x < 0.0 else (self.gw - 1 if x >= self.gw else cython.cast(cython.int, x))

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def clear(self, x0: cython.double, y0: cython.double, x1: cython.double, y1: cython.double) -> cython.bint:
        """True if no edge comes near the rectangle."""
        c0: cython.int = self.column_of(x0)
        c1: cython.int = self.column_of(x1)
        row: cython.int
        for row in range(self.row_of(y0), self.row_of(y1) + 1):
            if self.cell_start[row * self.gw + c1 + 1] > self.cell_start[row * self.gw + c0]:
                return False
        return True

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def empty_around(self, column: cython.int, row: cython.int) -> cython.bint:
        """True if no edge touches a cell or its eight neighbours; −1 is the half cell along the border."""
        left: cython.int = 0 if column < 0 else column
        right: cython.int = column + 2 if column + 2 < self.gw else self.gw - 1
        r: cython.int
        for r in range(0 if row < 0 else row, (row + 2 if row + 2 < self.gh else self.gh - 1) + 1):
            if self.cell_start[r * self.gw + right + 1] > self.cell_start[r * self.gw + left]:
                return False
        return True

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def sees(self, px: cython.double, py: cython.double, qx: cython.double, qy: cython.double) -> cython.bint:
        """Whether two queries see each other."""
        if px == qx and py == qy:
            return True
        return not self.obstructed(px, py, qx, qy, -1, -1)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def sees_vertex(self, qx: cython.double, qy: cython.double, v: cython.int) -> cython.bint:
        """Whether no edge lies between a query and a vertex; the edges at the vertex are `bends_for`'s concern."""
        return not self.obstructed(qx, qy, self.vx[v], self.vy[v], -1, v)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def joined(self, u: cython.int, v: cython.int) -> cython.bint:
        """Whether the open segment between two vertices that share no edge meets neither edge nor vertex."""
        return not self.obstructed(self.vx[u], self.vy[u], self.vx[v], self.vy[v], u, v)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def obstructed(
        self,
        px: cython.double,
        py: cython.double,
        qx: cython.double,
        qy: cython.double,
        u: cython.int,
        v: cython.int,
    ) -> cython.bint:
        """Whether an edge meets the segment from p to q, which are the vertices u and v, or queries where those are −1.

        Walks the cells that the segment touches, in a crowded cell those of its own finer grid. In a row of cells with
        few edges beside the segment it is cheaper to look at them all than to find its cells there.
        """
        row: cython.int
        k: cython.int
        e: cython.int = -1
        first: cython.int
        last: cython.int
        left: cython.double = 0.0
        right: cython.double = 0.0
        low: cython.double = py if py < qy else qy
        high: cython.double = qy if py < qy else py
        c0: cython.int = self.column_of((px if px < qx else qx) - PAD)
        c1: cython.int = self.column_of((qx if px < qx else px) + PAD)
        for row in range(self.row_of(low - PAD), self.row_of(high + PAD) + 1):
            first = self.cell_start[row * self.gw + c0]
            last = self.cell_start[row * self.gw + c1 + 1]
            if last - first > FEW:
                span(px, py, qx, qy, row - 1, cython.address(left), cython.address(right))
                first = self.cell_start[row * self.gw + self.column_of(left)]
                last = self.cell_start[row * self.gw + self.column_of(right) + 1]
                if self.n_crowded and last - first >= CROWD:
                    if self.obstructed_in_crowd(px, py, qx, qy, u, v, row, self.column_of(left), self.column_of(right)):
                        return True
                    continue
            for k in range(first, last):
                if self.cell_edge[k] != e:  # the same in the next cell
                    e = self.cell_edge[k]
                    if self.meets(e, px, py, qx, qy, u, v):
                        return True
        return False

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def obstructed_in_crowd(
        self,
        px: cython.double,
        py: cython.double,
        qx: cython.double,
        qy: cython.double,
        u: cython.int,
        v: cython.int,
        row: cython.int,
        c0: cython.int,
        c1: cython.int,
    ) -> cython.bint:
        """The same for the cells c0 … c1 of one row, some of them crowded."""
        column: cython.int
        k: cython.int
        cell: cython.int
        fine: cython.int
        n: cython.int = FINE
        x0: cython.double
        x1: cython.double
        y0: cython.double = (py - (row - 1)) * n
        y1: cython.double = (qy - (row - 1)) * n
        low: cython.double = y0 if y0 < y1 else y1
        high: cython.double = y1 if y0 < y1 else y0
        left: cython.double = 0.0
        right: cython.double = 0.0
        for column in range(c0, c1 + 1):
            cell = row * self.gw + column
            if self.crowded[cell] < 0:
                for k in range(self.cell_start[cell], self.cell_start[cell + 1]):
                    if self.meets(self.cell_edge[k], px, py, qx, qy, u, v):
                        return True
                continue
            x0 = (px - (column - 1)) * n
            x1 = (qx - (column - 1)) * n
            for fine in range(within(low - PAD, n), within(high + PAD, n) + 1):
                span(x0, y0, x1, y1, fine, cython.address(left), cython.address(right))
                if right < 0.0 or left > n:
                    continue
                cell = self.crowded[row * self.gw + column] + fine * n
                for k in range(self.fine_start[cell + within(left, n)], self.fine_start[cell + within(right, n) + 1]):
                    if self.meets(self.fine_edge[k], px, py, qx, qy, u, v):
                        return True
        return False

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def meets(
        self,
        e: cython.int,
        px: cython.double,
        py: cython.double,
        qx: cython.double,
        qy: cython.double,
        u: cython.int,
        v: cython.int,
    ) -> cython.bint:
        """Whether one edge obstructs the segment from p to q; see `obstructed`."""
        a: cython.int = self.ea[e]
        b: cython.int = self.eb[e]
        ax: cython.double = self.vx[a]
        ay: cython.double = self.vy[a]
        bx: cython.double = self.vx[b]
        by: cython.double = self.vy[b]
        s: cython.int
        t: cython.int
        if v < 0:  # two queries
            return side_of_vertex(px, py, qx, qy, ax, ay) != side_of_vertex(px, py, qx, qy, bx, by) and side_of_query(
                ax, ay, bx, by, px, py
            ) != side_of_query(ax, ay, bx, by, qx, qy)
        if u < 0:  # a query and a vertex
            if a == v or b == v:
                return False
            if side_of_query(qx, qy, ax, ay, px, py) == side_of_query(qx, qy, bx, by, px, py):
                return False
            s = orient(ax, ay, bx, by, qx, qy)
            return s != 0 and s != side_of_query(ax, ay, bx, by, px, py)
        s = 0 if a == u or a == v else orient(px, py, qx, qy, ax, ay)
        t = 0 if b == u or b == v else orient(px, py, qx, qy, bx, by)
        if (s == 0 and between(px, py, qx, qy, ax, ay)) or (t == 0 and between(px, py, qx, qy, bx, by)):
            return True
        return s * t < 0 and orient(ax, ay, bx, by, px, py) * orient(ax, ay, bx, by, qx, qy) < 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def bends_for(self, node: cython.int, qx: cython.double, qy: cython.double) -> cython.bint:
        """Whether a shortest path may bend at this node and go straight to the query q: within the sector, and taut."""
        v: cython.int = self.node_vertex[node]
        a: cython.int = self.node_low[node]
        b: cython.int = self.node_high[node]
        if a == b:
            return True
        return side_of_query(self.vx[v], self.vy[v], self.vx[a], self.vy[a], qx, qy) == side_of_query(
            self.vx[v], self.vy[v], self.vx[b], self.vy[b], qx, qy
        )


def by_place(x: cython.double[::1], y: cython.double[::1], width: cython.int, height: cython.int):
    """The order (n,) of points by the blocks of 8 × 8 cells they lie in, those of one block as they come.

    What lies close together is then close together in memory: with 20 000 edges in no order everything else takes a
    seventh longer, for want of a cache that holds them all.
    """
    import numpy as np

    k: cython.Py_ssize_t
    block: cython.int
    across: cython.int = (width >> 3) + 1
    down: cython.int = (height >> 3) + 1
    n: cython.Py_ssize_t = x.shape[0]
    start: cython.int[::1] = np.zeros(across * down + 1, np.intc)
    blocks: cython.int[::1] = np.empty(n, np.intc)
    order = np.empty(n, np.intc)
    place: cython.int[::1] = order
    for k in range(n):
        block = (within(y[k], height) >> 3) * across + (within(x[k], width) >> 3)
        blocks[k] = block
        start[block + 1] += 1
    for k in range(across * down):
        start[k + 1] += start[k]
    for k in range(n):
        block = blocks[k]
        place[start[block]] = cython.cast(cython.int, k)
        start[block] += 1
    return order


@cython.cfunc
def doubles(array: cython.double[::1]) -> cython.p_double:
    """Where a contiguous array keeps its numbers."""
    return cython.address(array[0])


@cython.cfunc
def ints(array: cython.int[::1]) -> cython.p_int:
    """Where a contiguous array keeps its numbers."""
    return cython.address(array[0])


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def between(
    ux: cython.double, uy: cython.double, vx: cython.double, vy: cython.double, ax: cython.double, ay: cython.double
) -> cython.bint:
    """Whether a, known to be on the line of u and v, lies strictly between them."""
    if ux != vx:
        return (ux < ax) != (vx < ax) and ax != ux and ax != vx
    return (uy < ay) != (vy < ay) and ay != uy and ay != vy


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def within(x: cython.double, n: cython.int) -> cython.int:
    """The cell of a fine grid that holds a coordinate, in range."""
    return 0 if x < 0.0 else (n - 1 if x >= n else cython.cast(cython.int, x))


def visible(
    scene: Scene,
    p: cython.double[:, ::1],
    q: cython.double[:, ::1],
    begin: cython.Py_ssize_t,
    end: cython.Py_ssize_t,
    out: cython.bint[::1],
) -> None:
    """Which of the pairs begin … end see each other."""
    k: cython.Py_ssize_t
    with cython.nogil:
        for k in range(begin, end):
            out[k] = scene.n_edges == 0 or scene.sees(p[k, 0], p[k, 1], q[k, 0], q[k, 1])
