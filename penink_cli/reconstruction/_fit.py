# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Compiled: least squares against what a camera saw of a reconstruction that is a matrix. See fit.py."""

import cython

COMPILED = cython.compiled


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _see(
    weight: cython.float[:, :, ::1],
    x_base: cython.p_int,
    y_base: cython.p_int,
    samples: cython.float[:, ::1],
    out: cython.float[:, ::1],
) -> cython.void:
    """Pixels of a block from its samples; the bases are counted from the block's first sample."""
    p: cython.Py_ssize_t
    q: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    w: cython.p_float
    s: cython.p_float
    sums = cython.declare(cython.float[5])  # a column of samples each, which makes a vector of them
    for p in range(weight.shape[0]):
        for q in range(weight.shape[1]):
            w = cython.address(weight[p, q, 0])
            s = cython.address(samples[y_base[p], x_base[q]])
            for j in range(5):
                sums[j] = 0.0
            for i in range(5):
                for j in range(5):
                    sums[j] += w[5 * i + j] * s[j]
                s += samples.shape[1]
            out[p, q] = (sums[0] + sums[1]) + (sums[2] + sums[3]) + sums[4]


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _unsee(
    weight: cython.float[:, :, ::1],
    x_base: cython.p_int,
    y_base: cython.p_int,
    pixels: cython.float[:, ::1],
    out: cython.float[:, ::1],
) -> cython.void:
    """The transpose of `_see`."""
    p: cython.Py_ssize_t
    q: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    w: cython.p_float
    s: cython.p_float
    v: cython.float
    out[:, :] = 0
    for p in range(weight.shape[0]):
        for q in range(weight.shape[1]):
            w = cython.address(weight[p, q, 0])
            s = cython.address(out[y_base[p], x_base[q]])
            v = pixels[p, q]
            for i in range(5):
                for j in range(5):
                    s[j] += w[5 * i + j] * v
                s += out.shape[1]


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _reflected(i: cython.Py_ssize_t, n: cython.Py_ssize_t) -> cython.Py_ssize_t:
    """Index i of (d c b a | a b c d | d c b a), which keeps the blur its own transpose."""
    while i < 0 or i >= n:
        i = -1 - i if i < 0 else 2 * n - 1 - i
    return i


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _blur(kernel: cython.float[::1], pixels: cython.float[:, ::1], room: cython.float[:, ::1]) -> cython.void:
    """Convolve pixels with a symmetric kernel (its centre first) along both axes, in place."""
    p: cython.Py_ssize_t
    q: cython.Py_ssize_t
    d: cython.Py_ssize_t
    a: cython.Py_ssize_t
    b: cython.Py_ssize_t
    h: cython.Py_ssize_t = pixels.shape[0]
    w: cython.Py_ssize_t = pixels.shape[1]
    k: cython.float
    reach: cython.Py_ssize_t = kernel.shape[0] - 1
    if reach == 0:
        return
    for p in range(h):
        for q in range(w):
            room[p, q] = kernel[0] * pixels[p, q]
        for d in range(1, reach + 1):
            k = kernel[d]
            a = _reflected(p - d, h)
            b = _reflected(p + d, h)
            for q in range(w):
                room[p, q] += k * (pixels[a, q] + pixels[b, q])
    for p in range(h):
        for q in range(w):
            pixels[p, q] = kernel[0] * room[p, q]
        for d in range(1, reach + 1):
            k = kernel[d]
            for q in range(min(d, w)):
                pixels[p, q] += k * (room[p, _reflected(q - d, w)] + room[p, _reflected(q + d, w)])
            for q in range(d, w - d):
                pixels[p, q] += k * (room[p, q - d] + room[p, q + d])
            for q in range(max(d, w - d), w):
                pixels[p, q] += k * (room[p, _reflected(q - d, w)] + room[p, _reflected(q + d, w)])


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _square(v: cython.float[:, ::1]) -> cython.double:
    """‖v‖²."""
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    row: cython.float
    total: cython.double = 0.0
    for i in range(v.shape[0]):
        row = 0.0
        for j in range(v.shape[1]):
            row += v[i, j] * v[i, j]
        total += row
    return total


def solve(
    weight: cython.float[:, :, ::1],
    x_base: cython.int[::1],
    y_base: cython.int[::1],
    kernel: cython.float[::1],
    photo: cython.float[:, ::1],
    hold: cython.float,
    steps: cython.int,
    samples: cython.float[:, ::1],
    room: cython.float[:, :, ::1],
    pixel_room: cython.float[:, :, ::1],
) -> None:
    """Conjugate gradients for ‖B R s − photo‖² + hold ‖s − s₀‖² over one block, samples being s₀ and then s.

    samples: at least 5 × 5; weight, x_base, y_base: as of `_rows.rows`, the bases counted from the first sample.
    room: (3, rows, columns) of samples; pixel_room: (2, rows, columns) of pixels; to work in.
    """
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    square: cython.double
    next_square: cython.double
    step: cython.float
    turn: cython.float
    columns: cython.p_int = cython.address(x_base[0])
    rows: cython.p_int = cython.address(y_base[0])
    g: cython.float[:, ::1] = room[0]
    way: cython.float[:, ::1] = room[1]
    change: cython.float[:, ::1] = room[2]
    seen: cython.float[:, ::1] = pixel_room[0]
    spare: cython.float[:, ::1] = pixel_room[1]
    with cython.nogil:
        _see(weight, columns, rows, samples, seen)
        _blur(kernel, seen, spare)
        for i in range(photo.shape[0]):
            for j in range(photo.shape[1]):
                seen[i, j] = photo[i, j] - seen[i, j]
        _blur(kernel, seen, spare)
        _unsee(weight, columns, rows, seen, g)
        way[:, :] = g
        square = _square(g)
        for _ in range(steps):
            if square < 1e-14:
                break
            _see(weight, columns, rows, way, seen)
            _blur(kernel, seen, spare)
            step = cython.cast(cython.float, square / (_square(seen) + hold * _square(way)))
            _blur(kernel, seen, spare)
            _unsee(weight, columns, rows, seen, change)
            for i in range(g.shape[0]):
                for j in range(g.shape[1]):
                    samples[i, j] += step * way[i, j]
                    g[i, j] -= step * (change[i, j] + hold * way[i, j])
            next_square = _square(g)
            turn = cython.cast(cython.float, next_square / square)
            for i in range(g.shape[0]):
                for j in range(g.shape[1]):
                    way[i, j] = g[i, j] + turn * way[i, j]
            square = next_square
