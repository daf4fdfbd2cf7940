# cython: boundscheck=False, wraparound=False, cdivision=True
"""Which neighbours of a sample lie behind an edge, for the prediction of samples in an archive.

Coordinates are whole numbers, 16 to the sample spacing: the sample in row i and column j lies at (16 j + 8, 16 i + 8).
A sample on an edge, or in line with an edge's end, counts as shifted by (ε, ε²): the tie rule of `predicates.pyx`.
"""

# west, north, north-west, north-east, two to the west, two to the north
cdef int[6] RIGHTWARD = [-1, 0, -1, 1, -2, 0]
cdef int[6] DOWNWARD = [0, -1, -1, -1, 0, -2]


cdef inline long long floor_16(long long value) noexcept nogil:
    """The whole number of spacings up to a coordinate."""
    return value >> 4


cdef inline bint left_of_edge(
    long long ax, long long ay, long long bx, long long by, long long x, long long y
) noexcept nogil:
    """Whether the sample at x, y is to the left of the edge a → b."""
    cdef long long turn = (bx - ax) * (y - ay) - (by - ay) * (x - ax)
    if turn == 0:
        turn = ay - by
        if turn == 0:
            turn = bx - ax
    return turn > 0


cdef inline bint left_of_view(
    long long px, long long py, long long qx, long long qy, long long x, long long y
) noexcept nogil:
    """Whether the vertex at x, y is to the left of the view from one sample to another, p → q."""
    cdef long long turn = (qx - px) * (y - py) - (qy - py) * (x - px)
    if turn == 0:
        turn = qy - py
        if turn == 0:
            turn = px - qx
    return turn > 0


def mark(long long[:, ::1] ends, unsigned char[:, ::1] cuts) -> None:
    """Mark, a bit each, which of six neighbours cannot be seen from a sample.

    ends: (m, 4) x, y, x, y of edges, 16 to the spacing. cuts: (h, w) zeros, filled with bits 1 west, 2 north,
    4 north-west, 8 north-east, 16 two to the west, 32 two to the north. Time grows with the cells that edges pass.
    """
    cdef Py_ssize_t e, i, j, k, first, last, row_end, column_end
    cdef long long ax, ay, bx, by, low, high, left, right, x, y, qx, qy, span, one, two
    cdef Py_ssize_t h = cuts.shape[0]
    cdef Py_ssize_t w = cuts.shape[1]
    with nogil:
        for e in range(ends.shape[0]):
            ax, ay, bx, by = ends[e, 0], ends[e, 1], ends[e, 2], ends[e, 3]
            if ay > by:
                ax, ay, bx, by = bx, by, ax, ay
            span = by - ay
            row_end = min(h - 1, floor_16(by - 8) + 3)
            for i in range(max(0, floor_16(ay - 8)), row_end + 1):
                # the edge between two rows above this one and a little below it
                low = max(ay, 16 * (i - 2) + 7)
                high = min(by, 16 * i + 9)
                if low > high:
                    continue
                if span == 0:
                    left, right = min(ax, bx), max(ax, bx)
                else:
                    one = ax + (bx - ax) * (low - ay) / span
                    two = ax + (bx - ax) * (high - ay) / span
                    left, right = min(one, two) - 2, max(one, two) + 2
                first = max(0, floor_16(left - 8) - 1)
                last = floor_16(right - 8) + 3
                column_end = min(w - 1, last)
                for j in range(first, column_end + 1):
                    x = 16 * j + 8
                    y = 16 * i + 8
                    for k in range(6):
                        if i + DOWNWARD[k] < 0 or j + RIGHTWARD[k] < 0 or j + RIGHTWARD[k] >= w:
                            continue
                        if cuts[i, j] & (1 << k):
                            continue
                        qx = x + 16 * RIGHTWARD[k]
                        qy = y + 16 * DOWNWARD[k]
                        if left_of_edge(ax, ay, bx, by, x, y) == left_of_edge(ax, ay, bx, by, qx, qy):
                            continue
                        if left_of_view(x, y, qx, qy, ax, ay) != left_of_view(x, y, qx, qy, bx, by):
                            cuts[i, j] |= <unsigned char>(1 << k)
