# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The arithmetic of equation 4: how much a sample counts at each pixel of a tile.

In double, or for 8-bit output in float, of which a vector holds twice as many; what pixels see is exact in both.
A tile is so many vectors, row after row of eight pixels: with SSE2 sixteen of floats. `_fades_avx2` and `_fades_avx512`
are this file again, compiled for processors that hold two and four times as many in one: the same numbers, each
rounded alike, so the same bytes.

Lengths are in units of the radius. A parameter `like` tells the lanes, and points to the desk's `bits`.
"""

import cython
from cython.cimports.penink_cli.reconstruction._desk import Desk
from cython.cimports.penink_cli.reconstruction._lanes import (
    Doubles,
    Floats,
    Lanes,
    among,
    by_column,
    by_row,
    ease,
    fill,
    lanes_at,
    less,
    number_at,
    root,
    vectors,
)

COMPILED = cython.compiled

FAR = cython.declare(cython.double, 1e30)  # a distance no path has


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def measure(
    like: cython.pointer[Lanes], desk: Desk, slot: cython.int, ny: cython.int, x: cython.double, y: cython.double
) -> cython.void:
    """Distance of each pixel of the tile from a node, FAR from where it is not seen."""
    k: cython.int
    vx: Lanes
    vy: Lanes
    far: Lanes
    across: Lanes
    down: Lanes
    out: cython.pointer[Lanes] = lanes_at(desk.nodes, like) + vectors(8, like) * slot
    hidden: cython.ulonglong = ~desk.node_mask[slot]
    fill(cython.address(vx), x)
    fill(cython.address(vy), y)
    fill(cython.address(far), FAR)
    for k in range(vectors(ny, like)):
        across = by_column(desk.ux, k, like) - vx
        down = by_row(desk.uy, k, 1, like) - vy
        out[k] = root(across * across + down * down) + among(hidden, k, like) * far


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
    k: cython.int
    whole: cython.ulonglong = 0x0101010101010101
    alpha: cython.pointer[Lanes] = lanes_at(desk.alpha, like) + vectors(8, like) * s
    most: cython.p_void = number_at(like, 8 * rows_of(hidden), like)
    desk.shaded_rows[s] = rows_of(hidden)
    desk.faded_rows[s] = desk.shaded_rows[s] & rows_of(~hidden & (whole * (255 >> (8 - nx))))
    for k in range(vectors(ny, like)):
        alpha[k] = less(among(~hidden, k, like), by_row(most, k, 1, like))


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def distances(like: cython.pointer[Lanes], desk: Desk, down: cython.int, across: cython.int) -> cython.pointer[Lanes]:
    """How far each pixel is from the sample −1 … 2 down and across the cell."""
    k: cython.int
    place: cython.int = 4 * down + across + 5
    out: cython.pointer[Lanes] = lanes_at(desk.distance, like) + vectors(8, like) * place
    x: Lanes
    y: Lanes
    ux: Lanes
    uy: Lanes
    if not (desk.known >> place) & 1:
        desk.known |= 1 << place
        fill(cython.address(x), across / desk.radius)
        fill(cython.address(y), down / desk.radius)
        for k in range(vectors(8, like)):
            ux = by_column(desk.ux, k, like) - x
            uy = by_row(desk.uy, k, 1, like) - y
            out[k] = root(ux * ux + uy * uy)
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
    k: cython.int
    m: cython.int
    n: cython.int = vectors(ny, like)
    one: Lanes
    three: Lanes
    length: Lanes
    nodes: cython.pointer[Lanes] = lanes_at(desk.nodes, like)
    near: cython.pointer[Lanes] = nodes + vectors(8, like) * desk.bend[0]
    alpha: cython.pointer[Lanes] = lanes_at(desk.alpha, like) + vectors(8, like) * s
    straight: cython.pointer[Lanes] = distances(like, desk, down, across)
    most: cython.p_void = number_at(like, 8 * rows_of(hidden), like)
    fill(cython.address(one), 1.0)
    fill(cython.address(three), 3.0)
    fill(cython.address(length), desk.bend_length[0])
    desk.shaded_rows[s] = desk.faded_rows[s] = rows_of(hidden)
    if bends == 1:
        length = length - one
        for k in range(n):
            alpha[k] = ease(straight[k] - (near[k] + length), among(~hidden, k, like), by_row(most, k, 1, like), three)
        return
    for k in range(n):
        alpha[k] = near[k] + length
    for m in range(1, bends):
        near = nodes + vectors(8, like) * desk.bend[m]
        fill(cython.address(length), desk.bend_length[m])
        for k in range(n):
            alpha[k] = less(near[k] + length, alpha[k])
    for k in range(n):
        alpha[k] = ease(straight[k] - (alpha[k] - one), among(~hidden, k, like), by_row(most, k, 1, like), three)


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
