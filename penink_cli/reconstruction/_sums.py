# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The arithmetic of equation 5: the weighted sums of the samples at each pixel of a tile.

As in `_fades` by vectors of doubles or floats, and likewise compiled again for wider ones. A *strip* is a row of eight
pixels, or the two of them that a vector of sixteen holds.
"""

import cython
from cython.cimports.libc.string import memcpy
from cython.cimports.penink_cli.reconstruction._desk import Desk
from cython.cimports.penink_cli.reconstruction._lanes import (
    DOUBLES,
    FLOATS,
    FOUR_QUADS,
    Columns,
    Doubles,
    Floats,
    Four,
    Lanes,
    Quads,
    above,
    by_column,
    by_row,
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
    number_at,
    spread,
    turn_sets,
    vectors,
)

COMPILED = cython.compiled

stored = cython.fused_type(cython.uchar, cython.ushort, cython.double)

T1 = cython.declare(cython.double, 0.5)  # below this sum of cubic weights the B-spline is blended in
T2 = cython.declare(cython.double, 1e-4)  # below this sum of B-spline weights plain convolution is faded in


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def rows_of_strip(like: cython.pointer[Lanes]) -> cython.int:
    """How many rows a strip has."""
    if Lanes is Floats:
        return FLOATS // 8 if FLOATS > 8 else 1
    else:
        return DOUBLES // 8 if DOUBLES > 8 else 1


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def multiply(like: cython.pointer[Lanes], desk: Desk, kernel: cython.int, samples: cython.int) -> cython.void:
    """Fill in the weights of some samples at each pixel, where they are not known."""
    s: cython.int
    k: cython.int
    n: cython.int = vectors(8, like)
    columns: cython.p_void
    rows: cython.p_void
    out: cython.pointer[Lanes]
    samples &= ~desk.known_weights[kernel]
    desk.known_weights[kernel] |= samples
    while samples:
        s = lowest(samples)
        samples &= samples - 1
        columns = number_at(desk.kx, 32 * kernel + 8 * (s & 3), like)
        rows = number_at(desk.ky, 32 * kernel + (s >> 2), like)
        out = lanes_at(desk.weights, like) + n * (16 * kernel + s)
        for k in range(n):
            out[k] = by_row(rows, k, 4, like) * by_column(columns, k, like)


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
    half: cython.Py_ssize_t = 1 if Columns is Four else FOUR_QUADS
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
    row: cython.int,
    shaded: cython.p_int,
    top: cython.pointer[Lanes],
    bottom: cython.pointer[Lanes],
) -> cython.void:
    """Numerator and denominator of equation 5 for the strip that begins at a row, over the samples all of a row see.

    kernel: 0 the cubic, 1 the B-spline. These samples are summed as separable. shaded: the others, for each row.
    top, bottom: of the whole tile.
    """
    i: cython.int
    k: cython.int
    r: cython.int
    first: cython.int = vectors(row, like)
    f: Lanes
    y: Lanes
    x: Lanes
    sums: cython.double[8]  # room for four of either, for each row
    ones: cython.double[8]
    columns: cython.p_void
    for r in range(rows_of_strip(like)):
        if Lanes is Floats:
            add_columns(
                desk, 32 * kernel + 4 * (row + r), ~shaded[row + r],
                cython.cast(cython.pointer[Four], number_at(sums, 4 * r, like)),
                cython.cast(cython.pointer[Four], number_at(ones, 4 * r, like)),
            )  # fmt: skip
        else:
            add_columns(
                desk, 32 * kernel + 4 * (row + r), ~shaded[row + r],
                cython.cast(cython.pointer[Quads], number_at(sums, 4 * r, like)),
                cython.cast(cython.pointer[Quads], number_at(ones, 4 * r, like)),
            )  # fmt: skip
    for i in range(4):
        columns = number_at(desk.kx, 32 * kernel + 8 * i, like)
        f = by_row(number_at(sums, i, like), 0, 4, like)
        y = by_row(number_at(ones, i, like), 0, 4, like)
        for k in range(vectors(rows_of_strip(like), like)):
            x = by_column(columns, k, like)
            top[first + k] = f * x if i == 0 else top[first + k] + f * x
            bottom[first + k] = y * x if i == 0 else bottom[first + k] + y * x


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
    top: cython.pointer[Lanes],
    bottom: cython.pointer[Lanes],
) -> cython.void:
    """Add one of the other samples to numerator and denominator, for vectors begin … end of the tile."""
    k: cython.int
    w: Lanes
    f: Lanes = number(desk.values, s, like)
    weights: cython.pointer[Lanes] = lanes_at(desk.weights, like) + vectors(8, like) * (16 * kernel + s)
    alpha: cython.pointer[Lanes] = lanes_at(desk.alpha, like) + vectors(8, like) * s
    for k in range(begin, end):
        w = weights[k] * alpha[k]
        bottom[k] = bottom[k] + w
        top[k] = top[k] + w * f


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def any_below(v: cython.pointer[Lanes], begin: cython.int, end: cython.int, limit: Lanes) -> cython.bint:
    """Whether any number of vectors begin … end is below the limit."""
    k: cython.int
    least: Lanes = v[begin]
    for k in range(begin + 1, end):
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
@cython.nogil
@cython.exceptval(check=False)
def blend(
    like: cython.pointer[Lanes],
    desk: Desk,
    row: cython.int,
    shaded: cython.p_int,
    faded: cython.int,
    top: cython.pointer[Lanes],
    bottom: cython.pointer[Lanes],
    out: cython.pointer[Lanes],
) -> cython.void:
    """The values of the strip that begins at a row, where the sums over the cubic's weights do not do.

    faded: the samples that count somewhere in the strip, but not everywhere. top, bottom, out: of the whole tile.
    """
    k: cython.int
    begin: cython.int = vectors(row, like)
    end: cython.int = begin + vectors(rows_of_strip(like), like)
    none: cython.int[8]
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
    add_seen(like, desk, 1, row, shaded, top_b, bottom_b)
    while faded:
        add_faded(like, desk, 1, lowest(faded), begin, end, top_b, bottom_b)
        faded &= faded - 1
    for k in range(begin, end):
        if desk.only_b:
            out[k] = top_b[k] / bottom_b[k]
        else:
            w = smooth(bottom[k] / half, one)  # ω = S(den / T1)
            out[k] = (w * top[k] + (one - w) * top_b[k]) / (w * bottom[k] + (one - w) * bottom_b[k])
    if any_below(bottom_b, begin, end, threshold):  # starved: plain convolution, across the edges
        for k in range(8):
            none[k] = 0
        add_seen(like, desk, 1 if desk.only_b else 0, row, none, top, bottom)
        for k in range(begin, end):
            w = smooth(bottom_b[k] / threshold, one)
            out[k] = chosen(bottom_b[k], w * out[k] + (one - w) * top[k], top[k])


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def keep(like: cython.pointer[Lanes], values: cython.p_void, n: cython.int, out: cython.pointer[stored]) -> cython.void:
    """Store n values of a row, clamped before: rounded half up, or in double as they are."""
    c: cython.int
    v: cython.double
    eight: cython.uchar[8]
    if Lanes is Floats and stored is cython.uchar:
        keep_bytes(cython.cast(cython.p_float, values), out if n == 8 else eight)
        if n < 8:
            memcpy(out, eight, n)
    else:
        for c in range(n):
            if Lanes is Floats:
                v = cython.cast(cython.p_float, values)[c]
            else:
                v = cython.cast(cython.p_double, values)[c]
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
    k: cython.int
    n: cython.int = vectors(ny, like)
    rows: cython.int = rows_of_strip(like)
    strips: cython.int = (ny + rows - 1) // rows
    half: Lanes
    zero: Lanes
    most: Lanes
    values: Lanes[32]
    top: Lanes[32]
    bottom: Lanes[32]
    shaded: cython.int[8]
    faded: cython.int[8]
    fill(cython.address(half), T1)
    fill(cython.address(zero), 0.0)
    fill(cython.address(most), desk.maxval)
    turn_sets(desk.shaded_rows, shaded)
    if not desk.only_b:
        multiply(like, desk, 0, samples)
        for r in range(strips):
            add_seen(like, desk, 0, rows * r, shaded, top, bottom)
        while samples:
            s = lowest(samples)
            samples &= samples - 1
            if desk.faded_rows[s]:
                add_faded(like, desk, 0, s, 0, n, top, bottom)
        for k in range(n):
            values[k] = top[k] / bottom[k]
    if desk.only_b or any_below(bottom, 0, n, half):
        turn_sets(desk.faded_rows, faded)
        for r in range(strips):
            k = vectors(rows * r, like)
            s = faded[rows * r] | faded[rows * r + rows - 1]
            if desk.only_b or any_below(bottom, k, k + vectors(rows, like), half):
                blend(like, desk, rows * r, shaded, s, top, bottom, values)
    if stored is not cython.double:
        for k in range(n):
            values[k] = less(more(values[k], zero), most)
    for r in range(ny):
        keep(like, number_at(values, 8 * r, like), nx, out + stride * r)


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
