# cython: boundscheck=False, wraparound=False, cdivision=True
"""Shortest unobstructed paths by a bounded Dijkstra over the path graph, and equation 4 at single points.

            ╱ q        Double lines are edges; u and w are nodes at their ends (see `nodes`).
    ══════ w           1. `first_bends`: the nodes that the query p sees, here u, with their distances.
          ╱            2. `spread`: Dijkstra from those over the arcs between nodes, here to w, within a reach.
         u ══════      3. `last_leg`: of the nodes reached and seen from the query q, the one that makes the whole way
        ╱                 shortest.
       p

The detour is the length of p–u–w–q less the distance of q from p. All lengths are in sample spacings. From a sample
the first bends are remembered, as many pixels ask for them (`bends_of`).
"""

from libc.math cimport fabs, sqrt
from libc.stdlib cimport free
from penink_cli.ground._compiled.memory cimport grow, room
from penink_cli.reconstruction._compiled.scene cimport BLOCK, Scene
from penink_cli.reconstruction._compiled.views cimport Views, worth

cdef double INFINITY = float("inf")
cdef double WIDEST = 15.0  # the widest window of `Views`
cdef int MANY = 64  # samples in a block from which on bends are not remembered for each of them


cdef class Finder:
    """Shortest paths in one scene for one thread, with the bends next to each sample remembered.

    row0, row1: the rows of samples to remember bends for. closed: remember for each sample every node that can be the
    last bend on a path of length `reach` from it, else only those it sees. looks: the `views` say which these are.
    start, count: (rows · width,) of each sample, where its bends begin in the pool, and how many there are; a count
    of −1 says that nobody has asked yet. pool_node, pool_length: (pool_size,) the bends, nearest first, and the length
    of the path to each.
    distance, stamp: (nodes,) of the search at hand the length of the path to each node, where the stamp is `now`.
    heap_node, heap_key: (heap_size,) the nodes to be looked at, as a binary heap by the length of the path.
    done: (nodes,) the n_done nodes that were reached, nearest first. from_x, from_y: where the search began.
    alpha: (alpha_size,) what `attenuate` fills in.
    """

    def __init__(self, Scene scene, int row0, int row1, double reach, bint closed):
        self.scene = scene
        self.reach = reach
        self.closed = closed
        self.radius = reach - 2.0 * sqrt(2.0)
        self.views = Views(scene, reach, self.radius)
        # In a crowd there are more edges near a node than on the way to it.
        self.looks = closed and scene.n_crowded == 0 and self.views.window <= WIDEST
        cdef Py_ssize_t k
        self.distance = <double*>room(max(1, scene.n_nodes), sizeof(double))
        self.stamp = <int*>room(max(1, scene.n_nodes), sizeof(int))
        self.done = <int*>room(max(1, scene.n_nodes), sizeof(int))
        for k in range(scene.n_nodes):
            self.stamp[k] = -1
        self.pool_size = 1024
        self.pool_node = <int*>room(self.pool_size, sizeof(int))
        self.pool_length = <double*>room(self.pool_size, sizeof(double))
        self.heap_size = 256
        self.heap_node = <int*>room(self.heap_size, sizeof(int))
        self.heap_key = <double*>room(self.heap_size, sizeof(double))
        self.alpha_size = 64
        self.alpha = <double*>room(self.alpha_size, sizeof(double))
        self.move(row0, row1)

    def move(self, int row0, int row1):
        """Remember bends for these rows of samples, and forget those of others."""
        cdef Py_ssize_t k
        cdef Py_ssize_t n = <Py_ssize_t>(row1 - row0) * self.scene.width
        self.row0 = row0
        self.row1 = row1
        if n > self.room:
            grow(<void**>&self.start, n, sizeof(int))
            grow(<void**>&self.count, n, sizeof(int))
            self.room = n
        for k in range(n):
            self.count[k] = -1
        self.pool_used = 0
        if self.looks:
            with nogil:
                self.views.look(row0, row1)

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

    cdef int push(self, int node, double key) except -1 nogil:
        """Note a path of that length to a node, if none as short is known."""
        cdef int i, up
        if self.stamp[node] == self.now and self.distance[node] <= key:
            return 0
        self.stamp[node] = self.now
        self.distance[node] = key
        if self.heap_used == self.heap_size:
            grow(<void**>&self.heap_node, 2 * self.heap_size, sizeof(int))
            grow(<void**>&self.heap_key, 2 * self.heap_size, sizeof(double))
            self.heap_size *= 2
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

    cdef int first_bends(self, double qx, double qy, double reach) except -1 nogil:
        """Start a search: note the nodes that the query q sees, within reach."""
        cdef int row, k, n
        cdef double x, y, d
        cdef double window = self.views.window if self.closed else reach
        cdef int across = self.scene.node_across
        cdef int c0 = self.scene.column_of(qx - window) >> BLOCK
        cdef int c1 = (self.scene.column_of(qx + window) >> BLOCK) + 1
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
                if d >= reach or (self.closed and not worth(x, y, d, self.radius)):
                    continue
                n = self.scene.node_sorted[k]
                if self.scene.bends_for(n, qx, qy) and self.scene.sees_vertex(qx, qy, self.scene.node_vertex[n]):
                    self.push(n, d)

    cdef int spread(self, double reach) except -1 nogil:
        """Dijkstra from the noted nodes as far as `reach`; `done` lists the nodes reached, nearest first."""
        cdef int n, node, i, down, k
        cdef double key, last
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
                if not self.closed or worth(
                    self.scene.vx[i] - self.from_x, self.scene.vy[i] - self.from_y, last, self.radius
                ):
                    self.push(n, last)

    cdef int bends_of(self, int i, int j) except -1 nogil:
        """Where the pool keeps the bends of sample (row i, column j), nearest first; `count` says how many."""
        cdef int k
        cdef Py_ssize_t s = <Py_ssize_t>(i - self.row0) * self.scene.width + j
        if self.count[s] >= 0:
            return self.start[s]
        if self.looks:
            self.now += 1
            self.heap_used = 0
            self.from_x = j
            self.from_y = i
            k = self.views.head[s]
            while k >= 0:
                self.push(self.views.node[k], self.views.length[k])
                k = self.views.following[k]
        else:
            self.first_bends(j, i, self.reach)
        if self.closed:
            self.spread(self.reach)
        else:  # the heap itself is the answer
            self.n_done = 0
            for k in range(self.heap_used):
                self.done[self.n_done] = self.heap_node[k]
                self.n_done += 1
        while self.pool_used + self.n_done > self.pool_size:
            grow(<void**>&self.pool_node, 2 * self.pool_size, sizeof(int))
            grow(<void**>&self.pool_length, 2 * self.pool_size, sizeof(double))
            self.pool_size *= 2
        self.start[s] = <int>self.pool_used
        self.count[s] = self.n_done
        for k in range(self.n_done):
            self.pool_node[self.pool_used] = self.done[k]
            self.pool_length[self.pool_used] = self.distance[self.done[k]]
            self.pool_used += 1
        return self.start[s]

    cdef bint attenuate(self, double px, double py, int i0, int i1, int j0, int j1, double r) except -1 nogil:
        """Equation 4 for the query p and the block of samples of rows i0 … i1, columns j0 … j1, into `alpha`.

        False, and nothing filled, where no edge is between: all are one. This finder must remember seen nodes only.
        """
        cdef int i, j, m, at, node
        cdef Py_ssize_t s
        cdef double t, d, best
        cdef int k = 0
        cdef int n = (i1 - i0 + 1) * (j1 - j0 + 1)
        cdef bint remember = n <= MANY
        cdef double farthest = 0.0
        if self.scene.clear(px if px < j0 else j0, py if py < i0 else i0, px if px > j1 else j1, py if py > i1 else i1):
            return False
        if n > self.alpha_size:
            grow(<void**>&self.alpha, n, sizeof(double))
            self.alpha_size = n
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
        # A block of many samples is one of few pixels: then finding all bends next to each sample first is dear.
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
                        s = <Py_ssize_t>(i - self.row0) * self.scene.width + j
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

    cdef double last_leg(self, double qx, double qy, double limit) noexcept nogil:
        """Length of the shortest path below the limit from where `spread` began, round a bend, to the query q."""
        cdef int k, n, v
        cdef double x, y, left
        cdef double best = INFINITY
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

    cdef double length(self, double px, double py, double qx, double qy, double limit) except -1 nogil:
        """Length of the shortest unobstructed path between two queries, infinite beyond the limit."""
        cdef double d = sqrt((px - qx) * (px - qx) + (py - qy) * (py - qy))
        if d > limit:
            return INFINITY
        if self.scene.n_edges == 0 or self.scene.sees(px, py, qx, qy):
            return d
        self.first_bends(px, py, limit)
        self.spread(limit)
        return self.last_leg(qx, qy, limit)


def path_lengths(
    Finder finder, double[:, ::1] p, double[:, ::1] q, double limit, Py_ssize_t begin, Py_ssize_t end, double[::1] out
) -> None:
    """Shortest path lengths for the pairs begin … end, infinite beyond the limit."""
    cdef Py_ssize_t k
    with nogil:
        for k in range(begin, end):
            out[k] = finder.length(p[k, 0], p[k, 1], q[k, 0], q[k, 1], limit)
