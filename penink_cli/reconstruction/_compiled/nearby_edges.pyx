# cython: boundscheck=False, wraparound=False, cdivision=True
"""The edges around one tile and their vertices, each classified against the tile and its 4 × 4 samples.

A set of samples is a word of 16 bits, in reading order; for sets of pixels see `pixels`.
"""

from libc.math cimport fabsf
from libc.stdlib cimport free
from libc.string cimport memset
from penink_cli.ground._compiled.memory cimport grow, room
from penink_cli.reconstruction._compiled.lanes cimport (
    Four, greater_four, broadcast_four, load_four, vector_bytes_here, lowest, abs_four,
)
from penink_cli.reconstruction._compiled.pixels cimport Pixels
from penink_cli.reconstruction._compiled.scene cimport Scene, side_of_query


cdef class NearbyEdges(Pixels):
    """The edges gathered around one tile after the other.

    column, row: of the samples, within the frame. sx, sy: where they lie relative to the cell.
    edge, edge_a, edge_b: the edges gathered, and their ends among the tile's vertices.
    tile_side: on which side of each edge the tile lies: 1, −1, or 0 where the edge's line cuts it.
    sample_side: the set of samples on the positive side of each edge.
    positive, negative: for each vertex the samples from which, looking at it, the whole tile is to that side.
    partial, side_mask, has_side_mask, line, has_line: room for what the tile finds out about each of them.
    """

    def __init__(self, Scene scene, double step_x, double step_y):
        self.wide = vector_bytes_here() > 16
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
        self.side_mask = <unsigned long long*>room(64, sizeof(unsigned long long))
        self.vertex = zeros(128)
        self.lx = <float*>room(128, sizeof(float))
        self.ly = <float*>room(128, sizeof(float))
        self.positive = zeros(128)
        self.negative = zeros(128)
        self.has_line = zeros(128)
        self.line = <unsigned long long*>room(128 * 16, sizeof(unsigned long long))

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

    cdef void place_in_row(self, int cy, double* py, int ny) noexcept nogil:
        """Go to the rows of pixels py, in the cells whose upper samples are row cy, −1 included."""
        cdef int k, t
        self.stand_in_row(cy, py, ny)
        for k in range(4):
            t = cy - 1 + k
            t = 0 if t < 0 else (self.scene.height - 1 if t >= self.scene.height else t)
            self.row[k] = t
            self.sy[k] = <float>(t - cy)

    cdef void place(self, int cx, double* px, int nx) noexcept nogil:
        """Go to the columns of pixels px, in the cell whose left samples are column cx, −1 included."""
        cdef int k, t
        self.stand_in_column(cx, px, nx)
        for k in range(4):
            t = cx - 1 + k
            t = 0 if t < 0 else (self.scene.width - 1 if t >= self.scene.width else t)
            self.column[k] = t
            self.sx[k] = <float>(t - cx)
        self.now += 1
        self.n_edges = 0
        self.n_vertices = 0

    cdef int gather(self, int radius) except -1 nogil:
        """Enter the edges of the cells up to `radius` away, those that are not there yet."""
        cdef int row, k, e
        cdef int c0 = self.cx + 1 - radius
        cdef int c1 = self.cx + 1 + radius
        cdef int r0 = self.cy + 1 - radius
        cdef int r1 = self.cy + 1 + radius
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
                    grow(<void**>&self.edge, 2 * self.size_edges, sizeof(int))
                    grow(<void**>&self.edge_a, 2 * self.size_edges, sizeof(int))
                    grow(<void**>&self.edge_b, 2 * self.size_edges, sizeof(int))
                    grow(<void**>&self.tile_side, 2 * self.size_edges, sizeof(int))
                    grow(<void**>&self.sample_side, 2 * self.size_edges, sizeof(int))
                    grow(<void**>&self.partial, 2 * self.size_edges, sizeof(int))
                    grow(<void**>&self.has_side_mask, 2 * self.size_edges, sizeof(int))
                    grow(<void**>&self.side_mask, 2 * self.size_edges, sizeof(unsigned long long))
                    self.size_edges *= 2
                self.edge[self.n_edges] = e
                self.edge_a[self.n_edges] = self.enter_vertex(self.scene.ea[e])
                self.edge_b[self.n_edges] = self.enter_vertex(self.scene.eb[e])
                self.has_side_mask[self.n_edges] = False
                self.n_edges += 1

    cdef int enter_vertex(self, int v) except -1 nogil:
        """The place of a vertex among those of the tile."""
        cdef int k
        if self.vertex_stamp[v] == self.now:
            return self.vertex_place[v]
        if self.n_vertices == self.size_vertices:
            grow(<void**>&self.vertex, 2 * self.size_vertices, sizeof(int))
            grow(<void**>&self.lx, 2 * self.size_vertices, sizeof(float))
            grow(<void**>&self.ly, 2 * self.size_vertices, sizeof(float))
            grow(<void**>&self.positive, 2 * self.size_vertices, sizeof(int))
            grow(<void**>&self.negative, 2 * self.size_vertices, sizeof(int))
            grow(<void**>&self.has_line, 2 * self.size_vertices, sizeof(int))
            grow(<void**>&self.line, 2 * self.size_vertices, 16 * sizeof(unsigned long long))
            self.size_vertices *= 2
        k = self.n_vertices
        self.n_vertices += 1
        self.vertex_stamp[v] = self.now
        self.vertex_place[v] = k
        self.vertex[k] = v
        self.lx[k] = <float>(self.scene.vx[v] - self.cx)
        self.ly[k] = <float>(self.scene.vy[v] - self.cy)
        self.has_line[k] = 0
        return k

    cdef void classify_vertex(self, int k) noexcept nogil:
        """The samples whose line to a vertex has the whole tile on one side, four of a row at a time."""
        cdef int j
        cdef float dy
        cdef Four value, extent
        cdef int positive = 0, negative = 0
        cdef Four sx = load_four(self.sx)
        cdef Four dx = broadcast_four(self.lx[k]) - sx
        cdef Four mx = broadcast_four(self.mid_x) - sx
        cdef Four wide = abs_four(dx) * broadcast_four(self.half_y)
        for j in range(4):
            dy = self.ly[k] - self.sy[j]
            value = dx * broadcast_four(self.mid_y - self.sy[j]) - broadcast_four(dy) * mx
            extent = wide + broadcast_four(fabsf(dy) * self.half_x)
            positive |= greater_four(value, extent) << (4 * j)
            negative |= greater_four(-value, extent) << (4 * j)
        self.positive[k] = positive
        self.negative[k] = negative

    cdef void classify_edge(self, int k, bint samples_too) noexcept nogil:
        """On which side of an edge the tile lies and, if that is asked, each sample."""
        cdef int j
        cdef Four along, value, least
        cdef int a = self.edge_a[k]
        cdef int b = self.edge_b[k]
        cdef float ax = self.lx[a]
        cdef float ay = self.ly[a]
        cdef float dx = self.lx[b] - ax
        cdef float dy = self.ly[b] - ay
        cdef int positive = 0, negative = 0
        # A far end is rounded coarsely: the slack grows with its distance.
        cdef float slack = <float>1e-6 * (
            fabsf(dx) * (fabsf(ay) + fabsf(dy) + 4) + fabsf(dy) * (fabsf(ax) + fabsf(dx) + 4)
        )
        cdef float extent = fabsf(dx) * self.half_y + fabsf(dy) * self.half_x + slack
        cdef float middle = dx * (self.mid_y - ay) - dy * (self.mid_x - ax)
        self.tile_side[k] = 1 if middle > extent else (-1 if -middle > extent else 0)
        if not samples_too:
            return
        along = broadcast_four(dy) * (load_four(self.sx) - broadcast_four(ax))
        least = broadcast_four(slack)
        for j in range(4):
            value = broadcast_four(dx * (self.sy[j] - ay)) - along
            positive |= greater_four(value, least) << (4 * j)
            negative |= greater_four(-value, least) << (4 * j)
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


cdef int* zeros(Py_ssize_t n) except NULL nogil:
    """Room for n whole numbers, all zero."""
    cdef int* numbers = <int*>room(n, sizeof(int))
    memset(numbers, 0, n * sizeof(int))
    return numbers
