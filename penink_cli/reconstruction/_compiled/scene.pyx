# cython: boundscheck=False, wraparound=False, cdivision=True
"""Which points see each other past the discontinuity edges (section 2.2).

Everything is in sample units: sample (row i, column j) is the point (j, i). Decisions are exact.

A *query* (output pixel or sample) is never on an edge, on a vertex or in line with one. It stands for a point that is
moved by a vector too short to matter otherwise, d = (ε, ε²) with ε > 0 as small as need be:

         b          q lies on the line from a to b. The point meant is q + d, a little to the right,
        ╱           and by far less down. So it is on the same side as d is of the direction b − a:
       q·→ q + d    the sign of (b − a) × d = (bx − ax) ε² − (by − ay) ε, which for small ε is
      ╱             that of −(by − ay), or where by = ay that of bx − ax.
     a
"""

from libc.stdlib cimport free
from penink_cli.geometry._compiled.predicates cimport orient

PAD = 1e-7
cdef int MANY = 4096  # edges from which on they are numbered by their place,
cdef double FAR = 8.0  # if this far lies between one vertex and the next in the mean: not in chains
cdef int FEW = 3  # edges in a row of cells that are looked at without finding the cells


cdef int tie(double x, double y) noexcept nogil:
    """Sign of (x, y) × (ε, ε²) = x ε² − y ε for a small ε > 0: that of −y, or of x where y is 0."""
    if y != 0.0:
        return -1 if y > 0.0 else 1
    if x != 0.0:
        return 1 if x > 0.0 else -1
    return 0


cdef int side_of_query(double ax, double ay, double bx, double by, double qx, double qy) noexcept nogil:
    """Side of the line of the vertices a → b on which the query q lies."""
    cdef int s = orient(ax, ay, bx, by, qx, qy)
    return s if s != 0 else tie(bx - ax, by - ay)


cdef int side_of_vertex(double px, double py, double qx, double qy, double ax, double ay) noexcept nogil:
    """Side of the line of the queries p → q on which the vertex a lies."""
    cdef int s = orient(px, py, qx, qy, ax, ay)
    return s if s != 0 else -tie(qx - px, qy - py)


cdef void span(double ax, double ay, double bx, double by, int row, double* left, double* right) noexcept nogil:
    """The x range of a segment within one row of cells, a little too wide."""
    cdef double x0 = ax
    cdef double x1 = bx
    cdef double low = row - PAD
    cdef double high = row + 1 + PAD
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


