# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The edges around one tile and their vertices, each classified against the tile and its 4 × 4 samples.

A set of samples is a word of 16 bits, in reading order; for sets of pixels see `_pixels`.
"""

import cython
from cython.cimports.libc.math import fabsf
from cython.cimports.libc.stdlib import free, malloc, realloc
from cython.cimports.penink_cli.reconstruction._lanes import (
    Four,
    above_four,
    all_four,
    four_at,
    lanes_here,
    lowest,
    size_four,
)
from cython.cimports.penink_cli.reconstruction._pixels import Pixels
from cython.cimports.penink_cli.reconstruction._scene import Scene, side_of_query

COMPILED = cython.compiled


@cython.cclass
class Surroundings(Pixels):
    """The edges gathered around one tile after the other.

    column, row: of the samples, within the frame. sx, sy: where they lie relative to the cell.
    edge, edge_a, edge_b: the edges gathered, and their ends among the tile's vertices.
    tile_side: on which side of each edge the tile lies: 1, −1, or 0 where the edge's line cuts it.
    sample_side: the set of samples on the positive side of each edge.
    positive, negative: for each vertex the samples from which, looking at it, the whole tile is to that side.
    partial, side_mask, has_side_mask, line, has_line: room for what the tile finds out about each of them.
    """

    def __init__(self, scene: Scene, step_x: cython.double, step_y: cython.double):
        self.wide = lanes_here() > 16
        self.scene = scene
        self.step_x = step_x
        self.step_y = step_y
        self.edge_stamp = zeros(scene.n_edges)
        self.vertex_stamp = zeros(scene.n_vertices)
        self.vertex_place = zeros(scene.n_vertices)
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
    def place_in_row(self, cy: cython.int, py: cython.p_double, ny: cython.int) -> cython.void:
        """Go to the rows of pixels py, in the cells whose upper samples are row cy, −1 included."""
        k: cython.int
        t: cython.int
        self.stand_in_row(cy, py, ny)
        for k in range(4):
            t = cy - 1 + k
            t = 0 if t < 0 else (self.scene.height - 1 if t >= self.scene.height else t)
            self.row[k] = t
            self.sy[k] = cython.cast(cython.float, t - cy)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def place(self, cx: cython.int, px: cython.p_double, nx: cython.int) -> cython.void:
        """Go to the columns of pixels px, in the cell whose left samples are column cx, −1 included."""
        k: cython.int
        t: cython.int
        self.stand_in_column(cx, px, nx)
        for k in range(4):
            t = cx - 1 + k
            t = 0 if t < 0 else (self.scene.width - 1 if t >= self.scene.width else t)
            self.column[k] = t
            self.sx[k] = cython.cast(cython.float, t - cx)
        self.now += 1
        self.n_edges = 0
        self.n_vertices = 0

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
        """The samples whose line to a vertex has the whole tile on one side, four of a row at a time."""
        j: cython.int
        positive: cython.int = 0
        negative: cython.int = 0
        sx: Four = four_at(self.sx)
        dx: Four = all_four(self.lx[k]) - sx
        mx: Four = all_four(self.mid_x) - sx
        wide: Four = size_four(dx) * all_four(self.half_y)
        dy: cython.float
        value: Four
        extent: Four
        for j in range(4):
            dy = self.ly[k] - self.sy[j]
            value = dx * all_four(self.mid_y - self.sy[j]) - all_four(dy) * mx
            extent = wide + all_four(fabsf(dy) * self.half_x)
            positive |= above_four(value, extent) << (4 * j)
            negative |= above_four(-value, extent) << (4 * j)
        self.positive[k] = positive
        self.negative[k] = negative

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def classify_edge(self, k: cython.int, samples_too: cython.bint) -> cython.void:
        """On which side of an edge the tile lies and, if that is asked, each sample."""
        j: cython.int
        a: cython.int = self.edge_a[k]
        b: cython.int = self.edge_b[k]
        ax: cython.float = self.lx[a]
        ay: cython.float = self.ly[a]
        dx: cython.float = self.lx[b] - ax
        dy: cython.float = self.ly[b] - ay
        positive: cython.int = 0
        negative: cython.int = 0
        along: Four
        value: Four
        least: Four
        # A far end is rounded coarsely: the slack grows with its distance.
        slack: cython.float = cython.cast(cython.float, 1e-6) * (
            fabsf(dx) * (fabsf(ay) + fabsf(dy) + 4) + fabsf(dy) * (fabsf(ax) + fabsf(dx) + 4)
        )
        extent: cython.float = fabsf(dx) * self.half_y + fabsf(dy) * self.half_x + slack
        middle: cython.float = dx * (self.mid_y - ay) - dy * (self.mid_x - ax)
        self.tile_side[k] = 1 if middle > extent else (-1 if -middle > extent else 0)
        if not samples_too:
            return
        along = all_four(dy) * (four_at(self.sx) - all_four(ax))
        least = all_four(slack)
        for j in range(4):
            value = all_four(dx * (self.sy[j] - ay)) - along
            positive |= above_four(value, least) << (4 * j)
            negative |= above_four(-value, least) << (4 * j)
        self.sample_side[k] = positive
        negative = 0xFFFF & ~(positive | negative)  # those too near its line for that
        while negative:
            j = lowest(negative)
            negative &= negative - 1
            a = self.scene.ea[self.edge[k]]
            b = self.scene.eb[self.edge[k]]
            if (
                side_of_query(
                    self.scene.vx[a], self.scene.vy[a], self.scene.vx[b], self.scene.vy[b],
                    self.column[j & 3], self.row[j >> 2],
                )
                > 0
            ):  # fmt: skip
                self.sample_side[k] |= 1 << j


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
