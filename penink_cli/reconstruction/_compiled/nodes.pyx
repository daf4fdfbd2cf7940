# cython: boundscheck=False, wraparound=False, cdivision=True
"""The path graph of a scene: its nodes, where a path can bend, and the arcs between them (section 2.2).

A *node* is a vertex v on the one side where a path can bend round it. Its sector is reflex: of π or more, with no edge
in it. It runs from the edge to `low` to the edge to `high`, in the direction that `orient` calls positive.

      high       low         x right, y down; turning positively is clockwise
          ╲     ╱
           ╲   ╱             a path bends round v like a thread round a nail:
            ╲ ╱              p ── v ── q
     p ╶╶╶╶╶╶╶v╶╶╶╶╶╶╶ q
        the sector of v      a taut leg has both edges on one side of its line, or on it

A shortest path is taut, so a leg may meet a node only where that holds of its line. This one test replaces "within the
sector" and leaves out nearly all bends of a smooth chain.
"""

from libc.math cimport sqrt
from libc.stdlib cimport free
from penink_cli.geometry._compiled.predicates cimport orient
from penink_cli.ground._compiled.memory cimport grow, room
from penink_cli.reconstruction._compiled.scene cimport BLOCK, Scene, doubles, ints


def find(Scene scene) -> None:
    """Fill in the nodes and the arcs of a scene whose edges are sorted into cells."""
    import numpy as np

    nodes = np.empty((3, 2 * scene.n_vertices), np.intc)
    scene.node_vertex = ints(nodes[0])
    scene.node_low = ints(nodes[1])
    scene.node_high = ints(nodes[2])
    star_start = np.zeros(scene.n_vertices + 1, np.intc)
    star = np.empty(2 * scene.n_edges, np.intc)
    scene.star_start = ints(star_start)
    scene.star = ints(star)
    find_nodes(scene)
    scene.node_across = (scene.gw >> BLOCK) + 1
    node_start = np.zeros(scene.node_across * ((scene.gh >> BLOCK) + 1) + 1, np.intc)
    node_sorted = np.empty(max(1, scene.n_nodes), np.intc)
    places = np.empty((2, max(1, scene.n_nodes)))
    scene.node_start = ints(node_start)
    scene.node_sorted = ints(node_sorted)
    scene.node_x = doubles(places[0])
    scene.node_y = doubles(places[1])
    bucket_nodes(scene)
    arc_start = np.zeros(scene.n_nodes + 1, np.intc)
    scene.arc_start = ints(arc_start)
    scene.arrays += [nodes, star_start, star, node_start, node_sorted, places, arc_start]
    with nogil:
        find_arcs(scene)


cdef double distance(double ax, double ay, double bx, double by) noexcept nogil:
    """Between two points."""
    return sqrt((ax - bx) * (ax - bx) + (ay - by) * (ay - by))


cdef void find_nodes(Scene scene):
    """The nodes: vertices strictly inside the frame with a sector of π or more between neighbouring edges.

    Seen from the first edge d at a vertex the others turn left, turn right or go straight on. The outermost to
    either side bound the sector, if there is one. A sector of exactly π carries paths along it, never a bend.
    """
    cdef int v, k, d, t, s, place, left, right, on
    cdef double x, y
    cdef int* first = scene.star_start
    cdef int* others = scene.star
    cdef int n = 0
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


cdef int add_node(Scene scene, int n, int v, int low, int high) noexcept:
    """Enter one node; how many there are then."""
    scene.node_vertex[n] = v
    scene.node_low[n] = low
    scene.node_high[n] = high
    return n + 1


cdef void bucket_nodes(Scene scene):
    """Sort the nodes into the blocks of cells they lie in."""
    cdef int n, k
    cdef int place = 0
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


cdef int home(Scene scene, int n) noexcept nogil:
    """The block a node lies in."""
    cdef int v = scene.node_vertex[n]
    return (scene.row_of(scene.vy[v]) >> BLOCK) * scene.node_across + (scene.column_of(scene.vx[v]) >> BLOCK)


cdef int find_arcs(Scene scene) except -1 nogil:
    """The arcs of the path graph: taut at both ends, unobstructed, no third vertex touched, at most `reach` long.

    Each pair of nodes is looked at once; then its arc is entered with both.
    """
    cdef int u, v, n, row, k, c0, c1
    cdef double x, y, d
    cdef int used = 0, size = 64
    cdef int* ends = NULL
    cdef double* lengths = NULL
    try:
        grow(<void**>&ends, 2 * size, sizeof(int))
        grow(<void**>&lengths, size, sizeof(double))
        for n in range(scene.n_nodes):
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
                    d = arc(scene, n, v) if v > n else -1.0
                    if d < 0.0:
                        continue
                    if used == size:
                        grow(<void**>&ends, 4 * size, sizeof(int))
                        grow(<void**>&lengths, 2 * size, sizeof(double))
                        size *= 2
                    ends[2 * used] = n
                    ends[2 * used + 1] = v
                    lengths[used] = d
                    used += 1
                    scene.arc_start[n] += 1
                    scene.arc_start[v] += 1
        scene.arc_to = <int*>room(2 * used, sizeof(int))
        scene.arc_length = <double*>room(2 * used, sizeof(double))
        c0 = 0
        for n in range(scene.n_nodes + 1):
            c0 += scene.arc_start[n]
            scene.arc_start[n] = c0
        for k in range(used - 1, -1, -1):  # from the end of each node's arcs down, so that their start is what is left
            for row in range(2):
                n = ends[2 * k + row]
                scene.arc_start[n] -= 1
                scene.arc_to[scene.arc_start[n]] = ends[2 * k + 1 - row]
                scene.arc_length[scene.arc_start[n]] = lengths[k]
    finally:
        free(ends)
        free(lengths)
    return 0


cdef double arc(Scene scene, int m, int n) noexcept nogil:
    """Length of the arc between two nodes, −1 where there is none."""
    cdef double d
    cdef int u = scene.node_vertex[m]
    cdef int v = scene.node_vertex[n]
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


cdef bint neighbours(Scene scene, int u, int v) noexcept nogil:
    """Whether an edge joins two vertices, by the one that has fewer."""
    cdef int i, t
    if scene.star_start[u + 1] - scene.star_start[u] > scene.star_start[v + 1] - scene.star_start[v]:
        t = u
        u = v
        v = t
    for i in range(scene.star_start[u], scene.star_start[u + 1]):
        if scene.star[i] == v:
            return True
    return False


cdef bint taut(Scene scene, int node, int u) noexcept nogil:
    """Whether a shortest path between vertices may run from this node towards the vertex u."""
    cdef int v = scene.node_vertex[node]
    cdef int a = scene.node_low[node]
    cdef int b = scene.node_high[node]
    if a == b or u == a or u == b:  # along an edge of its own: the commonest tie by far, and dear to decide exactly
        return True
    return (
        orient(scene.vx[v], scene.vy[v], scene.vx[a], scene.vy[a], scene.vx[u], scene.vy[u])
        * orient(scene.vx[v], scene.vy[v], scene.vx[b], scene.vy[b], scene.vx[u], scene.vy[u])
        >= 0
    )
