# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The reconstruction near edges: equation 5 for the pixels of one tile after the other, by rows of eight.

In double, or for 8-bit output in float, of which a vector holds twice as many; what pixels see is exact in both. A row
is `row` vectors: two of floats, four of doubles.
"""

import cython
from cython.cimports.libc.string import memcmp, memcpy
from cython.cimports.penink_cli.reconstruction._desk import Desk
from cython.cimports.penink_cli.reconstruction._lanes import (
    Four,
    Lanes,
    Two,
    above,
    chosen,
    fill,
    keep_bytes,
    lane,
    lanes_at,
    less,
    lowest,
    more,
)
from cython.cimports.penink_cli.reconstruction._shade import attenuate
from cython.cimports.penink_cli.reconstruction._tile import Tile

COMPILED = cython.compiled

real = cython.fused_type(cython.float, cython.double)
stored = cython.fused_type(cython.uchar, cython.ushort, cython.double)

T1 = cython.declare(cython.double, 0.5)  # below this sum of cubic weights the B-spline is blended in
T2 = cython.declare(cython.double, 1e-4)  # below this sum of B-spline weights plain convolution is faded in


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def multiply(bits: cython.pointer[Lanes], desk: Desk, kernel: cython.int, samples: cython.int) -> cython.void:
    """Fill in the weights of some samples at each pixel, where they are not known."""
    s: cython.int
    r: cython.Py_ssize_t
    h: cython.Py_ssize_t
    row: cython.Py_ssize_t = 2 if Lanes is Four else 4
    y: Lanes
    column: cython.pointer[Lanes]
    out: cython.pointer[Lanes]
    ky: cython.pointer[Lanes] = lanes_at(desk.ky, bits) + 32 * kernel
    samples &= ~desk.known_weights[kernel]
    desk.known_weights[kernel] |= samples
    while samples:
        s = lowest(samples)
        samples &= samples - 1
        column = lanes_at(desk.kx, bits) + row * (4 * kernel + (s & 3))
        out = lanes_at(desk.weights, bits) + 8 * row * (16 * kernel + s)
        for r in range(8):
            y = ky[4 * r + (s >> 2)]
            for h in range(row):
                out[row * r + h] = y * column[h]


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def add_up(
    bits: cython.pointer[Lanes],
    desk: Desk,
    kernel: cython.int,
    r: cython.int,
    shaded: cython.int,
    faded: cython.int,
    weights: cython.pointer[Lanes],
    alpha: cython.pointer[Lanes],
    top: cython.pointer[Lanes],
    bottom: cython.pointer[Lanes],
) -> cython.void:
    """Numerator and denominator of equation 5 for row r of the pixels, kernel 0 the cubic, 1 the B-spline.

    Samples that all of them see are summed as separable; `faded` are those of the others that count somewhere.
    weights, alpha: of this row of pixels for the first sample; those for the others follow 64 numbers apart.
    """
    i: cython.int
    j: cython.int
    s: cython.int
    h: cython.Py_ssize_t
    row: cython.Py_ssize_t = 2 if Lanes is Four else 4
    half: cython.Py_ssize_t = 1 if Lanes is Four else 2
    w: Lanes
    f: Lanes
    y: Lanes
    sums: Lanes[2]  # for each column of samples, those of weight times value
    ones: Lanes[2]  # and of the weights
    t: Lanes[4]
    b: Lanes[4]
    mask: cython.pointer[Lanes]
    kx: cython.pointer[Lanes] = lanes_at(desk.kx, bits) + 4 * row * kernel
    ky: cython.pointer[Lanes] = lanes_at(desk.ky, bits) + 4 * (8 * kernel + r)
    values: cython.pointer[Lanes] = lanes_at(desk.values, bits)
    spread: cython.pointer[Lanes] = lanes_at(desk.spread, bits)
    for h in range(half):
        fill(cython.address(sums[h]), 0.0)
        fill(cython.address(ones[h]), 0.0)
    shaded = ~shaded
    for j in range(4):
        mask = bits + row * ((shaded >> (4 * j)) & 15)
        y = ky[j]
        for h in range(half):
            w = y * mask[h]
            ones[h] = ones[h] + w
            sums[h] = sums[h] + w * values[half * j + h]
    f = lane(sums, 0)
    y = lane(ones, 0)
    for h in range(row):
        t[h] = f * kx[h]
        b[h] = y * kx[h]
    for i in range(1, 4):
        f = lane(sums, i)
        y = lane(ones, i)
        for h in range(row):
            t[h] = t[h] + f * kx[row * i + h]
            b[h] = b[h] + y * kx[row * i + h]
    while faded:
        s = lowest(faded)
        faded &= faded - 1
        f = spread[s]
        for h in range(row):
            w = weights[8 * row * s + h] * alpha[8 * row * s + h]
            b[h] = b[h] + w
            t[h] = t[h] + w * f
    for h in range(row):
        top[h] = t[h]
        bottom[h] = b[h]


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def any_below(v: cython.pointer[Lanes], limit: Lanes) -> cython.bint:
    """Whether any number of a row is below the limit."""
    h: cython.Py_ssize_t
    row: cython.Py_ssize_t = 2 if Lanes is Four else 4
    found: cython.int = 0
    for h in range(row):
        found |= above(limit, v[h])
    return found != 0


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def smooth(t: Lanes, one: Lanes) -> Lanes:
    """S(t) = 3t² − 2t³ on 0 … 1, clamped."""
    three: Lanes
    t = less(t, one)
    t = more(t, one - one)
    fill(cython.address(three), 3.0)
    return t * t * (three - (t + t))


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def blend(
    bits: cython.pointer[Lanes], desk: Desk, r: cython.int, only_b: cython.bint, out: cython.pointer[Lanes]
) -> cython.void:
    """The values of row r of a tile that is attenuated."""
    h: cython.Py_ssize_t
    row: cython.Py_ssize_t = 2 if Lanes is Four else 4
    top: Lanes[4]
    bottom: Lanes[4]
    top_b: Lanes[4]
    bottom_b: Lanes[4]
    w: Lanes
    one: Lanes
    half: Lanes
    threshold: Lanes
    weights: cython.pointer[Lanes] = lanes_at(desk.weights, bits) + row * r
    alpha: cython.pointer[Lanes] = lanes_at(desk.alpha, bits) + row * r
    fill(cython.address(one), 1.0)
    fill(cython.address(half), T1)
    fill(cython.address(threshold), T2)
    if not only_b:
        add_up(bits, desk, 0, r, desk.shaded[r], desk.faded[r], weights, alpha, top, bottom)
        if not any_below(bottom, half):
            for h in range(row):
                out[h] = top[h] / bottom[h]
            return
    multiply(bits, desk, 1, desk.faded[r])
    add_up(bits, desk, 1, r, desk.shaded[r], desk.faded[r], weights + 128 * row, alpha, top_b, bottom_b)
    for h in range(row):
        if only_b:
            out[h] = top_b[h] / bottom_b[h]
        else:
            w = smooth(bottom[h] / half, one)  # ω = S(den / T1)
            out[h] = (w * top[h] + (one - w) * top_b[h]) / (w * bottom[h] + (one - w) * bottom_b[h])
    if any_below(bottom_b, threshold):  # starved: plain convolution, across the edges
        add_up(bits, desk, 1 if only_b else 0, r, 0, 0, weights, alpha, top, bottom)
        for h in range(row):
            w = smooth(bottom_b[h] / threshold, one)
            out[h] = chosen(bottom_b[h], w * out[h] + (one - w) * top[h], top[h])


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def keep(
    values: cython.pointer[Lanes], n: cython.int, maxval: cython.double, out: cython.pointer[stored]
) -> cython.void:
    """Store n values of a row: clamped and rounded half up, or in double as they are."""
    c: cython.int
    h: cython.Py_ssize_t
    row: cython.Py_ssize_t = 2 if Lanes is Four else 4
    v: cython.double
    most: Lanes
    zero: Lanes
    clamped: Lanes[4]
    eight: cython.uchar[8]
    fill(cython.address(most), maxval)
    fill(cython.address(zero), 0.0)
    for h in range(row):
        clamped[h] = values[h] if stored is cython.double else less(more(values[h], zero), most)
    if Lanes is Four and stored is cython.uchar:
        keep_bytes(clamped[0], clamped[1], out if n == 8 else eight)
        if n < 8:
            memcpy(out, eight, n)
    else:
        for c in range(n):
            if Lanes is Four:
                v = cython.cast(cython.p_float, clamped)[c]
            else:
                v = cython.cast(cython.p_double, clamped)[c]
            if stored is cython.double:
                out[c] = v
            else:
                out[c] = cython.cast(cython.int, v + 0.5)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def lay_out_rows(
    bits: cython.pointer[Lanes],
    desk: Desk,
    tile: Tile,
    yc: cython.pointer[real],
    yb: cython.pointer[real],
    radius: cython.double,
) -> cython.void:
    """Lay ready what belongs to the rows of pixels of a tile; yc, yb: (8, 4) weights. `bits` only tells the lanes."""
    k: cython.int
    uy: Lanes[8]
    ky: Lanes[64]
    for k in range(64):
        fill(ky + k, 0.0)
    for k in range(4 * tile.ny):
        fill(ky + k, yc[k])
        fill(ky + 32 + k, yb[k])
    if memcmp(desk.ky, ky, 64 * cython.sizeof(ky[0])) != 0:
        memcpy(desk.ky, ky, 64 * cython.sizeof(ky[0]))
        desk.known_weights[0] = desk.known_weights[1] = 0
    for k in range(8):
        fill(uy + k, (tile.py[k if k < tile.ny else 0] - tile.cy) / radius)
    if memcmp(desk.uy, uy, 8 * cython.sizeof(uy[0])) != 0:
        memcpy(desk.uy, uy, 8 * cython.sizeof(uy[0]))
        desk.known = 0


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def lay_out(
    desk: Desk,
    tile: Tile,
    samples: cython.pointer[real],
    xc: cython.pointer[real],
    xb: cython.pointer[real],
    stride: cython.Py_ssize_t,
    ux: cython.pointer[real],
) -> cython.void:
    """Lay ready the samples of a tile, and what belongs to its columns; what is beyond them belongs to the next."""
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    f: cython.pointer[real]
    columns: cython.pointer[real]
    kx: cython.pointer[real]
    values: cython.pointer[real]
    if real is cython.float:
        kx = cython.cast(cython.p_float, desk.kx)
        values = cython.cast(cython.p_float, desk.values)
    else:
        kx = cython.cast(cython.p_double, desk.kx)
        values = cython.cast(cython.p_double, desk.values)
    for i in range(8):
        columns = xc + stride * i if i < 4 else xb + stride * (i - 4)
        if memcmp(kx + 8 * i, columns, 8 * cython.sizeof(xc[0])) != 0:
            memcpy(kx + 8 * i, columns, 8 * cython.sizeof(xc[0]))
            desk.known_weights[0] = desk.known_weights[1] = 0
    if memcmp(desk.ux, ux, 8 * cython.sizeof(xc[0])) != 0:
        memcpy(desk.ux, ux, 8 * cython.sizeof(xc[0]))
        desk.known = 0
    for j in range(4):
        f = samples + cython.cast(cython.Py_ssize_t, tile.row[j]) * tile.scene.width
        for i in range(4):
            values[4 * j + i] = f[tile.column[i]]


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def paint(
    bits: cython.pointer[Lanes],
    desk: Desk,
    tile: Tile,
    radius: cython.double,
    only_b: cython.bint,
    maxval: cython.double,
    out: cython.pointer[stored],
    stride: cython.Py_ssize_t,
) -> cython.void:
    """Reconstruct a tile that `see` found edges in."""
    r: cython.int
    values: Lanes[4]
    attenuate(bits, desk, tile, radius)
    multiply(bits, desk, 0, tile.shaded)
    for r in range(tile.ny):
        blend(bits, desk, r, only_b, values)
        keep(values, tile.nx, maxval, out + stride * r)


def retouch(
    tile: Tile,
    desk: Desk,
    samples: real[:, ::1],
    x: cython.double[::1],
    ux: real[::1],
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

    x: (n + 8,) positions of the columns, sample units; ux: the same relative to the cell and in units of the radius.
    xc, xb: (4, n + 8) taps. x_cell, x_begin: (t,), (t + 1,) the cell and the first column of each tile, left to right.
    For y likewise, but (rows, 4) taps. out: (rows, n).
    """
    a: cython.Py_ssize_t
    b: cython.Py_ssize_t
    c: cython.Py_ssize_t
    four: cython.pointer[Four] = cython.cast(cython.pointer[Four], desk.bits)
    two: cython.pointer[Two] = cython.cast(cython.pointer[Two], desk.bits)
    at: cython.pointer[stored]
    with cython.nogil:
        for a in range(y_cell.shape[0]):
            c = y_begin[a]
            tile.place_in_row(y_cell[a], cython.address(y[c]), y_begin[a + 1] - y_begin[a])
            if real is cython.float:
                lay_out_rows(four, desk, tile, cython.address(yc[c, 0]), cython.address(yb[c, 0]), radius)
            else:
                lay_out_rows(two, desk, tile, cython.address(yc[c, 0]), cython.address(yb[c, 0]), radius)
            for b in range(x_cell.shape[0]):
                if tile.scene.empty_around(x_cell[b], y_cell[a]):
                    continue
                c = x_begin[b]
                tile.place(x_cell[b], cython.address(x[c]), x_begin[b + 1] - x_begin[b])
                if not tile.see():
                    continue
                lay_out(
                    desk, tile, cython.address(samples[0, 0]), cython.address(xc[0, c]), cython.address(xb[0, c]),
                    xc.shape[1], cython.address(ux[c]),
                )  # fmt: skip
                at = cython.address(out[y_begin[a], c])
                if real is cython.float:
                    paint(four, desk, tile, radius, only_b, maxval, at, out.shape[1])
                else:
                    paint(two, desk, tile, radius, only_b, maxval, at, out.shape[1])
