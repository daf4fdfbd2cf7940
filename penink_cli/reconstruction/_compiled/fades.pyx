# cython: boundscheck=False, wraparound=False, cdivision=True
"""The arithmetic of equation 4: how much a sample counts at each pixel of a tile.

In double, or for 8-bit output in float, of which a vector holds twice as many; what pixels see is exact in both.
A tile is so many vectors, row after row of eight pixels: with SSE2 sixteen of floats. `fades_avx2` is this file again,
compiled for processors that hold twice as many in one: the same numbers, each rounded alike, so the same bytes.

Lengths are in units of the radius. A parameter `like` tells the lanes, and points to the scratch's `bits`.
"""

from penink_cli.reconstruction._compiled.scratch cimport Scratch
from penink_cli.reconstruction._compiled.lanes cimport (
    Doubles, Floats, Lanes, by_column, by_row, fill, lanes_at, minimum, number_at, smoothstep, square_root, vectors,
    where,
)

cdef double FAR = 1e30  # a distance no path has


cdef void measure(Lanes* like, Scratch scratch, int slot, int ny, double x, double y) noexcept nogil:
    """Distance of each pixel of the tile from a node, FAR from where it is not seen."""
    cdef int k
    cdef Lanes vx, vy, far, across, down
    cdef Lanes* out = lanes_at(scratch.nodes, like) + vectors(8, like) * slot
    cdef unsigned long long hidden = ~scratch.node_mask[slot]
    fill(&vx, x)
    fill(&vy, y)
    fill(&far, FAR)
    for k in range(vectors(ny, like)):
        across = by_column(scratch.ux, k, like) - vx
        down = by_row(scratch.uy, k, 1, like) - vy
        out[k] = square_root(across * across + down * down) + where(hidden, k, like) * far


cdef inline unsigned char rows_of(unsigned long long pixels) noexcept nogil:
    """The rows that a set of pixels touches: the bytes of the word that are not zero, gathered by a multiplication."""
    cdef unsigned long long low = 0x7F7F7F7F7F7F7F7F, first = 0x0101010101010101, gather = 0x0102040810204080
    pixels = (((pixels & low) + low) | pixels) >> 7 & first
    return <unsigned char>((pixels * gather) >> 56)


cdef void cover(Lanes* like, Scratch scratch, int s, unsigned long long hidden, int nx, int ny) noexcept nogil:
    """Attenuate a sample to which no path bends: it counts where it is seen, and only there; see `fade`."""
    cdef int k
    cdef unsigned long long whole = 0x0101010101010101
    cdef Lanes* alpha = lanes_at(scratch.alpha, like) + vectors(8, like) * s
    cdef void* most = number_at(like, 8 * rows_of(hidden), like)
    scratch.shaded_rows[s] = rows_of(hidden)
    scratch.faded_rows[s] = scratch.shaded_rows[s] & rows_of(~hidden & (whole * (255 >> (8 - nx))))
    for k in range(vectors(ny, like)):
        alpha[k] = minimum(where(~hidden, k, like), by_row(most, k, 1, like))


cdef inline Lanes* distances(Lanes* like, Scratch scratch, int down, int across) noexcept nogil:
    """How far each pixel is from the sample −1 … 2 down and across the cell."""
    cdef int k
    cdef Lanes x, y, ux, uy
    cdef int place = 4 * down + across + 5
    cdef Lanes* out = lanes_at(scratch.distance, like) + vectors(8, like) * place
    if not (scratch.known >> place) & 1:
        scratch.known |= 1 << place
        fill(&x, across / scratch.radius)
        fill(&y, down / scratch.radius)
        for k in range(vectors(8, like)):
            ux = by_column(scratch.ux, k, like) - x
            uy = by_row(scratch.uy, k, 1, like) - y
            out[k] = square_root(ux * ux + uy * uy)
    return out


cdef void fade(
    Lanes* like, Scratch scratch, int s, unsigned long long hidden, int bends, int ny, int down, int across
) noexcept nogil:
    """Attenuate the sample so far down and across the cell, which the hidden pixels do not see, by `bends` paths.

    With u = 1 − detour / r clamped to 0 … 1 the attenuation 1 − S(1 − u) is S(u); u is one where nothing is between,
    and zero in rows all of which see the sample, which are summed without. All rows are computed: no branch predictor
    can tell which rows a shadow touches, and a wrong prediction costs as much as a row.
    """
    cdef int k, m
    cdef Lanes one, three, length, excess
    cdef int n = vectors(ny, like)
    cdef Lanes* nodes = lanes_at(scratch.nodes, like)
    cdef Lanes* near = nodes + vectors(8, like) * scratch.bend[0]
    cdef Lanes* alpha = lanes_at(scratch.alpha, like) + vectors(8, like) * s
    cdef Lanes* straight = distances(like, scratch, down, across)
    cdef void* most = number_at(like, 8 * rows_of(hidden), like)
    fill(&one, 1.0)
    fill(&three, 3.0)
    fill(&length, scratch.bend_length[0])
    scratch.shaded_rows[s] = scratch.faded_rows[s] = rows_of(hidden)
    if bends == 1:
        length = length - one
        for k in range(n):
            excess = straight[k] - (near[k] + length)
            alpha[k] = smoothstep(excess, where(~hidden, k, like), by_row(most, k, 1, like), three)
        return
    for k in range(n):
        alpha[k] = near[k] + length
    for m in range(1, bends):
        near = nodes + vectors(8, like) * scratch.bend[m]
        fill(&length, scratch.bend_length[m])
        for k in range(n):
            alpha[k] = minimum(near[k] + length, alpha[k])
    for k in range(n):
        alpha[k] = smoothstep(straight[k] - (alpha[k] - one), where(~hidden, k, like), by_row(most, k, 1, like), three)


cdef void measure_node(Scratch scratch, int slot, int ny, double x, double y) noexcept nogil:
    """`measure` in the scratch's numbers."""
    if scratch.single:
        measure(<Floats*>scratch.bits, scratch, slot, ny, x, y)
    else:
        measure(<Doubles*>scratch.bits, scratch, slot, ny, x, y)


cdef void cover_sample(Scratch scratch, int s, unsigned long long hidden, int nx, int ny) noexcept nogil:
    """`cover` in the scratch's numbers."""
    if scratch.single:
        cover(<Floats*>scratch.bits, scratch, s, hidden, nx, ny)
    else:
        cover(<Doubles*>scratch.bits, scratch, s, hidden, nx, ny)


cdef void fade_sample(
    Scratch scratch, int s, unsigned long long hidden, int bends, int ny, int down, int across
) noexcept nogil:
    """`fade` in the scratch's numbers."""
    if scratch.single:
        fade(<Floats*>scratch.bits, scratch, s, hidden, bends, ny, down, across)
    else:
        fade(<Doubles*>scratch.bits, scratch, s, hidden, bends, ny, down, across)


def bind(Scratch scratch) -> None:
    """Have a scratch's samples attenuated here."""
    scratch.measure = measure_node
    scratch.cover = cover_sample
    scratch.fade = fade_sample
