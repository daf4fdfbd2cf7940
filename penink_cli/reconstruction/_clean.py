# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Compiled: what a pixel can reach without crossing an edge, and values fitted to that. See extraction.py.

The pixels that a walk reaches are kept as bits, a row of the window around it in one word, and so are
the steps that are open. A flood of words takes a fifth of the time of a queue of pixels.
"""

import cython
from cython.cimports.libc.math import exp, floor
from cython.cimports.penink_cli.reconstruction._scene import side_of_query, side_of_vertex

COMPILED = cython.compiled

MAX_REACH = 24  # steps of a walk along each axis; the window is 2 · 24 + 1 wide, and fits a word


@cython.cclass
class Ground:
    """What can be walked on: words of 64 columns with an empty one before each row and one or two after it.

    right, down: (h, words) a bit for each pixel centre from which a step leads to the next without crossing
    an edge. clean: (h, words) a bit for each pixel that counts.
    """

    right: cython.ulonglong[:, ::1]
    down: cython.ulonglong[:, ::1]
    clean: cython.ulonglong[:, ::1]
    height: cython.int

    def __init__(
        self,
        right: cython.ulonglong[:, ::1],
        down: cython.ulonglong[:, ::1],
        clean: cython.ulonglong[:, ::1],
    ) -> None:
        self.right = right
        self.down = down
        self.clean = clean
        self.height = right.shape[0]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def flood(self, i: cython.int, j: cython.int, reach: cython.int, seen: cython.p_ulonglong) -> cython.void:
        """Spread the bits of `seen`, rows i − reach … of columns j − reach …, over all that they reach there."""
        side: cython.int = 2 * reach + 1
        first: cython.int = max(0, reach - i)
        last: cython.int = min(side, self.height - i + reach)
        r: cython.int
        k: cython.int
        row: cython.int
        sweep: cython.int
        changed: cython.bint = True
        one: cython.ulonglong = 1
        s: cython.ulonglong
        inside: cython.ulonglong = (one << side) - 1
        right = cython.declare(cython.ulonglong[49])
        down = cython.declare(cython.ulonglong[49])
        for r in range(first, last):
            row = i - reach + r
            right[r] = _bits(cython.address(self.right[row, 0]), j - reach) & (inside >> 1)
            down[r] = _bits(cython.address(self.down[row, 0]), j - reach) & inside
        while changed:
            changed = False
            for sweep in range(2):
                for k in range(first, last):
                    r = k if sweep == 0 else first + last - 1 - k
                    s = seen[r]
                    if r > first:
                        s |= seen[r - 1] & down[r - 1]
                    if r + 1 < last:
                        s |= seen[r + 1] & down[r]
                    if s:
                        s = _along(s, right[r], side)
                    if s != seen[r]:
                        seen[r] = s
                        changed = True


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _bits(words: cython.p_ulonglong, x: cython.int) -> cython.ulonglong:
    """The 64 bits from column x ≥ −64 on."""
    at: cython.int = x + 64
    k: cython.int = at >> 6
    shift: cython.int = at & 63
    if shift == 0:
        return words[k]
    return (words[k] >> shift) | (words[k + 1] << (64 - shift))


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _along(s: cython.ulonglong, right: cython.ulonglong, side: cython.int) -> cython.ulonglong:
    """Spread bits along a row both ways, in steps of 1, 2, 4 … columns over the open ones (Kogge and Stone)."""
    onward: cython.ulonglong = right << 1
    back: cython.ulonglong = right
    step: cython.int = 1
    a: cython.ulonglong = s
    b: cython.ulonglong = s
    while step < side:
        a |= onward & (a << step)
        b |= back & (b >> step)
        onward &= onward << step
        back &= back >> step
        step *= 2
    return a | b


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _plane(
    values: cython.float[:, ::1],
    seen: cython.p_ulonglong,
    i: cython.int,
    j: cython.int,
    reach: cython.int,
    x: cython.double,
    y: cython.double,
    across: cython.p_double,
    down: cython.p_double,
    stiffness: cython.double,
    out: cython.p_double,
) -> cython.bint:
    """Value at (x, y), in pixel centres, of the plane fitted to the pixels of `seen` around (i, j).

    across, down: weights of the window's columns and rows; a pixel's is their product. `stiffness` holds
    the slope back, the more the farther the pixels lie to one side. False where there are no pixels.
    """
    r: cython.int
    c: cython.int
    dx: cython.double
    dy: cython.double
    w: cython.double
    v: cython.double
    bits: cython.ulonglong
    row: cython.p_float
    side: cython.int = 2 * reach + 1
    r0: cython.double
    r1: cython.double
    r2: cython.double
    v0: cython.double
    v1: cython.double
    s: cython.double = 0
    sx: cython.double = 0
    sy: cython.double = 0
    sxx: cython.double = 0
    sxy: cython.double = 0
    syy: cython.double = 0
    sv: cython.double = 0
    sxv: cython.double = 0
    syv: cython.double = 0
    low: cython.double = 1e9
    high: cython.double = -1e9
    det: cython.double
    bx: cython.double
    by: cython.double
    for r in range(side):
        bits = seen[r]
        if bits == 0:
            continue
        row = cython.address(values[i - reach + r, 0])
        r0 = r1 = r2 = v0 = v1 = 0.0
        c = 0
        while bits:
            if bits & 1:
                dx = j - reach + c - x
                v = row[j - reach + c]
                w = across[c]
                r0 += w
                v0 += w * v
                w *= dx
                r1 += w
                v1 += w * v
                r2 += w * dx
                low = min(low, v)
                high = max(high, v)
            bits >>= 1
            c += 1
        dy = i - reach + r - y
        w = down[r]
        s += w * r0
        sx += w * r1
        sxx += w * r2
        sv += w * v0
        sxv += w * v1
        w *= dy
        sy += w * r0
        sxy += w * r1
        syv += w * v0
        syy += w * dy * r0
    if s < 1e-12:
        return False
    sx /= s
    sy /= s
    sv /= s
    sxx = sxx / s - sx * sx + stiffness
    syy = syy / s - sy * sy + stiffness
    sxy = sxy / s - sx * sy
    sxv = sxv / s - sx * sv
    syv = syv / s - sy * sv
    det = sxx * syy - sxy * sxy
    bx = (sxv * syy - syv * sxy) / det
    by = (syv * sxx - sxv * sxy) / det
    v = sv - bx * sx - by * sy
    w = 0.5 * (high - low)
    out[0] = min(high + w, max(low - w, v))
    return True


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _least_contaminated(
    values: cython.float[:, ::1],
    distance: cython.float[:, ::1],
    seen: cython.p_ulonglong,
    i: cython.int,
    j: cython.int,
    reach: cython.int,
    spread: cython.double,
) -> cython.double:
    """Mean of the pixels of `seen` that lie farthest from edges, the near ones more."""
    r: cython.int
    c: cython.int
    bits: cython.ulonglong
    w: cython.double
    best: cython.double = 0
    s: cython.double = 0
    sv: cython.double = 0
    sweep: cython.int
    for sweep in range(2):
        for r in range(2 * reach + 1):
            bits = seen[r]
            c = 0
            while bits:
                if bits & 1:
                    if sweep == 0:
                        best = max(best, distance[i - reach + r, j - reach + c])
                    else:
                        w = (r - reach) * (r - reach) + (c - reach) * (c - reach)
                        w = exp(-w / (2 * spread * spread) + 6 * (distance[i - reach + r, j - reach + c] - best))
                        s += w
                        sv += w * values[i - reach + r, j - reach + c]
                bits >>= 1
                c += 1
    return sv / s if s > 0 else values[i, j]


def extrapolate(
    values: cython.float[:, ::1],
    ground: Ground,
    distance: cython.float[:, ::1],
    margin: cython.double,
    first_row: cython.Py_ssize_t,
    last_row: cython.Py_ssize_t,
    steps: cython.int,
    spread: cython.double,
    stiffness: cython.double,
    table: cython.double[::1],
    out: cython.float[:, ::1],
) -> None:
    """Replace the contaminated pixels (distance ≤ margin) of rows first_row … last_row − 1.

    A plane is fitted to the clean pixels within `steps`; where there are none, up to MAX_REACH
    away; and where the region has none at all, the mean of its least contaminated pixels is taken.

    table: (2 · MAX_REACH + 1,) weights by the distance along an axis, its middle standing for none.
    out: (h, w) filled in these rows.
    """
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    reach: cython.int
    k: cython.int
    one: cython.ulonglong = 1
    done: cython.bint
    value: cython.double = 0
    weights: cython.p_double
    seen = cython.declare(cython.ulonglong[49])
    clean = cython.declare(cython.ulonglong[49])
    with cython.nogil:
        for i in range(first_row, last_row):
            for j in range(values.shape[1]):
                if distance[i, j] > margin:
                    out[i, j] = values[i, j]
                    continue
                reach = min(24, steps)
                while True:
                    for k in range(2 * reach + 1):
                        seen[k] = 0
                        clean[k] = 0
                    seen[reach] = one << reach
                    ground.flood(i, j, reach, seen)
                    for k in range(max(0, reach - i), min(2 * reach + 1, values.shape[0] - i + reach)):
                        if seen[k]:
                            clean[k] = seen[k] & _bits(cython.address(ground.clean[i - reach + k, 0]), j - reach)
                    weights = cython.address(table[24 - reach])
                    done = _plane(values, clean, i, j, reach, j, i, weights, weights, stiffness, cython.address(value))
                    if done or reach == 24:
                        break
                    reach = min(24, 2 * reach)
                if not done:
                    value = _least_contaminated(values, distance, seen, i, j, reach, spread)
                out[i, j] = value


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _sees(
    ax: cython.double[::1],
    ay: cython.double[::1],
    bx: cython.double[::1],
    by: cython.double[::1],
    e: cython.int,
    px: cython.double,
    py: cython.double,
    qx: cython.double,
    qy: cython.double,
) -> cython.bint:
    """Whether edge e leaves the segment from p to q alone, both shifted by (ε, ε²)."""
    if side_of_query(ax[e], ay[e], bx[e], by[e], px, py) == side_of_query(ax[e], ay[e], bx[e], by[e], qx, qy):
        return True
    return side_of_vertex(px, py, qx, qy, ax[e], ay[e]) == side_of_vertex(px, py, qx, qy, bx[e], by[e])


def resample(
    values: cython.float[:, ::1],
    ground: Ground,
    ax: cython.double[::1],
    ay: cython.double[::1],
    bx: cython.double[::1],
    by: cython.double[::1],
    cell: cython.double,
    first: cython.int[:, ::1],
    items: cython.int[::1],
    first_row: cython.Py_ssize_t,
    last_row: cython.Py_ssize_t,
    steps: cython.int,
    spread: cython.double,
    stiffness: cython.double,
    near: cython.float[:, ::1],
    out: cython.double[:, ::1],
) -> None:
    """Fill new samples of some rows, those with a finite `near`, each from the pixels that its place reaches.

    first: (rows, columns + 1 as one flat run) offsets of `items` by cell, as of `bucket`. spread, stiffness:
    as of `_plane`, the weights being a Gaussian.
    """
    height: cython.Py_ssize_t = values.shape[0]
    width: cython.Py_ssize_t = values.shape[1]
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    k: cython.Py_ssize_t
    ci: cython.Py_ssize_t
    cj: cython.Py_ssize_t
    pi: cython.int
    pj: cython.int
    di: cython.int
    dj: cython.int
    x: cython.double
    y: cython.double
    px: cython.double
    py: cython.double
    d: cython.double
    visible: cython.bint
    any_visible: cython.bint
    value: cython.double = 0
    one: cython.ulonglong = 1
    seen = cython.declare(cython.ulonglong[49])
    across = cython.declare(cython.double[49])
    down = cython.declare(cython.double[49])
    with cython.nogil:
        for i in range(first_row, last_row):
            for j in range(out.shape[1]):
                if near[i, j] > 1e9:
                    continue
                x = (j + 0.5) * width / out.shape[1]
                y = (i + 0.5) * height / out.shape[0]
                pi = cython.cast(cython.int, floor(y - 0.5))
                pj = cython.cast(cython.int, floor(x - 0.5))
                any_visible = False
                for k in range(2 * steps + 1):
                    seen[k] = 0
                for di in range(2):
                    for dj in range(2):
                        if not (0 <= pi + di < height and 0 <= pj + dj < width):
                            continue
                        px = pj + dj + 0.5
                        py = pi + di + 0.5
                        visible = True
                        for ci in range(
                            cython.cast(cython.Py_ssize_t, min(y, py) / cell),
                            cython.cast(cython.Py_ssize_t, max(y, py) / cell) + 1,
                        ):
                            for cj in range(
                                cython.cast(cython.Py_ssize_t, min(x, px) / cell),
                                cython.cast(cython.Py_ssize_t, max(x, px) / cell) + 1,
                            ):
                                for k in range(first[ci, cj], first[ci, cj + 1]):
                                    if not _sees(ax, ay, bx, by, items[k], x, y, px, py):
                                        visible = False
                        if visible:
                            seen[steps + di] |= one << (steps + dj)
                            any_visible = True
                if not any_visible:
                    out[i, j] = values[
                        min(height - 1, cython.cast(cython.Py_ssize_t, y)),
                        min(width - 1, cython.cast(cython.Py_ssize_t, x)),
                    ]
                    continue
                ground.flood(pi, pj, steps, seen)
                for k in range(2 * steps + 1):
                    d = pj - steps + k - (x - 0.5)
                    across[k] = exp(-d * d / (2 * spread * spread))
                    d = pi - steps + k - (y - 0.5)
                    down[k] = exp(-d * d / (2 * spread * spread))
                _plane(values, seen, pi, pj, steps, x - 0.5, y - 0.5, across, down, stiffness, cython.address(value))
                out[i, j] = value
