# cython: boundscheck=False, wraparound=False, cdivision=True
"""The reconstruction near edges: equation 5 for the pixels of one tile after the other.

In double, or for 8-bit output in float; what pixels see is exact in both.
"""

from libc.string cimport memcmp, memcpy
from penink_cli.reconstruction._compiled.scratch cimport Scratch
from penink_cli.reconstruction._compiled.shade cimport attenuate
from penink_cli.reconstruction._compiled.tile cimport Tile


ctypedef fused real:
    float
    double


ctypedef fused stored:
    unsigned char
    unsigned short
    double


cdef void lay_out_rows(Scratch scratch, Tile tile, real* yc, real* yb) noexcept nogil:
    """Lay ready what belongs to the rows of pixels of a tile; yc, yb: (8, 4) weights."""
    cdef int k, r
    cdef real[8] uy
    cdef real[64] ky
    for k in range(32):  # beyond the last row as in it
        r = k if k < 4 * tile.ny else 4 * (tile.ny - 1) + (k & 3)
        ky[k] = yc[r]
        ky[32 + k] = yb[r]
    if memcmp(scratch.ky, ky, 64 * sizeof(ky[0])) != 0:
        memcpy(scratch.ky, ky, 64 * sizeof(ky[0]))
        scratch.known_weights[0] = scratch.known_weights[1] = 0
    for k in range(8):
        uy[k] = (tile.py[k if k < tile.ny else 0] - tile.cy) / scratch.radius
    if memcmp(scratch.uy, uy, 8 * sizeof(uy[0])) != 0:
        memcpy(scratch.uy, uy, 8 * sizeof(uy[0]))
        scratch.known = 0


cdef void lay_out(Scratch scratch, real* xc, real* xb, Py_ssize_t stride, real* ux) noexcept nogil:
    """Lay ready what belongs to the columns of pixels of a tile; what is beyond them belongs to the next."""
    cdef Py_ssize_t i
    cdef real* columns
    cdef real* kx
    if real is float:
        kx = <float*>scratch.kx
    else:
        kx = <double*>scratch.kx
    for i in range(8):
        columns = xc + stride * i if i < 4 else xb + stride * (i - 4)
        if memcmp(kx + 8 * i, columns, 8 * sizeof(xc[0])) != 0:
            memcpy(kx + 8 * i, columns, 8 * sizeof(xc[0]))
            scratch.known_weights[0] = scratch.known_weights[1] = 0
    if memcmp(scratch.ux, ux, 8 * sizeof(xc[0])) != 0:
        memcpy(scratch.ux, ux, 8 * sizeof(xc[0]))
        scratch.known = 0


cdef void lay_out_samples(Scratch scratch, Tile tile, real* samples) noexcept nogil:
    """Lay ready the samples of a tile, those of one plane."""
    cdef Py_ssize_t i, j
    cdef real* f
    cdef real* values
    if real is float:
        values = <float*>scratch.values
    else:
        values = <double*>scratch.values
    for j in range(4):
        f = samples + <Py_ssize_t>tile.row[j] * tile.scene.width
        if tile.column[3] == tile.column[0] + 3:
            memcpy(values + 4 * j, f + tile.column[0], 4 * sizeof(f[0]))
            continue
        for i in range(4):
            values[4 * j + i] = f[tile.column[i]]


def retouch(
    Tile tile, Scratch scratch, real[:, :, ::1] samples, columns, real[::1] ux, rows, stored[:, :, ::1] out
) -> None:
    """Reconstruct every tile that has an edge within the cells that its samples span.

    samples: (p, h, w), planes of one picture: what hides a sample, and how much it counts, is alike in all.
    columns, rows: `enlarge.TileAxis`. ux: positions of the columns relative to the cell and in units of the radius.
    out: (p, rows, columns).
    """
    cdef Py_ssize_t a, b, c, k
    cdef double[::1] x = columns.where, y = rows.where
    cdef real[:, ::1] xc = columns.cubic, xb = columns.bspline, yc = rows.cubic, yb = rows.bspline
    cdef int[::1] x_cell = columns.cell, x_begin = columns.first, y_cell = rows.cell, y_begin = rows.first
    with nogil:
        for a in range(y_cell.shape[0]):
            c = y_begin[a]
            tile.place_in_row(y_cell[a], &y[c], y_begin[a + 1] - y_begin[a])
            lay_out_rows(scratch, tile, &yc[c, 0], &yb[c, 0])
            for b in range(x_cell.shape[0]):
                if tile.scene.empty_around(x_cell[b], y_cell[a]):
                    continue
                c = x_begin[b]
                tile.place(x_cell[b], &x[c], x_begin[b + 1] - x_begin[b])
                if not tile.see():
                    continue
                lay_out(scratch, &xc[0, c], &xb[0, c], xc.shape[1], &ux[c])
                attenuate(scratch, tile)
                for k in range(samples.shape[0]):
                    lay_out_samples(scratch, tile, &samples[k, 0, 0])
                    scratch.paint(scratch, tile.shaded, tile.nx, tile.ny, &out[k, y_begin[a], c], out.shape[2])
