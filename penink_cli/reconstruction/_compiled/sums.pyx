# cython: boundscheck=False, wraparound=False, cdivision=True
"""The arithmetic of equation 5: the weighted sums of the samples at each pixel of a tile.

As in `fades` by vectors of doubles or floats, and likewise compiled again for wider ones.
"""

cimport cython
from libc.string cimport memcpy
from penink_cli.reconstruction._compiled.scratch cimport Scratch
from penink_cli.reconstruction._compiled.lanes cimport (
    FOUR_DOUBLES, Columns, Doubles, Floats, Four, Lanes, broadcast, broadcast_column, by_column,
    by_row, columns_at, fill, greater, lanes_at, lowest, maximum, minimum, number_at, round_to_bytes, select,
    smoothstep, transpose_sets, vectors,
)

from penink_cli.reconstruction import kernels


ctypedef fused stored:
    unsigned char
    unsigned short
    double

cdef double T1 = kernels.T1
cdef double T2 = kernels.T2


cdef void multiply(Lanes* like, Scratch scratch, int kernel, int samples) noexcept nogil:
    """Fill in the weights of some samples at each pixel, where they are not known."""
    cdef int s, k
    cdef void* columns
    cdef void* rows
    cdef Lanes* out
    cdef int n = vectors(8, like)
    samples &= ~scratch.known_weights[kernel]
    scratch.known_weights[kernel] |= samples
    while samples:
        s = lowest(samples)
        samples &= samples - 1
        columns = number_at(scratch.kx, 32 * kernel + 8 * (s & 3), like)
        rows = number_at(scratch.ky, 32 * kernel + (s >> 2), like)
        out = lanes_at(scratch.weights, like) + n * (16 * kernel + s)
        for k in range(n):
            out[k] = by_row(rows, k, 4, like) * by_column(columns, k, like)


cdef inline void add_columns(Scratch scratch, int weights, int seen, Columns* sums, Columns* ones) noexcept nogil:
    """For each column of samples Σ weight · value, and of the weights, over its samples that are seen.

    weights: where in `ky` those of the four rows of samples are.
    """
    cdef int j
    cdef Py_ssize_t h
    cdef Columns y, w
    cdef Columns* mask
    cdef Py_ssize_t half = 1 if Columns is Four else FOUR_DOUBLES
    cdef double zero = 0.0  # in float, too
    cdef Columns* values = columns_at(scratch.values, sums)
    for h in range(half):
        sums[h] = ones[h] = broadcast_column(&zero, 0, sums)
    for j in range(4):
        y = broadcast_column(scratch.ky, weights + j, sums)
        mask = columns_at(scratch.bits, sums) + 2 * half * ((seen >> (4 * j)) & 15)
        for h in range(half):
            w = y * mask[h]
            ones[h] = ones[h] + w
            sums[h] = sums[h] + w * values[half * j + h]


cdef inline void add_seen(
    Lanes* like, Scratch scratch, int kernel, int row, int* shaded, Lanes* top, Lanes* bottom
) noexcept nogil:
    """Numerator and denominator of equation 5 for a row of pixels, over the samples that all of them see.

    kernel: 0 the cubic, 1 the B-spline. These samples are summed as separable. shaded: the others, for each row.
    top, bottom: of the whole tile.
    """
    cdef int i, k
    cdef Lanes f, y, x
    cdef Lanes[2] sums, ones  # room for four numbers, of floats and of doubles
    cdef void* columns
    cdef int first = vectors(row, like)
    if Lanes is Floats:
        add_columns(scratch, 32 * kernel + 4 * row, ~shaded[row], <Four*>sums, <Four*>ones)
    else:
        add_columns(scratch, 32 * kernel + 4 * row, ~shaded[row], <Doubles*>sums, <Doubles*>ones)
    for i in range(4):
        columns = number_at(scratch.kx, 32 * kernel + 8 * i, like)
        f = broadcast(sums, i, like)
        y = broadcast(ones, i, like)
        for k in range(vectors(1, like)):
            x = by_column(columns, k, like)
            top[first + k] = f * x if i == 0 else top[first + k] + f * x
            bottom[first + k] = y * x if i == 0 else bottom[first + k] + y * x


cdef inline void add_faded(
    Lanes* like, Scratch scratch, int kernel, int s, int begin, int end, Lanes* top, Lanes* bottom
) noexcept nogil:
    """Add one of the other samples to numerator and denominator, for vectors begin … end of the tile."""
    cdef int k
    cdef Lanes w
    cdef Lanes f = broadcast(scratch.values, s, like)
    cdef Lanes* weights = lanes_at(scratch.weights, like) + vectors(8, like) * (16 * kernel + s)
    cdef Lanes* alpha = lanes_at(scratch.alpha, like) + vectors(8, like) * s
    for k in range(begin, end):
        w = weights[k] * alpha[k]
        bottom[k] = bottom[k] + w
        top[k] = top[k] + w * f


cdef inline bint any_below(Lanes* v, int begin, int end, Lanes limit) noexcept nogil:
    """Whether any number of vectors begin … end is below the limit."""
    cdef int k
    cdef Lanes least = v[begin]
    for k in range(begin + 1, end):
        least = minimum(v[k], least)
    return greater(limit, least) != 0


