# cython: boundscheck=False, wraparound=False, cdivision=True
"""The separable pass over whole rows of output: along the rows of samples, then down the columns.

In double, or for 8-bit output in float, which vectorises twice as wide.
"""

cimport cython
from libc.stdlib cimport free
from penink_cli.ground._compiled.memory cimport room
from penink_cli.reconstruction._compiled.lanes cimport (
    DOUBLES, FLOATS, PACK, Doubles, Floats, Lanes, broadcast, broadcast_floats, load, pack_bytes, store,
)


ctypedef fused real:
    float
    double
cdef int ROWS = 16  # of samples, expanded at once


ctypedef fused stored:
    unsigned char
    unsigned short
    double


def expand(real[:, ::1] samples, int begin, int[::1] x_first, real[:, ::1] xw, real[:, ::1] out) -> None:
    """The horizontal half of the separable pass, for the rows of samples from `begin` on, clamped, as many as out has.

    x_first: (n,) the first sample of each column of output. xw: (4, n + 8) their weights. out: (rows, n + 8). What is
    beyond the n columns is room: the columns that share their samples are computed a few at a time, from left to right.
    """
    cdef Py_ssize_t row, k, at
    cdef int j, end
    cdef Py_ssize_t[4] column
    cdef Floats floats
    cdef Doubles doubles
    cdef Py_ssize_t n = x_first.shape[0]
    cdef Py_ssize_t w = samples.shape[1]
    cdef Py_ssize_t runs = 0
    cdef real* f[16]
    cdef int* start = <int*>room((n + 1), sizeof(int))
    with nogil:
        for k in range(n):
            if k == 0 or x_first[k] != x_first[k - 1]:
                start[runs] = <int>k
                runs += 1
        start[runs] = <int>n
        row = 0
        while row < out.shape[0]:
            end = <int>min(ROWS, out.shape[0] - row)
            for j in range(end):
                f[j] = &samples[within(begin + row + j, samples.shape[0]), 0]
            for k in range(runs):
                at = start[k]
                for j in range(4):
                    column[j] = within(x_first[at] + j, w)
                while at < start[k + 1]:
                    if real is float:
                        expand_few(
                            &floats, f, end, column, &xw[0, at], xw.shape[1],
                            &out[row, at], out.shape[1],
                        )  # fmt: skip
                        at += FLOATS
                    else:
                        expand_few(
                            &doubles, f, end, column, &xw[0, at], xw.shape[1],
                            &out[row, at], out.shape[1],
                        )  # fmt: skip
                        at += DOUBLES
            row += end
        free(start)


cdef inline Py_ssize_t within(Py_ssize_t j, Py_ssize_t n) noexcept nogil:
    """A row or column of samples, clamped to the frame."""
    return 0 if j < 0 else (n - 1 if j >= n else j)


cdef inline void expand_few(
    Lanes* like, real** f, int rows, Py_ssize_t* column, real* w, Py_ssize_t stride, real* out, Py_ssize_t across
) noexcept nogil:
    """Σ f w for a vector of columns that share their four samples, in some rows: their weights are loaded once."""
    cdef int j
    cdef Lanes sums
    cdef Lanes w0 = load(w, like)
    cdef Lanes w1 = load(w + stride, like)
    cdef Lanes w2 = load(w + 2 * stride, like)
    cdef Lanes w3 = load(w + 3 * stride, like)
    for j in range(rows):
        sums = broadcast(f[j], column[0], like) * w0
        sums = sums + broadcast(f[j], column[1], like) * w1
        sums = sums + broadcast(f[j], column[2], like) * w2
        sums = sums + broadcast(f[j], column[3], like) * w3
        store(out + across * j, sums)


def combine(
    real[:, ::1] expanded, int begin, int[::1] y_first, real[:, ::1] yw, real maxval, stored[:, ::1] out
) -> None:
    """The vertical half: every row of output from four rows expanded, of which the first is sample row `begin`."""
    cdef Py_ssize_t y, i
    with nogil:
        for y in range(out.shape[0]):
            i = y_first[y] - begin
            combine_row(
                &expanded[i, 0], &expanded[i + 1, 0],
                &expanded[i + 2, 0], &expanded[i + 3, 0],
                yw[y, 0], yw[y, 1], yw[y, 2], yw[y, 3], maxval, out.shape[1], &out[y, 0],
            )  # fmt: skip


cdef void combine_row(
    real* f0, real* f1, real* f2, real* f3, real w0, real w1, real w2, real w3, real maxval, Py_ssize_t n, stored* out
) noexcept nogil:
    """One row: Σ w f, clamped and rounded half up, or in double as it is."""
    cdef Py_ssize_t x
    cdef real v
    cdef real half = 0.5, zero = 0
    if real is float and stored is cython.uchar:
        if n >= PACK:
            combine_bytes(f0, f1, f2, f3, w0, w1, w2, w3, maxval, n, out)
            return
    for x in range(n):
        v = f0[x] * w0 + f1[x] * w1 + f2[x] * w2 + f3[x] * w3
        if stored is double:
            out[x] = v
        else:
            v = v if v > zero else zero
            v = v if v < maxval else maxval
            out[x] = <int>(v + half)


cdef void combine_bytes(
    float* f0, float* f1, float* f2, float* f3, float w0, float w1, float w2, float w3, float maxval, Py_ssize_t n,
    unsigned char* out,
) noexcept nogil:
    """One row of at least PACK bytes: nearly all of the time that a picture without edges takes."""
    cdef Py_ssize_t h, k
    cdef Floats[4] sums
    cdef Py_ssize_t x = 0
    cdef Floats v0 = broadcast_floats(w0)
    cdef Floats v1 = broadcast_floats(w1)
    cdef Floats v2 = broadcast_floats(w2)
    cdef Floats v3 = broadcast_floats(w3)
    cdef unsigned char most = <unsigned char>maxval
    while True:
        for h in range(4):
            k = x + FLOATS * h
            sums[h] = (
                load(f0 + k, sums) * v0 + load(f1 + k, sums) * v1 + load(f2 + k, sums) * v2 + load(f3 + k, sums) * v3
            )
        pack_bytes(sums, most, out + x)
        if x == n - PACK:
            return
        x = x + PACK if x + 2 * PACK <= n else n - PACK  # the last ones, some of them a second time
