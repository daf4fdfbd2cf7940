# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The reconstruction of whole rows of output: a separable pass everywhere, then the tiles near edges once more.

In double, or for 8-bit output in float, which vectorises twice as wide; what pixels see is exact in both. Wider vectors
are not worth a second build: with AVX2 500 edges at 128² → 1024² took 5 % less, the separable pass 18 %. Of the time of
such a call the sums of weights take a quarter, attenuation an eighth, masks and classification of lines a third.
"""

import cython
from cython.cimports.libc.math import sqrt, sqrtf
from cython.cimports.libc.stdlib import free, malloc, realloc
from cython.cimports.libc.string import memcpy
from cython.cimports.penink_cli.reconstruction._tile import Tile

COMPILED = cython.compiled

real = cython.fused_type(cython.float, cython.double)
stored = cython.fused_type(cython.uchar, cython.ushort, cython.double)

T1 = cython.declare(cython.double, 0.5)  # below this sum of cubic weights the B-spline is blended in
T2 = cython.declare(cython.double, 1e-4)  # below this sum of B-spline weights plain convolution is faded in
FAR = cython.declare(cython.float, 1e30)  # a distance no path has


@cython.final
@cython.cclass
class Desk:
    """Scratch of one thread. Arrays of 64 hold one number a pixel of the tile, row by row."""

    bits: cython.p_double  # 256 × 8: a byte as eight numbers, 0 or 1 for each bit
    bits_single: cython.p_float
    alpha: cython.p_double  # 16 × 64: attenuation of each sample
    alpha_single: cython.p_float
    nodes: cython.p_double  # (size) × 64: distance from each pixel to a node, FAR where that is hidden
    nodes_single: cython.p_float
    node_mask: cython.p_ulonglong
    used: cython.int
    size: cython.int
    kind: cython.int[16]  # of each sample's attenuation: 0 or 1 throughout the tile, or 2 for mixed

    def __init__(self):
        k: cython.int
        i: cython.int
        self.size = 32
        self.bits = cython.cast(cython.p_double, malloc(256 * 8 * cython.sizeof(cython.double)))
        self.bits_single = cython.cast(cython.p_float, malloc(256 * 8 * cython.sizeof(cython.float)))
        self.alpha = cython.cast(cython.p_double, malloc(16 * 64 * cython.sizeof(cython.double)))
        self.alpha_single = cython.cast(cython.p_float, self.alpha)
        self.nodes = cython.cast(cython.p_double, malloc(self.size * 64 * cython.sizeof(cython.double)))
        self.nodes_single = cython.cast(cython.p_float, self.nodes)
        self.node_mask = cython.cast(cython.p_ulonglong, malloc(self.size * cython.sizeof(cython.ulonglong)))
        for k in range(256):
            for i in range(8):
                self.bits[8 * k + i] = self.bits_single[8 * k + i] = (k >> i) & 1

    def __dealloc__(self):
        free(self.bits)
        free(self.bits_single)
        free(self.alpha)
        free(self.nodes)
        free(self.node_mask)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def another_node(self, seen: cython.ulonglong) -> cython.int:
        """Room for the distances to one more node, seen from some pixels; its place."""
        slot: cython.int = self.used
        if slot == self.size:
            self.size *= 2
            self.nodes = cython.cast(
                cython.p_double, realloc(self.nodes, self.size * 64 * cython.sizeof(cython.double))
            )
            self.nodes_single = cython.cast(cython.p_float, self.nodes)
            self.node_mask = cython.cast(
                cython.p_ulonglong, realloc(self.node_mask, self.size * cython.sizeof(cython.ulonglong))
            )
        self.node_mask[slot] = seen
        self.used = slot + 1
        return slot


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def measure(out: cython.pointer[real], ux: cython.pointer[real], uy: cython.pointer[real], ny: cython.int,
            x: real, y: real) -> cython.void:  # fmt: skip
    """Distance of each pixel of the tile from a point."""
    r: cython.int
    c: cython.int
    across: real[8]
    squares: real[64]
    down: real
    for c in range(8):
        across[c] = (ux[c] - x) * (ux[c] - x)
    for r in range(ny):
        down = (uy[r] - y) * (uy[r] - y)
        for c in range(8):
            squares[8 * r + c] = across[c] + down
    for r in range(8 * ny):
        if real is cython.float:
            out[r] = sqrtf(squares[r])
        else:
            out[r] = sqrt(squares[r])


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def attenuate(desk: Desk, tile: Tile, ux: cython.pointer[real], uy: cython.pointer[real], radius: real) -> cython.void:
    """Equation 4 for every sample and pixel of a tile, from what the tile sees and the bends of the hidden samples."""
    s: cython.int
    k: cython.int
    m: cython.int
    at: cython.int
    end: cython.int
    node: cython.int
    slot: cython.int
    v: cython.int
    touched: cython.bint
    limit: cython.double
    d: cython.double
    t: real
    zero: real = 0
    one: real = 1
    three: real = 3
    far: real = FAR
    veil: real[64]
    row_size: cython.size_t = 8 * cython.sizeof(ux[0])
    length: real
    row: cython.Py_ssize_t
    hidden: cython.ulonglong
    seen: cython.ulonglong
    x: real
    y: real
    bits: cython.pointer[real]
    all_alpha: cython.pointer[real]
    alpha: cython.pointer[real]
    near: cython.pointer[real]
    best: real[64]
    straight: real[64]
    ny: cython.int = tile.ny
    n: cython.int = 8 * ny
    desk.used = 0
    if real is cython.float:
        bits = desk.bits_single
        all_alpha = desk.alpha_single
    else:
        bits = desk.bits
        all_alpha = desk.alpha
    for s in range(16):
        hidden = tile.hidden[s]
        if hidden == 0:
            desk.kind[s] = 1
            continue
        touched = False
        limit = tile.farthest(tile.column[s & 3], tile.row[s >> 2]) + radius
        at = tile.finder.bends_of(tile.row[s >> 2], tile.column[s & 3])
        row = cython.cast(cython.Py_ssize_t, tile.row[s >> 2] - tile.finder.row0) * tile.scene.width
        end = at + tile.finder.count[row + tile.column[s & 3]]
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
                    near = desk.nodes_single + 64 * slot
                else:
                    near = desk.nodes + 64 * slot
                x = tile.scene.vx[v] - tile.cx
                y = tile.scene.vy[v] - tile.cy
                measure(near, ux, uy, ny, x, y)
                for k in range(ny):
                    memcpy(veil + 8 * k, bits + 8 * (~(seen >> (8 * k)) & 255), row_size)
                for k in range(n):
                    near[k] += veil[k] * far
            slot = tile.node_place[node]
            if slot < 0 or not (desk.node_mask[slot] & hidden):
                continue
            if real is cython.float:
                near = desk.nodes_single + 64 * slot
            else:
                near = desk.nodes + 64 * slot
            length = d
            if touched:
                for k in range(n):
                    t = near[k] + length
                    best[k] = t if t < best[k] else best[k]
            else:
                touched = True
                for k in range(n):
                    best[k] = near[k] + length
        alpha = all_alpha + 64 * s
        if touched:
            desk.kind[s] = 2
            x = tile.sx[s]
            y = tile.sy[s]
            measure(straight, ux, uy, ny, x, y)
            for k in range(n):
                t = (best[k] - straight[k]) / radius
                t = t if t < one else one
                t = t if t > zero else zero
                best[k] = one - t * t * (three - (t + t))
            for k in range(ny):
                memcpy(veil + 8 * k, bits + 8 * ((hidden >> (8 * k)) & 255), row_size)
            for k in range(n):
                alpha[k] = (one - veil[k]) + veil[k] * best[k]
        elif (tile.all_hidden >> s) & 1:
            desk.kind[s] = 0
        else:
            desk.kind[s] = 2
            for k in range(ny):
                memcpy(alpha + 8 * k, bits + 8 * (~(hidden >> (8 * k)) & 255), row_size)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def add_up(
    desk: Desk,
    f: cython.pointer[real],
    kx: cython.pointer[real],
    ky: cython.pointer[real],
    ny: cython.int,
    top: cython.pointer[real],
    bottom: cython.pointer[real],
) -> cython.void:
    """Numerator and denominator of equation 5 for every pixel.

    f: the 16 samples. kx: 4 × 8, weights of the tile's columns. ky: 8 × 4, of its rows. Samples that count fully
    throughout the tile are summed as separable, those that do not count at all are left out. The sums are kept in local
    arrays: nothing can alias them, so the loops vectorise.
    """
    s: cython.int
    i: cython.int
    j: cython.int
    r: cython.int
    c: cython.int
    w: real
    v: real
    one: real
    y: real
    alpha: cython.pointer[real]
    all_alpha: cython.pointer[real]
    mine: real[32]
    rows: real[4]
    ones: real[4]
    t: real[64]
    b: real[64]
    if real is cython.float:
        all_alpha = desk.alpha_single
    else:
        all_alpha = desk.alpha
    for s in range(16):
        mine[s] = f[s] if desk.kind[s] == 1 else 0
        mine[16 + s] = 1 if desk.kind[s] == 1 else 0
    for r in range(ny):
        for i in range(4):
            v = 0
            one = 0
            for j in range(4):
                y = ky[4 * r + j]
                v += y * mine[4 * j + i]
                one += y * mine[16 + 4 * j + i]
            rows[i] = v
            ones[i] = one
        for c in range(8):
            t[8 * r + c] = rows[0] * kx[c] + rows[1] * kx[8 + c] + rows[2] * kx[16 + c] + rows[3] * kx[24 + c]
            b[8 * r + c] = ones[0] * kx[c] + ones[1] * kx[8 + c] + ones[2] * kx[16 + c] + ones[3] * kx[24 + c]
    for s in range(16):
        if desk.kind[s] != 2:
            continue
        i = 8 * (s & 3)
        j = s >> 2
        v = f[s]
        alpha = all_alpha + 64 * s
        for r in range(ny):
            y = ky[4 * r + j]
            for c in range(8):
                w = y * kx[i + c] * alpha[8 * r + c]
                b[8 * r + c] += w
                t[8 * r + c] += w * v
    for r in range(8 * ny):
        top[r] = t[r]
        bottom[r] = b[r]


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
    radius: real,
    only_b: cython.bint,
    out: cython.pointer[real],
) -> cython.void:
    """The values of a tile that `see` found edges in; samples: unpadded, row by row. xc …: (n, 4) from the tile on."""
    k: cython.int
    c: cython.int
    s: cython.int
    n: cython.int = 8 * tile.ny
    f: real[16]
    ux: real[8]
    uy: real[8]
    kx: real[32]
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
    for c in range(8):  # columns that the tile lacks repeat its last
        k = c if c < tile.nx else tile.nx - 1
        ux[c] = tile.px[k] - tile.cx
    for k in range(tile.ny):
        uy[k] = tile.py[k] - tile.cy
    for s in range(16):
        f[s] = samples[cython.cast(cython.Py_ssize_t, tile.row[s >> 2]) * tile.scene.width + tile.column[s & 3]]
    attenuate(desk, tile, ux, uy, radius)
    if not only_b:
        columns(kx, xc, tile.nx)
        add_up(desk, f, kx, yc, tile.ny, top, bottom)
        low = 0
        for k in range(n):
            low += 1 if bottom[k] < half else 0
        if low == 0:
            for k in range(n):
                value[k] = top[k] / bottom[k]
            memcpy(out, value, n * cython.sizeof(value[0]))
            return
    columns(kx, xb, tile.nx)
    add_up(desk, f, kx, yb, tile.ny, top_b, bottom_b)
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
        desk.kind[s] = 1
    if only_b:
        columns(kx, xb, tile.nx)
        add_up(desk, f, kx, yb, tile.ny, top, bottom)
    else:
        columns(kx, xc, tile.nx)
        add_up(desk, f, kx, yc, tile.ny, top, bottom)
    for k in range(n):
        t = bottom_b[k] / threshold
        if t <= zero:
            out[k] = top[k]
        elif t >= one:
            out[k] = value[k]
        else:
            w = t * t * (three - (t + t))
            out[k] = w * value[k] + (one - w) * top[k]


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def columns(kx: cython.pointer[real], weights: cython.pointer[real], nx: cython.int) -> cython.void:
    """Turn the taps of a tile's columns from (n, 4) into 4 × 8, the last column repeated."""
    c: cython.int
    k: cython.int
    i: cython.int
    for c in range(8):
        k = c if c < nx else nx - 1
        for i in range(4):
            kx[8 * i + c] = weights[4 * k + i]


