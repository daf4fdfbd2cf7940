# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Which points see each other past the discontinuity edges, and the shortest paths around them (section 2.2).

Everything is in sample units: sample (row i, column j) is the point (j, i). Decisions are
exact. A *query* (output pixel or sample) stands for p + (ε, ε²), so it is never on an edge,
on a vertex or in line with one; a tie goes by the sign of the next power of ε.

A *node* is a vertex on the one side where a path can bend round it: its reflex sector runs,
turning positively, from the edge to `low` to the edge to `high`. A shortest path is taut, so
a leg may meet a node only where both edges lie on one side of the leg's line or on it. That
one test replaces "within the sector" and prunes nearly all bends of a smooth chain.
"""

import cython
from cython.cimports.libc.math import fabs, sqrt
from cython.cimports.libc.stdlib import free, malloc, realloc
from cython.cimports.penink_cli.arrangement._predicates import orient

COMPILED = cython.compiled

PAD = cython.declare(cython.double, 1e-7)  # cells are closed, and this much wider than that: rounding is far below it
INFINITY = cython.declare(cython.double, float("inf"))
BLOCK = cython.declare(cython.int, 2)  # nodes are sorted into blocks of 2² × 2² cells: fewer to pass over than cells
CROWD = cython.declare(cython.int, 48)  # edges in one cell from which on it gets a grid of its own
SLACK = cython.declare(cython.double, 1e-9)  # more than rounding comes to in lengths of a few samples
MANY = cython.declare(cython.int, 64)  # samples in a block from which on bends are not remembered for each of them
FINE = cython.declare(cython.int, 32)  # cells of that grid along a side


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


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def distance(ax: cython.double, ay: cython.double, bx: cython.double, by: cython.double) -> cython.double:
    """Between two points."""
    return sqrt((ax - bx) * (ax - bx) + (ay - by) * (ay - by))


@cython.final  # calls are direct, and inlined
@cython.cclass
class Scene:
    """Edges in sample units, bucketed by unit cell; the nodes, and the arcs between them up to `reach` long."""

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
        self.arrays = [x, y, a, b]
        if self.n_edges == 0:
            return
        self.vx = doubles(x)
        self.vy = doubles(y)
        self.ea = ints(a)
        self.eb = ints(b)
        start = np.zeros(self.gw * self.gh + 1, np.intc)
        self.cell_start = ints(start)
        entries = np.empty(max(1, bucket(self)), np.intc)
        self.cell_edge = ints(entries)
        fill_buckets(self)
        if self.most >= CROWD:  # rare
            crowded = np.full(self.gw * self.gh, -1, np.intc)
            self.crowded = ints(crowded)
            count_crowds(self)
            fine_start = np.zeros(self.n_crowded * FINE * FINE + 1, np.intc)
            self.fine_start = ints(fine_start)
            fine_entries = np.empty(max(1, refine(self, False)), np.intc)
            self.fine_edge = ints(fine_entries)
            refine(self, True)
            self.arrays += [crowded, fine_start, fine_entries]
        nodes = np.empty((3, 2 * self.n_vertices), np.intc)
        self.node_vertex = ints(nodes[0])
        self.node_low = ints(nodes[1])
        self.node_high = ints(nodes[2])
        star_start = np.zeros(self.n_vertices + 1, np.intc)
        star = np.empty(2 * self.n_edges, np.intc)
        self.star_start = ints(star_start)
        self.star = ints(star)
        find_nodes(self)
        self.node_across = (self.gw >> BLOCK) + 1
        node_start = np.zeros(self.node_across * ((self.gh >> BLOCK) + 1) + 1, np.intc)
        node_sorted = np.empty(max(1, self.n_nodes), np.intc)
        places = np.empty((2, max(1, self.n_nodes)))
        self.node_start = ints(node_start)
        self.node_sorted = ints(node_sorted)
        self.node_x = doubles(places[0])
        self.node_y = doubles(places[1])
        bucket_nodes(self)
        arc_start = np.zeros(self.n_nodes + 1, np.intc)
        self.arc_start = ints(arc_start)
        self.arrays += [start, entries, nodes, star_start, star, node_start, node_sorted, places, arc_start]
        with cython.nogil:
            find_arcs(self)

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

        Walks the cells that the segment touches, in a crowded cell those of its own finer grid.
        """
        row: cython.int
        column: cython.int
        k: cython.int
        fine: cython.int
        n: cython.int
        c0: cython.int
        c1: cython.int
        left: cython.double = 0.0
        right: cython.double = 0.0
        low: cython.double = py if py < qy else qy
        high: cython.double = qy if py < qy else py
        x0: cython.double
        y0: cython.double
        x1: cython.double
        y1: cython.double
        for row in range(self.row_of(low - PAD), self.row_of(high + PAD) + 1):
            span(px, py, qx, qy, row - 1, cython.address(left), cython.address(right))
            c0 = row * self.gw + self.column_of(left)
            c1 = row * self.gw + self.column_of(right)
            if self.n_crowded == 0 or self.cell_start[c1 + 1] - self.cell_start[c0] < CROWD:
                for k in range(self.cell_start[c0], self.cell_start[c1 + 1]):
                    if self.meets(self.cell_edge[k], px, py, qx, qy, u, v):
                        return True
                continue
            for column in range(c0, c1 + 1):
                if self.crowded[column] < 0:
                    for k in range(self.cell_start[column], self.cell_start[column + 1]):
                        if self.meets(self.cell_edge[k], px, py, qx, qy, u, v):
                            return True
                    continue
                n = FINE
                x0 = (px - (column - row * self.gw - 1)) * n
                y0 = (py - (row - 1)) * n
                x1 = (qx - (column - row * self.gw - 1)) * n
                y1 = (qy - (row - 1)) * n
                low = y0 if y0 < y1 else y1
                high = y1 if y0 < y1 else y0
                for fine in range(within(low - PAD, n), within(high + PAD, n) + 1):
                    span(x0, y0, x1, y1, fine, cython.address(left), cython.address(right))
                    if right < 0.0 or left > n:
                        continue
                    c0 = self.crowded[column] + fine * n
                    for k in range(self.fine_start[c0 + within(left, n)], self.fine_start[c0 + within(right, n) + 1]):
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
def bucket(scene: Scene) -> cython.int:
    """Count the edges of each cell into cell_start, as running sums up to its end; how many entries there are."""
    e: cython.int
    k: cython.int
    total: cython.int = 0
    for e in range(scene.n_edges):
        enter(scene, e, False)
    for k in range(scene.gw * scene.gh + 1):
        total += scene.cell_start[k]
        scene.cell_start[k] = total
    return total