cdef inline Lanes smooth(Lanes t, Lanes one) noexcept nogil:
    """S(t) = 3t² − 2t³ on 0 … 1, clamped."""
    cdef Lanes three
    fill(&three, 3.0)
    return smoothstep(t, one - one, one, three)


cdef void blend(
    Lanes* like, Scratch scratch, int row, int* shaded, int faded, Lanes* top, Lanes* bottom, Lanes* out
) noexcept nogil:
    """The values of a row of pixels, where the sums over the cubic's weights do not do.

    faded: the samples that count somewhere in the row, but not everywhere. top, bottom, out: of the whole tile.
    """
    cdef int k
    cdef int[8] none
    cdef Lanes[32] top_b, bottom_b
    cdef Lanes w, one, half, threshold
    cdef int begin = vectors(row, like)
    cdef int end = begin + vectors(1, like)
    fill(&one, 1.0)
    fill(&half, T1)
    fill(&threshold, T2)
    multiply(like, scratch, 1, faded)
    add_seen(like, scratch, 1, row, shaded, top_b, bottom_b)
    while faded:
        add_faded(like, scratch, 1, lowest(faded), begin, end, top_b, bottom_b)
        faded &= faded - 1
    for k in range(begin, end):
        if scratch.only_b:
            out[k] = top_b[k] / bottom_b[k]
        else:
            w = smooth(bottom[k] / half, one)  # ω = S(den / T1)
            out[k] = (w * top[k] + (one - w) * top_b[k]) / (w * bottom[k] + (one - w) * bottom_b[k])
    if any_below(bottom_b, begin, end, threshold):  # starved: plain convolution, across the edges
        for k in range(8):
            none[k] = 0
        add_seen(like, scratch, 1 if scratch.only_b else 0, row, none, top, bottom)
        for k in range(begin, end):
            w = smooth(bottom_b[k] / threshold, one)
            out[k] = select(bottom_b[k], w * out[k] + (one - w) * top[k], top[k])


cdef inline void keep(Lanes* like, void* values, int n, stored* out) noexcept nogil:
    """Store n values of a row, clamped before: rounded half up, or in double as they are."""
    cdef int c
    cdef double v
    cdef unsigned char[8] eight
    if Lanes is Floats and stored is cython.uchar:
        round_to_bytes(<float*>values, out if n == 8 else eight)
        if n < 8:
            memcpy(out, eight, n)
    else:
        for c in range(n):
            if Lanes is Floats:
                v = (<float*>values)[c]
            else:
                v = (<double*>values)[c]
            if stored is double:
                out[c] = v
            else:
                out[c] = <int>(v + 0.5)


cdef inline void paint(
    Lanes* like, Scratch scratch, int samples, int nx, int ny, stored* out, Py_ssize_t stride
) noexcept nogil:
    """Reconstruct a tile, some samples of which `fades` has attenuated; the others count fully."""
    cdef int r, s, k
    cdef Lanes half, zero, most
    cdef Lanes[32] values, top, bottom
    cdef int[8] shaded, faded
    cdef int n = vectors(ny, like)
    fill(&half, T1)
    fill(&zero, 0.0)
    fill(&most, scratch.maxval)
    transpose_sets(scratch.shaded_rows, shaded)
    if not scratch.only_b:
        multiply(like, scratch, 0, samples)
        for r in range(ny):
            add_seen(like, scratch, 0, r, shaded, top, bottom)
        while samples:
            s = lowest(samples)
            samples &= samples - 1
            if scratch.faded_rows[s]:
                add_faded(like, scratch, 0, s, 0, n, top, bottom)
        for k in range(n):
            values[k] = top[k] / bottom[k]
    if scratch.only_b or any_below(bottom, 0, n, half):
        transpose_sets(scratch.faded_rows, faded)
        for r in range(ny):
            k = vectors(r, like)
            if scratch.only_b or any_below(bottom, k, k + vectors(1, like), half):
                blend(like, scratch, r, shaded, faded[r], top, bottom, values)
    if stored is not double:
        for k in range(n):
            values[k] = minimum(maximum(values[k], zero), most)
    for r in range(ny):
        keep(like, number_at(values, 8 * r, like), nx, out + stride * r)


cdef void paint_tile(Scratch scratch, int samples, int nx, int ny, void* out, Py_ssize_t stride) noexcept nogil:
    """`paint` in the scratch's numbers; stride: of the rows of output, in its numbers."""
    cdef Floats* floats = <Floats*>scratch.bits
    cdef Doubles* doubles = <Doubles*>scratch.bits
    if scratch.single and scratch.stored == 1:
        paint(floats, scratch, samples, nx, ny, <unsigned char*>out, stride)
    elif scratch.single:
        paint(floats, scratch, samples, nx, ny, <double*>out, stride)
    elif scratch.stored == 2:
        paint(doubles, scratch, samples, nx, ny, <unsigned short*>out, stride)
    else:
        paint(doubles, scratch, samples, nx, ny, <double*>out, stride)


def bind(Scratch scratch) -> None:
    """Have a scratch's tiles summed up here."""
    scratch.paint = paint_tile
