# cython: boundscheck=False, wraparound=False, cdivision=True
"""Nearest neighbours among stroke ends: a tree of boxes over points sorted along a Morton curve.

A plain grid is a little faster on even drawings, but quadratic on clustered ones; the tree does not
depend on clusters. Points can be taken away, and a box that holds no more points is passed by.

A tree is four arrays: `sorted_points` (m, 2), in which points that are looked at together lie together;
`order` (m,), the end that each point is (stroke s has ends 2s and 2s + 1); `boxes` (2·leaves, 4), x0, y0,
x1, y1 of each node; `alive` (2·leaves,), how many points of each node are left. Node 1 is the root, the
children of i are 2i and 2i + 1, and node `leaves` + j holds the points LEAF·j … LEAF·j + LEAF − 1.
"""

LEAF = 8
cdef int _LEAF = LEAF


def build(const double[:, ::1] sorted_points, double[:, ::1] boxes, int[::1] alive) -> None:
    """Fill boxes and alive of a tree over the points."""
    cdef Py_ssize_t node, k
    cdef Py_ssize_t leaves = alive.shape[0] // 2
    cdef Py_ssize_t count = sorted_points.shape[0]
    with nogil:
        for node in range(2 * leaves):
            boxes[node, 0] = boxes[node, 1] = 1e300
            boxes[node, 2] = boxes[node, 3] = -1e300
            alive[node] = 0
        for k in range(count):
            node = leaves + k // _LEAF
            alive[node] += 1
            boxes[node, 0] = min(boxes[node, 0], sorted_points[k, 0])
            boxes[node, 1] = min(boxes[node, 1], sorted_points[k, 1])
            boxes[node, 2] = max(boxes[node, 2], sorted_points[k, 0])
            boxes[node, 3] = max(boxes[node, 3], sorted_points[k, 1])
        for node in range(leaves - 1, 0, -1):
            alive[node] = alive[2 * node] + alive[2 * node + 1]
            boxes[node, 0] = min(boxes[2 * node, 0], boxes[2 * node + 1, 0])
            boxes[node, 1] = min(boxes[2 * node, 1], boxes[2 * node + 1, 1])
            boxes[node, 2] = max(boxes[2 * node, 2], boxes[2 * node + 1, 2])
            boxes[node, 3] = max(boxes[2 * node, 3], boxes[2 * node + 1, 3])


cdef inline double _box_distance(double[:, ::1] boxes, Py_ssize_t node, double x, double y) noexcept nogil:
    """Squared distance from (x, y) to a node's box."""
    cdef double dx = max(boxes[node, 0] - x, x - boxes[node, 2])
    cdef double dy = max(boxes[node, 1] - y, y - boxes[node, 3])
    dx = max(dx, 0.0)
    dy = max(dy, 0.0)
    return dx * dx + dy * dy


