# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Compiled: the camera as a linear operator on samples, and least squares against what it saw. See fit.py."""

import cython
from cython.cimports.libc.math import sqrt
from cython.cimports.penink_cli.reconstruction._tile import Tile

COMPILED = cython.compiled

T1 = cython.declare(cython.double, 0.5)  # below this sum of cubic weights the B-spline is blended in
T2 = cython.declare(cython.double, 1e-4)  # below this sum of B-spline weights plain convolution is faded in


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _smooth(t: cython.double) -> cython.double:
    """S(t) = 3t² − 2t³, clamped."""
    return 0.0 if t <= 0.0 else (1.0 if t >= 1.0 else t * t * (3.0 - 2.0 * t))


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _attenuate(tile: Tile, radius: cython.double, alpha: cython.p_double) -> cython.void:
    """Equation 4 for the 16 samples (outer) and 64 points (inner) of a tile that `see` has looked at."""
    s: cython.int
    k: cython.int
    m: cython.int
    at: cython.int
    end: cython.int
    node: cython.int
    v: cython.int
    i: cython.int
    j: cython.int
    d: cython.double
    dx: cython.double
    dy: cython.double
    t: cython.double
    limit: cython.double
    hidden: cython.ulonglong
    seen: cython.ulonglong
    left: cython.ulonglong
    one: cython.ulonglong = 1
    best = cython.declare(cython.double[64])
    for s in range(16):
        hidden = tile.hidden[s]
        for k in range(64):
            alpha[64 * s + k] = 1.0
        if hidden == 0:
            continue
        i = tile.row[s >> 2]
        j = tile.column[s & 3]
        for k in range(64):
            best[k] = 1e30
        limit = tile.farthest(j, i) + radius
        at = tile.finder.bends_of(i, j)
        end = at + tile.finder.count[cython.cast(cython.Py_ssize_t, i - tile.finder.row0) * tile.scene.width + j]
        for m in range(at, end):
            d = tile.finder.pool_length[m]
            if d >= limit:
                break
            node = tile.finder.pool_node[m]
            v = tile.scene.node_vertex[node]
            if d + tile.nearest(tile.scene.vx[v], tile.scene.vy[v]) >= limit:
                continue
            seen = tile.node_mask(node) & hidden
            k = 0
            while seen:
                if seen & one:
                    dx = tile.px[k & 7] - tile.scene.vx[v]
                    dy = tile.py[k >> 3] - tile.scene.vy[v]
                    best[k] = min(best[k], d + sqrt(dx * dx + dy * dy))
                seen >>= 1
                k += 1
        left = hidden
        k = 0
        while left:
            if left & one:
                dx = tile.px[k & 7] - j
                dy = tile.py[k >> 3] - i
                t = (best[k] - sqrt(dx * dx + dy * dy)) / radius
                t = min(1.0, max(0.0, t))
                alpha[64 * s + k] = 1.0 - t * t * (3.0 - 2.0 * t)
            left >>= 1
            k += 1


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _weigh(
    alpha: cython.p_double,
    k: cython.int,
    xc: cython.p_double,
    xb: cython.p_double,
    yc: cython.p_double,
    yb: cython.p_double,
    out: cython.p_double,
) -> cython.void:
    """Weights of the 16 samples for point k of a tile: equation 5, with the kernels blended."""
    a: cython.int
    b: cython.int
    w: cython.double
    omega: cython.double
    fade: cython.double
    norm: cython.double
    sum_c: cython.double = 0.0
    sum_b: cython.double = 0.0
    for a in range(4):
        for b in range(4):
            w = alpha[64 * (4 * a + b) + k]
            sum_c += w * (yc[a] * xc[b])
            sum_b += w * (yb[a] * xb[b])
    omega = _smooth(sum_c / T1)
    fade = 1.0 - _smooth(sum_b / T2)
    norm = omega * sum_c + (1.0 - omega) * sum_b
    norm = (1.0 - fade) / norm if norm > 0.0 else 0.0
    for a in range(4):
        for b in range(4):
            w = omega * (yc[a] * xc[b]) + (1.0 - omega) * (yb[a] * xb[b])
            out[4 * a + b] = norm * alpha[64 * (4 * a + b) + k] * w + fade * (yc[a] * xc[b])


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _weigh_tile(
    alpha: cython.p_double,
    nx: cython.int,
    ny: cython.int,
    xc: cython.double[:, ::1],
    xb: cython.double[:, ::1],
    yc: cython.double[:, ::1],
    yb: cython.double[:, ::1],
    x: cython.int,
    y: cython.int,
    out: cython.p_double,
) -> cython.void:
    """By what equation 5's weights of the 16 samples (outer) differ from plain ones at each point (inner) of a tile.

    x, y: the tile's first point along each axis. out: (16, 64).
    """
    a: cython.int
    b: cython.int
    r: cython.int
    c: cython.int
    k: cython.int
    s: cython.int
    v: cython.double
    across = cython.declare(cython.double[32])
    total = cython.declare(cython.double[64])
    one = cython.declare(cython.double[16])
    for k in range(64):
        total[k] = 0.0
    for c in range(8):
        for b in range(4):
            across[8 * b + c] = xc[x + min(c, nx - 1), b]
    for s in range(16):
        for r in range(ny):
            v = yc[y + r, s >> 2]
            for c in range(8):
                total[8 * r + c] += alpha[64 * s + 8 * r + c] * (v * across[8 * (s & 3) + c])
    for k in range(8 * ny):
        total[k] = 1.0 / total[k] if total[k] >= T1 else 0.0  # 0: the blend of both kernels, below
    for s in range(16):
        for r in range(ny):
            v = yc[y + r, s >> 2]
            for c in range(8):
                k = 8 * r + c
                out[64 * s + k] = v * across[8 * (s & 3) + c] * (alpha[64 * s + k] * total[k] - 1.0)
    for r in range(ny):
        for c in range(nx):
            k = 8 * r + c
            if total[k] == 0.0:
                _weigh(
                    alpha, k, cython.address(xc[x + c, 0]), cython.address(xb[x + c, 0]),
                    cython.address(yc[y + r, 0]), cython.address(yb[y + r, 0]), one,
                )  # fmt: skip
                for a in range(4):
                    for b in range(4):
                        out[64 * (4 * a + b) + k] = one[4 * a + b] - yc[y + r, a] * xc[x + c, b]


