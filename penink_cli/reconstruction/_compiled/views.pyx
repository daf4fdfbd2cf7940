# cython: boundscheck=False, wraparound=False, cdivision=True
"""Which samples each node sees, found from the nodes: the first bends of all samples of some rows at once.

The other way round, from each sample to each node near it along the cells between, takes ten times as long: here an
edge is looked at once for a node, and four samples at a time tell on which side of three lines they are. Those too
near a line to tell in single precision are decided by the exact predicates.
"""

from libc.math cimport ceil, fabs, fabsf, floor, sqrt
from libc.stdlib cimport free
from penink_cli.geometry._compiled.predicates cimport orient
from penink_cli.ground._compiled.memory cimport grow, room
from penink_cli.reconstruction._compiled.lanes cimport Four, greater_four, broadcast_four, load_four, lowest
from penink_cli.reconstruction._compiled.scene cimport BLOCK, Scene

cdef double SLACK = 1e-9  # more than rounding comes to in lengths of a few samples
cdef unsigned int ALL = 0xFFFFFFFF
cdef float[4] RAMP  # 0 … 3


cdef void tabulate():
    """Fill the table above."""
    cdef int k
    for k in range(4):
        RAMP[k] = k


tabulate()


cdef bint worth(double x, double y, double length, double radius) noexcept nogil:
    """Whether a path of that length from a sample to a bend, x and y away, can go on to a pixel of the sample's.

    A pixel p has a sample s among its 16 where it lies in the square of half side 2 around s, and the path matters
    where length + |p − v| < |p − s| + r. So length − r must be less than the most that |p − s| − |p − v| comes to
    in that square: within it at v itself; else, where v is beyond one side, at the point of that side that the
    mirror image of v is seen through, where the mirror image is; and at the corner where that is off the side.
    A node left out is no stage to another: |p − s| − |p − v| falls by no more than the way from node to node.
    It leaves out a third of all bends that the bound by distance alone lets in.
    """
    cdef double most
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
    return length < most + radius + SLACK


