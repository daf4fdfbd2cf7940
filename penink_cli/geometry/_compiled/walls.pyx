# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: edges drawn into a grid of pixels, as walls between centres, distances and regions."""

from libc.math cimport ceil, sqrt

RIGHT = 1  # an edge passes between this pixel's centre and the next in the row
DOWN = 2  # … and the one below


def block(double[::1] ax, double[::1] ay, double[::1] bx, double[::1] by, unsigned char[:, ::1] walls) -> None:
    """Mark the steps between neighbouring pixel centres that cross an edge.

    The edges (x, y in pixels of this image, pixel (i, j) centred on (j + ½, i + ½)) meet the
    lines through the centres; a centre on an edge stands for itself shifted by (ε, ε²).

    walls: (h, w) zeros, filled with RIGHT and DOWN.
    """
    cdef Py_ssize_t e, i, j
    cdef double x0, y0, x1, y1, at
    cdef Py_ssize_t height = walls.shape[0]
    cdef Py_ssize_t width = walls.shape[1]
    with nogil:
        for e in range(ax.shape[0]):
            x0 = ax[e] - 0.5
            y0 = ay[e] - 0.5
            x1 = bx[e] - 0.5
            y1 = by[e] - 0.5
            if y0 > y1:
                x0, y0, x1, y1 = x1, y1, x0, y0
            # rows i with y0 <= i < y1
            i = max(0, <Py_ssize_t>ceil(y0))
            while i < height and i < y1:
                at = x0 + (i - y0) * ((x1 - x0) / (y1 - y0))
                j = <Py_ssize_t>ceil(at) - 1
                if 0 <= j < width - 1:
                    walls[i, j] |= 1
                i += 1
            if x0 > x1:
                x0, y0, x1, y1 = x1, y1, x0, y0
            j = max(0, <Py_ssize_t>ceil(x0))
            while j < width and j < x1:
                at = y0 + (j - x0) * ((y1 - y0) / (x1 - x0))
                i = <Py_ssize_t>ceil(at) - 1
                if at == ceil(at) and y1 > y0:
                    i += 1
                if 0 <= i < height - 1:
                    walls[i, j] |= 2
                j += 1


def near(
    double[::1] ax, double[::1] ay, double[::1] bx, double[::1] by, double margin, float[:, ::1] distance,
    int[:, ::1] nearest=None,
) -> None:
    """Lower `distance` (h, w) to that from each pixel's centre to the nearest edge, where it is at most margin.

    ax, ay, bx, by: (m,) ends of the edges, and margin, in pixels. nearest: (h, w) the nearest edge's number, set where
    the distance is lowered; or None.
    """
    cdef bint told = nearest is not None
    cdef Py_ssize_t e, i, j
    cdef double x0, y0, dx, dy, px, py, length, along, left, right, slope, found, low, high
    cdef Py_ssize_t height = distance.shape[0]
    cdef Py_ssize_t width = distance.shape[1]
    with nogil:
        for e in range(ax.shape[0]):
            x0 = ax[e] - 0.5
            y0 = ay[e] - 0.5
            dx = bx[e] - ax[e]
            dy = by[e] - ay[e]
            length = dx * dx + dy * dy
            if length == 0:
                continue
            low = min(y0, y0 + dy) - margin
            high = max(y0, y0 + dy) + margin
            i = max(0, <Py_ssize_t>ceil(low))
            while i < height and i <= high:
                # the part of the edge within margin of this row bounds the columns that can be near
                left = 0.0
                right = 1.0
                if dy != 0:
                    left = (i - margin - y0) / dy
                    right = (i + margin - y0) / dy
                    if left > right:
                        left, right = right, left
                    left = max(0.0, left)
                    right = min(1.0, right)
                if left <= right:
                    slope = x0 + left * dx
                    right = x0 + right * dx
                    left = min(slope, right) - margin
                    right = max(slope, right) + margin
                    j = max(0, <Py_ssize_t>ceil(left))
                    while j < width and j <= right:
                        px = j - x0
                        py = i - y0
                        along = (px * dx + py * dy) / length
                        along = min(1.0, max(0.0, along))
                        px -= along * dx
                        py -= along * dy
                        found = sqrt(px * px + py * py)
                        if found <= margin and found < distance[i, j]:
                            distance[i, j] = <float>found
                            if told:
                                nearest[i, j] = <int>e
                        j += 1
                i += 1


cdef inline int _root(int[::1] parent, int k) noexcept nogil:
    while parent[k] != k:
        parent[k] = parent[parent[k]]
        k = parent[k]
    return k


def regions(unsigned char[:, ::1] walls, int[::1] parent) -> None:
    """Join pixels between whose centres a step crosses no edge.

    walls: (h, w) as of `block`. parent: (h · w,), filled with the first pixel of each pixel's region.
    """
    cdef int i, j, k, a, b
    cdef int height = walls.shape[0]
    cdef int width = walls.shape[1]
    with nogil:
        for k in range(height * width):
            parent[k] = k
        for i in range(height):
            for j in range(width):
                k = i * width + j
                if j + 1 < width and not walls[i, j] & 1:
                    a = _root(parent, k)
                    b = _root(parent, k + 1)
                    parent[max(a, b)] = min(a, b)
                if i + 1 < height and not walls[i, j] & 2:
                    a = _root(parent, k)
                    b = _root(parent, k + width)
                    parent[max(a, b)] = min(a, b)
        for k in range(height * width):
            parent[k] = parent[parent[k]]