def rows(
    tile: Tile,
    x: cython.double[::1],
    xc: cython.double[:, ::1],
    xb: cython.double[:, ::1],
    x_cell: cython.int[::1],
    x_begin: cython.int[::1],
    y: cython.double[::1],
    yc: cython.double[:, ::1],
    yb: cython.double[:, ::1],
    y_cell: cython.int[::1],
    y_begin: cython.int[::1],
    tiles: cython.int[::1],
    pixels: cython.int[::1],
    fine: cython.int,
    x_base: cython.int[::1],
    y_base: cython.int[::1],
    x_plain: cython.float[:, ::1],
    y_plain: cython.float[:, ::1],
    radius: cython.double,
    weight: cython.float[:, :, ::1],
) -> cython.bint:
    """Fill the reconstruction's rows for pixels, each the mean of fine × fine points. True if an edge matters.

    x …, y …: of all points along each axis, as in lattice.Axis. tiles: (4,) first and last + 1 tile down and
    across. pixels: (2,) row and column of the block's first pixel. x_base, y_base: first sample that each
    pixel of an axis depends on; x_plain, y_plain: (n, 5) weights of plain convolution from there on.
    weight: (rows, columns, 25) filled: 5 × 5 samples from the bases on.
    """
    a: cython.int
    b: cython.int
    r: cython.int
    c: cython.int
    i: cython.int
    j: cython.int
    k: cython.int
    s: cython.int
    nx: cython.int
    ny: cython.int
    py: cython.int
    px: cython.int
    at_x: cython.int
    at_y: cython.int
    v: cython.float
    w: cython.p_float
    matters: cython.bint = False
    share: cython.double = 1.0 / (fine * fine)
    last_x: cython.int = tile.scene.width - 1
    last_y: cython.int = tile.scene.height - 1
    alpha = cython.declare(cython.double[1024])
    change = cython.declare(cython.double[1024])
    place_x = cython.declare(cython.int[4])
    place_y = cython.declare(cython.int[4])
    with cython.nogil:
        for py in range(weight.shape[0]):
            for px in range(weight.shape[1]):
                w = cython.address(weight[py, px, 0])
                for i in range(5):
                    v = y_plain[pixels[0] + py, i]
                    for j in range(5):
                        w[5 * i + j] = v * x_plain[pixels[1] + px, j]
        for a in range(tiles[0], tiles[1]):
            at_y = y_begin[a]
            ny = y_begin[a + 1] - at_y
            tile.place_in_row(y_cell[a], cython.address(y[at_y]), ny)
            for b in range(tiles[2], tiles[3]):
                if tile.scene.empty_around(x_cell[b], y_cell[a]):
                    continue
                at_x = x_begin[b]
                nx = x_begin[b + 1] - at_x
                tile.place(x_cell[b], cython.address(x[at_x]), nx)
                if not tile.see():
                    continue
                matters = True
                _attenuate(tile, radius, alpha)
                _weigh_tile(alpha, nx, ny, xc, xb, yc, yb, at_x, at_y, change)
                for r in range(ny):
                    py = (at_y + r) // fine - pixels[0]
                    if py < 0 or py >= weight.shape[0]:
                        continue
                    for i in range(4):
                        place_y[i] = min(last_y, max(0, y_cell[a] - 1 + i)) - y_base[pixels[0] + py]
                    for c in range(nx):
                        px = (at_x + c) // fine - pixels[1]
                        if px < 0 or px >= weight.shape[1]:
                            continue
                        for j in range(4):
                            place_x[j] = min(last_x, max(0, x_cell[b] - 1 + j)) - x_base[pixels[1] + px]
                        k = 8 * r + c
                        w = cython.address(weight[py, px, 0])
                        for s in range(16):
                            w[5 * place_y[s >> 2] + place_x[s & 3]] += share * change[64 * s + k]
    return matters


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _see(
    weight: cython.float[:, :, ::1],
    x_base: cython.p_int,
    y_base: cython.p_int,
    samples: cython.double[:, ::1],
    out: cython.double[:, ::1],
) -> cython.void:
    """Pixels of a block from its samples; the bases are counted from the block's first sample."""
    p: cython.Py_ssize_t
    q: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    high: cython.Py_ssize_t = min(5, samples.shape[0])
    wide: cython.Py_ssize_t = min(5, samples.shape[1])
    w: cython.p_float
    s: cython.p_double
    total: cython.double
    for p in range(weight.shape[0]):
        for q in range(weight.shape[1]):
            w = cython.address(weight[p, q, 0])
            total = 0.0
            for i in range(high):
                s = cython.address(samples[y_base[p] + i, x_base[q]])
                for j in range(wide):
                    total += w[5 * i + j] * s[j]
            out[p, q] = total


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _unsee(
    weight: cython.float[:, :, ::1],
    x_base: cython.p_int,
    y_base: cython.p_int,
    pixels: cython.double[:, ::1],
    out: cython.double[:, ::1],
) -> cython.void:
    """The transpose of `_see`."""
    p: cython.Py_ssize_t
    q: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    high: cython.Py_ssize_t = min(5, out.shape[0])
    wide: cython.Py_ssize_t = min(5, out.shape[1])
    w: cython.p_float
    s: cython.p_double
    v: cython.double
    out[:, :] = 0
    for p in range(weight.shape[0]):
        for q in range(weight.shape[1]):
            w = cython.address(weight[p, q, 0])
            v = pixels[p, q]
            for i in range(high):
                s = cython.address(out[y_base[p] + i, x_base[q]])
                for j in range(wide):
                    s[j] += w[5 * i + j] * v


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _reflected(i: cython.Py_ssize_t, n: cython.Py_ssize_t) -> cython.Py_ssize_t:
    """Index i of (d c b a | a b c d | d c b a), which keeps the blur its own transpose."""
    while i < 0 or i >= n:
        i = -1 - i if i < 0 else 2 * n - 1 - i
    return i


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _blur(kernel: cython.double[::1], pixels: cython.double[:, ::1], room: cython.double[:, ::1]) -> cython.void:
    """Convolve pixels with a symmetric kernel (its centre first) along both axes, in place."""
    p: cython.Py_ssize_t
    q: cython.Py_ssize_t
    d: cython.Py_ssize_t
    a: cython.Py_ssize_t
    b: cython.Py_ssize_t
    h: cython.Py_ssize_t = pixels.shape[0]
    w: cython.Py_ssize_t = pixels.shape[1]
    k: cython.double
    reach: cython.Py_ssize_t = kernel.shape[0] - 1
    if reach == 0:
        return
    for p in range(h):
        for q in range(w):
            room[p, q] = kernel[0] * pixels[p, q]
        for d in range(1, reach + 1):
            k = kernel[d]
            a = _reflected(p - d, h)
            b = _reflected(p + d, h)
            for q in range(w):
                room[p, q] += k * (pixels[a, q] + pixels[b, q])
    for p in range(h):
        for q in range(w):
            pixels[p, q] = kernel[0] * room[p, q]
        for d in range(1, reach + 1):
            k = kernel[d]
            for q in range(min(d, w)):
                pixels[p, q] += k * (room[p, _reflected(q - d, w)] + room[p, _reflected(q + d, w)])
            for q in range(d, w - d):
                pixels[p, q] += k * (room[p, q - d] + room[p, q + d])
            for q in range(max(d, w - d), w):
                pixels[p, q] += k * (room[p, _reflected(q - d, w)] + room[p, _reflected(q + d, w)])


