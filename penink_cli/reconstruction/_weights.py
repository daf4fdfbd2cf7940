# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The reconstruction at single points: the weight that equation 5 gives to each sample under the kernel.

Slower than the tiles of an enlargement, and free of their conditions: any points, any widening of the kernels.
"""

import cython
from cython.cimports.penink_cli.reconstruction._search import Finder

COMPILED = cython.compiled

T1 = cython.declare(cython.double, 0.5)  # below this sum of cubic weights the B-spline is blended in
T2 = cython.declare(cython.double, 1e-4)  # below this sum of B-spline weights plain convolution is faded in


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def smooth(t: cython.double) -> cython.double:
    """S(t) = 3t² − 2t³, clamped."""
    return 0.0 if t <= 0.0 else (1.0 if t >= 1.0 else t * t * (3.0 - 2.0 * t))


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def clamp(k: cython.int, n: cython.int) -> cython.int:
    """The nearest index that exists."""
    return 0 if k < 0 else (n - 1 if k >= n else k)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def weigh(
    finder: Finder,
    px: cython.double,
    py: cython.double,
    j0: cython.int,
    i0: cython.int,
    xc: cython.p_double,
    xb: cython.p_double,
    nx: cython.int,
    yc: cython.p_double,
    yb: cython.p_double,
    ny: cython.int,
    r: cython.double,
    only_b: cython.bint,
    out: cython.p_double,
) -> cython.double:
    """Weights of the ny × nx taps from (row i0, column j0) on, which sum to one; returned, how starved the point is.

    Taps beyond the frame are replicated: the weight of their own place, the visibility and detour of their source.
    """
    w: cython.int = finder.scene.width
    h: cython.int = finder.scene.height
    a: cython.int
    b: cython.int
    k: cython.int = 0
    alpha: cython.double
    sum_c: cython.double = 0.0
    sum_b: cython.double = 0.0
    omega: cython.double = 0.0
    fade: cython.double = 0.0
    norm: cython.double = 0.0
    left: cython.int = clamp(j0, w)
    right: cython.int = clamp(j0 + nx - 1, w)
    top: cython.int = clamp(i0, h)
    bottom: cython.int = clamp(i0 + ny - 1, h)
    row: cython.p_double
    if finder.scene.n_edges == 0 or not finder.attenuate(px, py, top, bottom, left, right, r):
        for a in range(ny):
            for b in range(nx):
                out[k] = yb[a] * xb[b] if only_b else yc[a] * xc[b]
                k += 1
        return 0.0
    for a in range(ny):
        row = finder.alpha + (clamp(i0 + a, h) - top) * (right - left + 1) - left
        for b in range(nx):
            alpha = row[clamp(j0 + b, w)]
            sum_c += alpha * (yc[a] * xc[b])
            sum_b += alpha * (yb[a] * xb[b])
    if not only_b:
        omega = smooth(sum_c / T1)
    fade = 1.0 - smooth(sum_b / T2)
    norm = omega * sum_c + (1.0 - omega) * sum_b
    norm = (1.0 - fade) / norm if norm > 0.0 else 0.0
    for a in range(ny):
        row = finder.alpha + (clamp(i0 + a, h) - top) * (right - left + 1) - left
        for b in range(nx):
            alpha = row[clamp(j0 + b, w)]
            out[k] = norm * alpha * (omega * (yc[a] * xc[b]) + (1.0 - omega) * (yb[a] * xb[b]))
            if fade > 0.0:
                out[k] += fade * (yb[a] * xb[b] if only_b else yc[a] * xc[b])
            k += 1
    return fade


def scattered(
    finder: Finder,
    points: cython.double[:, ::1],
    x_first: cython.int[::1],
    xc: cython.double[:, ::1],
    xb: cython.double[:, ::1],
    y_first: cython.int[::1],
    yc: cython.double[:, ::1],
    yb: cython.double[:, ::1],
    r: cython.double,
    only_b: cython.bint,
    begin: cython.Py_ssize_t,
    end: cython.Py_ssize_t,
    index: cython.longlong[:, ::1],
    weight: cython.double[:, ::1],
    starved: cython.double[::1],
) -> None:
    """Sample indices, weights and starvation of the points begin … end."""
    k: cython.Py_ssize_t
    a: cython.int
    b: cython.int
    n: cython.int = cython.cast(cython.int, xc.shape[1])
    w: cython.int = finder.scene.width
    h: cython.int = finder.scene.height
    with cython.nogil:
        for k in range(begin, end):
            starved[k] = weigh(
                finder, points[k, 0], points[k, 1], x_first[k], y_first[k],
                cython.address(xc[k, 0]), cython.address(xb[k, 0]), n,
                cython.address(yc[k, 0]), cython.address(yb[k, 0]), n,
                r, only_b, cython.address(weight[k, 0]),
            )  # fmt: skip
            for a in range(n):
                for b in range(n):
                    index[k, a * n + b] = cython.cast(cython.longlong, clamp(y_first[k] + a, h)) * w + clamp(
                        x_first[k] + b, w
                    )


def lattice(
    finder: Finder,
    samples: cython.double[:, ::1],
    x: cython.double[::1],
    x_first: cython.int[::1],
    xc: cython.double[:, ::1],
    xb: cython.double[:, ::1],
    y: cython.double[::1],
    y_first: cython.int[::1],
    yc: cython.double[:, ::1],
    yb: cython.double[:, ::1],
    r: cython.double,
    only_b: cython.bint,
    weight: cython.double[::1],
    out: cython.double[:, ::1],
) -> None:
    """Values at every crossing of the columns x and the rows y. weight: room for the taps of one point."""
    p: cython.Py_ssize_t
    q: cython.Py_ssize_t
    a: cython.int
    b: cython.int
    i: cython.int
    nx: cython.int = cython.cast(cython.int, xc.shape[1])
    ny: cython.int = cython.cast(cython.int, yc.shape[1])
    w: cython.int = finder.scene.width
    h: cython.int = finder.scene.height
    total: cython.double
    with cython.nogil:
        for p in range(y.shape[0]):
            for q in range(x.shape[0]):
                weigh(
                    finder, x[q], y[p], x_first[q], y_first[p],
                    cython.address(xc[q, 0]), cython.address(xb[q, 0]), nx,
                    cython.address(yc[p, 0]), cython.address(yb[p, 0]), ny,
                    r, only_b, cython.address(weight[0]),
                )  # fmt: skip
                total = 0.0
                for a in range(ny):
                    i = clamp(y_first[p] + a, h)
                    for b in range(nx):
                        total += weight[a * nx + b] * samples[i, clamp(x_first[q] + b, w)]
                out[p, q] = total