cdef int _nearest(
    const double[:, ::1] sorted_points, const int[::1] order, double[:, ::1] boxes, int[::1] alive,
    unsigned char[::1] used, double x, double y, int most, int* found, double* distances, int but,
) noexcept nogil:
    """Find the `most` ends nearest to (x, y) of strokes that are not used, without those of stroke `but`.

    found, distances: room for `most` ends, nearest first, and the squares of their distances. Returns how many there
    are.
    """
    cdef Py_ssize_t[64] stack
    cdef double[64] bound
    cdef Py_ssize_t k, node, near, far
    cdef int point, slot
    cdef double dx, dy, d, near_d, far_d
    cdef Py_ssize_t leaves = alive.shape[0] // 2
    cdef int depth = 1, n = 0
    stack[0] = 1
    bound[0] = 0.0
    while depth > 0:
        depth -= 1
        node = stack[depth]
        if alive[node] == 0 or (n == most and bound[depth] >= distances[n - 1]):
            continue
        if node >= leaves:
            for k in range((node - leaves) * _LEAF, min((node - leaves + 1) * _LEAF, order.shape[0])):
                point = order[k]
                if used[point // 2] or point // 2 == but:
                    continue
                dx = sorted_points[k, 0] - x
                dy = sorted_points[k, 1] - y
                d = dx * dx + dy * dy
                if n < most:
                    slot = n
                    n += 1
                elif d < distances[n - 1]:
                    slot = n - 1
                else:
                    continue
                while slot > 0 and distances[slot - 1] > d:
                    distances[slot] = distances[slot - 1]
                    found[slot] = found[slot - 1]
                    slot -= 1
                distances[slot] = d
                found[slot] = point
        else:
            near = 2 * node
            far = near + 1
            near_d = _box_distance(boxes, near, x, y)
            far_d = _box_distance(boxes, far, x, y)
            if far_d < near_d:
                near, far = far, near
                near_d, far_d = far_d, near_d
            stack[depth] = far
            bound[depth] = far_d
            stack[depth + 1] = near
            bound[depth + 1] = near_d
            depth += 2
    return n


def greedy(
    const double[:, ::1] points, const double[:, ::1] sorted_points, const int[::1] order, const int[::1] place,
    double[:, ::1] boxes, int[::1] alive, double[::1] pen, int[::1] tour, unsigned char[::1] flips,
    unsigned char[::1] used,
) -> None:
    """Go from `pen` (x, y) always on to the nearest end of a stroke not yet used, and draw the stroke from there.

    points (2n, 2): start and end of each stroke. place (2n,): where each end stands in `order`, or -1. tour: filled
    with strokes, of which there must be so many left. flips (n,): set to 1 where a stroke is drawn from its end. used
    (n,): set for each stroke drawn. pen: where the pen is left.
    """
    cdef Py_ssize_t i, node
    cdef int end, stroke
    cdef Py_ssize_t leaves = alive.shape[0] // 2
    cdef int found = 0
    cdef double distance = 0.0
    with nogil:
        for i in range(tour.shape[0]):
            _nearest(
                sorted_points, order, boxes, alive, used, pen[0], pen[1], 1,
                &found, &distance, -1,
            )  # fmt: skip
            stroke = found // 2
            tour[i] = stroke
            flips[stroke] = found & 1
            used[stroke] = 1
            for end in range(2 * stroke, 2 * stroke + 2):
                if place[end] < 0:
                    continue
                node = leaves + place[end] // _LEAF
                while node > 0:
                    alive[node] -= 1
                    node //= 2
            end = found ^ 1
            pen[0] = points[end, 0]
            pen[1] = points[end, 1]


def greedy_few(
    const double[:, ::1] points, const int[::1] order, const long long[::1] first, const long long[::1] begins,
    int[::1] tour, unsigned char[::1] flips, unsigned char[::1] used,
) -> None:
    """As `greedy`, for many groups of few strokes: each group begins at the corner (0, 0), and there is no tree.

    points (2n, 2): ends of all groups. order: ends, group after group; those of group g are order[first[g]] …
    order[first[g + 1] - 1], and its strokes fill tour[begins[g]] … tour[begins[g + 1] - 1].
    """
    cdef Py_ssize_t g, i, k
    cdef double x, y, dx, dy, d, nearest
    cdef int found
    with nogil:
        for g in range(begins.shape[0] - 1):
            x = y = 0.0
            for i in range(begins[g], begins[g + 1]):
                nearest = 1e300
                found = -1
                for k in range(first[g], first[g + 1]):
                    if used[order[k] // 2]:
                        continue
                    dx = points[order[k], 0] - x
                    dy = points[order[k], 1] - y
                    d = dx * dx + dy * dy
                    if found < 0 or d < nearest:
                        nearest = d
                        found = order[k]
                tour[i] = found // 2
                flips[found // 2] = found & 1
                used[found // 2] = 1
                x = points[found ^ 1, 0]
                y = points[found ^ 1, 1]


def neighbours(
    const double[:, ::1] sorted_points, const int[::1] order, double[:, ::1] boxes, int[::1] alive,
    unsigned char[::1] used, int[:, ::1] near,
) -> None:
    """For each end the nearest ends of other strokes, nearest first, into near (2n, k); -1 where there are fewer."""
    cdef double[32] distances
    cdef Py_ssize_t i
    cdef int k, n, end
    cdef int most = <int>near.shape[1]
    if most > 32:
        raise ValueError("at most 32 neighbours")
    with nogil:
        for i in range(order.shape[0]):  # along the Morton curve, so that the nodes looked at are still in the cache
            end = order[i]
            n = _nearest(
                sorted_points, order, boxes, alive, used, sorted_points[i, 0], sorted_points[i, 1], most,
                &near[end, 0], &distances[0], end // 2,
            )  # fmt: skip
            for k in range(n, most):
                near[end, k] = -1