def expand(
    samples: real[:, ::1], begin: cython.int, x_first: cython.int[::1], xw: real[:, ::1], out: real[:, ::1]
) -> None:
    """The horizontal half of the separable pass, for the rows of samples from `begin` on, clamped, as many as out has.

    xw: (4, n) weights of each column of output. out: (rows, n).
    """
    row: cython.Py_ssize_t
    x: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.int
    n: cython.Py_ssize_t = out.shape[1]
    w: cython.int = cython.cast(cython.int, samples.shape[1])
    h: cython.int = cython.cast(cython.int, samples.shape[0])
    stop: cython.Py_ssize_t
    f0: real
    f1: real
    f2: real
    f3: real
    with cython.nogil:
        for row in range(out.shape[0]):
            i = begin + row
            i = 0 if i < 0 else (h - 1 if i >= h else i)
            x = 0
            while x < n:
                j = x_first[x]
                stop = x + 1
                while stop < n and x_first[stop] == j:
                    stop += 1
                f0 = samples[i, 0 if j < 0 else (w - 1 if j >= w else j)]
                f1 = samples[i, 0 if j < -1 else (w - 1 if j + 1 >= w else j + 1)]
                f2 = samples[i, 0 if j < -2 else (w - 1 if j + 2 >= w else j + 2)]
                f3 = samples[i, 0 if j < -3 else (w - 1 if j + 3 >= w else j + 3)]
                while x < stop:
                    out[row, x] = f0 * xw[0, x] + f1 * xw[1, x] + f2 * xw[2, x] + f3 * xw[3, x]
                    x += 1


