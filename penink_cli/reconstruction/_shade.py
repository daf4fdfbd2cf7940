# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The attenuation of the samples of one tile at its pixels: equation 4, the paths of which are found here."""

import cython
from cython.cimports.libc.string import memset
from cython.cimports.penink_cli.reconstruction._desk import Desk
from cython.cimports.penink_cli.reconstruction._lanes import lowest
from cython.cimports.penink_cli.reconstruction._tile import Tile

COMPILED = cython.compiled


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def find_bends(desk: Desk, tile: Tile, s: cython.int) -> cython.int:
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
    x: cython.double
    y: cython.double
    place: cython.Py_ssize_t
    seen: cython.ulonglong
    i: cython.int = tile.row[s >> 2]
    j: cython.int = tile.column[s & 3]
    hidden: cython.ulonglong = tile.hidden[s]
    limit: cython.double = tile.farthest(j, i) + desk.radius
    place = cython.cast(cython.Py_ssize_t, i - tile.finder.row0) * tile.scene.width + j
    at = tile.finder.start[place] if tile.finder.count[place] >= 0 else tile.finder.bends_of(i, j)
    end = at + tile.finder.count[place]
    for m in range(at, end):
        d = tile.finder.pool_length[m]
        if d >= limit:
            break
        node = tile.finder.pool_node[m]
        if tile.node_stamp[node] != tile.now:
            v = tile.scene.node_vertex[node]
            if tile.beyond(tile.scene.vx[v], tile.scene.vy[v], limit - d):
                continue
            tile.node_stamp[node] = tile.now
            seen = tile.node_mask(node)
            if seen == 0:
                tile.node_place[node] = -1
                continue
            slot = desk.another_node(seen)
            tile.node_place[node] = slot
            x = (tile.scene.vx[v] - tile.cx) / desk.radius
            y = (tile.scene.vy[v] - tile.cy) / desk.radius
            desk.measure(desk, slot, tile.ny, x, y)
        slot = tile.node_place[node]
        if slot < 0 or not (desk.node_mask[slot] & hidden):
            continue
        desk.bend[bends] = slot
        desk.bend_length[bends] = d / desk.radius
        bends += 1
    return bends


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def attenuate(desk: Desk, tile: Tile) -> cython.void:
    """Find the samples that do not count fully in each row of pixels, and their attenuation."""
    s: cython.int
    bends: cython.int
    left: cython.int = tile.shaded
    desk.used = 0
    memset(desk.shaded_rows, 0, 16)
    memset(desk.faded_rows, 0, 16)
    while left:
        s = lowest(left)
        left &= left - 1
        bends = find_bends(desk, tile, s)
        if bends == 0:
            desk.cover(desk, s, tile.hidden[s], tile.nx, tile.ny)
        else:
            desk.fade(desk, s, tile.hidden[s], bends, tile.ny, tile.row[s >> 2] - tile.cy, tile.column[s & 3] - tile.cx)
