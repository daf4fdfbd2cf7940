# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: the reconstruction as a matrix, as it is linear in the samples while the edges stay. See fit.py.

A row stands for a pixel, the mean of a few points, and holds the weights of the 5 × 5 samples that it depends on:
those of plain convolution, changed where the points of a tile do not see all of their samples alike.
"""

from penink_cli.reconstruction._compiled.scratch cimport Scratch
from penink_cli.reconstruction._compiled.lanes cimport transpose_sets
from penink_cli.reconstruction._compiled.shade cimport attenuate
from penink_cli.reconstruction._compiled.tile cimport Tile

cdef float T1 = 0.5  # below this sum of cubic weights the B-spline is blended in
cdef float T2 = 1e-4  # below this sum of B-spline weights plain convolution is faded in


cdef float _smooth(float t) noexcept nogil:
    """S(t) = 3t² − 2t³, clamped."""
    return <float>0.0 if t <= 0 else (<float>1.0 if t >= 1 else t * t * (<float>3.0 - 2 * t))


cdef int _shade(Tile tile, Scratch scratch) except -1 nogil:
    """Find what the points of a tile that `see` has looked at do not see, and how far it is attenuated."""
    cdef int k
    cdef float u
    cdef bint same = True
    cdef float* ux = <float*>scratch.ux
    cdef float* uy = <float*>scratch.uy
    for k in range(8):
        u = <float>((tile.px[min(k, tile.nx - 1)] - tile.cx) / scratch.radius)
        same &= ux[k] == u
        ux[k] = u
        u = <float>((tile.py[min(k, tile.ny - 1)] - tile.cy) / scratch.radius)
        same &= uy[k] == u
        uy[k] = u
    if not same:
        scratch.known = 0
    attenuate(scratch, tile)


cdef void _change(
    Scratch scratch, int r, int shaded, int faded, float* xc, float* xb, double* yc, double* yb, float* out
) noexcept nogil:
    """By what equation 5's weights of the 16 samples (outer) differ from plain ones at the 8 points of row r (inner).

    shaded, faded: the sets of samples some of them do not see, and of those that count at some all the same.
    xc, xb: (4, 8) weights of each column of samples at the points; yc, yb: (4,) of each row of samples.
    """
    cdef int s, c
    cdef float y, omega, fade
    cdef float* source
    cdef float[128] alpha, cubic, spline
    cdef float[8] by_cubic, by_spline, across
    cdef float least = 1.0
    for c in range(8):
        by_cubic[c] = by_spline[c] = 0.0
    for s in range(16):
        y = 0.0 if (shaded >> s) & 1 else 1.0
        for c in range(8):
            alpha[8 * s + c] = y
        if (faded >> s) & 1:
            source = <float*>scratch.alpha + 64 * s + 8 * r
            for c in range(8):
                alpha[8 * s + c] = source[c]
        y = <float>yc[s >> 2]
        for c in range(8):
            cubic[8 * s + c] = y * xc[8 * (s & 3) + c]
            by_cubic[c] += alpha[8 * s + c] * cubic[8 * s + c]
    for c in range(8):
        least = min(least, by_cubic[c])
    if least >= T1:
        for c in range(8):
            by_cubic[c] = <float>1.0 / by_cubic[c]
        for s in range(16):
            for c in range(8):
                out[8 * s + c] = cubic[8 * s + c] * (alpha[8 * s + c] * by_cubic[c] - <float>1.0)
        return
    for s in range(16):
        y = <float>yb[s >> 2]
        for c in range(8):
            spline[8 * s + c] = y * xb[8 * (s & 3) + c]
            by_spline[c] += alpha[8 * s + c] * spline[8 * s + c]
    for c in range(8):
        omega = _smooth(by_cubic[c] / T1)
        fade = <float>1.0 - _smooth(by_spline[c] / T2)
        y = omega * by_cubic[c] + (<float>1.0 - omega) * by_spline[c]
        y = (<float>1.0 - fade) / y if y > 0 else <float>0.0
        by_cubic[c] = omega * y
        by_spline[c] = (<float>1.0 - omega) * y
        across[c] = fade - <float>1.0
    for s in range(16):
        for c in range(8):
            out[8 * s + c] = (
                cubic[8 * s + c] * (alpha[8 * s + c] * by_cubic[c] + across[c])
                + alpha[8 * s + c] * by_spline[c] * spline[8 * s + c]
            )


cdef class Axis:
    """The points along one axis of a picture, fine of them a pixel, and the samples that its pixels depend on.

    where, cubic, bspline: (n,) place of each point and (n, 4) its taps, and cell, first: (t,), (t + 1,) the tiles of
    points, all as in lattice.Axis. base: (pixels,) first sample that each pixel depends on; plain: (pixels, 5) its
    weights in plain convolution from there on.
    """

    cdef double[::1] where
    cdef double[:, ::1] cubic, bspline
    cdef int[::1] cell, first, base
    cdef float[:, ::1] plain

    def __init__(
        self, double[::1] where, double[:, ::1] cubic, double[:, ::1] bspline, int[::1] cell, int[::1] first,
        int[::1] base, float[:, ::1] plain,
    ) -> None:
        self.where = where
        self.cubic = cubic
        self.bspline = bspline
        self.cell = cell
        self.first = first
        self.base = base
        self.plain = plain


def rows(
    Tile tile, Scratch scratch, Axis x, Axis y, int[::1] tiles, int[::1] pixels, int fine, float[:, :, ::1] weight
):
    """Fill the rows of some pixels, each the mean of fine × fine points. True if an edge matters.

    scratch: of single numbers. tiles: (4,) first and last + 1 tile down and across. pixels: (2,) row and column of the
    block's first pixel. weight: (rows, columns, 25) filled: 5 × 5 samples from the bases on.
    """
    cdef int a, b, r, c, i, j, k, s, nx, ny, py, px, at_x, at_y
    cdef float v
    cdef float* w
    cdef float[32] columns_c, columns_b
    cdef float[128] change
    cdef int[8] pixel, shaded, faded
    cdef int[32] place
    cdef int[4] down
    cdef bint matters = False
    cdef float[:, ::1] x_plain = x.plain, y_plain = y.plain
    cdef double[:, ::1] x_cubic = x.cubic, x_bspline = x.bspline
    cdef int[::1] x_cell = x.cell, y_cell = y.cell, x_base = x.base
    cdef float share = 1.0 / (fine * fine)
    cdef int last_x = tile.scene.width - 1
    cdef int last_y = tile.scene.height - 1
    with nogil:
        for py in range(weight.shape[0]):
            for px in range(weight.shape[1]):
                w = &weight[py, px, 0]
                for i in range(5):
                    v = y_plain[pixels[0] + py, i]
                    for j in range(5):
                        w[5 * i + j] = v * x_plain[pixels[1] + px, j]
        for a in range(tiles[0], tiles[1]):
            at_y = y.first[a]
            ny = y.first[a + 1] - at_y
            tile.place_in_row(y_cell[a], &y.where[at_y], ny)
            for b in range(tiles[2], tiles[3]):
                if tile.scene.empty_around(x_cell[b], y_cell[a]):
                    continue
                at_x = x.first[b]
                nx = x.first[b + 1] - at_x
                tile.place(x_cell[b], &x.where[at_x], nx)
                if not tile.see():
                    continue
                matters = True
                _shade(tile, scratch)
                transpose_sets(scratch.shaded_rows, shaded)
                transpose_sets(scratch.faded_rows, faded)
                for c in range(8):
                    k = at_x + min(c, nx - 1)
                    pixel[c] = k // fine - pixels[1]
                    for j in range(4):
                        columns_c[8 * j + c] = <float>x_cubic[k, j]
                        columns_b[8 * j + c] = <float>x_bspline[k, j]
                        place[4 * c + j] = min(last_x, max(0, x_cell[b] - 1 + j)) - x_base[k // fine]
                for r in range(ny):
                    k = at_y + r
                    py = k // fine - pixels[0]
                    if py < 0 or py >= weight.shape[0]:
                        continue
                    for i in range(4):
                        down[i] = 5 * (min(last_y, max(0, y_cell[a] - 1 + i)) - y.base[k // fine])
                    _change(
                        scratch, r, shaded[r], faded[r], columns_c, columns_b, &y.cubic[k, 0], &y.bspline[k, 0], change
                    )
                    for c in range(nx):
                        px = pixel[c]
                        if px < 0 or px >= weight.shape[1]:
                            continue
                        w = &weight[py, px, 0]
                        for s in range(16):
                            w[down[s >> 2] + place[4 * c + (s & 3)]] += share * change[8 * s + c]
    return matters


def clear(Tile tile, double x0, double y0, double x1, double y1):
    """Whether no edge comes near the rectangle (sample units)."""
    return tile.scene.clear(x0, y0, x1, y1)