cdef class Views:
    """The nodes that each sample of the rows row0 … row1 sees and that are worth their while, as linked lists.

    head: for each sample its first entry, −1 for none. node, length, following: of each entry the node, how far away
    it is, and the sample's next entry. alive: for each row of samples in a node's window those that see it so far.
    window: at most 15, how far away along an axis a node worth its while can be: |v| + |v − corner| ≥ |corner mirrored
    at v's x|.
    """

    def __init__(self, Scene scene, double reach, double radius):
        cdef int k
        self.scene = scene
        self.reach = reach
        self.radius = radius
        self.window = 1.0 + 0.5 * sqrt(reach * reach - 4.0)
        self.size = 1024
        self.node = <int*>room(self.size, sizeof(int))
        self.following = <int*>room(self.size, sizeof(int))
        self.length = <double*>room(self.size, sizeof(double))
        self.alive = <unsigned int*>room(32, sizeof(unsigned int))
        self.edge_stamp = <int*>room((scene.n_edges + 1), sizeof(int))
        for k in range(scene.n_edges):
            self.edge_stamp[k] = 0

    def __dealloc__(self):
        free(self.head)
        free(self.node)
        free(self.following)
        free(self.length)
        free(self.alive)
        free(self.edge_stamp)

    cdef int look(self, int row0, int row1) except -1 nogil:
        """Find what the samples of these rows see."""
        cdef Py_ssize_t k
        cdef int row
        cdef int across = self.scene.node_across
        cdef Py_ssize_t n = <Py_ssize_t>(row1 - row0) * self.scene.width
        if n > self.room:
            grow(<void**>&self.head, n, sizeof(int))
            self.room = n
        for k in range(n):
            self.head[k] = -1
        self.row0 = row0
        self.row1 = row1
        self.used = 0
        for row in range(
            self.scene.row_of(row0 - self.window) >> BLOCK, (self.scene.row_of(row1 + self.window) >> BLOCK) + 1
        ):
            for k in range(self.scene.node_start[row * across], self.scene.node_start[(row + 1) * across]):
                self.look_from(self.scene.node_sorted[k])

    cdef int look_from(self, int n) except -1 nogil:
        """Find the samples that see one node."""
        cdef int k, e, row, left, right, base
        cdef unsigned int seen
        cdef int v = self.scene.node_vertex[n]
        cdef double x = self.scene.vx[v]
        cdef double y = self.scene.vy[v]
        cdef int c0 = <int>ceil(x - self.window)
        cdef int c1 = <int>floor(x + self.window)
        cdef int r0 = <int>ceil(y - self.window)
        cdef int r1 = <int>floor(y + self.window)
        c0 = 0 if c0 < 0 else c0
        c1 = self.scene.width - 1 if c1 >= self.scene.width else c1
        r0 = self.row0 if r0 < self.row0 else r0
        r1 = self.row1 - 1 if r1 >= self.row1 else r1
        if c0 > c1 or r0 > r1:
            return 0
        seen = ALL >> (31 - (c1 - c0))
        for row in range(r1 - r0 + 1):
            self.alive[row] = seen
        if self.scene.node_low[n] != self.scene.node_high[n]:
            self.block(n, -1, c0, c1, r0, r1)
        self.now += 1
        left = self.scene.column_of(x if x < c0 else c0)
        right = self.scene.column_of(x if x > c1 else c1)
        for row in range(self.scene.row_of(y if y < r0 else r0), self.scene.row_of(y if y > r1 else r1) + 1):
            base = row * self.scene.gw
            for k in range(self.scene.cell_start[base + left], self.scene.cell_start[base + right + 1]):
                e = self.scene.cell_edge[k]
                if self.edge_stamp[e] == self.now:
                    continue
                self.edge_stamp[e] = self.now
                if self.scene.ea[e] != v and self.scene.eb[e] != v:
                    self.block(n, e, c0, c1, r0, r1)
            seen = 0
            for k in range(r1 - r0 + 1):
                seen |= self.alive[k]
            if seen == 0:
                return 0
        self.enter(n, c0, c1, r0, r1)

    cdef void block(self, int n, int e, int c0, int c1, int r0, int r1) noexcept nogil:
        """Strike out the samples that edge e hides from a node; if it is −1 those off the node's own wedge."""
        cdef Four px, value
        cdef float py
        cdef int j, i, k, a_left, a_right, b_left, b_right, far_side, near_side, hidden, unsure
        cdef int v = self.scene.node_vertex[n]
        cdef double x = self.scene.vx[v]
        cdef double y = self.scene.vy[v]
        cdef int a = self.scene.node_low[n] if e < 0 else self.scene.ea[e]
        cdef int b = self.scene.node_high[n] if e < 0 else self.scene.eb[e]
        cdef float ax = <float>(self.scene.vx[a] - x)
        cdef float ay = <float>(self.scene.vy[a] - y)
        cdef float bx = <float>(self.scene.vx[b] - x)
        cdef float by = <float>(self.scene.vy[b] - y)
        cdef float dx = <float>(self.scene.vx[b] - self.scene.vx[a])
        cdef float dy = <float>(self.scene.vy[b] - self.scene.vy[a])
        cdef float far = <float>1e-6 * (<float>self.window + 1)
        cdef Four of_a = broadcast_four(far * (fabsf(ax) + fabsf(ay)))
        cdef Four of_b = broadcast_four(far * (fabsf(bx) + fabsf(by)))
        cdef Four of_edge = broadcast_four(
            far * (fabsf(dx) + fabsf(dy)) + <float>1e-6 * (fabsf(dx * ay) + fabsf(dy * ax))
        )
        cdef int side = 0
        if e >= 0:
            side = orient(
                self.scene.vx[a], self.scene.vy[a], self.scene.vx[b], self.scene.vy[b], x, y
            )  # of the node
            if side == 0:
                return
        for j in range(c0, c1 + 1, 4):
            px = broadcast_four(<float>(j - x)) + load_four(RAMP)
            for i in range(r0, r1 + 1):
                if not self.alive[i - r0] >> (j - c0) & 15:
                    continue  # in a crowd most are struck out before most edges have been looked at
                py = <float>(i - y)
                value = broadcast_four(ax * py) - broadcast_four(ay) * px
                a_left = greater_four(value, of_a)
                a_right = greater_four(-value, of_a)
                value = broadcast_four(bx * py) - broadcast_four(by) * px
                b_left = greater_four(value, of_b)
                b_right = greater_four(-value, of_b)
                if e < 0:
                    hidden = (a_left & b_right) | (a_right & b_left)
                    unsure = ~((a_left | a_right) & (b_left | b_right))
                else:
                    value = broadcast_four(dx * (py - ay)) - broadcast_four(dy) * (px - broadcast_four(ax))
                    far_side = greater_four(-value if side > 0 else value, of_edge)
                    near_side = greater_four(value if side > 0 else -value, of_edge)
                    hidden = ((a_left & b_right) | (a_right & b_left)) & far_side
                    unsure = ~(hidden | near_side | (a_left & b_left) | (a_right & b_right))
                unsure &= self.alive[i - r0] >> (j - c0) & 15
                while unsure:
                    k = lowest(unsure)
                    unsure &= unsure - 1
                    if (not self.scene.bends_for(n, j + k, i)) if e < 0 else self.scene.meets(e, j + k, i, x, y, -1, v):
                        hidden |= 1 << k
                self.alive[i - r0] &= ~(<unsigned int>hidden << (j - c0))

    cdef int enter(self, int n, int c0, int c1, int r0, int r1) except -1 nogil:
        """Note a node for the samples left, those of them it is worth their while to."""
        cdef int i, j
        cdef double x, y, d
        cdef unsigned int left
        cdef Py_ssize_t s
        cdef int v = self.scene.node_vertex[n]
        for i in range(r0, r1 + 1):
            left = self.alive[i - r0]
            y = self.scene.vy[v] - i
            while left:
                j = c0 + lowest(left)
                left &= left - 1
                x = self.scene.vx[v] - j
                d = sqrt(x * x + y * y)
                if d >= self.reach or not worth(x, y, d, self.radius):
                    continue
                if self.used == self.size:
                    grow(<void**>&self.node, 2 * self.size, sizeof(int))
                    grow(<void**>&self.following, 2 * self.size, sizeof(int))
                    grow(<void**>&self.length, 2 * self.size, sizeof(double))
                    self.size *= 2
                s = <Py_ssize_t>(i - self.row0) * self.scene.width + j
                self.node[self.used] = n
                self.length[self.used] = d
                self.following[self.used] = self.head[s]
                self.head[s] = <int>self.used
                self.used += 1