@cython.cfunc
def fill_buckets(scene: Scene) -> cython.void:
    """Enter each edge into its cells."""
    e: cython.int
    for e in range(scene.n_edges):
        enter(scene, e, True)


@cython.cfunc
@cython.exceptval(check=False)
def enter(scene: Scene, e: cython.int, fill: cython.bint) -> cython.void:
    """Count or enter one edge in the cells that it touches."""
    ax: cython.double = scene.vx[scene.ea[e]]
    ay: cython.double = scene.vy[scene.ea[e]]
    bx: cython.double = scene.vx[scene.eb[e]]
    by: cython.double = scene.vy[scene.eb[e]]
    y0: cython.double = (ay if ay < by else by) - PAD
    y1: cython.double = (by if ay < by else ay) + PAD
    left: cython.double = 0.0
    right: cython.double = 0.0
    row: cython.int
    k: cython.int
    if y1 < -1.0 or y0 > scene.height:
        return
    for row in range(scene.row_of(y0), scene.row_of(y1) + 1):
        span(ax, ay, bx, by, row - 1, cython.address(left), cython.address(right))
        if right < -1.0 or left > scene.width:
            continue
        for k in range(
            row * scene.gw + scene.column_of(left),
            row * scene.gw + scene.column_of(right) + 1,
        ):
            if fill:  # from the end of the cell down, so that its start is what is left
                scene.cell_start[k] -= 1
                scene.cell_edge[scene.cell_start[k]] = e
            else:
                scene.cell_start[k] += 1
                if scene.cell_start[k] > scene.most:
                    scene.most = scene.cell_start[k]


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def within(x: cython.double, n: cython.int) -> cython.int:
    """The cell of a fine grid that holds a coordinate, in range."""
    return 0 if x < 0.0 else (n - 1 if x >= n else cython.cast(cython.int, x))


