# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The separable pass over whole rows of output: along the rows of samples, then down the columns.

In double, or for 8-bit output in float, which vectorises twice as wide.
"""

import cython

COMPILED = cython.compiled

real = cython.fused_type(cython.float, cython.double)
stored = cython.fused_type(cython.uchar, cython.ushort, cython.double)


def expand(
    samples: real[:, ::1], begin: cython.int, x_first: cython.int[::1], xw: real[:, ::1], out: real[:, ::1]
) -> None:
    """The horizontal half of the separable pass, for the rows of samples from `begin` on, clamped, as many as out has.

    xw: (4, n) weights of each column of output. out: (rows, n).
    """
    row: cython.Py_ssize_t
    x: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.int
    n: cython.Py_ssize_t = out.shape[1]
    w: cython.int = cython.cast(cython.int, samples.shape[1])
    h: cython.int = cython.cast(cython.int, samples.shape[0])
    stop: cython.Py_ssize_t
    f0: real
    f1: real
    f2: real
    f3: real
    with cython.nogil:
        for row in range(out.shape[0]):
            i = begin + row
            i = 0 if i < 0 else (h - 1 if i >= h else i)
            x = 0
            while x < n:
                j = x_first[x]
                stop = x + 1
                while stop < n and x_first[stop] == j:
                    stop += 1
                f0 = samples[i, 0 if j < 0 else (w - 1 if j >= w else j)]
                f1 = samples[i, 0 if j < -1 else (w - 1 if j + 1 >= w else j + 1)]
                f2 = samples[i, 0 if j < -2 else (w - 1 if j + 2 >= w else j + 2)]
                f3 = samples[i, 0 if j < -3 else (w - 1 if j + 3 >= w else j + 3)]
                while x < stop:
                    out[row, x] = f0 * xw[0, x] + f1 * xw[1, x] + f2 * xw[2, x] + f3 * xw[3, x]
                    x += 1


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
    """One row: Σ w f, stored as `keep` stores."""
    x: cython.Py_ssize_t
    v: real
    half: real = 0.5
    zero: real = 0
    for x in range(n):
        v = f0[x] * w0 + f1[x] * w1 + f2[x] * w2 + f3[x] * w3
        if stored is cython.double:
            out[x] = v
        else:
            v = v if v > zero else zero
            v = v if v < maxval else maxval
            out[x] = cython.cast(cython.int, v + half)
