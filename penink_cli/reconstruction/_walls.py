# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Compiled: edges drawn into a grid of pixels, as walls between centres, distances, lists by cell and regions."""

import cython

COMPILED = cython.compiled

if cython.compiled:
    from cython.cimports.libc.math import ceil, floor, sqrt
else:
    from math import ceil, floor, sqrt

RIGHT = 1  # an edge passes between this pixel's centre and the next in the row
DOWN = 2  # … and the one below


def block(
    ax: cython.double[::1],
    ay: cython.double[::1],
    bx: cython.double[::1],
    by: cython.double[::1],
    walls: cython.uchar[:, ::1],
) -> None:
    """Mark the steps between neighbouring pixel centres that cross an edge.

    The edges (x, y in pixels of this image, pixel (i, j) centred on (j + ½, i + ½)) meet the
    lines through the centres; a centre on an edge stands for itself shifted by (ε, ε²).

    walls: (h, w) zeros, filled with RIGHT and DOWN.
    """
    height: cython.Py_ssize_t = walls.shape[0]
    width: cython.Py_ssize_t = walls.shape[1]
    e: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    x0: cython.double
    y0: cython.double
    x1: cython.double
    y1: cython.double
    at: cython.double
    with cython.nogil:
        for e in range(ax.shape[0]):
            x0 = ax[e] - 0.5
            y0 = ay[e] - 0.5
            x1 = bx[e] - 0.5
            y1 = by[e] - 0.5
            if y0 > y1:
                x0, y0, x1, y1 = x1, y1, x0, y0
            # rows i with y0 <= i < y1
            i = max(0, cython.cast(cython.Py_ssize_t, ceil(y0)))
            while i < height and i < y1:
                at = x0 + (i - y0) * ((x1 - x0) / (y1 - y0))
                j = cython.cast(cython.Py_ssize_t, ceil(at)) - 1
                if 0 <= j < width - 1:
                    walls[i, j] |= 1
                i += 1
            if x0 > x1:
                x0, y0, x1, y1 = x1, y1, x0, y0
            j = max(0, cython.cast(cython.Py_ssize_t, ceil(x0)))
            while j < width and j < x1:
                at = y0 + (j - x0) * ((y1 - y0) / (x1 - x0))
                i = cython.cast(cython.Py_ssize_t, ceil(at)) - 1
                if at == ceil(at) and y1 > y0:
                    i += 1
                if 0 <= i < height - 1:
                    walls[i, j] |= 2
                j += 1


def near(
    ax: cython.double[::1],
    ay: cython.double[::1],
    bx: cython.double[::1],
    by: cython.double[::1],
    margin: cython.double,
    distance: cython.float[:, ::1],
) -> None:
    """Lower `distance` (h, w) to the distance from pixel centres to edges, where it is at most margin."""
    height: cython.Py_ssize_t = distance.shape[0]
    width: cython.Py_ssize_t = distance.shape[1]
    e: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    x0: cython.double
    y0: cython.double
    dx: cython.double
    dy: cython.double
    px: cython.double
    py: cython.double
    length: cython.double
    along: cython.double
    left: cython.double
    right: cython.double
    slope: cython.double
    found: cython.double
    low: cython.double
    high: cython.double
    with cython.nogil:
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
            i = max(0, cython.cast(cython.Py_ssize_t, ceil(low)))
            while i < height and i <= high:
                # the part of the edge within margin of this row bounds the columns
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
                    j = max(0, cython.cast(cython.Py_ssize_t, ceil(left)))
                    while j < width and j <= right:
                        px = j - x0
                        py = i - y0
                        along = (px * dx + py * dy) / length
                        along = min(1.0, max(0.0, along))
                        px -= along * dx
                        py -= along * dy
                        found = sqrt(px * px + py * py)
                        if found <= margin and found < distance[i, j]:
                            distance[i, j] = found
                        j += 1
                i += 1


def bucket(
    ax: cython.double[::1],
    ay: cython.double[::1],
    bx: cython.double[::1],
    by: cython.double[::1],
    cell: cython.double,
    first: cython.int[:, ::1],
    items: cython.int[::1],
    fill: cython.bint,
) -> None:
    """Count (fill false), then list, the edges whose bounding box meets each square cell.

    first: (rows, columns) counts on the first call; then, as offsets of each cell's end, lowered to its start.
    """
    e: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    rows: cython.Py_ssize_t = first.shape[0]
    columns: cython.Py_ssize_t = first.shape[1]
    dx: cython.double
    dy: cython.double
    left: cython.double
    right: cython.double
    low: cython.double
    high: cython.double
    with cython.nogil:
        for e in range(ax.shape[0]):
            dx = bx[e] - ax[e]
            dy = by[e] - ay[e]
            i = max(0, cython.cast(cython.Py_ssize_t, floor(min(ay[e], by[e]) / cell)))
            while i < rows and i * cell <= max(ay[e], by[e]):
                low = 0.0
                high = 1.0
                if dy != 0:
                    left = (i * cell - ay[e]) / dy
                    right = ((i + 1) * cell - ay[e]) / dy
                    low = max(low, min(left, right))
                    high = min(high, max(left, right))
                left = ax[e] + low * dx
                right = ax[e] + high * dx
                if left > right:
                    left, right = right, left
                j = max(0, cython.cast(cython.Py_ssize_t, floor(left / cell - 1e-6)))
                while j < columns and j * cell <= right + 1e-6 * cell:
                    if fill:
                        first[i, j] -= 1
                        items[first[i, j]] = e
                    else:
                        first[i, j] += 1
                    j += 1
                i += 1


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _root(parent: cython.int[::1], k: cython.int) -> cython.int:
    while parent[k] != k:
        parent[k] = parent[parent[k]]
        k = parent[k]
    return k


def regions(walls: cython.uchar[:, ::1], parent: cython.int[::1]) -> None:
    """Join pixel centres between which a step crosses no edge; afterwards parent[k] is the region's first pixel.

    walls: (h, w) as of `block`. parent: (h · w,) filled.
    """
    height: cython.int = walls.shape[0]
    width: cython.int = walls.shape[1]
    i: cython.int
    j: cython.int
    k: cython.int
    a: cython.int
    b: cython.int
    with cython.nogil:
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