def solve(
    weight: cython.float[:, :, ::1],
    x_base: cython.int[::1],
    y_base: cython.int[::1],
    kernel: cython.double[::1],
    photo: cython.float[:, ::1],
    hold: cython.double,
    steps: cython.int,
    samples: cython.double[:, ::1],
    room: cython.double[:, :, ::1],
    pixel_room: cython.double[:, :, ::1],
) -> None:
    """Conjugate gradients for ‖B R s − photo‖² + hold ‖s − s₀‖² over one block, samples being s₀ and then s.

    room: (3, rows, columns) of samples; pixel_room: (2, rows, columns) of pixels; to work in.
    """
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    square: cython.double = 0.0
    next_square: cython.double
    curvature: cython.double
    step: cython.double
    g: cython.double[:, ::1] = room[0]
    way: cython.double[:, ::1] = room[1]
    change: cython.double[:, ::1] = room[2]
    seen: cython.double[:, ::1] = pixel_room[0]
    spare: cython.double[:, ::1] = pixel_room[1]
    with cython.nogil:
        _see(weight, cython.address(x_base[0]), cython.address(y_base[0]), samples, seen)
        _blur(kernel, seen, spare)
        for i in range(photo.shape[0]):
            for j in range(photo.shape[1]):
                seen[i, j] = photo[i, j] - seen[i, j]
        _blur(kernel, seen, spare)
        _unsee(weight, cython.address(x_base[0]), cython.address(y_base[0]), seen, g)
        for i in range(g.shape[0]):
            for j in range(g.shape[1]):
                way[i, j] = g[i, j]
                square += g[i, j] * g[i, j]
        for _ in range(steps):
            if square < 1e-14:
                break
            _see(weight, cython.address(x_base[0]), cython.address(y_base[0]), way, seen)
            _blur(kernel, seen, spare)
            curvature = 0.0
            for i in range(seen.shape[0]):
                for j in range(seen.shape[1]):
                    curvature += seen[i, j] * seen[i, j]
            for i in range(way.shape[0]):
                for j in range(way.shape[1]):
                    curvature += hold * way[i, j] * way[i, j]
            step = square / curvature
            _blur(kernel, seen, spare)
            _unsee(weight, cython.address(x_base[0]), cython.address(y_base[0]), seen, change)
            next_square = 0.0
            for i in range(g.shape[0]):
                for j in range(g.shape[1]):
                    samples[i, j] += step * way[i, j]
                    g[i, j] -= step * (change[i, j] + hold * way[i, j])
                    next_square += g[i, j] * g[i, j]
            for i in range(g.shape[0]):
                for j in range(g.shape[1]):
                    way[i, j] = g[i, j] + next_square / square * way[i, j]
            square = next_square


def clear(tile: Tile, x0: cython.double, y0: cython.double, x1: cython.double, y1: cython.double) -> cython.bint:
    """Whether no edge comes near the rectangle (sample units)."""
    return tile.scene.clear(x0, y0, x1, y1)
