# cython: boundscheck=False, wraparound=False, cdivision=True
"""What the output pixels of one tile see: up to 8 × 8 of them, in one cell, which share the same 4 × 4 samples.

    s ·────────── a ───────      The pixels (░) that an edge a–b hides from a sample s lie beyond the edge's line and
        ╲         │ ░ ░ ░        between the lines from s through a and through b: of three masks the first is
            ╲     │ ░ ░ ░        turned to the side where s is not, and the other two differ.
                ╲ b ░ ░ ░
                    ╲ ░ ░
"""

from libc.stdlib cimport free
from libc.string cimport memset
from penink_cli.geometry._compiled.predicates cimport orient
from penink_cli.reconstruction._compiled.lanes cimport lowest
from penink_cli.reconstruction._compiled.search cimport Finder
from penink_cli.reconstruction._compiled.nearby_edges cimport NearbyEdges, zeros

cdef unsigned long long ALL = 0xFFFFFFFFFFFFFFFF


cdef class Tile(NearbyEdges):
    """Work space of one thread for one tile after the other.

    hidden: for each sample the pixels that do not see it; shaded: the set of samples for which that is any.
    side_mask: for each edge the pixels on its positive side. line: for each vertex and sample the mask of the line
    through both. Sets of pixels are filled as they are needed.
    """

    def __init__(self, Finder finder, double step_x, double step_y, int gather_radius):
        NearbyEdges.__init__(self, finder.scene, step_x, step_y)
        self.finder = finder
        self.gather_radius = gather_radius
        self.node_stamp = zeros(self.scene.n_nodes)
        self.node_place = zeros(self.scene.n_nodes)

    def __dealloc__(self):
        free(self.node_stamp)
        free(self.node_place)

    cdef bint see(self) except -1 nogil:
        """Fill `hidden` and `shaded`; False, and nothing filled, if all pixels see all samples."""
        cdef int k, s, a, b, same, across, beyond, cut, left
        cdef unsigned long long mask, side, everything
        cdef int full = 0, some = 0
        self.gather(1)
        self.gathered_wide = False
        for k in range(self.n_vertices):
            self.classify_vertex(k)
        for k in range(self.n_edges):
            self.classify_edge(k, True)
            a = self.edge_a[k]
            b = self.edge_b[k]
            same = (self.positive[a] & self.positive[b]) | (self.negative[a] & self.negative[b])
            across = (self.positive[a] & self.negative[b]) | (self.negative[a] & self.positive[b])
            # Samples on the tile's own side of the edge see past it; without a branch, for none can be foreseen.
            beyond = self.sample_side[k] ^ -(self.tile_side[k] > 0)
            cut = -(self.tile_side[k] == 0)
            full |= across & beyond & ~cut
            self.partial[k] = ~same & (cut | (beyond & ~across)) & 0xFFFF
            some |= self.partial[k]
        if not (full | some):
            return False
        memset(self.hidden, 0, 16 * sizeof(unsigned long long))
        everything = self.pixels()
        self.shaded = full
        left = full
        while left:
            self.hidden[lowest(left)] = everything
            left &= left - 1
        if some & ~full:
            for k in range(self.n_edges):
                left = self.partial[k] & ~full
                if left == 0:
                    continue
                mask = self.edge_mask(k) & everything
                if mask == everything:  # seen from its positive side it hides nothing
                    left &= ~self.sample_side[k]
                elif mask == 0:
                    left &= self.sample_side[k]
                a = self.edge_a[k]
                b = self.edge_b[k]
                self.draw_lines(a, left)
                self.draw_lines(b, left)
                while left:
                    s = lowest(left)
                    left &= left - 1
                    side = -<unsigned long long>((self.sample_side[k] >> s) & 1)
                    self.hidden[s] |= ((mask ^ side) & everything) & (beside_line(self, a, s) ^ beside_line(self, b, s))
            left = some & ~full
            while left:
                s = lowest(left)
                self.shaded |= (left & -left) if self.hidden[s] else 0
                left &= left - 1
        return self.shaded != 0

    cdef int node_mask(self, int node, unsigned long long* seen) except -1 nogil:
        """Find the pixels from which a path may go straight to a node, as the bend next to it."""
        cdef unsigned long long h
        cdef int k, e, side, la, lb
        cdef int scene_v = self.scene.node_vertex[node]
        cdef int a = self.scene.node_low[node]
        cdef int b = self.scene.node_high[node]
        cdef double x = self.scene.vx[scene_v]
        cdef double y = self.scene.vy[scene_v]
        cdef unsigned long long m = ALL
        seen[0] = 0
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
                self.classify_edge(k, False)
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
            if not (m & self.pixels()):
                return 0
        seen[0] = m & self.pixels()
        return 0

    cdef unsigned long long edge_mask(self, int k) noexcept nogil:
        """The pixels on the positive side of an edge."""
        cdef int a, b
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

    cdef void draw_lines(self, int k, int samples) noexcept nogil:
        """Note the pixels on the positive side of the lines from some samples to a vertex, if those cut the tile."""
        cdef int s
        cdef int v = self.vertex[k]
        samples &= ~(self.positive[k] | self.negative[k] | self.has_line[k])
        self.has_line[k] |= samples
        while samples:
            s = lowest(samples)
            samples &= samples - 1
            self.line[16 * k + s] = self.half_plane(
                self.column[s & 3], self.row[s >> 2], self.scene.vx[v], self.scene.vy[v], True
            )


cdef inline unsigned long long beside_line(Tile tile, int k, int s) noexcept nogil:
    """The pixels on the positive side of the line from a sample to a vertex, without a branch: none can be foreseen."""
    cdef unsigned long long positive = (tile.positive[k] >> s) & 1
    cdef unsigned long long drawn = (tile.has_line[k] >> s) & 1
    return -positive | (tile.line[16 * k + s] & -drawn)
