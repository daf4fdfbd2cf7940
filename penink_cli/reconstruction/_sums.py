# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The arithmetic of equation 5: the weighted sums of the samples at each pixel of a tile, by rows of eight.

As in `_fades`, by vectors of doubles or floats, and likewise compiled once more for AVX2, as `_sums_avx2`.
"""

import cython
from cython.cimports.libc.string import memcpy
from cython.cimports.penink_cli.reconstruction._desk import Desk
from cython.cimports.penink_cli.reconstruction._lanes import (
    FOUR_DOUBLES,
    ROW_OF_DOUBLES,
    ROW_OF_FLOATS,
    Columns,
    Doubles,
    Floats,
    Four,
    Lanes,
    above,
    chosen,
    columns_at,
    ease,
    fill,
    keep_bytes,
    lanes_at,
    less,
    lowest,
    more,
    number,
    spread,
    turn_sets,
)

COMPILED = cython.compiled

stored = cython.fused_type(cython.uchar, cython.ushort, cython.double)

T1 = cython.declare(cython.double, 0.5)  # below this sum of cubic weights the B-spline is blended in
T2 = cython.declare(cython.double, 1e-4)  # below this sum of B-spline weights plain convolution is faded in


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def multiply(like: cython.pointer[Lanes], desk: Desk, kernel: cython.int, samples: cython.int) -> cython.void:
    """Fill in the weights of some samples at each pixel, where they are not known."""
    s: cython.int
    r: cython.Py_ssize_t
    h: cython.Py_ssize_t
    row: cython.Py_ssize_t = ROW_OF_FLOATS if Lanes is Floats else ROW_OF_DOUBLES
    y: Lanes
    column: cython.pointer[Lanes]
    out: cython.pointer[Lanes]
    samples &= ~desk.known_weights[kernel]
    desk.known_weights[kernel] |= samples
    while samples:
        s = lowest(samples)
        samples &= samples - 1
        column = lanes_at(desk.kx, like) + row * (4 * kernel + (s & 3))
        out = lanes_at(desk.weights, like) + 8 * row * (16 * kernel + s)
        for r in range(8):
            y = number(desk.ky, 32 * kernel + 4 * r + (s >> 2), like)
            for h in range(row):
                out[row * r + h] = y * column[h]


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def add_columns(
    desk: Desk,
    weights: cython.int,
    seen: cython.int,
    sums: cython.pointer[Columns],
    ones: cython.pointer[Columns],
) -> cython.void:
    """For each column of samples Σ weight · value, and of the weights, over its samples that are seen.

    weights: where in `ky` those of the four rows of samples are.
    """
    j: cython.int
    h: cython.Py_ssize_t
    half: cython.Py_ssize_t = 1 if Columns is Four else FOUR_DOUBLES
    zero: cython.double = 0.0  # in float, too
    y: Columns
    w: Columns
    mask: cython.pointer[Columns]
    values: cython.pointer[Columns] = columns_at(desk.values, sums)
    for h in range(half):
        sums[h] = ones[h] = spread(cython.address(zero), 0, sums)
    for j in range(4):
        y = spread(desk.ky, weights + j, sums)
        mask = columns_at(desk.bits, sums) + 2 * half * ((seen >> (4 * j)) & 15)
        for h in range(half):
            w = y * mask[h]
            ones[h] = ones[h] + w
            sums[h] = sums[h] + w * values[half * j + h]


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def add_seen(
    like: cython.pointer[Lanes],
    desk: Desk,
    kernel: cython.int,
    r: cython.int,
    shaded: cython.int,
    t: cython.pointer[Lanes],
    b: cython.pointer[Lanes],
) -> cython.void:
    """Numerator and denominator of equation 5 for row r of the pixels, over the samples that all of them see.

    kernel: 0 the cubic, 1 the B-spline. These samples are summed as separable.
    """
    i: cython.int
    h: cython.Py_ssize_t
    row: cython.Py_ssize_t = ROW_OF_FLOATS if Lanes is Floats else ROW_OF_DOUBLES
    f: Lanes
    y: Lanes
    sums: cython.double[4]  # room for four of either
    ones: cython.double[4]
    kx: cython.pointer[Lanes] = lanes_at(desk.kx, like) + 4 * row * kernel
    if Lanes is Floats:
        add_columns(
            desk, 32 * kernel + 4 * r, ~shaded,
            cython.cast(cython.pointer[Four], sums), cython.cast(cython.pointer[Four], ones),
        )  # fmt: skip
    else:
        add_columns(
            desk, 32 * kernel + 4 * r, ~shaded,
            cython.cast(cython.pointer[Doubles], sums), cython.cast(cython.pointer[Doubles], ones),
        )  # fmt: skip
    f = number(sums, 0, like)
    y = number(ones, 0, like)
    for h in range(row):
        t[h] = f * kx[h]
        b[h] = y * kx[h]
    for i in range(1, 4):
        f = number(sums, i, like)
        y = number(ones, i, like)
        for h in range(row):
            t[h] = t[h] + f * kx[row * i + h]
            b[h] = b[h] + y * kx[row * i + h]


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def add_faded(
    like: cython.pointer[Lanes],
    desk: Desk,
    kernel: cython.int,
    s: cython.int,
    begin: cython.int,
    end: cython.int,
    t: cython.pointer[Lanes],
    b: cython.pointer[Lanes],
) -> cython.void:
    """Add one of the other samples to numerator and denominator, in rows begin … end of the pixels."""
    k: cython.Py_ssize_t
    row: cython.Py_ssize_t = ROW_OF_FLOATS if Lanes is Floats else ROW_OF_DOUBLES
    w: Lanes
    f: Lanes = number(desk.values, s, like)
    weights: cython.pointer[Lanes] = lanes_at(desk.weights, like) + 8 * row * (16 * kernel + s)
    alpha: cython.pointer[Lanes] = lanes_at(desk.alpha, like) + 8 * row * s
    for k in range(row * begin, row * end):
        w = weights[k] * alpha[k]
        b[k] = b[k] + w
        t[k] = t[k] + w * f


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def any_below(v: cython.pointer[Lanes], n: cython.Py_ssize_t, limit: Lanes) -> cython.bint:
    """Whether any number of some vectors is below the limit."""
    k: cython.Py_ssize_t
    least: Lanes = v[0]
    for k in range(1, n):
        least = less(v[k], least)
    return above(limit, least) != 0


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def smooth(t: Lanes, one: Lanes) -> Lanes:
    """S(t) = 3t² − 2t³ on 0 … 1, clamped."""
    three: Lanes
    fill(cython.address(three), 3.0)
    return ease(t, one - one, one, three)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def blend(
    like: cython.pointer[Lanes],
    desk: Desk,
    r: cython.int,
    shaded: cython.int,
    faded: cython.int,
    top: cython.pointer[Lanes],
    bottom: cython.pointer[Lanes],
    out: cython.pointer[Lanes],
) -> cython.void:
    """The values of row r of a tile, where the sums over the cubic's weights are wanting; top, bottom: of all rows."""
    h: cython.Py_ssize_t
    row: cython.Py_ssize_t = ROW_OF_FLOATS if Lanes is Floats else ROW_OF_DOUBLES
    top_b: Lanes[32]
    bottom_b: Lanes[32]
    w: Lanes
    one: Lanes
    half: Lanes
    threshold: Lanes
    fill(cython.address(one), 1.0)
    fill(cython.address(half), T1)
    fill(cython.address(threshold), T2)
    multiply(like, desk, 1, faded)
    add_seen(like, desk, 1, r, shaded, top_b + row * r, bottom_b + row * r)
    while faded:
        add_faded(like, desk, 1, lowest(faded), r, r + 1, top_b, bottom_b)
        faded &= faded - 1
    for h in range(row * r, row * r + row):
        if desk.only_b:
            out[h] = top_b[h] / bottom_b[h]
        else:
            w = smooth(bottom[h] / half, one)  # ω = S(den / T1)
            out[h] = (w * top[h] + (one - w) * top_b[h]) / (w * bottom[h] + (one - w) * bottom_b[h])
    if any_below(bottom_b + row * r, row, threshold):  # starved: plain convolution, across the edges
        add_seen(like, desk, 1 if desk.only_b else 0, r, 0, top + row * r, bottom + row * r)
        for h in range(row * r, row * r + row):
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
    row: cython.Py_ssize_t = ROW_OF_FLOATS if Lanes is Floats else ROW_OF_DOUBLES
    v: cython.double
    most: Lanes
    zero: Lanes
    clamped: Lanes[4]
    eight: cython.uchar[8]
    fill(cython.address(most), maxval)
    fill(cython.address(zero), 0.0)
    for h in range(row):
        clamped[h] = values[h] if stored is cython.double else less(more(values[h], zero), most)
    if Lanes is Floats and stored is cython.uchar:
        keep_bytes(clamped, out if n == 8 else eight)
        if n < 8:
            memcpy(out, eight, n)
    else:
        for c in range(n):
            if Lanes is Floats:
                v = cython.cast(cython.p_float, clamped)[c]
            else:
                v = cython.cast(cython.p_double, clamped)[c]
            if stored is cython.double:
                out[c] = v
            else:
                out[c] = cython.cast(cython.int, v + 0.5)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def paint(
    like: cython.pointer[Lanes],
    desk: Desk,
    samples: cython.int,
    nx: cython.int,
    ny: cython.int,
    out: cython.pointer[stored],
    stride: cython.Py_ssize_t,
) -> cython.void:
    """Reconstruct a tile, some samples of which `cover` or `fade` have attenuated; the others count fully."""
    r: cython.int
    s: cython.int
    k: cython.Py_ssize_t
    row: cython.Py_ssize_t = ROW_OF_FLOATS if Lanes is Floats else ROW_OF_DOUBLES
    half: Lanes
    values: Lanes[32]
    top: Lanes[32]
    bottom: Lanes[32]
    shaded: cython.int[8]
    faded: cython.int[8]
    turn_sets(desk.shaded_rows, shaded)
    if not desk.only_b:
        multiply(like, desk, 0, samples)
        for r in range(ny):
            add_seen(like, desk, 0, r, shaded[r], top + row * r, bottom + row * r)
        while samples:
            s = lowest(samples)
            samples &= samples - 1
            if desk.faded_rows[s]:
                add_faded(like, desk, 0, s, 0, ny, top, bottom)
    fill(cython.address(half), T1)
    if desk.only_b or any_below(bottom, row * ny, half):
        turn_sets(desk.faded_rows, faded)
        for r in range(ny):
            if desk.only_b or any_below(bottom + row * r, row, half):
                blend(like, desk, r, shaded[r], faded[r], top, bottom, values)
            else:
                for k in range(row * r, row * r + row):
                    values[k] = top[k] / bottom[k]
    else:
        for k in range(row * ny):
            values[k] = top[k] / bottom[k]
    for r in range(ny):
        keep(values + row * r, nx, desk.maxval, out + stride * r)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def paint_tile(
    desk: Desk, samples: cython.int, nx: cython.int, ny: cython.int, out: cython.p_void, stride: cython.Py_ssize_t
) -> cython.void:
    """`paint` in the desk's numbers; stride: of the rows of output, in its numbers."""
    floats: cython.pointer[Floats] = cython.cast(cython.pointer[Floats], desk.bits)
    doubles: cython.pointer[Doubles] = cython.cast(cython.pointer[Doubles], desk.bits)
    if desk.single and desk.stored == 1:
        paint(floats, desk, samples, nx, ny, cython.cast(cython.p_uchar, out), stride)
    elif desk.single:
        paint(floats, desk, samples, nx, ny, cython.cast(cython.p_double, out), stride)
    elif desk.stored == 2:
        paint(doubles, desk, samples, nx, ny, cython.cast(cython.p_ushort, out), stride)
    else:
        paint(doubles, desk, samples, nx, ny, cython.cast(cython.p_double, out), stride)


def furnish(desk: Desk) -> None:
    """Have a desk's tiles summed up here."""
    desk.paint = paint_tile
