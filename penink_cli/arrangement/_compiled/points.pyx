# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: sub-pixel edge points and their links to neighbours. See gradient.py and chains.py.

    dark     bright       The grey changes fastest on the edge ┊. On the axis nearer to the gradient g, here x, the
       ┊                  slopes of a pixel b and of its neighbours a and c are read along g. A parabola through their
    a  ┊b     c  → g      logarithms has its vertex at ×: that is the edge point. Forward along the edge is where the
       ×                  dark side lies to the right on the screen, here downwards. The next point that way is
       ┊                  `following`, the one behind `preceding`.
       ↓ forward
"""

from libc.math cimport fabs, sqrt, sqrtf
from penink_cli.ground._compiled.real cimport logarithm


cdef inline double _along_x(float[:, ::1] smooth, int i, int j) noexcept nogil:
    return 0.5 * (smooth[i, j + 1] - smooth[i, j - 1])


cdef inline double _along_y(float[:, ::1] smooth, int i, int j) noexcept nogil:
    return 0.5 * (smooth[i + 1, j] - smooth[i - 1, j])


def steepness(float[:, ::1] smooth, float[:, ::1] out) -> None:
    """Length (h, w) of the gradient, grey per pixel; 0 on the border."""
    cdef Py_ssize_t i, j
    cdef float dx, dy
    with nogil:
        for i in range(1, smooth.shape[0] - 1):
            for j in range(1, smooth.shape[1] - 1):
                dx = smooth[i, j + 1] - smooth[i, j - 1]
                dy = smooth[i + 1, j] - smooth[i - 1, j]
                out[i, j] = 0.5 * sqrtf(dx * dx + dy * dy)


def surround(float[:, ::1] steep, int[:, ::1] pixel, double[:, ::1] values, int reach) -> None:
    """Mean steepness around each point, what is steeper than the point counted as equal.

    Every other row and column of the window is looked at. values: as of `locate`, column 5 is filled.
    """
    cdef Py_ssize_t k, i, j
    cdef int count
    cdef float own, total
    with nogil:
        for k in range(pixel.shape[0]):
            own = sqrtf(values[k, 2] * values[k, 2] + values[k, 3] * values[k, 3])
            total = 0
            count = 0
            for i in range(max(0, pixel[k, 0] - reach), min(steep.shape[0], pixel[k, 0] + reach + 1), 2):
                for j in range(max(0, pixel[k, 1] - reach), min(steep.shape[1], pixel[k, 1] + reach + 1), 2):
                    total += min(own, steep[i, j])
                    count += 1
            values[k, 5] = total / count


def locate(float[:, ::1] smooth, int[:, ::1] pixel, double[:, ::1] out) -> None:
    """Place each edge pixel's point on the ridge of the gradient.

    Along the axis nearer to the gradient, the slope of three neighbouring pixels in the
    gradient's direction is taken for a Gaussian, which it is for a blurred step. A parabola through
    the logarithms has its vertex on the edge, and its curvature tells the edge's width. A parabola
    through the slopes themselves pulls the point to the pixel's centre by up to 0.05.

    pixel: (n, 2) int32, moved to the pixel that the point was taken from.
    out: (n, 5) x, y, gradient along x and y, width; a width of -1 drops the point.
    """
    cdef Py_ssize_t k
    cdef int step, i, j, di, dj
    cdef double gx, gy, magnitude, nx, ny, a, b, c, bend, offset, cosine
    cdef Py_ssize_t n = pixel.shape[0]
    cdef int height = smooth.shape[0]
    cdef int width = smooth.shape[1]
    with nogil:
        for k in range(n):
            i = pixel[k, 0]
            j = pixel[k, 1]
            out[k, 4] = -1
            for step in range(2):  # a second look where the ridge lies nearer to the next pixel
                if i < 1 or j < 1 or i > height - 2 or j > width - 2:
                    break
                gx = _along_x(smooth, i, j)
                gy = _along_y(smooth, i, j)
                magnitude = sqrt(gx * gx + gy * gy)
                if magnitude <= 0:
                    break
                nx = gx / magnitude
                ny = gy / magnitude
                di = 0 if fabs(gx) >= fabs(gy) else 1
                dj = 1 - di
                cosine = fabs(nx) if dj else fabs(ny)
                offset = 0.0
                out[k, 4] = 0
                if di <= i - 1 and i + 1 + di <= height - 1 and dj <= j - 1 and j + 1 + dj <= width - 1:
                    a = nx * _along_x(smooth, i - di, j - dj) + ny * _along_y(smooth, i - di, j - dj)
                    c = nx * _along_x(smooth, i + di, j + dj) + ny * _along_y(smooth, i + di, j + dj)
                    b = magnitude
                    if a > 0.05 * b and c > 0.05 * b:
                        a = logarithm(a / b)
                        c = logarithm(c / b)
                        bend = -(a + c)
                        if bend > 1e-3:
                            offset = (c - a) / (2 * bend)
                            out[k, 4] = cosine / sqrt(bend)
                    else:  # a neighbour falls the other way: a line or a corner, too sharp for a Gaussian
                        bend = 2 * b - a - c
                        offset = (c - a) / (2 * bend) if bend > 0 else 0.0
                if fabs(offset) > 0.75 and step == 0:
                    i += di if offset > 0 else -di
                    j += dj if offset > 0 else -dj
                    continue
                offset = min(1.0, max(-1.0, offset))
                pixel[k, 0] = i
                pixel[k, 1] = j
                out[k, 0] = j + 0.5 + offset * dj
                out[k, 1] = i + 0.5 + offset * di
                out[k, 2] = gx
                out[k, 3] = gy
                break


def thin(
    int[:, ::1] pixel, double[:, ::1] position, int[:, ::1] index, unsigned char[::1] keep, double spacing
) -> None:
    """Of two points closer than spacing (at most one pixel) keep the one nearer to its own pixel's centre.

    Where an edge runs diagonally two pixels may name the same place on the ridge, and a link
    between them would point anywhere. keep: (n,) ones, cleared for points that go; index: (h, w)
    a point of each pixel or -1, cleared likewise.
    """
    cdef int k, other, i, j
    cdef double dx, dy
    cdef Py_ssize_t n = pixel.shape[0]
    with nogil:
        for k in range(n):
            for i in range(max(0, pixel[k, 0] - 2), min(index.shape[0], pixel[k, 0] + 3)):
                for j in range(max(0, pixel[k, 1] - 2), min(index.shape[1], pixel[k, 1] + 3)):
                    other = index[i, j]
                    if other < 0 or other == k or not keep[k]:
                        continue
                    dx = position[other, 0] - position[k, 0]
                    dy = position[other, 1] - position[k, 1]
                    if dx * dx + dy * dy >= spacing * spacing:
                        continue
                    dx = fabs(position[k, 0] - pixel[k, 1] - 0.5) + fabs(position[k, 1] - pixel[k, 0] - 0.5)
                    dy = fabs(position[other, 0] - j - 0.5) + fabs(position[other, 1] - i - 0.5)
                    if dx < dy or (dx == dy and k < other):
                        keep[other] = 0
                        index[i, j] = -1
                    else:
                        keep[k] = 0
                        index[pixel[k, 0], pixel[k, 1]] = -1


def link(
    int[:, ::1] pixel, double[:, ::1] position, double[:, ::1] gradient, int[:, ::1] index, int[::1] following,
    int[::1] preceding,
) -> None:
    """Give each point its nearest fellow forward and backward along the edge (forward: dark side on the right).

    Two points may be linked if their gradients agree within 90 degrees and each lies ahead of
    the other's normal. Each chooses the nearest in the 5 × 5 pixels around (Devernay 1995). Only
    what both choose is a link, so each point has at most one of each kind.

    index: (h, w) -1, or the point of that pixel. following, preceding: (n,) filled, -1 for none.
    """
    cdef Py_ssize_t k
    cdef int other, i, j, forward, backward
    cdef double ahead, other_ahead, dx, dy, distance, best_forward, best_backward
    cdef Py_ssize_t n = pixel.shape[0]
    cdef int height = index.shape[0]
    cdef int width = index.shape[1]
    with nogil:
        for k in range(n):
            best_forward = best_backward = 1e9
            forward = backward = -1
            for i in range(max(0, pixel[k, 0] - 2), min(height, pixel[k, 0] + 3)):
                for j in range(max(0, pixel[k, 1] - 2), min(width, pixel[k, 1] + 3)):
                    other = index[i, j]
                    if other < 0 or other == k:
                        continue
                    if gradient[k, 0] * gradient[other, 0] + gradient[k, 1] * gradient[other, 1] <= 0:
                        continue
                    dx = position[other, 0] - position[k, 0]
                    dy = position[other, 1] - position[k, 1]
                    distance = dx * dx + dy * dy
                    ahead = gradient[k, 0] * dy - gradient[k, 1] * dx
                    other_ahead = gradient[other, 0] * dy - gradient[other, 1] * dx
                    if ahead > 0 and other_ahead > 0 and distance < best_forward:
                        best_forward = distance
                        forward = other
                    elif ahead < 0 and other_ahead < 0 and distance < best_backward:
                        best_backward = distance
                        backward = other
            following[k] = forward
            preceding[k] = backward
        for k in range(n):
            other = following[k]
            if other >= 0 and preceding[other] != k:
                following[k] = -1
        for k in range(n):
            other = preceding[k]
            if other >= 0 and following[other] != k:
                preceding[k] = -1


def follow(int[::1] following, int[::1] preceding, int[::1] order, int[::1] first):
    """List the points chain by chain: open chains first by their first point, then rings.

    order: (n,) filled with points; first: (n + 1,) filled with offsets into it. A ring's first
    point keeps its `preceding`. Returns the number of chains.
    """
    cdef Py_ssize_t k
    cdef int at, beyond, ring
    cdef Py_ssize_t n = following.shape[0]
    cdef Py_ssize_t filled = 0, chains = 0
    with nogil:
        for ring in range(2):
            for k in range(n):
                if following[k] == -2 or (ring == 0 and preceding[k] >= 0):
                    continue
                first[chains] = filled
                chains += 1
                at = k
                while at >= 0:
                    order[filled] = at
                    filled += 1
                    beyond = following[at]
                    following[at] = -2  # taken
                    at = beyond if beyond >= 0 and following[beyond] != -2 else -1
    first[chains] = filled
    return chains


def reach(
    int[::1] ends, double[:, ::1] start, double[:, ::1] direction, double[:, ::1] position, int[:, ::1] pixel,
    int[:, ::1] index, int[::1] chain, int[::1] place, double radius, int[::1] target, double[::1] cost,
) -> None:
    """For each end of a chain, the point that the chain would meet if it went on straight.

    ends: (n,) points; start: (n, 2) where the straight line leaves the chain, direction: (n, 2)
    unit vectors out of it. index: (h, w) point of each pixel or -1. chain, place: the chain of each
    point (-1: none) and its place along it; an end does not meet its own neighbourhood, but the other side of a loop.
    target: (n,) filled, -1 for none within radius of the start; cost: (n,) filled, pixels.
    """
    cdef Py_ssize_t k
    cdef int e, i, j, other, way
    cdef double dx, dy, distance, ahead, aside, price
    cdef int height = index.shape[0]
    cdef int width = index.shape[1]
    cdef int window = <int>radius + 2
    cdef Py_ssize_t n = ends.shape[0]
    with nogil:
        for k in range(n):
            e = ends[k]
            target[k] = -1
            cost[k] = 1e9
            for i in range(max(0, pixel[e, 0] - window), min(height, pixel[e, 0] + window + 1)):
                for j in range(max(0, pixel[e, 1] - window), min(width, pixel[e, 1] + window + 1)):
                    other = index[i, j]
                    if other < 0 or other == e or chain[other] < 0:
                        continue
                    dx = position[other, 0] - start[k, 0]
                    dy = position[other, 1] - start[k, 1]
                    distance = sqrt(dx * dx + dy * dy)
                    way = abs(place[other] - place[e])
                    if chain[other] == chain[e] and way < 4 * window and way < 3 * distance + 4:
                        continue
                    ahead = dx * direction[k, 0] + dy * direction[k, 1]
                    aside = fabs(dx * direction[k, 1] - dy * direction[k, 0])
                    if distance > radius or (ahead < 0 and distance > 1.5) or aside > 1.5 + 0.3 * ahead:
                        continue
                    price = fabs(ahead) + 2 * aside
                    if price < cost[k]:
                        cost[k] = price
                        target[k] = other


def trace(
    int[::1] start, int[::1] degree, int[::1] first, int[::1] neighbour, int[::1] via, unsigned char[::1] used,
    int[::1] path, int[::1] segment, int[::1] offset,
):
    """Cut a graph into paths that end at nodes (vertices not of degree 2), then into rings.

    start: vertices in the order to start from, nodes first. neighbour, via: the vertices and
    segments around vertex v are those from first[v] to first[v + 1]. used: (segments,) zeros.
    path, segment: filled, path k in offset[k] : offset[k + 1], one vertex more than segments (the
    last place of `segment` in each path is -1). Returns the number of paths.
    """
    cdef Py_ssize_t k
    cdef int v, at, e, way
    cdef Py_ssize_t filled = 0, paths = 0
    with nogil:
        for k in range(start.shape[0]):
            v = start[k]
            for e in range(first[v], first[v + 1]):
                if used[via[e]]:
                    continue
                offset[paths] = filled
                paths += 1
                way = e
                path[filled] = v
                while True:
                    used[via[way]] = 1
                    segment[filled] = via[way]
                    filled += 1
                    at = neighbour[way]
                    path[filled] = at
                    if degree[at] != 2 or at == v:
                        break
                    way = first[at] if not used[via[first[at]]] else first[at] + 1
                segment[filled] = -1
                filled += 1
        offset[paths] = filled
    return paths
