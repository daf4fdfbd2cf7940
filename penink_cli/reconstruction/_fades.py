# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The arithmetic of equation 4: how much a sample counts at each pixel of a tile, by rows of eight, as vectors.

In double, or for 8-bit output in float, of which a vector holds twice as many; what pixels see is exact in both. A row
is `row` vectors: with SSE2 two of floats, four of doubles. `_fades_avx2` is this file once more, compiled for AVX2,
which holds twice as many again: the same numbers, each rounded alike, so the same bytes.

Lengths are in units of the radius. A parameter `like` tells the lanes, and points to the desk's `bits`.
"""

import cython
from cython.cimports.penink_cli.reconstruction._desk import Desk
from cython.cimports.penink_cli.reconstruction._lanes import (
    ROW_OF_DOUBLES,
    ROW_OF_FLOATS,
    Doubles,
    Floats,
    Lanes,
    ease,
    fill,
    lanes_at,
    less,
    number,
    root,
)

COMPILED = cython.compiled

FAR = cython.declare(cython.double, 1e30)  # a distance no path has


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def measure(
    like: cython.pointer[Lanes],
    desk: Desk,
    slot: cython.int,
    ny: cython.int,
    x: cython.double,
    y: cython.double,
) -> cython.void:
    """Distance of each pixel of the tile from a node, FAR from where it is not seen."""
    r: cython.Py_ssize_t
    h: cython.Py_ssize_t
    row: cython.Py_ssize_t = ROW_OF_FLOATS if Lanes is Floats else ROW_OF_DOUBLES
    vx: Lanes
    vy: Lanes
    far: Lanes
    down: Lanes
    across: Lanes[4]
    veil: cython.pointer[Lanes]
    ux: cython.pointer[Lanes] = lanes_at(desk.ux, like)
    out: cython.pointer[Lanes] = lanes_at(desk.nodes, like) + 8 * row * slot
    seen: cython.ulonglong = desk.node_mask[slot]
    fill(cython.address(vx), x)
    fill(cython.address(vy), y)
    fill(cython.address(far), FAR)
    for h in range(row):
        across[h] = (ux[h] - vx) * (ux[h] - vx)
    for r in range(ny):
        veil = like + row * (~(seen >> (8 * r)) & 255)
        down = number(desk.uy, r, like) - vy
        down = down * down
        for h in range(row):
            out[row * r + h] = root(across[h] + down) + veil[h] * far


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def rows_of(pixels: cython.ulonglong) -> cython.uchar:
    """The rows that a set of pixels touches: the bytes of the word that are not zero, gathered by a multiplication."""
    low: cython.ulonglong = 0x7F7F7F7F7F7F7F7F
    first: cython.ulonglong = 0x0101010101010101
    gather: cython.ulonglong = 0x0102040810204080
    pixels = (((pixels & low) + low) | pixels) >> 7 & first
    return cython.cast(cython.uchar, (pixels * gather) >> 56)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def cover(
    like: cython.pointer[Lanes], desk: Desk, s: cython.int, hidden: cython.ulonglong, nx: cython.int, ny: cython.int
) -> cython.void:
    """Attenuate a sample to which no path bends: it counts where it is seen, and only there; see `fade`."""
    r: cython.Py_ssize_t
    h: cython.Py_ssize_t
    row: cython.Py_ssize_t = ROW_OF_FLOATS if Lanes is Floats else ROW_OF_DOUBLES
    whole: cython.ulonglong = 0x0101010101010101
    touched: Lanes
    bare: cython.pointer[Lanes]
    alpha: cython.pointer[Lanes] = lanes_at(desk.alpha, like) + 8 * row * s
    most: cython.pointer[Lanes] = like + row * rows_of(hidden)
    desk.shaded_rows[s] = rows_of(hidden)
    desk.faded_rows[s] = desk.shaded_rows[s] & rows_of(~hidden & (whole * (255 >> (8 - nx))))
    for r in range(ny):
        bare = like + row * ((hidden & 255) ^ 255)
        hidden >>= 8
        touched = number(most, r, like)
        for h in range(row):
            alpha[row * r + h] = less(bare[h], touched)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def distances(like: cython.pointer[Lanes], desk: Desk, down: cython.int, across: cython.int) -> cython.pointer[Lanes]:
    """How far each pixel is from the sample −1 … 2 down and across the cell."""
    r: cython.Py_ssize_t
    h: cython.Py_ssize_t
    place: cython.int = 4 * down + across + 5
    row: cython.Py_ssize_t = ROW_OF_FLOATS if Lanes is Floats else ROW_OF_DOUBLES
    ux: cython.pointer[Lanes] = lanes_at(desk.ux, like)
    out: cython.pointer[Lanes] = lanes_at(desk.distance, like) + 8 * row * place
    x: Lanes
    y: Lanes
    away: Lanes
    if not (desk.known >> place) & 1:
        desk.known |= 1 << place
        fill(cython.address(x), across / desk.radius)
        fill(cython.address(y), down / desk.radius)
        for r in range(8):
            away = number(desk.uy, r, like) - y
            for h in range(row):
                out[row * r + h] = root((ux[h] - x) * (ux[h] - x) + away * away)
    return out


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def fade(
    like: cython.pointer[Lanes],
    desk: Desk,
    s: cython.int,
    hidden: cython.ulonglong,
    bends: cython.int,
    ny: cython.int,
    down: cython.int,
    across: cython.int,
) -> cython.void:
    """Attenuate the sample so far down and across the cell, which the hidden pixels do not see, by `bends` paths.

    With u = 1 − detour / r clamped to 0 … 1 the attenuation 1 − S(1 − u) is S(u); u is one where nothing is between,
    and zero in rows all of which see the sample, which are summed without. All rows are computed: which ones a shadow
    touches is anyone's guess, and a wrong one costs as much as a row.
    """
    r: cython.Py_ssize_t
    k: cython.Py_ssize_t
    m: cython.int
    h: cython.Py_ssize_t
    row: cython.Py_ssize_t = ROW_OF_FLOATS if Lanes is Floats else ROW_OF_DOUBLES
    one: Lanes
    three: Lanes
    length: Lanes
    touched: Lanes
    bare: cython.pointer[Lanes]
    nodes: cython.pointer[Lanes] = lanes_at(desk.nodes, like)
    near: cython.pointer[Lanes] = nodes + 8 * row * desk.bend[0]
    alpha: cython.pointer[Lanes] = lanes_at(desk.alpha, like) + 8 * row * s
    straight: cython.pointer[Lanes] = distances(like, desk, down, across)
    most: cython.pointer[Lanes] = like + row * rows_of(hidden)
    fill(cython.address(one), 1.0)
    fill(cython.address(three), 3.0)
    fill(cython.address(length), desk.bend_length[0])
    desk.shaded_rows[s] = desk.faded_rows[s] = rows_of(hidden)
    if bends == 1:
        length = length - one
        for r in range(ny):
            bare = like + row * ((hidden & 255) ^ 255)
            hidden >>= 8
            touched = number(most, r, like)
            for h in range(row):
                k = row * r + h
                alpha[k] = ease(straight[k] - (near[k] + length), bare[h], touched, three)
        return
    for k in range(row * ny):
        alpha[k] = near[k] + length
    for m in range(1, bends):
        near = nodes + 8 * row * desk.bend[m]
        fill(cython.address(length), desk.bend_length[m])
        for k in range(row * ny):
            alpha[k] = less(near[k] + length, alpha[k])
    for r in range(ny):
        bare = like + row * ((hidden & 255) ^ 255)
        hidden >>= 8
        touched = number(most, r, like)
        for h in range(row):
            k = row * r + h
            alpha[k] = ease(straight[k] - (alpha[k] - one), bare[h], touched, three)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def measure_node(desk: Desk, slot: cython.int, ny: cython.int, x: cython.double, y: cython.double) -> cython.void:
    """`measure` in the desk's numbers."""
    if desk.single:
        measure(cython.cast(cython.pointer[Floats], desk.bits), desk, slot, ny, x, y)
    else:
        measure(cython.cast(cython.pointer[Doubles], desk.bits), desk, slot, ny, x, y)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def cover_sample(desk: Desk, s: cython.int, hidden: cython.ulonglong, nx: cython.int, ny: cython.int) -> cython.void:
    """`cover` in the desk's numbers."""
    if desk.single:
        cover(cython.cast(cython.pointer[Floats], desk.bits), desk, s, hidden, nx, ny)
    else:
        cover(cython.cast(cython.pointer[Doubles], desk.bits), desk, s, hidden, nx, ny)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def fade_sample(
    desk: Desk,
    s: cython.int,
    hidden: cython.ulonglong,
    bends: cython.int,
    ny: cython.int,
    down: cython.int,
    across: cython.int,
) -> cython.void:
    """`fade` in the desk's numbers."""
    if desk.single:
        fade(cython.cast(cython.pointer[Floats], desk.bits), desk, s, hidden, bends, ny, down, across)
    else:
        fade(cython.cast(cython.pointer[Doubles], desk.bits), desk, s, hidden, bends, ny, down, across)


def furnish(desk: Desk) -> None:
    """Have a desk's samples attenuated here."""
    desk.measure = measure_node
    desk.cover = cover_sample
    desk.fade = fade_sample
