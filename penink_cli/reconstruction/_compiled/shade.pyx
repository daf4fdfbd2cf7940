# cython: boundscheck=False, wraparound=False, cdivision=True
"""The attenuation of the samples of one tile at its pixels: equation 4, the paths of which are found here."""

from libc.string cimport memset
from penink_cli.reconstruction._compiled.scratch cimport Scratch
from penink_cli.reconstruction._compiled.lanes cimport lowest
from penink_cli.reconstruction._compiled.tile cimport Tile


cdef int find_bends(Scratch scratch, Tile tile, int s) except -1 nogil:
    """The bends next to a sample that hidden pixels see; how many.

    The distances of all pixels to a node are measured when the first sample of the tile asks for it.
    """
    cdef int m, at, end, node, slot, v
    cdef double d, x, y
    cdef Py_ssize_t place
    cdef unsigned long long seen
    cdef int bends = 0
    cdef int i = tile.row[s >> 2]
    cdef int j = tile.column[s & 3]
    cdef unsigned long long hidden = tile.hidden[s]
    cdef double limit = tile.farthest(j, i) + scratch.radius
    place = <Py_ssize_t>(i - tile.finder.row0) * tile.scene.width + j
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
            tile.node_mask(node, &seen)
            if seen == 0:
                tile.node_place[node] = -1
                continue
            slot = scratch.another_node(seen)
            tile.node_place[node] = slot
            x = (tile.scene.vx[v] - tile.cx) / scratch.radius
            y = (tile.scene.vy[v] - tile.cy) / scratch.radius
            scratch.measure(scratch, slot, tile.ny, x, y)
        slot = tile.node_place[node]
        if slot < 0 or not (scratch.node_mask[slot] & hidden):
            continue
        scratch.bend[bends] = slot
        scratch.bend_length[bends] = d / scratch.radius
        bends += 1
    return bends


cdef int attenuate(Scratch scratch, Tile tile) except -1 nogil:
    """Find the samples that do not count fully in each row of pixels, and their attenuation."""
    cdef int s, bends, i, j
    cdef int left = tile.shaded
    scratch.used = 0
    memset(scratch.shaded_rows, 0, 16)
    memset(scratch.faded_rows, 0, 16)
    while left:
        s = lowest(left)
        left &= left - 1
        bends = find_bends(scratch, tile, s)
        if bends == 0:
            scratch.cover(scratch, s, tile.hidden[s], tile.nx, tile.ny)
        else:
            i = tile.row[s >> 2] - tile.cy
            j = tile.column[s & 3] - tile.cx
            scratch.fade(scratch, s, tile.hidden[s], bends, tile.ny, i, j)
