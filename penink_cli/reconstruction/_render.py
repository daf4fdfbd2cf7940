# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The reconstruction near edges: equations 4 and 5 for the pixels of one tile after the other.

In double, or for 8-bit output in float, which vectorises twice as wide; what pixels see is exact in both. Wider vectors
are not worth a second build: with AVX2 500 scattered edges at 128² → 1024² took 3 % less, the separable pass 18 %.
"""

import cython
from cython.cimports.libc.math import sqrt, sqrtf
from cython.cimports.libc.string import memcpy
from cython.cimports.penink_cli.reconstruction._desk import Desk
from cython.cimports.penink_cli.reconstruction._tile import Tile

COMPILED = cython.compiled

real = cython.fused_type(cython.float, cython.double)
stored = cython.fused_type(cython.uchar, cython.ushort, cython.double)

T1 = cython.declare(cython.double, 0.5)  # below this sum of cubic weights the B-spline is blended in
T2 = cython.declare(cython.double, 1e-4)  # below this sum of B-spline weights plain convolution is faded in
FAR = cython.declare(cython.float, 1e30)  # a distance no path has


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def rows_of(pixels: cython.ulonglong) -> cython.int:
    """The rows that a set of pixels touches: the bytes of the word that are not zero, gathered by a multiplication."""
    low: cython.ulonglong = 0x7F7F7F7F7F7F7F7F
    first: cython.ulonglong = 0x0101010101010101
    gather: cython.ulonglong = 0x0102040810204080
    pixels = (((pixels & low) + low) | pixels) >> 7 & first
    return cython.cast(cython.int, (pixels * gather) >> 56)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def measure(
    out: cython.pointer[real],
    bits: cython.pointer[real],
    seen: cython.ulonglong,
    ux: cython.pointer[real],
    uy: cython.pointer[real],
    ny: cython.int,
    x: real,
    y: real,
) -> cython.void:
    """Distance of each pixel of the tile from a node, FAR from where it is not seen."""
    r: cython.Py_ssize_t
    c: cython.Py_ssize_t
    far: real = FAR
    across: real[8]
    mine: real[8]
    down: real
    veil: cython.pointer[real]
    for c in range(8):
        across[c] = (ux[c] - x) * (ux[c] - x)
    for r in range(ny):
        veil = bits + 8 * (~(seen >> (8 * r)) & 255)
        down = (uy[r] - y) * (uy[r] - y)
        for c in range(8):
            if real is cython.float:
                mine[c] = sqrtf(across[c] + down) + veil[c] * far
            else:
                mine[c] = sqrt(across[c] + down) + veil[c] * far
        memcpy(out + 8 * r, mine, 8 * cython.sizeof(out[0]))


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def fade(
    alpha: cython.pointer[real],
    bits: cython.pointer[real],
    hidden: cython.ulonglong,
    ux: cython.pointer[real],
    uy: cython.pointer[real],
    ny: cython.int,
    x: real,
    y: real,
    bend: cython.pointer[real],
    length: real,
) -> cython.void:
    """Equation 4 for one sample, in the rows where pixels do not see it; lengths in units of the radius.

    bend: distance of each pixel to a bend, which is `length` from the sample. With u = 1 − detour / r clamped to
    0 … 1 the attenuation 1 − S(1 − u) is S(u), and as no path is shorter than the straight line only 0 needs a test.
    """
    r: cython.Py_ssize_t
    c: cython.Py_ssize_t
    byte: cython.int
    u: real
    down: real
    zero: real = 0
    three: real = 3
    across: real[8]
    mine: real[8]
    veil: cython.pointer[real]
    bare: cython.pointer[real]
    near: cython.pointer[real]
    length -= 1
    for c in range(8):
        across[c] = (ux[c] - x) * (ux[c] - x)
    for r in range(ny):
        byte = (hidden >> (8 * r)) & 255
        if byte == 0:
            continue
        veil = bits + 8 * byte
        bare = bits + 8 * (byte ^ 255)
        near = bend + 8 * r
        down = (uy[r] - y) * (uy[r] - y)
        for c in range(8):
            if real is cython.float:
                u = sqrtf(across[c] + down) - (near[c] + length)
            else:
                u = sqrt(across[c] + down) - (near[c] + length)
            u = u if u > zero else zero
            mine[c] = u * u * (three - (u + u)) * veil[c] + bare[c]
        memcpy(alpha + 8 * r, mine, 8 * cython.sizeof(alpha[0]))


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def attenuate(desk: Desk, tile: Tile, ux: cython.pointer[real], uy: cython.pointer[real], radius: real) -> cython.void:
    """Equation 4 for every sample and pixel of a tile, from what the tile sees and the bends of the hidden samples.

    ux, uy: the pixels, relative to the cell and in units of the radius.
    """
    s: cython.int
    k: cython.Py_ssize_t
    m: cython.int
    at: cython.int
    end: cython.int
    node: cython.int
    slot: cython.int
    v: cython.int
    byte: cython.int
    bends: cython.int
    first: cython.int = 0
    limit: cython.double
    d: cython.double
    t: real
    length: real = 0
    row: cython.Py_ssize_t
    hidden: cython.ulonglong
    seen: cython.ulonglong
    bits: cython.pointer[real]
    nodes: cython.pointer[real]
    alpha: cython.pointer[real]
    near: cython.pointer[real]
    best: real[64]
    ny: cython.int = tile.ny
    n: cython.Py_ssize_t = 8 * ny
    desk.used = 0
    if real is cython.float:
        bits = desk.bits_single
    else:
        bits = desk.bits
    for s in range(16):
        hidden = tile.hidden[s]
        desk.mixed[s] = desk.shaded[s] = 0
        if hidden == 0:
            continue
        bends = 0
        limit = tile.farthest(tile.column[s & 3], tile.row[s >> 2]) + radius
        at = tile.finder.bends_of(tile.row[s >> 2], tile.column[s & 3])
        row = cython.cast(cython.Py_ssize_t, tile.row[s >> 2] - tile.finder.row0) * tile.scene.width
        end = at + tile.finder.count[row + tile.column[s & 3]]
        near = cython.NULL
        for m in range(at, end):
            d = tile.finder.pool_length[m]
            if d >= limit:
                break
            node = tile.finder.pool_node[m]
            v = tile.scene.node_vertex[node]
            if tile.node_stamp[node] != tile.now:
                if d + tile.nearest(tile.scene.vx[v], tile.scene.vy[v]) >= limit:
                    continue
                tile.node_stamp[node] = tile.now
                seen = tile.node_mask(node)
                if seen == 0:
                    tile.node_place[node] = -1
                    continue
                slot = desk.another_node(seen)
                tile.node_place[node] = slot
                if real is cython.float:
                    nodes = desk.nodes_single
                else:
                    nodes = desk.nodes
                measure(
                    nodes + 64 * slot, bits, seen, ux, uy, ny,
                    (tile.scene.vx[v] - tile.cx) / radius, (tile.scene.vy[v] - tile.cy) / radius,
                )  # fmt: skip
            slot = tile.node_place[node]
            if slot < 0 or not (desk.node_mask[slot] & hidden):
                continue
            if real is cython.float:
                nodes = desk.nodes_single + 64 * slot
            else:
                nodes = desk.nodes + 64 * slot
            if bends == 0:
                first = slot
                length = d / radius
            else:
                if bends == 1:
                    near = nodes + 64 * (first - slot)
                    for k in range(n):
                        best[k] = near[k] + length
                length = d / radius
                for k in range(n):
                    t = nodes[k] + length
                    best[k] = t if t < best[k] else best[k]
            bends += 1
        if real is cython.float:
            alpha = desk.alpha_single + 64 * s
            nodes = desk.nodes_single
        else:
            alpha = desk.alpha + 64 * s
            nodes = desk.nodes
        desk.shaded[s] = desk.mixed[s] = rows_of(hidden)
        if bends == 0:
            desk.mixed[s] &= rows_of(~hidden & tile.pixels())
            for k in range(ny):
                byte = (hidden >> (8 * k)) & 255
                memcpy(alpha + 8 * k, bits + 8 * (byte ^ 255), 8 * cython.sizeof(alpha[0]))
        elif bends == 1:
            fade(alpha, bits, hidden, ux, uy, ny, tile.sx[s] / radius, tile.sy[s] / radius, nodes + 64 * first, length)
        elif bends:
            fade(alpha, bits, hidden, ux, uy, ny, tile.sx[s] / radius, tile.sy[s] / radius, best, 0)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def add_up(
    desk: Desk,
    f: cython.pointer[real],
    kx: cython.pointer[real],
    stride: cython.Py_ssize_t,
    ky: cython.pointer[real],
    ny: cython.int,
    top: cython.pointer[real],
    bottom: cython.pointer[real],
) -> cython.void:
    """Numerator and denominator of equation 5 for every pixel.

    f: the 16 samples. kx: 4 × stride, weights of the columns from the tile's first on. ky: 8 × 4, of its rows. In each
    row of pixels the samples that count fully are summed as separable, those that do not count at all are left out.
    The sums are kept in local arrays: nothing can alias them, so the loops vectorise.
    """
    s: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    r: cython.Py_ssize_t
    c: cython.Py_ssize_t
    w: real
    v: real
    y: real
    alpha: cython.pointer[real]
    all_alpha: cython.pointer[real]
    bits: cython.pointer[real]
    mask: cython.pointer[real]
    kx1: cython.pointer[real] = kx + stride
    kx2: cython.pointer[real] = kx1 + stride
    kx3: cython.pointer[real] = kx2 + stride
    column: cython.pointer[real]
    rows: real[4]
    ones: real[4]
    t: real[64]
    b: real[64]
    shaded: cython.uint[4]  # four samples a word
    memcpy(shaded, desk.shaded, 16)
    if real is cython.float:
        all_alpha = desk.alpha_single
        bits = desk.bits_single
    else:
        all_alpha = desk.alpha
        bits = desk.bits
    for r in range(ny):
        for i in range(4):
            rows[i] = 0
            ones[i] = 0
        for j in range(4):
            y = ky[4 * r + j]
            mask = bits + 8 * (~((((shaded[j] >> r) & 0x01010101) * 0x10204080) >> 28) & 15)
            for i in range(4):
                w = y * mask[i]
                ones[i] += w
                rows[i] += w * f[4 * j + i]
        for c in range(8):
            t[8 * r + c] = rows[0] * kx[c] + rows[1] * kx1[c] + rows[2] * kx2[c] + rows[3] * kx3[c]
            b[8 * r + c] = ones[0] * kx[c] + ones[1] * kx1[c] + ones[2] * kx2[c] + ones[3] * kx3[c]
    for s in range(16):
        if desk.mixed[s] == 0:
            continue
        column = kx + stride * (s & 3)
        j = s >> 2
        v = f[s]
        for r in range(ny):
            if not (desk.mixed[s] >> r) & 1:
                continue
            y = ky[4 * r + j]
            alpha = all_alpha + 64 * s + 8 * r
            for c in range(8):
                w = y * column[c] * alpha[c]
                b[8 * r + c] += w
                t[8 * r + c] += w * v
    memcpy(top, t, 8 * ny * cython.sizeof(t[0]))
    memcpy(bottom, b, 8 * ny * cython.sizeof(b[0]))


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def blend(
    desk: Desk,
    tile: Tile,
    samples: cython.pointer[real],
    xc: cython.pointer[real],
    xb: cython.pointer[real],
    yc: cython.pointer[real],
    yb: cython.pointer[real],
    stride: cython.Py_ssize_t,
    radius: real,
    only_b: cython.bint,
    out: cython.pointer[real],
) -> cython.void:
    """The values of a tile that `see` found edges in; samples: unpadded, row by row. xc, xb: as kx of `add_up`."""
    k: cython.Py_ssize_t
    c: cython.Py_ssize_t
    s: cython.int
    n: cython.Py_ssize_t = 8 * tile.ny
    f: real[16]
    ux: real[8]
    uy: real[8]
    top: real[64]
    bottom: real[64]
    top_b: real[64]
    bottom_b: real[64]
    t: real
    w: real
    low: cython.int
    value: real[64]
    half: real = T1
    threshold: real = T2
    zero: real = 0
    one: real = 1
    three: real = 3
    for c in range(8):  # beyond the tile's own columns come those of the next; what they give is not used
        ux[c] = (tile.px[c] - tile.cx) / radius
    for k in range(tile.ny):
        uy[k] = (tile.py[k] - tile.cy) / radius
    for s in range(16):
        f[s] = samples[cython.cast(cython.Py_ssize_t, tile.row[s >> 2]) * tile.scene.width + tile.column[s & 3]]
    attenuate(desk, tile, ux, uy, radius)
    if not only_b:
        add_up(desk, f, xc, stride, yc, tile.ny, top, bottom)
        low = 0
        for k in range(n):
            low += 1 if bottom[k] < half else 0
        if low == 0:
            for k in range(n):
                value[k] = top[k] / bottom[k]
            memcpy(out, value, n * cython.sizeof(value[0]))
            return
    add_up(desk, f, xb, stride, yb, tile.ny, top_b, bottom_b)
    low = 0
    for k in range(n):
        low += 1 if bottom_b[k] < threshold else 0
    if only_b:
        for k in range(n):
            value[k] = top_b[k] / bottom_b[k]
    else:
        for k in range(n):
            t = bottom[k] / half  # ω = S(den / T1)
            t = t if t < one else one
            t = t if t > zero else zero
            w = t * t * (three - (t + t))
            value[k] = (w * top[k] + (one - w) * top_b[k]) / (w * bottom[k] + (one - w) * bottom_b[k])
    if low == 0:
        memcpy(out, value, n * cython.sizeof(value[0]))
        return
    # Starved pixels: plain convolution, across the edges.
    for s in range(16):
        desk.mixed[s] = desk.shaded[s] = 0
    if only_b:
        add_up(desk, f, xb, stride, yb, tile.ny, top, bottom)
    else:
        add_up(desk, f, xc, stride, yc, tile.ny, top, bottom)
    for k in range(n):
        t = bottom_b[k] / threshold
        if t <= zero:
            out[k] = top[k]
        elif t >= one:
            out[k] = value[k]
        else:
            w = t * t * (three - (t + t))
            out[k] = w * value[k] + (one - w) * top[k]


def retouch(
    tile: Tile,
    desk: Desk,
    samples: real[:, ::1],
    x: cython.double[::1],
    xc: real[:, ::1],
    xb: real[:, ::1],
    x_cell: cython.int[::1],
    x_begin: cython.int[::1],
    y: cython.double[::1],
    yc: real[:, ::1],
    yb: real[:, ::1],
    y_cell: cython.int[::1],
    y_begin: cython.int[::1],
    radius: real,
    only_b: cython.bint,
    maxval: real,
    out: stored[:, ::1],
) -> None:
    """Reconstruct every tile that has an edge within the cells that its samples span.

    x: (n + 8,) positions of the columns, sample units. xc, xb: (4, n + 8) taps. x_cell, x_begin: (t,), (t + 1,) the
    cell and the first column of each tile, left to right. For y likewise, but (rows, 4) taps. out: (rows, n).
    """
    a: cython.Py_ssize_t
    b: cython.Py_ssize_t
    r: cython.Py_ssize_t
    c: cython.Py_ssize_t
    nx: cython.int
    ny: cython.int
    v: real
    half: real = 0.5
    zero: real = 0
    values: real[64]
    rounded: stored[64]
    with cython.nogil:
        for a in range(y_cell.shape[0]):
            ny = y_begin[a + 1] - y_begin[a]
            for b in range(x_cell.shape[0]):
                if tile.scene.clear(x_cell[b] - 1, y_cell[a] - 1, x_cell[b] + 1, y_cell[a] + 1):
                    continue
                nx = x_begin[b + 1] - x_begin[b]
                tile.place(x_cell[b], y_cell[a], cython.address(x[x_begin[b]]), nx, cython.address(y[y_begin[a]]), ny)
                if not tile.see():
                    continue
                blend(
                    desk, tile, cython.address(samples[0, 0]),
                    cython.address(xc[0, x_begin[b]]), cython.address(xb[0, x_begin[b]]),
                    cython.address(yc[y_begin[a], 0]), cython.address(yb[y_begin[a], 0]),
                    xc.shape[1], radius, only_b, values,
                )  # fmt: skip
                if stored is cython.double:
                    for r in range(ny):
                        for c in range(nx):
                            out[y_begin[a] + r, x_begin[b] + c] = values[8 * r + c]
                else:
                    for r in range(8 * ny):
                        v = values[r]
                        v = v if v > zero else zero
                        v = v if v < maxval else maxval
                        rounded[r] = cython.cast(cython.int, v + half)
                    if nx == 8:
                        for r in range(ny):
                            memcpy(
                                cython.address(out[y_begin[a] + r, x_begin[b]]), rounded + 8 * r,
                                8 * cython.sizeof(rounded[0]),
                            )  # fmt: skip
                    else:
                        for r in range(ny):
                            for c in range(nx):
                                out[y_begin[a] + r, x_begin[b] + c] = rounded[8 * r + c]
