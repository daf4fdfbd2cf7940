# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The reconstruction near edges: equation 5 for the pixels of one tile after the other.

In double, or for 8-bit output in float; what pixels see is exact in both.
"""

import cython
from cython.cimports.libc.string import memcmp, memcpy
from cython.cimports.penink_cli.reconstruction._desk import Desk
from cython.cimports.penink_cli.reconstruction._shade import attenuate
from cython.cimports.penink_cli.reconstruction._tile import Tile

COMPILED = cython.compiled

real = cython.fused_type(cython.float, cython.double)
stored = cython.fused_type(cython.uchar, cython.ushort, cython.double)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def lay_out_rows(desk: Desk, tile: Tile, yc: cython.pointer[real], yb: cython.pointer[real]) -> cython.void:
    """Lay ready what belongs to the rows of pixels of a tile; yc, yb: (8, 4) weights."""
    k: cython.int
    r: cython.int
    uy: real[8]
    ky: real[64]
    for k in range(32):  # beyond the last row as in it
        r = k if k < 4 * tile.ny else 4 * (tile.ny - 1) + (k & 3)
        ky[k] = yc[r]
        ky[32 + k] = yb[r]
    if memcmp(desk.ky, ky, 64 * cython.sizeof(ky[0])) != 0:
        memcpy(desk.ky, ky, 64 * cython.sizeof(ky[0]))
        desk.known_weights[0] = desk.known_weights[1] = 0
    for k in range(8):
        uy[k] = (tile.py[k if k < tile.ny else 0] - tile.cy) / desk.radius
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
        if tile.column[3] == tile.column[0] + 3:
            memcpy(values + 4 * j, f + tile.column[0], 4 * cython.sizeof(f[0]))
            continue
        for i in range(4):
            values[4 * j + i] = f[tile.column[i]]


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
    with cython.nogil:
        for a in range(y_cell.shape[0]):
            c = y_begin[a]
            tile.place_in_row(y_cell[a], cython.address(y[c]), y_begin[a + 1] - y_begin[a])
            lay_out_rows(desk, tile, cython.address(yc[c, 0]), cython.address(yb[c, 0]))
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
                attenuate(desk, tile)
                desk.paint(desk, tile.shaded, tile.nx, tile.ny, cython.address(out[y_begin[a], c]), out.shape[1])