def combine(
    expanded: real[:, ::1],
    begin: cython.int,
    y_first: cython.int[::1],
    yw: real[:, ::1],
    maxval: real,
    out: stored[:, ::1],
) -> None:
    """The vertical half: every row of output from four rows expanded, of which the first is sample row `begin`."""
    y: cython.Py_ssize_t
    i: cython.Py_ssize_t
    with cython.nogil:
        for y in range(out.shape[0]):
            i = y_first[y] - begin
            combine_row(
                cython.address(expanded[i, 0]), cython.address(expanded[i + 1, 0]),
                cython.address(expanded[i + 2, 0]), cython.address(expanded[i + 3, 0]),
                yw[y, 0], yw[y, 1], yw[y, 2], yw[y, 3], maxval, out.shape[1], cython.address(out[y, 0]),
            )  # fmt: skip


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def combine_row(
    f0: cython.pointer[real],
    f1: cython.pointer[real],
    f2: cython.pointer[real],
    f3: cython.pointer[real],
    w0: real,
    w1: real,
    w2: real,
    w3: real,
    maxval: real,
    n: cython.Py_ssize_t,
    out: cython.pointer[stored],
) -> cython.void:
    """One row: Σ w f, stored as `keep` stores."""
    x: cython.Py_ssize_t
    v: real
    half: real = 0.5
    zero: real = 0
    for x in range(n):
        v = f0[x] * w0 + f1[x] * w1 + f2[x] * w2 + f3[x] * w3
        if stored is cython.double:
            out[x] = v
        else:
            v = v if v > zero else zero
            v = v if v < maxval else maxval
            out[x] = cython.cast(cython.int, v + half)


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

    x: (n,) positions of the columns, sample units. xc, xb: (n, 4) taps. x_cell, x_begin: (t,), (t + 1,) the cell and
    the first column of each tile, left to right. The same for y. out: (rows, n).
    """
    a: cython.Py_ssize_t
    b: cython.Py_ssize_t
    r: cython.int
    c: cython.int
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
                    cython.address(xc[x_begin[b], 0]), cython.address(xb[x_begin[b], 0]),
                    cython.address(yc[y_begin[a], 0]), cython.address(yb[y_begin[a], 0]),
                    radius, only_b, values,
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
