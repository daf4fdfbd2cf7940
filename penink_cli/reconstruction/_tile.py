# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""What the output pixels of one tile see: up to 8 × 8 of them, in one cell, which share the same 4 × 4 samples.

A set of samples is a word of 16 bits, in reading order; for sets of pixels see `_pixels`.
"""

import cython
from cython.cimports.libc.math import fabsf
from cython.cimports.libc.stdlib import free, malloc, realloc
from cython.cimports.penink_cli.arrangement._predicates import orient
from cython.cimports.penink_cli.reconstruction._pixels import ALL, Pixels
from cython.cimports.penink_cli.reconstruction._scene import side_of_query
from cython.cimports.penink_cli.reconstruction._search import Finder

COMPILED = cython.compiled

BIT = cython.declare(cython.int[16])  # 1 << k: shifting by a vector of counts is dear without AVX2


@cython.cfunc
def tabulate() -> cython.void:
    """Fill the table above."""
    k: cython.int
    for k in range(16):
        BIT[k] = 1 << k


tabulate()


@cython.final  # calls are direct, and inlined
@cython.cclass
class Tile(Pixels):
    """Work space of one thread for one tile after the other.

    edge, edge_a, edge_b: the edges gathered around the tile, and their ends among its vertices.
    tile_side: on which side of each edge the tile lies: 1, −1, or 0 where the edge's line cuts it.
    sample_side: the set of samples on the positive side of each edge. partial: the samples it hides from some pixels.
    positive, negative: for each vertex the samples from which, looking at it, the whole tile is to that side.
    line: for each vertex and sample the mask of the line through both. Sets of pixels are filled as they are needed.
    """

    def __init__(self, finder: Finder, step_x: cython.double, step_y: cython.double, gather_radius: cython.int):
        self.finder = finder
        self.scene = finder.scene
        self.step_x = step_x
        self.step_y = step_y
        self.gather_radius = gather_radius
        self.edge_stamp = zeros(self.scene.n_edges)
        self.vertex_stamp = zeros(self.scene.n_vertices)
        self.vertex_place = zeros(self.scene.n_vertices)
        self.node_stamp = zeros(self.scene.n_nodes)
        self.node_place = zeros(self.scene.n_nodes)
        self.size_edges = 64
        self.size_vertices = 128
        self.edge = zeros(64)
        self.edge_a = zeros(64)
        self.edge_b = zeros(64)
        self.tile_side = zeros(64)
        self.sample_side = zeros(64)
        self.partial = zeros(64)
        self.has_side_mask = zeros(64)
        self.side_mask = cython.cast(cython.p_ulonglong, malloc(64 * 8))
        self.vertex = zeros(128)
        self.lx = cython.cast(cython.p_float, malloc(128 * 4))
        self.ly = cython.cast(cython.p_float, malloc(128 * 4))
        self.positive = zeros(128)
        self.negative = zeros(128)
        self.has_line = zeros(128)
        self.line = cython.cast(cython.p_ulonglong, malloc(128 * 16 * 8))

    def __dealloc__(self):
        free(self.edge_stamp)
        free(self.vertex_stamp)
        free(self.vertex_place)
        free(self.node_stamp)
        free(self.node_place)
        free(self.edge)
        free(self.edge_a)
        free(self.edge_b)
        free(self.tile_side)
        free(self.sample_side)
        free(self.partial)
        free(self.has_side_mask)
        free(self.side_mask)
        free(self.vertex)
        free(self.lx)
        free(self.ly)
        free(self.positive)
        free(self.negative)
        free(self.has_line)
        free(self.line)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def place(
        self,
        cx: cython.int,
        cy: cython.int,
        px: cython.p_double,
        nx: cython.int,
        py: cython.p_double,
        ny: cython.int,
    ) -> cython.void:
        """Move to the pixels px × py of the cell whose top-left sample is (row cy, column cx), −1 included."""
        k: cython.int
        t: cython.int
        self.stand(cx, cy, px, nx, py, ny)
        for k in range(4):
            t = cx - 1 + k
            self.column[k] = 0 if t < 0 else (self.scene.width - 1 if t >= self.scene.width else t)
            t = cy - 1 + k
            self.row[k] = 0 if t < 0 else (self.scene.height - 1 if t >= self.scene.height else t)
        for k in range(16):
            self.sx[k] = cython.cast(cython.float, self.column[k & 3] - cx)
            self.sy[k] = cython.cast(cython.float, self.row[k >> 2] - cy)
        self.now += 1
        self.n_edges = 0
        self.n_vertices = 0
        self.gathered_wide = False

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def see(self) -> cython.bint:
        """Fill `hidden`, `all_visible` and `all_hidden`; False, and nothing filled, if all pixels see all samples."""
        k: cython.int
        s: cython.int
        a: cython.int
        b: cython.int
        same: cython.int
        across: cython.int
        full: cython.int = 0
        some: cython.int = 0
        left: cython.int
        m: cython.ulonglong
        self.gather(1)
        for k in range(self.n_vertices):
            self.classify_vertex(k)
        for k in range(self.n_edges):
            self.classify_edge(k)
            a = self.edge_a[k]
            b = self.edge_b[k]
            same = (self.positive[a] & self.positive[b]) | (self.negative[a] & self.negative[b])
            across = (self.positive[a] & self.negative[b]) | (self.negative[a] & self.positive[b])
            if self.tile_side[k] > 0:
                full |= across & ~self.sample_side[k]
                self.partial[k] = ~(same | across | self.sample_side[k]) & 0xFFFF
            elif self.tile_side[k] < 0:
                full |= across & self.sample_side[k]
                self.partial[k] = self.sample_side[k] & ~(same | across)
            else:
                self.partial[k] = ~same & 0xFFFF
            some |= self.partial[k]
        if not (full | some):
            return False
        for s in range(16):
            self.hidden[s] = 0
        if some & ~full:
            for k in range(self.n_edges):
                left = self.partial[k] & ~full
                s = 0
                while left:
                    if left & 1:
                        m = self.edge_mask(k)
                        if (self.sample_side[k] >> s) & 1:
                            m = ~m
                        if m:
                            m &= self.line_mask(self.edge_a[k], s) ^ self.line_mask(self.edge_b[k], s)
                            self.hidden[s] |= m
                    left >>= 1
                    s += 1
        self.all_visible = 0
        self.all_hidden = full
        m = self.pixels()
        for s in range(16):
            if (full >> s) & 1:
                self.hidden[s] = m
            else:
                self.hidden[s] &= m
                if self.hidden[s] == 0:
                    self.all_visible |= 1 << s
                elif self.hidden[s] == m:
                    self.all_hidden |= 1 << s
        return self.all_visible != 0xFFFF

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def node_mask(self, node: cython.int) -> cython.ulonglong:
        """The pixels from which a path may go straight to a node, as the bend next to it."""
        scene_v: cython.int = self.scene.node_vertex[node]
        a: cython.int = self.scene.node_low[node]
        b: cython.int = self.scene.node_high[node]
        x: cython.double = self.scene.vx[scene_v]
        y: cython.double = self.scene.vy[scene_v]
        m: cython.ulonglong = ALL
        h: cython.ulonglong
        k: cython.int
        e: cython.int
        side: cython.int
        la: cython.int
        lb: cython.int
        if a != b:
            la = self.box_side(x, y, self.scene.vx[a], self.scene.vy[a])
            lb = self.box_side(x, y, self.scene.vx[b], self.scene.vy[b])
            if la != 0 and lb != 0:
                if la != lb:
                    return 0
            else:
                m = ~(
                    self.half_plane(x, y, self.scene.vx[a], self.scene.vy[a], False)
                    ^ self.half_plane(x, y, self.scene.vx[b], self.scene.vy[b], False)
                )
                if not (m & self.pixels()):
                    return 0
        if not self.gathered_wide:
            k = self.n_edges
            self.gather(self.gather_radius)
            self.gathered_wide = True
            while k < self.n_edges:
                self.classify_edge(k)
                k += 1
        for k in range(self.n_edges):
            e = self.edge[k]
            a = self.scene.ea[e]
            b = self.scene.eb[e]
            if a == scene_v or b == scene_v:
                continue
            side = orient(self.scene.vx[a], self.scene.vy[a], self.scene.vx[b], self.scene.vy[b], x, y)
            if side == 0 or side == self.tile_side[k]:
                continue
            la = self.box_side(x, y, self.scene.vx[a], self.scene.vy[a])
            lb = self.box_side(x, y, self.scene.vx[b], self.scene.vy[b])
            if la != 0 and lb != 0:
                if la == lb:
                    continue
                if self.tile_side[k] != 0:
                    return 0
                h = ALL
            else:
                h = self.half_plane(x, y, self.scene.vx[a], self.scene.vy[a], False) ^ self.half_plane(
                    x, y, self.scene.vx[b], self.scene.vy[b], False
                )
            if self.tile_side[k] == 0:
                h &= ~self.edge_mask(k) if side > 0 else self.edge_mask(k)
            m &= ~h
        return m & self.pixels()

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def gather(self, radius: cython.int) -> cython.void:
        """Enter the edges of the cells up to `radius` away, those that are not there yet."""
        row: cython.int
        k: cython.int
        e: cython.int
        c0: cython.int = self.cx + 1 - radius
        c1: cython.int = self.cx + 1 + radius
        r0: cython.int = self.cy + 1 - radius
        r1: cython.int = self.cy + 1 + radius
        c0 = 0 if c0 < 0 else c0
        r0 = 0 if r0 < 0 else r0
        c1 = self.scene.gw - 1 if c1 >= self.scene.gw else c1
        r1 = self.scene.gh - 1 if r1 >= self.scene.gh else r1
        for row in range(r0, r1 + 1):
            for k in range(
                self.scene.cell_start[row * self.scene.gw + c0], self.scene.cell_start[row * self.scene.gw + c1 + 1]
            ):
                e = self.scene.cell_edge[k]
                if self.edge_stamp[e] == self.now:
                    continue
                self.edge_stamp[e] = self.now
                if self.n_edges == self.size_edges:
                    self.size_edges *= 2
                    self.edge = grown(self.edge, self.size_edges)
                    self.edge_a = grown(self.edge_a, self.size_edges)
                    self.edge_b = grown(self.edge_b, self.size_edges)
                    self.tile_side = grown(self.tile_side, self.size_edges)
                    self.sample_side = grown(self.sample_side, self.size_edges)
                    self.partial = grown(self.partial, self.size_edges)
                    self.has_side_mask = grown(self.has_side_mask, self.size_edges)
                    self.side_mask = cython.cast(cython.p_ulonglong, realloc(self.side_mask, self.size_edges * 8))
                self.edge[self.n_edges] = e
                self.edge_a[self.n_edges] = self.enter_vertex(self.scene.ea[e])
                self.edge_b[self.n_edges] = self.enter_vertex(self.scene.eb[e])
                self.has_side_mask[self.n_edges] = False
                self.n_edges += 1

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def enter_vertex(self, v: cython.int) -> cython.int:
        """The place of a vertex among those of the tile."""
        k: cython.int
        if self.vertex_stamp[v] == self.now:
            return self.vertex_place[v]
        if self.n_vertices == self.size_vertices:
            self.size_vertices *= 2
            self.vertex = grown(self.vertex, self.size_vertices)
            self.lx = cython.cast(cython.p_float, realloc(self.lx, self.size_vertices * 4))
            self.ly = cython.cast(cython.p_float, realloc(self.ly, self.size_vertices * 4))
            self.positive = grown(self.positive, self.size_vertices)
            self.negative = grown(self.negative, self.size_vertices)
            self.has_line = grown(self.has_line, self.size_vertices)
            self.line = cython.cast(cython.p_ulonglong, realloc(self.line, self.size_vertices * 128))
        k = self.n_vertices
        self.n_vertices += 1
        self.vertex_stamp[v] = self.now
        self.vertex_place[v] = k
        self.vertex[k] = v
        self.lx[k] = cython.cast(cython.float, self.scene.vx[v] - self.cx)
        self.ly[k] = cython.cast(cython.float, self.scene.vy[v] - self.cy)
        self.has_line[k] = 0
        return k

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def classify_vertex(self, k: cython.int) -> cython.void:
        """The samples whose line to a vertex has the whole tile on one side; the inner loop vectorises."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        value: cython.float
        extent: cython.float
        dy: cython.float
        my: cython.float
        high: cython.float
        bit: cython.int
        positive: cython.int = 0
        negative: cython.int = 0
        x: cython.float = self.lx[k]
        y: cython.float = self.ly[k]
        half_x: cython.float = self.half_x
        half_y: cython.float = self.half_y
        dx: cython.float[4]
        mx: cython.float[4]
        wide: cython.float[4]
        for i in range(4):
            dx[i] = x - self.sx[i]
            mx[i] = self.mid_x - self.sx[i]
            wide[i] = fabsf(dx[i]) * half_y
        for j in range(4):
            dy = y - self.sy[4 * j]
            my = self.mid_y - self.sy[4 * j]
            high = fabsf(dy) * half_x
            for i in range(4):
                value = dx[i] * my - dy * mx[i]
                extent = wide[i] + high
                bit = BIT[4 * j + i]
                positive += bit if value > extent else 0
                negative += bit if -value > extent else 0
        self.positive[k] = positive
        self.negative[k] = negative

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def classify_edge(self, k: cython.int) -> cython.void:
        """On which side of an edge the tile and each sample lie."""
        s: cython.Py_ssize_t
        a: cython.int = self.edge_a[k]
        b: cython.int = self.edge_b[k]
        ax: cython.float = self.lx[a]
        ay: cython.float = self.ly[a]
        dx: cython.float = self.lx[b] - ax
        dy: cython.float = self.ly[b] - ay
        value: cython.float
        bit: cython.int
        unsure: cython.int = 0
        positive: cython.int = 0
        # A far end is rounded coarsely: the slack grows with its distance.
        slack: cython.float = cython.cast(cython.float, 1e-6) * (
            fabsf(dx) * (fabsf(ay) + fabsf(dy) + 4) + fabsf(dy) * (fabsf(ax) + fabsf(dx) + 4)
        )
        extent: cython.float = fabsf(dx) * self.half_y + fabsf(dy) * self.half_x + slack
        value = dx * (self.mid_y - ay) - dy * (self.mid_x - ax)
        self.tile_side[k] = 1 if value > extent else (-1 if -value > extent else 0)
        for s in range(16):
            value = dx * (self.sy[s] - ay) - dy * (self.sx[s] - ax)
            bit = BIT[s]
            positive += bit if value > slack else 0
            unsure += 0 if fabsf(value) > slack else bit
        self.sample_side[k] = positive
        s = 0
        while unsure:
            if unsure & 1:
                a = self.scene.ea[self.edge[k]]
                b = self.scene.eb[self.edge[k]]
                if (
                    side_of_query(
                        self.scene.vx[a],
                        self.scene.vy[a],
                        self.scene.vx[b],
                        self.scene.vy[b],
                        self.column[s & 3],
                        self.row[s >> 2],
                    )
                    > 0
                ):
                    self.sample_side[k] |= 1 << s
            unsure >>= 1
            s += 1

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def edge_mask(self, k: cython.int) -> cython.ulonglong:
        """The pixels on the positive side of an edge."""
        a: cython.int
        b: cython.int
        if self.tile_side[k] != 0:
            return ALL if self.tile_side[k] > 0 else 0
        if not self.has_side_mask[k]:
            a = self.vertex[self.edge_a[k]]
            b = self.vertex[self.edge_b[k]]
            self.side_mask[k] = self.half_plane(
                self.scene.vx[a], self.scene.vy[a], self.scene.vx[b], self.scene.vy[b], False
            )
            self.has_side_mask[k] = True
        return self.side_mask[k]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def line_mask(self, k: cython.int, sample: cython.int) -> cython.ulonglong:
        """The pixels on the positive side of the line from a sample to a vertex."""
        bit: cython.int = 1 << sample
        v: cython.int
        if self.positive[k] & bit:
            return ALL
        if self.negative[k] & bit:
            return 0
        if not (self.has_line[k] & bit):
            v = self.vertex[k]
            self.line[16 * k + sample] = self.half_plane(
                self.column[sample & 3], self.row[sample >> 2], self.scene.vx[v], self.scene.vy[v], True
            )
            self.has_line[k] |= bit
        return self.line[16 * k + sample]


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def zeros(n: cython.Py_ssize_t) -> cython.p_int:
    """Room for n whole numbers, all zero."""
    k: cython.Py_ssize_t
    room: cython.p_int = cython.cast(cython.p_int, malloc((n + 1) * cython.sizeof(cython.int)))
    for k in range(n + 1):
        room[k] = 0
    return room


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def grown(room: cython.p_int, n: cython.Py_ssize_t) -> cython.p_int:
    """The same room, made larger."""
    return cython.cast(cython.p_int, realloc(room, n * cython.sizeof(cython.int)))
