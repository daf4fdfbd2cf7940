# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The attenuation of the samples of one tile at its pixels: equation 4, by rows of eight pixels.

A row is `row` vectors: two of floats, four of doubles.
"""

import cython
from cython.cimports.penink_cli.reconstruction._desk import Desk
from cython.cimports.penink_cli.reconstruction._lanes import Four, Lanes, fill, lane, lanes_at, less, lowest, more, root
from cython.cimports.penink_cli.reconstruction._tile import Tile

COMPILED = cython.compiled

FAR = cython.declare(cython.double, 1e30)  # a distance no path has


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def measure(
    out: cython.pointer[Lanes],
    bits: cython.pointer[Lanes],
    ux: cython.pointer[Lanes],
    uy: cython.pointer[Lanes],
    ny: cython.int,
    seen: cython.ulonglong,
    x: cython.double,
    y: cython.double,
) -> cython.void:
    """Distance of each pixel of the tile from a node, FAR from where it is not seen."""
    r: cython.Py_ssize_t
    h: cython.Py_ssize_t
    row: cython.Py_ssize_t = 2 if Lanes is Four else 4
    vx: Lanes
    vy: Lanes
    far: Lanes
    down: Lanes
    across: Lanes[4]
    veil: cython.pointer[Lanes]
    fill(cython.address(vx), x)
    fill(cython.address(vy), y)
    fill(cython.address(far), FAR)
    for h in range(row):
        across[h] = (ux[h] - vx) * (ux[h] - vx)
    for r in range(ny):
        veil = bits + row * (~(seen >> (8 * r)) & 255)
        down = (uy[r] - vy) * (uy[r] - vy)
        for h in range(row):
            out[row * r + h] = root(across[h] + down) + veil[h] * far


@cython.cfunc
@cython.inline
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
def cover(
    bits: cython.pointer[Lanes], desk: Desk, s: cython.int, hidden: cython.ulonglong, nx: cython.int, ny: cython.int
) -> cython.void:
    """Attenuate a sample to which no path bends: it counts where it is seen, and only there.

    Without a branch: which rows a shadow touches is anyone's guess, and a wrong one costs as much as a row.
    """
    r: cython.Py_ssize_t
    h: cython.Py_ssize_t
    byte: cython.int
    row: cython.Py_ssize_t = 2 if Lanes is Four else 4
    whole: cython.int = 255 >> (8 - nx)
    bare: cython.pointer[Lanes]
    alpha: cython.pointer[Lanes] = lanes_at(desk.alpha, bits) + 8 * row * s
    for r in range(ny):
        byte = hidden & 255
        hidden >>= 8
        desk.shaded[r] |= (byte != 0) << s
        desk.faded[r] |= ((byte != 0) & (byte != whole)) << s
        bare = bits + row * (byte ^ 255)
        for h in range(row):
            alpha[row * r + h] = bare[h]


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def distances(
    bits: cython.pointer[Lanes], desk: Desk, down: cython.int, across: cython.int, radius: cython.double
) -> cython.pointer[Lanes]:
    """How far each pixel is from the sample −1 … 2 down and across the cell, in units of the radius."""
    r: cython.Py_ssize_t
    h: cython.Py_ssize_t
    place: cython.int = 4 * down + across + 5
    row: cython.Py_ssize_t = 2 if Lanes is Four else 4
    ux: cython.pointer[Lanes] = lanes_at(desk.ux, bits)
    uy: cython.pointer[Lanes] = lanes_at(desk.uy, bits)
    out: cython.pointer[Lanes] = lanes_at(desk.distance, bits) + 8 * row * place
    x: Lanes
    y: Lanes
    squares: Lanes[4]
    if not (desk.known >> place) & 1:
        desk.known |= 1 << place
        fill(cython.address(x), across / radius)
        fill(cython.address(y), down / radius)
        for h in range(row):
            squares[h] = (ux[h] - x) * (ux[h] - x)
        for r in range(8):
            for h in range(row):
                out[row * r + h] = root(squares[h] + (uy[r] - y) * (uy[r] - y))
    return out


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def fade(
    bits: cython.pointer[Lanes],
    desk: Desk,
    s: cython.int,
    hidden: cython.ulonglong,
    bends: cython.int,
    straight: cython.pointer[Lanes],
) -> cython.void:
    """Attenuate a sample in the rows where pixels do not see it; lengths in units of the radius.

    straight: how far each pixel is from the sample. With u = 1 − detour / r clamped to 0 … 1 the attenuation
    1 − S(1 − u) is S(u); u is one where nothing is between.
    """
    r: cython.Py_ssize_t
    m: cython.int
    h: cython.Py_ssize_t
    rows: cython.int = rows_of(hidden)
    row: cython.Py_ssize_t = 2 if Lanes is Four else 4
    one: Lanes
    three: Lanes
    u: Lanes
    best: Lanes[4]
    bare: cython.pointer[Lanes]
    near: cython.pointer[Lanes]
    length: cython.pointer[Lanes] = lanes_at(desk.bend_length, bits)
    nodes: cython.pointer[Lanes] = lanes_at(desk.nodes, bits)
    first: cython.pointer[Lanes] = nodes + 8 * row * desk.bend[0]
    alpha: cython.pointer[Lanes] = lanes_at(desk.alpha, bits) + 8 * row * s
    fill(cython.address(one), 1.0)
    fill(cython.address(three), 3.0)
    if bends == 1:
        length[0] = length[0] - one
    while rows:
        r = lowest(rows)
        rows &= rows - 1
        bare = bits + row * (((hidden >> (8 * r)) & 255) ^ 255)
        for h in range(row):
            best[h] = first[row * r + h] + length[0]
        if bends > 1:
            for m in range(1, bends):
                near = nodes + row * (8 * desk.bend[m] + r)
                for h in range(row):
                    best[h] = less(near[h] + length[m], best[h])
            for h in range(row):
                best[h] = best[h] - one
        for h in range(row):
            u = less(more(straight[row * r + h] - best[h], bare[h]), one)
            alpha[row * r + h] = u * u * (three - (u + u))
        desk.shaded[r] |= 1 << s
        desk.faded[r] |= 1 << s


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def find_bends(bits: cython.pointer[Lanes], desk: Desk, tile: Tile, s: cython.int, radius: cython.double) -> cython.int:
    """The bends next to a sample that hidden pixels see; how many.

    The distances of all pixels to a node are measured when the first sample of the tile asks for it.
    """
    m: cython.int
    at: cython.int
    end: cython.int
    node: cython.int
    slot: cython.int
    v: cython.int
    bends: cython.int = 0
    d: cython.double
    place: cython.Py_ssize_t
    seen: cython.ulonglong
    i: cython.int = tile.row[s >> 2]
    j: cython.int = tile.column[s & 3]
    row: cython.Py_ssize_t = 2 if Lanes is Four else 4
    hidden: cython.ulonglong = tile.hidden[s]
    limit: cython.double = tile.farthest(j, i) + radius
    place = cython.cast(cython.Py_ssize_t, i - tile.finder.row0) * tile.scene.width + j
    at = tile.finder.start[place] if tile.finder.count[place] >= 0 else tile.finder.bends_of(i, j)
    end = at + tile.finder.count[place]
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
            measure(
                lanes_at(desk.nodes, bits) + 8 * row * slot,
                bits,
                lanes_at(desk.ux, bits),
                lanes_at(desk.uy, bits),
                tile.ny,
                seen,
                (tile.scene.vx[v] - tile.cx) / radius,
                (tile.scene.vy[v] - tile.cy) / radius,
            )
        slot = tile.node_place[node]
        if slot < 0 or not (desk.node_mask[slot] & hidden):
            continue
        desk.bend[bends] = slot
        fill(lanes_at(desk.bend_length, bits) + bends, d / radius)
        bends += 1
    return bends


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def attenuate(bits: cython.pointer[Lanes], desk: Desk, tile: Tile, radius: cython.double) -> cython.void:
    """Find the samples that do not count fully in each row of pixels, and their attenuation; bits: the desk's."""
    s: cython.int
    bends: cython.int
    r: cython.int
    left: cython.int = tile.shaded
    straight: cython.pointer[Lanes]
    desk.used = 0
    for r in range(8):
        desk.shaded[r] = 0
        desk.faded[r] = 0
    while left:
        s = lowest(left)
        left &= left - 1
        lanes_at(desk.spread, bits)[s] = lane(lanes_at(desk.values, bits), s)
        bends = find_bends(bits, desk, tile, s, radius)
        if bends == 0:
            cover(bits, desk, s, tile.hidden[s], tile.nx, tile.ny)
        else:
            straight = distances(
                bits, desk, tile.row[s >> 2] - tile.cy, tile.column[s & 3] - tile.cx, radius
            )  # fmt: skip
            fade(bits, desk, s, tile.hidden[s], bends, straight)