cdef class Scene:
    """Edges in sample units, bucketed by unit cell; the nodes, and the arcs between them up to `reach` long.

    A new one holds the edges alone: `cells.sort_edges` and then `nodes.find` fill in the rest. Lists by groups lie one
    group after the other in one array: group i is list[start[i] : start[i + 1]].

    width, height: samples. vx, vy: (n_vertices,) positions. ea, eb: (n_edges,) the vertices of each edge.
    gw, gh: cells of the grid, a sample spacing wide; the first and the last are half ones along the border.
    cell_start, cell_edge: the edges that touch each cell. most: edges in the fullest cell.
    crowded: (gh · gw,) the first cell of the cell's own fine grid, −1 where it has none; n_crowded: how many have one.
    fine_start, fine_edge: the edges that touch each cell of the fine grids, FINE × FINE cells a grid.
    star_start, star: the other ends of the edges at each vertex.
    node_vertex, node_low, node_high: (n_nodes,) a node's vertex and those at the ends of its sector (see `nodes`).
    node_across: blocks in a row of blocks. node_start, node_sorted: the nodes in each block of 2^BLOCK cells a side;
    node_x, node_y: their places, in that order.
    arc_start, arc_to, arc_length: the nodes that each node sees, and how far away they are.
    arrays: keeps alive what the pointers point into.
    """

    def __init__(self, vertices, edges, int width, int height, double reach):
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

    cdef int row_of(self, double y) noexcept nogil:
        """Row of the grid of cells, in range; row 0 is the half cell along the border."""
        y += 1.0  # what rounding does here is far within the padding of the cells
        return 0 if y < 0.0 else (self.gh - 1 if y >= self.gh else <int>y)

    cdef int column_of(self, double x) noexcept nogil:
        """Column of the grid of cells, in range."""
        x += 1.0
        return 0 if x < 0.0 else (self.gw - 1 if x >= self.gw else <int>x)

    cdef bint clear(self, double x0, double y0, double x1, double y1) noexcept nogil:
        """True if no edge comes near the rectangle."""
        cdef int row
        cdef int c0 = self.column_of(x0)
        cdef int c1 = self.column_of(x1)
        for row in range(self.row_of(y0), self.row_of(y1) + 1):
            if self.cell_start[row * self.gw + c1 + 1] > self.cell_start[row * self.gw + c0]:
                return False
        return True

    cdef bint empty_around(self, int column, int row) noexcept nogil:
        """True if no edge touches a cell or its eight neighbours; −1 is the half cell along the border."""
        cdef int r
        cdef int left = 0 if column < 0 else column
        cdef int right = column + 2 if column + 2 < self.gw else self.gw - 1
        for r in range(0 if row < 0 else row, (row + 2 if row + 2 < self.gh else self.gh - 1) + 1):
            if self.cell_start[r * self.gw + right + 1] > self.cell_start[r * self.gw + left]:
                return False
        return True

    cdef bint sees(self, double px, double py, double qx, double qy) noexcept nogil:
        """Whether two queries see each other."""
        if px == qx and py == qy:
            return True
        return not self.obstructed(px, py, qx, qy, -1, -1)

    cdef bint sees_vertex(self, double qx, double qy, int v) noexcept nogil:
        """Whether no edge lies between a query and a vertex; the edges at the vertex are `bends_for`'s concern."""
        return not self.obstructed(qx, qy, self.vx[v], self.vy[v], -1, v)

    cdef bint joined(self, int u, int v) noexcept nogil:
        """Whether the open segment between two vertices that share no edge meets neither edge nor vertex."""
        return not self.obstructed(self.vx[u], self.vy[u], self.vx[v], self.vy[v], u, v)

    cdef bint obstructed(self, double px, double py, double qx, double qy, int u, int v) noexcept nogil:
        """Whether an edge meets the segment from p to q, which are the vertices u and v, or queries where those are −1.

        Walks the cells that the segment touches, in a crowded cell those of its own finer grid. In a row of cells with
        few edges beside the segment it is cheaper to look at them all than to find its cells there.
        """
        cdef int row, k, first, last
        cdef int e = -1
        cdef double left = 0.0, right = 0.0
        cdef double low = py if py < qy else qy
        cdef double high = qy if py < qy else py
        cdef int c0 = self.column_of((px if px < qx else qx) - PAD)
        cdef int c1 = self.column_of((qx if px < qx else px) + PAD)
        for row in range(self.row_of(low - PAD), self.row_of(high + PAD) + 1):
            first = self.cell_start[row * self.gw + c0]
            last = self.cell_start[row * self.gw + c1 + 1]
            if last - first > FEW:
                span(px, py, qx, qy, row - 1, &left, &right)
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

    cdef bint obstructed_in_crowd(
        self, double px, double py, double qx, double qy, int u, int v, int row, int c0, int c1
    ) noexcept nogil:
        """The same for the cells c0 … c1 of one row, some of them crowded."""
        cdef int column, k, cell, fine
        cdef double x0, x1
        cdef int n = FINE
        cdef double y0 = (py - (row - 1)) * n
        cdef double y1 = (qy - (row - 1)) * n
        cdef double low = y0 if y0 < y1 else y1
        cdef double high = y1 if y0 < y1 else y0
        cdef double left = 0.0, right = 0.0
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
                span(x0, y0, x1, y1, fine, &left, &right)
                if right < 0.0 or left > n:
                    continue
                cell = self.crowded[row * self.gw + column] + fine * n
                for k in range(self.fine_start[cell + within(left, n)], self.fine_start[cell + within(right, n) + 1]):
                    if self.meets(self.fine_edge[k], px, py, qx, qy, u, v):
                        return True
        return False

    cdef bint meets(self, int e, double px, double py, double qx, double qy, int u, int v) noexcept nogil:
        """Whether one edge obstructs the segment from p to q; see `obstructed`."""
        cdef int s, t
        cdef int a = self.ea[e]
        cdef int b = self.eb[e]
        cdef double ax = self.vx[a]
        cdef double ay = self.vy[a]
        cdef double bx = self.vx[b]
        cdef double by = self.vy[b]
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

    cdef bint bends_for(self, int node, double qx, double qy) noexcept nogil:
        """Whether a shortest path may bend at this node and go straight to the query q: within the sector, and taut."""
        cdef int v = self.node_vertex[node]
        cdef int a = self.node_low[node]
        cdef int b = self.node_high[node]
        if a == b:
            return True
        return side_of_query(self.vx[v], self.vy[v], self.vx[a], self.vy[a], qx, qy) == side_of_query(
            self.vx[v], self.vy[v], self.vx[b], self.vy[b], qx, qy
        )


def by_place(double[::1] x, double[::1] y, int width, int height):
    """The order (n,) of points by the blocks of 8 × 8 cells they lie in, those of one block as they come.

    What lies close together is then close together in memory: with 20 000 edges in no order everything else takes a
    seventh longer, for want of a cache that holds them all.
    """
    import numpy as np

    cdef Py_ssize_t k
    cdef int block
    cdef int across = (width >> 3) + 1
    cdef int down = (height >> 3) + 1
    cdef Py_ssize_t n = x.shape[0]
    cdef int[::1] start = np.zeros(across * down + 1, np.intc)
    cdef int[::1] blocks = np.empty(n, np.intc)
    order = np.empty(n, np.intc)
    cdef int[::1] place = order
    for k in range(n):
        block = (within(y[k], height) >> 3) * across + (within(x[k], width) >> 3)
        blocks[k] = block
        start[block + 1] += 1
    for k in range(across * down):
        start[k + 1] += start[k]
    for k in range(n):
        block = blocks[k]
        place[start[block]] = <int>k
        start[block] += 1
    return order


cdef double* doubles(double[::1] array):
    """Where a contiguous array keeps its numbers."""
    return &array[0]


cdef int* ints(int[::1] array):
    """Where a contiguous array keeps its numbers."""
    return &array[0]


cdef bint between(double ux, double uy, double vx, double vy, double ax, double ay) noexcept nogil:
    """Whether a, known to be on the line of u and v, lies strictly between them."""
    if ux != vx:
        return (ux < ax) != (vx < ax) and ax != ux and ax != vx
    return (uy < ay) != (vy < ay) and ay != uy and ay != vy


cdef int within(double x, int n) noexcept nogil:
    """The cell of a fine grid that holds a coordinate, in range."""
    return 0 if x < 0.0 else (n - 1 if x >= n else <int>x)


def visible(Scene scene, double[:, ::1] p, double[:, ::1] q, Py_ssize_t begin, Py_ssize_t end, bint[::1] out) -> None:
    """Which of the pairs begin … end see each other."""
    cdef Py_ssize_t k
    with nogil:
        for k in range(begin, end):
            out[k] = scene.n_edges == 0 or scene.sees(p[k, 0], p[k, 1], q[k, 0], q[k, 1])
