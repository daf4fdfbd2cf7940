# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The separable pass over whole rows of output: along the rows of samples, then down the columns.

In double, or for 8-bit output in float, which vectorises twice as wide.
"""

import cython
from cython.cimports.libc.stdlib import free, malloc
from cython.cimports.penink_cli.reconstruction._lanes import (
    Four,
    Lanes,
    Two,
    all_four,
    all_two,
    four_at,
    keep_bytes,
    less_four,
    load,
    store,
)

COMPILED = cython.compiled

real = cython.fused_type(cython.float, cython.double)
stored = cython.fused_type(cython.uchar, cython.ushort, cython.double)


def expand(
    samples: real[:, ::1], begin: cython.int, x_first: cython.int[::1], xw: real[:, ::1], out: real[:, ::1]
) -> None:
    """The horizontal half of the separable pass, for the rows of samples from `begin` on, clamped, as many as out has.

    x_first: (n,) the first sample of each column of output. xw: (4, n + 8) their weights. out: (rows, n + 8). What is
    beyond the n columns is room: the columns that share their samples are computed a few at a time, from left to right.
    """
    row: cython.Py_ssize_t
    i: cython.Py_ssize_t
    k: cython.Py_ssize_t
    n: cython.Py_ssize_t = x_first.shape[0]
    runs: cython.Py_ssize_t = 0
    j: cython.int
    w: cython.int = cython.cast(cython.int, samples.shape[1])
    h: cython.int = cython.cast(cython.int, samples.shape[0])
    f: cython.pointer[real]
    four: Four[4]
    two: Two[4]
    start: cython.p_int = cython.cast(cython.p_int, malloc((n + 1) * cython.sizeof(cython.int)))
    with cython.nogil:
        for k in range(n):
            if k == 0 or x_first[k] != x_first[k - 1]:
                start[runs] = cython.cast(cython.int, k)
                runs += 1
        start[runs] = cython.cast(cython.int, n)
        for row in range(out.shape[0]):
            i = begin + row
            f = cython.address(samples[within(i, h), 0])
            for k in range(runs):
                for j in range(4):
                    if real is cython.float:
                        four[j] = all_four(f[within(x_first[start[k]] + j, w)])
                    else:
                        two[j] = all_two(f[within(x_first[start[k]] + j, w)])
                if real is cython.float:
                    expand_run(
                        four, cython.address(xw[0, start[k]]), xw.shape[1], start[k + 1] - start[k],
                        cython.address(out[row, start[k]]),
                    )  # fmt: skip
                else:
                    expand_run(
                        two, cython.address(xw[0, start[k]]), xw.shape[1], start[k + 1] - start[k],
                        cython.address(out[row, start[k]]),
                    )  # fmt: skip
        free(start)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def within(j: cython.Py_ssize_t, n: cython.Py_ssize_t) -> cython.Py_ssize_t:
    """A row or column of samples, clamped to the frame."""
    return 0 if j < 0 else (n - 1 if j >= n else j)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def expand_run(
    f: cython.pointer[Lanes],
    w: cython.pointer[real],
    stride: cython.Py_ssize_t,
    n: cython.Py_ssize_t,
    out: cython.pointer[real],
) -> cython.void:
    """Σ f w for n columns that share their four samples, and for a few beyond them."""
    x: cython.Py_ssize_t = 0
    step: cython.Py_ssize_t = 4 if Lanes is Four else 2
    sums: Lanes
    while x < n:
        sums = f[0] * load(w + x, f)
        sums = sums + f[1] * load(w + stride + x, f)
        sums = sums + f[2] * load(w + 2 * stride + x, f)
        sums = sums + f[3] * load(w + 3 * stride + x, f)
        store(out + x, sums)
        x += step


def combine(
    expanded: real[:, ::1],
    begin: cython.int,
    y_first: cython.int[::1],
    yw: real[:, ::1],
    maxval: real,
    out: stored[:, ::1],
) -> None:
    """The vertical half: every row of output from four rows expanded, of which the first is sample row `begin`."""
    y: cython.Py_ssize_t
    i: cython.Py_ssize_t
    with cython.nogil:
        for y in range(out.shape[0]):
            i = y_first[y] - begin
            combine_row(
                cython.address(expanded[i, 0]), cython.address(expanded[i + 1, 0]),
                cython.address(expanded[i + 2, 0]), cython.address(expanded[i + 3, 0]),
                yw[y, 0], yw[y, 1], yw[y, 2], yw[y, 3], maxval, out.shape[1], cython.address(out[y, 0]),
            )  # fmt: skip


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def combine_row(
    f0: cython.pointer[real],
    f1: cython.pointer[real],
    f2: cython.pointer[real],
    f3: cython.pointer[real],
    w0: real,
    w1: real,
    w2: real,
    w3: real,
    maxval: real,
    n: cython.Py_ssize_t,
    out: cython.pointer[stored],
) -> cython.void:
    """One row: Σ w f, clamped and rounded half up, or in double as it is."""
    x: cython.Py_ssize_t
    begin: cython.Py_ssize_t = 0
    v: real
    half: real = 0.5
    zero: real = 0
    if real is cython.float and stored is cython.uchar:
        begin = n & ~7
        combine_bytes(f0, f1, f2, f3, w0, w1, w2, w3, maxval, begin, out)
    for x in range(begin, n):
        v = f0[x] * w0 + f1[x] * w1 + f2[x] * w2 + f3[x] * w3
        if stored is cython.double:
            out[x] = v
        else:
            v = v if v > zero else zero
            v = v if v < maxval else maxval
            out[x] = cython.cast(cython.int, v + half)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def combine_bytes(
    f0: cython.p_float,
    f1: cython.p_float,
    f2: cython.p_float,
    f3: cython.p_float,
    w0: cython.float,
    w1: cython.float,
    w2: cython.float,
    w3: cython.float,
    maxval: cython.float,
    n: cython.Py_ssize_t,
    out: cython.p_uchar,
) -> cython.void:
    """The first n of a row, a multiple of eight: nearly all of the time that a picture without edges takes."""
    x: cython.Py_ssize_t
    a: Four
    b: Four
    v0: Four = all_four(w0)
    v1: Four = all_four(w1)
    v2: Four = all_four(w2)
    v3: Four = all_four(w3)
    most: Four = all_four(maxval)
    for x in range(0, n, 8):
        a = four_at(f0 + x) * v0 + four_at(f1 + x) * v1 + four_at(f2 + x) * v2 + four_at(f3 + x) * v3
        b = four_at(f0 + x + 4) * v0 + four_at(f1 + x + 4) * v1 + four_at(f2 + x + 4) * v2 + four_at(f3 + x + 4) * v3
        keep_bytes(less_four(a, most), less_four(b, most), out + x)
