# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The separable pass over whole rows of output: along the rows of samples, then down the columns.

In double, or for 8-bit output in float, which vectorises twice as wide.
"""

import cython
from cython.cimports.libc.stdlib import free, malloc
from cython.cimports.penink_cli.reconstruction._lanes import (
    DOUBLES,
    FLOATS,
    PACK,
    Doubles,
    Floats,
    Lanes,
    all_floats,
    load,
    number,
    pack_bytes,
    store,
)

COMPILED = cython.compiled

real = cython.fused_type(cython.float, cython.double)
ROWS = cython.declare(cython.int, 16)  # of samples, expanded at once
stored = cython.fused_type(cython.uchar, cython.ushort, cython.double)


def expand(
    samples: real[:, ::1], begin: cython.int, x_first: cython.int[::1], xw: real[:, ::1], out: real[:, ::1]
) -> None:
    """The horizontal half of the separable pass, for the rows of samples from `begin` on, clamped, as many as out has.

    x_first: (n,) the first sample of each column of output. xw: (4, n + 8) their weights. out: (rows, n + 8). What is
    beyond the n columns is room: the columns that share their samples are computed a few at a time, from left to right.
    """
    row: cython.Py_ssize_t
    k: cython.Py_ssize_t
    n: cython.Py_ssize_t = x_first.shape[0]
    w: cython.Py_ssize_t = samples.shape[1]
    runs: cython.Py_ssize_t = 0
    at: cython.Py_ssize_t
    j: cython.int
    end: cython.int
    f: cython.pointer[real][16]
    column: cython.Py_ssize_t[4]
    floats: Floats
    doubles: Doubles
    start: cython.p_int = cython.cast(cython.p_int, malloc((n + 1) * cython.sizeof(cython.int)))
    with cython.nogil:
        for k in range(n):
            if k == 0 or x_first[k] != x_first[k - 1]:
                start[runs] = cython.cast(cython.int, k)
                runs += 1
        start[runs] = cython.cast(cython.int, n)
        row = 0
        while row < out.shape[0]:
            end = cython.cast(cython.int, min(ROWS, out.shape[0] - row))
            for j in range(end):
                f[j] = cython.address(samples[within(begin + row + j, samples.shape[0]), 0])
            for k in range(runs):
                at = start[k]
                for j in range(4):
                    column[j] = within(x_first[at] + j, w)
                while at < start[k + 1]:
                    if real is cython.float:
                        expand_few(
                            cython.address(floats), f, end, column, cython.address(xw[0, at]), xw.shape[1],
                            cython.address(out[row, at]), out.shape[1],
                        )  # fmt: skip
                        at += FLOATS
                    else:
                        expand_few(
                            cython.address(doubles), f, end, column, cython.address(xw[0, at]), xw.shape[1],
                            cython.address(out[row, at]), out.shape[1],
                        )  # fmt: skip
                        at += DOUBLES
            row += end
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
def expand_few(
    like: cython.pointer[Lanes],
    f: cython.pointer[cython.pointer[real]],
    rows: cython.int,
    column: cython.pointer[cython.Py_ssize_t],
    w: cython.pointer[real],
    stride: cython.Py_ssize_t,
    out: cython.pointer[real],
    across: cython.Py_ssize_t,
) -> cython.void:
    """Σ f w for a vector of columns that share their four samples, in some rows: their weights are loaded once."""
    j: cython.int
    sums: Lanes
    w0: Lanes = load(w, like)
    w1: Lanes = load(w + stride, like)
    w2: Lanes = load(w + 2 * stride, like)
    w3: Lanes = load(w + 3 * stride, like)
    for j in range(rows):
        sums = number(f[j], column[0], like) * w0
        sums = sums + number(f[j], column[1], like) * w1
        sums = sums + number(f[j], column[2], like) * w2
        sums = sums + number(f[j], column[3], like) * w3
        store(out + across * j, sums)


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
    v: real
    half: real = 0.5
    zero: real = 0
    if real is cython.float and stored is cython.uchar:
        if n >= PACK:
            combine_bytes(f0, f1, f2, f3, w0, w1, w2, w3, maxval, n, out)
            return
    for x in range(n):
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
    """One row of at least PACK bytes: nearly all of the time that a picture without edges takes."""
    x: cython.Py_ssize_t = 0
    h: cython.Py_ssize_t
    k: cython.Py_ssize_t
    v0: Floats = all_floats(w0)
    v1: Floats = all_floats(w1)
    v2: Floats = all_floats(w2)
    v3: Floats = all_floats(w3)
    most: cython.uchar = cython.cast(cython.uchar, maxval)
    sums: Floats[4]
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