@cython.cfunc
def count_crowds(scene: Scene) -> cython.void:
    """Find the crowded cells, and say where the fine grid of each begins."""
    k: cython.int
    for k in range(scene.gw * scene.gh):
        if scene.cell_start[k + 1] - scene.cell_start[k] >= CROWD:
            scene.crowded[k] = scene.n_crowded * FINE * FINE
            scene.n_crowded += 1


@cython.cfunc
def refine(scene: Scene, fill: cython.bint) -> cython.int:
    """Count the edges of each fine cell as running sums, or enter them; how many entries there are."""
    cell: cython.int
    k: cython.int
    e: cython.int
    row: cython.int
    c: cython.int
    n: cython.int
    total: cython.int = 0
    left: cython.double = 0.0
    right: cython.double = 0.0
    ax: cython.double
    ay: cython.double
    bx: cython.double
    by: cython.double
    for cell in range(scene.gw * scene.gh):
        if scene.crowded[cell] < 0:
            continue
        for k in range(scene.cell_start[cell], scene.cell_start[cell + 1]):
            e = scene.cell_edge[k]
            ax = (scene.vx[scene.ea[e]] - (cell % scene.gw - 1)) * FINE
            ay = (scene.vy[scene.ea[e]] - (cell // scene.gw - 1)) * FINE
            bx = (scene.vx[scene.eb[e]] - (cell % scene.gw - 1)) * FINE
            by = (scene.vy[scene.eb[e]] - (cell // scene.gw - 1)) * FINE
            for row in range(
                within((ay if ay < by else by) - PAD, FINE), within((by if ay < by else ay) + PAD, FINE) + 1
            ):
                span(ax, ay, bx, by, row, cython.address(left), cython.address(right))
                if right < 0.0 or left > FINE:
                    continue
                for c in range(within(left, FINE), within(right, FINE) + 1):
                    n = scene.crowded[cell] + row * FINE + c
                    if fill:
                        scene.fine_edge[scene.fine_start[n]] = e
                    scene.fine_start[n] += 1
    n = scene.n_crowded * FINE * FINE
    if fill:
        for k in range(n, 0, -1):
            scene.fine_start[k] = scene.fine_start[k - 1]
        scene.fine_start[0] = 0
        return 0
    for k in range(n + 1):
        c = scene.fine_start[k]
        scene.fine_start[k] = total
        total += c
    return total


@cython.cfunc
def find_nodes(scene: Scene) -> cython.void:
    """The nodes: vertices strictly inside the frame with a sector of π or more between neighbouring edges.

    Seen from the first edge d at a vertex the others turn left, turn right or go straight on. The outermost to
    either side bound the sector, if there is one. A sector of exactly π carries paths along it, never a bend.
    """
    v: cython.int
    k: cython.int
    d: cython.int
    t: cython.int
    s: cython.int
    first: cython.p_int = scene.star_start
    others: cython.p_int = scene.star
    place: cython.int
    n: cython.int = 0
    x: cython.double
    y: cython.double
    left: cython.int
    right: cython.int
    on: cython.int
    for k in range(scene.n_edges):
        first[scene.ea[k]] += 1
        first[scene.eb[k]] += 1
    place = 0
    for v in range(scene.n_vertices + 1):
        k = first[v]
        first[v] = place
        place += k
    for k in range(scene.n_edges):
        others[first[scene.ea[k]]] = scene.eb[k]
        first[scene.ea[k]] += 1
        others[first[scene.eb[k]]] = scene.ea[k]
        first[scene.eb[k]] += 1
    for v in range(scene.n_vertices, 0, -1):
        first[v] = first[v - 1]
    first[0] = 0
    for v in range(scene.n_vertices):
        x = scene.vx[v]
        y = scene.vy[v]
        if first[v] == first[v + 1] or x <= -0.5 or y <= -0.5 or x >= scene.width - 0.5 or y >= scene.height - 0.5:
            continue
        d = others[first[v]]
        left = right = on = -1
        for k in range(first[v] + 1, first[v + 1]):
            t = others[k]
            s = orient(x, y, scene.vx[d], scene.vy[d], scene.vx[t], scene.vy[t])
            if s == 0:
                on = t
            elif s > 0:
                if left < 0 or orient(x, y, scene.vx[left], scene.vy[left], scene.vx[t], scene.vy[t]) > 0:
                    left = t
            elif right < 0 or orient(x, y, scene.vx[right], scene.vy[right], scene.vx[t], scene.vy[t]) < 0:
                right = t
        if on >= 0:
            if left < 0:
                n = add_node(scene, n, v, d, on)
            if right < 0:
                n = add_node(scene, n, v, on, d)
        elif left < 0 or right < 0:
            n = add_node(scene, n, v, d if left < 0 else left, d if right < 0 else right)
        elif orient(x, y, scene.vx[right], scene.vy[right], scene.vx[left], scene.vy[left]) >= 0:
            n = add_node(scene, n, v, left, right)
    scene.n_nodes = n


@cython.cfunc
@cython.exceptval(check=False)
def add_node(scene: Scene, n: cython.int, v: cython.int, low: cython.int, high: cython.int) -> cython.int:
    """Enter one node; how many there are then."""
    scene.node_vertex[n] = v
    scene.node_low[n] = low
    scene.node_high[n] = high
    return n + 1


@cython.cfunc
def bucket_nodes(scene: Scene) -> cython.void:
    """Sort the nodes into the blocks of cells they lie in."""
    n: cython.int
    k: cython.int
    place: cython.int = 0
    for n in range(scene.n_nodes):
        scene.node_start[home(scene, n)] += 1
    for k in range(scene.node_across * ((scene.gh >> BLOCK) + 1) + 1):
        place += scene.node_start[k]
        scene.node_start[k] = place
    for n in range(scene.n_nodes - 1, -1, -1):
        k = home(scene, n)
        scene.node_start[k] -= 1
        k = scene.node_start[k]
        scene.node_sorted[k] = n
        scene.node_x[k] = scene.vx[scene.node_vertex[n]]
        scene.node_y[k] = scene.vy[scene.node_vertex[n]]


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def home(scene: Scene, n: cython.int) -> cython.int:
    """The block a node lies in."""
    v: cython.int = scene.node_vertex[n]
    return (scene.row_of(scene.vy[v]) >> BLOCK) * scene.node_across + (scene.column_of(scene.vx[v]) >> BLOCK)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def find_arcs(scene: Scene) -> cython.void:
    """The arcs of the path graph: taut at both ends, unobstructed, no third vertex touched, at most `reach` long."""
    u: cython.int
    v: cython.int
    n: cython.int
    row: cython.int
    k: cython.int
    used: cython.int = 0
    size: cython.int = 64
    x: cython.double
    y: cython.double
    d: cython.double
    c0: cython.int
    c1: cython.int
    scene.arc_to = cython.cast(cython.p_int, malloc(size * cython.sizeof(cython.int)))
    scene.arc_length = cython.cast(cython.p_double, malloc(size * cython.sizeof(cython.double)))
    for n in range(scene.n_nodes):
        scene.arc_start[n] = used
        u = scene.node_vertex[n]
        x = scene.vx[u]
        y = scene.vy[u]
        c0 = scene.column_of(x - scene.reach) >> BLOCK
        c1 = (scene.column_of(x + scene.reach) >> BLOCK) + 1
        for row in range(scene.row_of(y - scene.reach) >> BLOCK, (scene.row_of(y + scene.reach) >> BLOCK) + 1):
            for k in range(
                scene.node_start[row * scene.node_across + c0], scene.node_start[row * scene.node_across + c1]
            ):
                v = scene.node_sorted[k]
                d = arc(scene, n, v)
                if d < 0.0 or d > scene.reach:
                    continue
                if used == size:
                    size *= 2
                    scene.arc_to = cython.cast(cython.p_int, realloc(scene.arc_to, size * cython.sizeof(cython.int)))
                    scene.arc_length = cython.cast(
                        cython.p_double, realloc(scene.arc_length, size * cython.sizeof(cython.double))
                    )
                scene.arc_to[used] = v
                scene.arc_length[used] = d
                used += 1
    scene.arc_start[scene.n_nodes] = used


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def arc(scene: Scene, m: cython.int, n: cython.int) -> cython.double:
    """Length of the arc between two nodes, −1 where there is none."""
    u: cython.int = scene.node_vertex[m]
    v: cython.int = scene.node_vertex[n]
    d: cython.double
    if u == v:
        return -1.0
    d = distance(scene.vx[u], scene.vy[u], scene.vx[v], scene.vy[v])
    if d > scene.reach:
        return -1.0
    if not (taut(scene, m, v) and taut(scene, n, u)):
        return -1.0
    # Along a common edge the sectors of both ends must lie on the same side of it. A sector touches an edge of its
    # vertex only where the edge bounds it.
    if neighbours(scene, u, v):
        if (scene.node_low[m] == v and scene.node_high[n] == u) or (scene.node_high[m] == v and scene.node_low[n] == u):
            return d
        return -1.0
    return d if scene.joined(u, v) else -1.0


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def neighbours(scene: Scene, u: cython.int, v: cython.int) -> cython.bint:
    """Whether an edge joins two vertices, by the one that has fewer."""
    i: cython.int
    t: cython.int
    if scene.star_start[u + 1] - scene.star_start[u] > scene.star_start[v + 1] - scene.star_start[v]:
        t = u
        u = v
        v = t
    for i in range(scene.star_start[u], scene.star_start[u + 1]):
        if scene.star[i] == v:
            return True
    return False


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def taut(scene: Scene, node: cython.int, u: cython.int) -> cython.bint:
    """Whether a shortest path between vertices may run from this node towards the vertex u."""
    v: cython.int = scene.node_vertex[node]
    a: cython.int = scene.node_low[node]
    b: cython.int = scene.node_high[node]
    if a == b or u == a or u == b:  # along an edge of its own: the commonest tie by far, and dear to decide exactly
        return True
    return (
        orient(scene.vx[v], scene.vy[v], scene.vx[a], scene.vy[a], scene.vx[u], scene.vy[u])
        * orient(scene.vx[v], scene.vy[v], scene.vx[b], scene.vy[b], scene.vx[u], scene.vy[u])
        >= 0
    )


@cython.final  # calls are direct, and inlined
@cython.cclass
class Finder:
    """Shortest paths in one scene for one thread, with the bends next to each sample remembered.

    row0, row1: the rows of samples to remember bends for. closed: remember for each sample every node that can be the
    last bend on a path of length `reach` from it, else only those it sees.
    """

    def __init__(self, scene: Scene, row0: cython.int, row1: cython.int, reach: cython.double, closed: cython.bint):
        self.scene = scene
        self.row0 = row0
        self.row1 = row1
        self.reach = reach
        self.closed = closed
        self.radius = reach - 2.0 * sqrt(2.0)
        n: cython.Py_ssize_t = cython.cast(cython.Py_ssize_t, row1 - row0) * scene.width
        k: cython.Py_ssize_t
        self.start = cython.cast(cython.p_int, malloc(max(1, n) * cython.sizeof(cython.int)))
        self.count = cython.cast(cython.p_int, malloc(max(1, n) * cython.sizeof(cython.int)))
        self.distance = cython.cast(cython.p_double, malloc(max(1, scene.n_nodes) * cython.sizeof(cython.double)))
        self.stamp = cython.cast(cython.p_int, malloc(max(1, scene.n_nodes) * cython.sizeof(cython.int)))
        self.done = cython.cast(cython.p_int, malloc(max(1, scene.n_nodes) * cython.sizeof(cython.int)))
        for k in range(n):
            self.count[k] = -1
        for k in range(scene.n_nodes):
            self.stamp[k] = -1
        self.pool_size = 1024
        self.pool_node = cython.cast(cython.p_int, malloc(self.pool_size * cython.sizeof(cython.int)))
        self.pool_length = cython.cast(cython.p_double, malloc(self.pool_size * cython.sizeof(cython.double)))
        self.heap_size = 256
        self.heap_node = cython.cast(cython.p_int, malloc(self.heap_size * cython.sizeof(cython.int)))
        self.heap_key = cython.cast(cython.p_double, malloc(self.heap_size * cython.sizeof(cython.double)))
        self.alpha_size = 64
        self.alpha = cython.cast(cython.p_double, malloc(self.alpha_size * cython.sizeof(cython.double)))

    def __dealloc__(self):
        free(self.start)
        free(self.count)
        free(self.distance)
        free(self.stamp)
        free(self.done)
        free(self.pool_node)
        free(self.pool_length)
        free(self.heap_node)
        free(self.heap_key)
        free(self.alpha)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def push(self, node: cython.int, key: cython.double) -> cython.void:
        """Note a path of that length to a node, if none as short is known."""
        i: cython.int
        up: cython.int
        if self.stamp[node] == self.now and self.distance[node] <= key:
            return
        self.stamp[node] = self.now
        self.distance[node] = key
        if self.heap_used == self.heap_size:
            self.heap_size *= 2
            self.heap_node = cython.cast(
                cython.p_int, realloc(self.heap_node, self.heap_size * cython.sizeof(cython.int))
            )
            self.heap_key = cython.cast(
                cython.p_double, realloc(self.heap_key, self.heap_size * cython.sizeof(cython.double))
            )
        i = self.heap_used
        self.heap_used += 1
        while i > 0:
            up = (i - 1) >> 1
            if self.heap_key[up] <= key:
                break
            self.heap_key[i] = self.heap_key[up]
            self.heap_node[i] = self.heap_node[up]
            i = up
        self.heap_key[i] = key
        self.heap_node[i] = node

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def worth(self, x: cython.double, y: cython.double, length: cython.double) -> cython.bint:
        """Whether a path of that length from a sample to a bend, x and y away, can go on to a pixel of the sample's.

        A pixel p has a sample s among its 16 where it lies in the square of half side 2 around s, and the path matters
        where length + |p − v| < |p − s| + r. So length − r must be less than the most that |p − s| − |p − v| comes to
        in that square: within it at v itself; else, where v is beyond one side, at the point of that side that the
        mirror image of v is seen through, where the mirror image is; and at the corner where that is off the side.
        A node left out is no stage to another: |p − s| − |p − v| falls by no more than the way from node to node.
        It leaves out a third of all bends that the bound by distance alone lets in.
        """
        most: cython.double
        x = fabs(x)
        y = fabs(y)
        if x <= 2.0 and y <= 2.0:
            most = sqrt(x * x + y * y)
        elif y <= 4.0 - x and x > 2.0:
            most = sqrt((4.0 - x) * (4.0 - x) + y * y)
        elif x <= 4.0 - y and y > 2.0:
            most = sqrt((4.0 - y) * (4.0 - y) + x * x)
        else:
            most = 2.0 * sqrt(2.0) - sqrt((x - 2.0) * (x - 2.0) + (y - 2.0) * (y - 2.0))
        return length < most + self.radius + SLACK

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def first_bends(self, qx: cython.double, qy: cython.double, reach: cython.double) -> cython.void:
        """Start a search: note the nodes that the query q sees, within reach."""
        row: cython.int
        k: cython.int
        n: cython.int
        x: cython.double
        y: cython.double
        d: cython.double
        # A node worth its while is at most so far away along an axis: |v| + |v − corner| ≥ |corner mirrored at v's x|.
        window: cython.double = 1.0 + 0.5 * sqrt(reach * reach - 4.0) if self.closed else reach
        across: cython.int = self.scene.node_across
        c0: cython.int = self.scene.column_of(qx - window) >> BLOCK
        c1: cython.int = (self.scene.column_of(qx + window) >> BLOCK) + 1
        self.now += 1
        self.heap_used = 0
        self.from_x = qx
        self.from_y = qy
        for row in range(self.scene.row_of(qy - window) >> BLOCK, (self.scene.row_of(qy + window) >> BLOCK) + 1):
            for k in range(self.scene.node_start[row * across + c0], self.scene.node_start[row * across + c1]):
                x = self.scene.node_x[k] - qx
                y = self.scene.node_y[k] - qy
                if fabs(x) > window or fabs(y) > window:
                    continue
                d = sqrt(x * x + y * y)
                if d >= reach or (self.closed and not self.worth(x, y, d)):
                    continue
                n = self.scene.node_sorted[k]
                if self.scene.bends_for(n, qx, qy) and self.scene.sees_vertex(qx, qy, self.scene.node_vertex[n]):
                    self.push(n, d)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def spread(self, reach: cython.double) -> cython.void:
        """Dijkstra from the noted nodes as far as `reach`; `done` lists the nodes reached, nearest first."""
        n: cython.int
        node: cython.int
        i: cython.int
        down: cython.int
        k: cython.int
        key: cython.double
        last: cython.double
        self.n_done = 0
        while self.heap_used > 0:
            node = self.heap_node[0]
            key = self.heap_key[0]
            self.heap_used -= 1
            n = self.heap_used
            last = self.heap_key[n]
            i = 0
            while True:
                down = 2 * i + 1
                if down >= n:
                    break
                if down + 1 < n and self.heap_key[down + 1] < self.heap_key[down]:
                    down += 1
                if self.heap_key[down] >= last:
                    break
                self.heap_key[i] = self.heap_key[down]
                self.heap_node[i] = self.heap_node[down]
                i = down
            self.heap_key[i] = last
            self.heap_node[i] = self.heap_node[n]
            if key > self.distance[node]:
                continue  # a shorter way was found meanwhile
            self.done[self.n_done] = node
            self.n_done += 1
            for k in range(self.scene.arc_start[node], self.scene.arc_start[node + 1]):
                last = key + self.scene.arc_length[k]
                if last >= reach:
                    continue
                n = self.scene.arc_to[k]
                i = self.scene.node_vertex[n]
                if not self.closed or self.worth(self.scene.vx[i] - self.from_x, self.scene.vy[i] - self.from_y, last):
                    self.push(n, last)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def bends_of(self, i: cython.int, j: cython.int) -> cython.int:
        """Where the pool keeps the bends of sample (row i, column j), nearest first; `count` says how many."""
        k: cython.int
        s: cython.Py_ssize_t = cython.cast(cython.Py_ssize_t, i - self.row0) * self.scene.width + j
        if self.count[s] >= 0:
            return self.start[s]
        self.first_bends(j, i, self.reach)
        if self.closed:
            self.spread(self.reach)
        else:  # the heap itself is the answer
            self.n_done = 0
            for k in range(self.heap_used):
                self.done[self.n_done] = self.heap_node[k]
                self.n_done += 1
        while self.pool_used + self.n_done > self.pool_size:
            self.pool_size *= 2
            self.pool_node = cython.cast(
                cython.p_int, realloc(self.pool_node, self.pool_size * cython.sizeof(cython.int))
            )
            self.pool_length = cython.cast(
                cython.p_double, realloc(self.pool_length, self.pool_size * cython.sizeof(cython.double))
            )
        self.start[s] = cython.cast(cython.int, self.pool_used)
        self.count[s] = self.n_done
        for k in range(self.n_done):
            self.pool_node[self.pool_used] = self.done[k]
            self.pool_length[self.pool_used] = self.distance[self.done[k]]
            self.pool_used += 1
        return self.start[s]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def attenuate(
        self,
        px: cython.double,
        py: cython.double,
        i0: cython.int,
        i1: cython.int,
        j0: cython.int,
        j1: cython.int,
        r: cython.double,
    ) -> cython.bint:
        """Equation 4 for the query p and the block of samples of rows i0 … i1, columns j0 … j1, into `alpha`.

        False, and nothing filled, where no edge is between: all are one. This finder must remember seen nodes only.
        """
        i: cython.int
        j: cython.int
        k: cython.int = 0
        n: cython.int = (i1 - i0 + 1) * (j1 - j0 + 1)
        remember: cython.bint = n <= MANY
        s: cython.Py_ssize_t
        m: cython.int
        at: cython.int
        node: cython.int
        t: cython.double
        d: cython.double
        best: cython.double
        farthest: cython.double = 0.0
        if self.scene.clear(px if px < j0 else j0, py if py < i0 else i0, px if px > j1 else j1, py if py > i1 else i1):
            return False
        if n > self.alpha_size:
            self.alpha_size = n
            self.alpha = cython.cast(cython.p_double, realloc(self.alpha, n * cython.sizeof(cython.double)))
        for i in range(i0, i1 + 1):
            for j in range(j0, j1 + 1):
                if self.scene.sees(px, py, j, i):
                    self.alpha[k] = 1.0
                else:
                    self.alpha[k] = -1.0
                    d = (px - j) * (px - j) + (py - i) * (py - i)
                    if d > farthest:
                        farthest = d
                k += 1
        if farthest <= 0.0:
            return True
        # A block of many samples is one of few pixels: then it is dear to find all bends next to each sample beforehand.
        if remember:  # first of all: finding them uses the same marks as the search from p
            k = 0
            for i in range(i0, i1 + 1):
                for j in range(j0, j1 + 1):
                    if self.alpha[k] < 0.0:
                        self.bends_of(i, j)
                    k += 1
        farthest = sqrt(farthest) + r
        self.first_bends(px, py, farthest)
        self.spread(farthest)
        k = 0
        for i in range(i0, i1 + 1):
            for j in range(j0, j1 + 1):
                if self.alpha[k] < 0.0:
                    d = sqrt((px - j) * (px - j) + (py - i) * (py - i))
                    best = INFINITY
                    if remember:
                        at = self.bends_of(i, j)
                        s = cython.cast(cython.Py_ssize_t, i - self.row0) * self.scene.width + j
                        for m in range(at, at + self.count[s]):
                            node = self.pool_node[m]
                            if self.stamp[node] == self.now and self.distance[node] + self.pool_length[m] < best:
                                best = self.distance[node] + self.pool_length[m]
                    else:
                        best = self.last_leg(j, i, d + r)
                    t = (best - d) / r
                    if t >= 1.0:
                        self.alpha[k] = 0.0
                    elif t <= 0.0:
                        self.alpha[k] = 1.0
                    else:
                        self.alpha[k] = 1.0 - t * t * (3.0 - 2.0 * t)
                k += 1
        return True

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def last_leg(self, qx: cython.double, qy: cython.double, limit: cython.double) -> cython.double:
        """Length of the shortest path shorter than the limit from where `spread` began, round a bend, to the query q."""
        k: cython.int
        n: cython.int
        v: cython.int
        x: cython.double
        y: cython.double
        left: cython.double
        best: cython.double = INFINITY
        for k in range(self.n_done):
            n = self.done[k]
            left = limit - self.distance[n]
            if left <= 0.0:
                break
            v = self.scene.node_vertex[n]
            x = self.scene.vx[v] - qx
            y = self.scene.vy[v] - qy
            if x * x + y * y >= left * left:
                continue
            if self.scene.bends_for(n, qx, qy) and self.scene.sees_vertex(qx, qy, v):
                best = self.distance[n] + sqrt(x * x + y * y)
                limit = best
        return best

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def length(
        self, px: cython.double, py: cython.double, qx: cython.double, qy: cython.double, limit: cython.double
    ) -> cython.double:
        """Length of the shortest unobstructed path between two queries, infinite beyond the limit."""
        d: cython.double = sqrt((px - qx) * (px - qx) + (py - qy) * (py - qy))
        if d > limit:
            return INFINITY
        if self.scene.n_edges == 0 or self.scene.sees(px, py, qx, qy):
            return d
        self.first_bends(px, py, limit)
        self.spread(limit)
        return self.last_leg(qx, qy, limit)


def path_lengths(
    finder: Finder,
    p: cython.double[:, ::1],
    q: cython.double[:, ::1],
    limit: cython.double,
    begin: cython.Py_ssize_t,
    end: cython.Py_ssize_t,
    out: cython.double[::1],
) -> None:
    """Shortest path lengths for the pairs begin … end, infinite beyond the limit."""
    k: cython.Py_ssize_t
    with cython.nogil:
        for k in range(begin, end):
            out[k] = finder.length(p[k, 0], p[k, 1], q[k, 0], q[k, 1], limit)


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
