# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: edges followed as a pen would, straight on at junctions. Only `trails` imports this module.

        c                 Coming from a, a trail goes on to d, the straightest way; c is left for another trail. Where
        |                 but two edges meet, a trail goes on whatever the bend.
    a --+---- d
"""

from libc.math cimport fabs
from libc.stdlib cimport free
from penink_cli.ground._compiled.memory cimport room


cdef struct Graph:
    const double* at  # two a vertex
    long long* first  # vertex v has the places first[v] … first[v + 1] - 1 in the two lists that follow
    int* other  # the vertex at the other end of each of its edges
    int* edge  # that edge
    unsigned char* used  # of each edge, whether a trail has it already
    double limit  # the least straightness for which a trail goes on


def follow(
    const double[:, ::1] points, const int[:, ::1] ends, const long long[::1] starts, const long long[::1] order,
    double limit, int[::1] vertices, int[::1] edges, int[::1] count,
) -> int:
    """Fill in the vertices and edges of all trails, one after another, and the number of edges of each.

    points: (n, 2). ends: (m, 2). starts: (n,) vertices in the order in which trails may begin at them. order: (m,)
    edges in the order in which equals are taken. limit: the square of the least cosine of a bend, with the cosine's
    sign. vertices: (2 m,), edges: (m,), count: (m,) room for the result. Returns the number of trails.
    """
    cdef Py_ssize_t n = points.shape[0], m = ends.shape[0], i, k
    cdef int a, b, here, way, rings, trails = 0, taken = 0, left, begin
    cdef double came_x, came_y
    cdef Graph graph
    graph.first = NULL
    graph.other = graph.edge = NULL
    graph.used = NULL
    try:
        graph.first = <long long*>room(n + 2, sizeof(long long))
        graph.other = <int*>room(2 * m, sizeof(int))
        graph.edge = <int*>room(2 * m, sizeof(int))
        graph.used = <unsigned char*>room(m, 1)
        if m == 0:
            return 0
        graph.at = &points[0, 0]
        graph.limit = limit
        with nogil:
            for i in range(n + 2):
                graph.first[i] = 0
            for i in range(m):
                graph.used[i] = 0
                for k in range(2):
                    graph.first[ends[i, k] + 2] += 1
            for i in range(2, n + 2):
                graph.first[i] += graph.first[i - 1]
            for i in range(m):  # first[v + 1] is the next free place of vertex v, and the end of its places at last
                for k in range(2):
                    a, b = ends[order[i], k], ends[order[i], 1 - k]
                    graph.other[graph.first[a + 1]] = b
                    graph.edge[graph.first[a + 1]] = <int>order[i]
                    graph.first[a + 1] += 1
            for rings in range(2):
                for i in range(n):
                    while True:
                        here = <int>starts[i]
                        left = 0
                        for k in range(graph.first[here], graph.first[here + 1]):
                            left += not graph.used[graph.edge[k]]
                        if left == 0 or not (rings or left & 1):
                            break
                        begin = taken
                        vertices[taken + trails] = here
                        way = onward(&graph, here, -1, 0.0, 0.0)
                        while way >= 0:
                            graph.used[graph.edge[way]] = 1
                            edges[taken] = graph.edge[way]
                            taken += 1
                            came_x = points[graph.other[way], 0] - points[here, 0]
                            came_y = points[graph.other[way], 1] - points[here, 1]
                            here = graph.other[way]
                            vertices[taken + trails] = here
                            way = onward(&graph, here, way, came_x, came_y)
                        count[trails] = taken - begin
                        trails += 1
        return trails
    finally:
        free(graph.first)
        free(graph.other)
        free(graph.edge)
        free(graph.used)


cdef int onward(const Graph* graph, int here, int came, double came_x, double came_y) noexcept nogil:
    """The place in the lists of the edge along which a trail goes on from vertex `here`, -1 where the trail ends.

    came: negative at the start of a trail. came_x, came_y: the edge by which it has come.
    """
    cdef long long k, begin = graph.first[here], end = graph.first[here + 1]
    cdef int best = -1
    cdef double dx, dy, along, straight, straightest = 0.0, length = came_x * came_x + came_y * came_y
    for k in range(begin, end):
        if graph.used[graph.edge[k]]:
            continue
        if came < 0 or end - begin == 2:
            return <int>k
        dx = graph.at[2 * graph.other[k]] - graph.at[2 * here]
        dy = graph.at[2 * graph.other[k] + 1] - graph.at[2 * here + 1]
        along = dx * came_x + dy * came_y
        straight = along * fabs(along) / ((dx * dx + dy * dy) * length)
        if best < 0 or straight > straightest:
            best, straightest = <int>k, straight
    return best if best >= 0 and straightest >= graph.limit else -1
