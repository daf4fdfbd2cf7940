# cython: boundscheck=False, wraparound=False, cdivision=True
"""The arithmetic of equation 4: how much a sample counts at each pixel of a tile.

In double, or for 8-bit output in float, of which a vector holds twice as many; what pixels see is exact in both.
A tile is so many vectors, row after row of eight pixels: with SSE2 sixteen of floats. `fades_avx2` and `fades_avx512`
are this file again, compiled for processors that hold two and four times as many in one: the same numbers, each
rounded alike, so the same bytes.

Lengths are in units of the radius. A parameter `like` tells the lanes, and points to the desk's `bits`.
"""

from penink_cli.reconstruction._compiled.desk cimport Desk
from penink_cli.reconstruction._compiled.lanes cimport (
    Doubles, Floats, Lanes, among, by_column, by_row, ease, fill, lanes_at, less, number_at, root, vectors,
)

cdef double FAR = 1e30  # a distance no path has


cdef void measure(Lanes* like, Desk desk, int slot, int ny, double x, double y) noexcept nogil:
    """Distance of each pixel of the tile from a node, FAR from where it is not seen."""
    cdef int k
    cdef Lanes vx, vy, far, across, down
    cdef Lanes* out = lanes_at(desk.nodes, like) + vectors(8, like) * slot
    cdef unsigned long long hidden = ~desk.node_mask[slot]
    fill(&vx, x)
    fill(&vy, y)
    fill(&far, FAR)
    for k in range(vectors(ny, like)):
        across = by_column(desk.ux, k, like) - vx
        down = by_row(desk.uy, k, 1, like) - vy
        out[k] = root(across * across + down * down) + among(hidden, k, like) * far


cdef inline unsigned char rows_of(unsigned long long pixels) noexcept nogil:
    """The rows that a set of pixels touches: the bytes of the word that are not zero, gathered by a multiplication."""
    cdef unsigned long long low = 0x7F7F7F7F7F7F7F7F, first = 0x0101010101010101, gather = 0x0102040810204080
    pixels = (((pixels & low) + low) | pixels) >> 7 & first
    return <unsigned char>((pixels * gather) >> 56)


cdef void cover(Lanes* like, Desk desk, int s, unsigned long long hidden, int nx, int ny) noexcept nogil:
    """Attenuate a sample to which no path bends: it counts where it is seen, and only there; see `fade`."""
    cdef int k
    cdef unsigned long long whole = 0x0101010101010101
    cdef Lanes* alpha = lanes_at(desk.alpha, like) + vectors(8, like) * s
    cdef void* most = number_at(like, 8 * rows_of(hidden), like)
    desk.shaded_rows[s] = rows_of(hidden)
    desk.faded_rows[s] = desk.shaded_rows[s] & rows_of(~hidden & (whole * (255 >> (8 - nx))))
    for k in range(vectors(ny, like)):
        alpha[k] = less(among(~hidden, k, like), by_row(most, k, 1, like))


cdef inline Lanes* distances(Lanes* like, Desk desk, int down, int across) noexcept nogil:
    """How far each pixel is from the sample −1 … 2 down and across the cell."""
    cdef int k
    cdef Lanes x, y, ux, uy
    cdef int place = 4 * down + across + 5
    cdef Lanes* out = lanes_at(desk.distance, like) + vectors(8, like) * place
    if not (desk.known >> place) & 1:
        desk.known |= 1 << place
        fill(&x, across / desk.radius)
        fill(&y, down / desk.radius)
        for k in range(vectors(8, like)):
            ux = by_column(desk.ux, k, like) - x
            uy = by_row(desk.uy, k, 1, like) - y
            out[k] = root(ux * ux + uy * uy)
    return out


cdef void fade(
    Lanes* like, Desk desk, int s, unsigned long long hidden, int bends, int ny, int down, int across
) noexcept nogil:
    """Attenuate the sample so far down and across the cell, which the hidden pixels do not see, by `bends` paths.

    With u = 1 − detour / r clamped to 0 … 1 the attenuation 1 − S(1 − u) is S(u); u is one where nothing is between,
    and zero in rows all of which see the sample, which are summed without. All rows are computed: which ones a shadow
    touches is anyone's guess, and a wrong one costs as much as a row.
    """
    cdef int k, m
    cdef Lanes one, three, length
    cdef int n = vectors(ny, like)
    cdef Lanes* nodes = lanes_at(desk.nodes, like)
    cdef Lanes* near = nodes + vectors(8, like) * desk.bend[0]
    cdef Lanes* alpha = lanes_at(desk.alpha, like) + vectors(8, like) * s
    cdef Lanes* straight = distances(like, desk, down, across)
    cdef void* most = number_at(like, 8 * rows_of(hidden), like)
    fill(&one, 1.0)
    fill(&three, 3.0)
    fill(&length, desk.bend_length[0])
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
        fill(&length, desk.bend_length[m])
        for k in range(n):
            alpha[k] = less(near[k] + length, alpha[k])
    for k in range(n):
        alpha[k] = ease(straight[k] - (alpha[k] - one), among(~hidden, k, like), by_row(most, k, 1, like), three)


cdef void measure_node(Desk desk, int slot, int ny, double x, double y) noexcept nogil:
    """`measure` in the desk's numbers."""
    if desk.single:
        measure(<Floats*>desk.bits, desk, slot, ny, x, y)
    else:
        measure(<Doubles*>desk.bits, desk, slot, ny, x, y)


cdef void cover_sample(Desk desk, int s, unsigned long long hidden, int nx, int ny) noexcept nogil:
    """`cover` in the desk's numbers."""
    if desk.single:
        cover(<Floats*>desk.bits, desk, s, hidden, nx, ny)
    else:
        cover(<Doubles*>desk.bits, desk, s, hidden, nx, ny)


cdef void fade_sample(
    Desk desk, int s, unsigned long long hidden, int bends, int ny, int down, int across
) noexcept nogil:
    """`fade` in the desk's numbers."""
    if desk.single:
        fade(<Floats*>desk.bits, desk, s, hidden, bends, ny, down, across)
    else:
        fade(<Doubles*>desk.bits, desk, s, hidden, bends, ny, down, across)


def furnish(Desk desk) -> None:
    """Have a desk's samples attenuated here."""
    desk.measure = measure_node
    desk.cover = cover_sample
    desk.fade = fade_sample
