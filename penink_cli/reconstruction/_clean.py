# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Compiled: what a pixel can reach without crossing an edge, and values fitted to that. See extraction.py."""

import cython

COMPILED = cython.compiled

if cython.compiled:
    from cython.cimports.libc.math import ceil, exp, floor, sqrt
else:
    from math import ceil, exp, floor, sqrt

RIGHT = 1  # an edge passes between this pixel's centre and the next in the row
DOWN = 2  # … and the one below

MAX_REACH = 24  # steps of a pixel centre's walk; the window below is 2 · 24 + 1 wide


def block(
    ax: cython.double[::1],
    ay: cython.double[::1],
    bx: cython.double[::1],
    by: cython.double[::1],
    walls: cython.uchar[:, ::1],
) -> None:
    """Mark the steps between neighbouring pixel centres that cross an edge.

    The edges (x, y in pixels of this image, pixel (i, j) centred on (j + ½, i + ½)) meet the
    lines through the centres; a centre on an edge stands for itself shifted by (ε, ε²).

    walls: (h, w) zeros, filled with RIGHT and DOWN.
    """
    height: cython.Py_ssize_t = walls.shape[0]
    width: cython.Py_ssize_t = walls.shape[1]
    e: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    x0: cython.double
    y0: cython.double
    x1: cython.double
    y1: cython.double
    at: cython.double
    with cython.nogil:
        for e in range(ax.shape[0]):
            x0 = ax[e] - 0.5
            y0 = ay[e] - 0.5
            x1 = bx[e] - 0.5
            y1 = by[e] - 0.5
            if y0 > y1:
                x0, y0, x1, y1 = x1, y1, x0, y0
            # rows i with y0 <= i < y1
            i = max(0, cython.cast(cython.Py_ssize_t, ceil(y0)))
            while i < height and i < y1:
                at = x0 + (i - y0) * ((x1 - x0) / (y1 - y0))
                j = cython.cast(cython.Py_ssize_t, ceil(at)) - 1
                if 0 <= j < width - 1:
                    walls[i, j] |= 1
                i += 1
            if x0 > x1:
                x0, y0, x1, y1 = x1, y1, x0, y0
            j = max(0, cython.cast(cython.Py_ssize_t, ceil(x0)))
            while j < width and j < x1:
                at = y0 + (j - x0) * ((y1 - y0) / (x1 - x0))
                i = cython.cast(cython.Py_ssize_t, ceil(at)) - 1
                if at == ceil(at) and y1 > y0:
                    i += 1
                if 0 <= i < height - 1:
                    walls[i, j] |= 2
                j += 1


def near(
    ax: cython.double[::1],
    ay: cython.double[::1],
    bx: cython.double[::1],
    by: cython.double[::1],
    margin: cython.double,
    distance: cython.float[:, ::1],
) -> None:
    """Lower `distance` (h, w) to the distance from pixel centres to edges, where it is at most margin."""
    height: cython.Py_ssize_t = distance.shape[0]
    width: cython.Py_ssize_t = distance.shape[1]
    e: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    x0: cython.double
    y0: cython.double
    dx: cython.double
    dy: cython.double
    px: cython.double
    py: cython.double
    length: cython.double
    along: cython.double
    left: cython.double
    right: cython.double
    slope: cython.double
    found: cython.double
    low: cython.double
    high: cython.double
    with cython.nogil:
        for e in range(ax.shape[0]):
            x0 = ax[e] - 0.5
            y0 = ay[e] - 0.5
            dx = bx[e] - ax[e]
            dy = by[e] - ay[e]
            length = dx * dx + dy * dy
            if length == 0:
                continue
            low = min(y0, y0 + dy) - margin
            high = max(y0, y0 + dy) + margin
            i = max(0, cython.cast(cython.Py_ssize_t, ceil(low)))
            while i < height and i <= high:
                # the part of the edge within margin of this row bounds the columns
                left = 0.0
                right = 1.0
                if dy != 0:
                    left = (i - margin - y0) / dy
                    right = (i + margin - y0) / dy
                    if left > right:
                        left, right = right, left
                    left = max(0.0, left)
                    right = min(1.0, right)
                if left <= right:
                    slope = x0 + left * dx
                    right = x0 + right * dx
                    left = min(slope, right) - margin
                    right = max(slope, right) + margin
                    j = max(0, cython.cast(cython.Py_ssize_t, ceil(left)))
                    while j < width and j <= right:
                        px = j - x0
                        py = i - y0
                        along = (px * dx + py * dy) / length
                        along = min(1.0, max(0.0, along))
                        px -= along * dx
                        py -= along * dy
                        found = sqrt(px * px + py * py)
                        if found <= margin and found < distance[i, j]:
                            distance[i, j] = found
                        j += 1
                i += 1


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _walk(
    walls: cython.uchar[:, ::1],
    steps: cython.int,
    i: cython.int,
    j: cython.int,
    seen: cython.int[::1],
    stamp: cython.int,
    queue: cython.int[:, ::1],
    count: cython.int,
) -> cython.int:
    """Breadth first from the pixels already queued (`count` of them), within steps of (i, j) along each axis."""
    height: cython.int = walls.shape[0]
    width: cython.int = walls.shape[1]
    side: cython.int = 2 * 24 + 1
    head: cython.int = 0
    y: cython.int
    x: cython.int
    way: cython.int
    ny: cython.int
    nx: cython.int
    cell: cython.int
    while head < count:
        y = queue[head, 0]
        x = queue[head, 1]
        head += 1
        for way in range(4):
            ny = y
            nx = x
            if way == 0:
                if x + 1 >= width or walls[y, x] & 1:
                    continue
                nx = x + 1
            elif way == 1:
                if y + 1 >= height or walls[y, x] & 2:
                    continue
                ny = y + 1
            elif way == 2:
                if x == 0 or walls[y, x - 1] & 1:
                    continue
                nx = x - 1
            else:
                if y == 0 or walls[y - 1, x] & 2:
                    continue
                ny = y - 1
            if abs(ny - i) > steps or abs(nx - j) > steps:
                continue
            cell = (ny - i + 24) * side + nx - j + 24
            if seen[cell] == stamp:
                continue
            seen[cell] = stamp
            queue[count, 0] = ny
            queue[count, 1] = nx
            count += 1
    return count


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _plane(
    values: cython.float[:, ::1],
    distance: cython.float[:, ::1],
    margin: cython.double,
    queue: cython.int[:, ::1],
    count: cython.int,
    x: cython.double,
    y: cython.double,
    spread: cython.double,
    stiffness: cython.double,
    table: cython.double[::1],
    out: cython.p_double,
) -> cython.bint:
    """Value at (x, y), in pixel centres, of the plane fitted to the clean pixels of the queue.

    Weights fall as a Gaussian of `spread` pixels, tabulated by the square of the distance where (x, y)
    is a pixel's centre (table not empty); `stiffness` holds the slope back, the more
    the farther the pixels lie to one side. False where no pixel is clean.
    """
    k: cython.int
    dx: cython.double
    dy: cython.double
    w: cython.double
    v: cython.double
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
    tabulated: cython.bint = table.shape[0] > 0
    for k in range(count):
        if distance[queue[k, 0], queue[k, 1]] <= margin:
            continue
        dx = queue[k, 1] - x
        dy = queue[k, 0] - y
        v = values[queue[k, 0], queue[k, 1]]
        w = dx * dx + dy * dy
        w = table[cython.cast(cython.int, w)] if tabulated else exp(-w / (2 * spread * spread))
        s += w
        sx += w * dx
        sy += w * dy
        sxx += w * dx * dx
        sxy += w * dx * dy
        syy += w * dy * dy
        sv += w * v
        sxv += w * dx * v
        syv += w * dy * v
        low = min(low, v)
        high = max(high, v)
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


def extrapolate(
    values: cython.float[:, ::1],
    walls: cython.uchar[:, ::1],
    distance: cython.float[:, ::1],
    margin: cython.double,
    first_row: cython.Py_ssize_t,
    last_row: cython.Py_ssize_t,
    steps: cython.int,
    spread: cython.double,
    stiffness: cython.double,
    table: cython.double[::1],
    seen: cython.int[::1],
    queue: cython.int[:, ::1],
    out: cython.float[:, ::1],
) -> None:
    """Replace the contaminated pixels (distance ≤ margin) of rows first_row … last_row − 1.

    A plane is fitted to the clean pixels within `steps`; where there are none, up to MAX_REACH
    away; and where the region has none at all, the mean of its least contaminated pixels.

    table: weights by the square of the distance, up to 2 · MAX_REACH².
    seen: ((2 · MAX_REACH + 1)²,) zeros; queue: (that many + 9, 2); room to work in. out: (h, w) filled in these rows.
    """
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    stamp: cython.int = 0
    count: cython.int
    reach: cython.int
    k: cython.int
    best: cython.double
    w: cython.double
    s: cython.double
    sv: cython.double
    done: cython.bint
    value: cython.double = 0
    with cython.nogil:
        for i in range(first_row, last_row):
            for j in range(values.shape[1]):
                if distance[i, j] > margin:
                    out[i, j] = values[i, j]
                    continue
                reach = steps
                done = False
                count = 0
                while not done and reach <= 24:
                    stamp += 1
                    seen[24 * 49 + 24] = stamp
                    queue[0, 0] = i
                    queue[0, 1] = j
                    count = _walk(walls, reach, i, j, seen, stamp, queue, 1)
                    done = _plane(
                        values, distance, margin, queue, count, j, i, spread, stiffness, table, cython.address(value)
                    )
                    if not done and reach == 24:
                        break
                    reach = min(24, 2 * reach) if reach < 24 else 25
                if not done:
                    best = 0
                    for k in range(count):
                        best = max(best, distance[queue[k, 0], queue[k, 1]])
                    s = 0
                    sv = 0
                    for k in range(count):
                        w = (queue[k, 0] - i) * (queue[k, 0] - i) + (queue[k, 1] - j) * (queue[k, 1] - j)
                        w = exp(-w / (2 * spread * spread) + 6 * (distance[queue[k, 0], queue[k, 1]] - best))
                        s += w
                        sv += w * values[queue[k, 0], queue[k, 1]]
                    value = sv / s if s > 0 else values[i, j]
                out[i, j] = value


def bucket(
    ax: cython.double[::1],
    ay: cython.double[::1],
    bx: cython.double[::1],
    by: cython.double[::1],
    cell: cython.double,
    first: cython.int[:, ::1],
    items: cython.int[::1],
    fill: cython.bint,
) -> None:
    """Count (fill false), then list, the edges whose bounding box meets each square cell.

    first: (rows, columns) counts on the first call; then, as offsets of each cell's end, lowered to its start.
    """
    e: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    rows: cython.Py_ssize_t = first.shape[0]
    columns: cython.Py_ssize_t = first.shape[1]
    dx: cython.double
    dy: cython.double
    left: cython.double
    right: cython.double
    low: cython.double
    high: cython.double
    with cython.nogil:
        for e in range(ax.shape[0]):
            dx = bx[e] - ax[e]
            dy = by[e] - ay[e]
            i = max(0, cython.cast(cython.Py_ssize_t, floor(min(ay[e], by[e]) / cell)))
            while i < rows and i * cell <= max(ay[e], by[e]):
                low = 0.0
                high = 1.0
                if dy != 0:
                    left = (i * cell - ay[e]) / dy
                    right = ((i + 1) * cell - ay[e]) / dy
                    low = max(low, min(left, right))
                    high = min(high, max(left, right))
                left = ax[e] + low * dx
                right = ax[e] + high * dx
                if left > right:
                    left, right = right, left
                j = max(0, cython.cast(cython.Py_ssize_t, floor(left / cell - 1e-6)))
                while j < columns and j * cell <= right + 1e-6 * cell:
                    if fill:
                        first[i, j] -= 1
                        items[first[i, j]] = e
                    else:
                        first[i, j] += 1
                    j += 1
                i += 1


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
    ex: cython.double = bx[e] - ax[e]
    ey: cython.double = by[e] - ay[e]
    p: cython.double = ex * (py - ay[e]) - ey * (px - ax[e])
    q: cython.double = ex * (qy - ay[e]) - ey * (qx - ax[e])
    a: cython.double
    b: cython.double
    tie: cython.double = -ey if ey != 0 else ex
    if p == 0:
        p = tie
    if q == 0:
        q = tie
    if (p > 0) == (q > 0):
        return True
    ex = qx - px
    ey = qy - py
    a = ex * (ay[e] - py) - ey * (ax[e] - px)
    b = ex * (by[e] - py) - ey * (bx[e] - px)
    tie = ey if ey != 0 else -ex
    if a == 0:
        a = tie
    if b == 0:
        b = tie
    return (a > 0) == (b > 0)


def resample(
    values: cython.float[:, ::1],
    walls: cython.uchar[:, ::1],
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
    table: cython.double[::1],
    near: cython.float[:, ::1],
    seen: cython.int[::1],
    queue: cython.int[:, ::1],
    out: cython.double[:, ::1],
) -> None:
    """Fill new samples of some rows, those with a finite `near`, each from the pixels that its place reaches.

    first: (rows, columns + 1 as one flat run) offsets of `items` by cell.
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
    stamp: cython.int = 0
    count: cython.int
    x: cython.double
    y: cython.double
    px: cython.double
    py: cython.double
    visible: cython.bint
    value: cython.double = 0
    none: cython.float[:, ::1] = values
    with cython.nogil:
        for i in range(first_row, last_row):
            for j in range(out.shape[1]):
                if near[i, j] > 1e9:
                    continue
                x = (j + 0.5) * width / out.shape[1]
                y = (i + 0.5) * height / out.shape[0]
                stamp += 1
                count = 0
                pi = cython.cast(cython.int, floor(y - 0.5))
                pj = cython.cast(cython.int, floor(x - 0.5))
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
                            seen[(pi + di - pi + 24) * 49 + (dj + 24)] = stamp
                            queue[count, 0] = pi + di
                            queue[count, 1] = pj + dj
                            count += 1
                if count:
                    count = _walk(walls, steps, pi, pj, seen, stamp, queue, count)
                    _plane(
                        none,
                        none,
                        -1.0,
                        queue,
                        count,
                        x - 0.5,
                        y - 0.5,
                        spread,
                        stiffness,
                        table,
                        cython.address(value),
                    )
                    out[i, j] = value
                else:
                    out[i, j] = values[
                        min(height - 1, cython.cast(cython.Py_ssize_t, y)),
                        min(width - 1, cython.cast(cython.Py_ssize_t, x)),
                    ]


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _root(parent: cython.int[::1], k: cython.int) -> cython.int:
    while parent[k] != k:
        parent[k] = parent[parent[k]]
        k = parent[k]
    return k


def regions(walls: cython.uchar[:, ::1], parent: cython.int[::1]) -> None:
    """Join pixel centres between which a step crosses no edge; afterwards parent[k] is the region's first pixel.

    walls: (h, w) as of `block`. parent: (h · w,) filled.
    """
    height: cython.int = walls.shape[0]
    width: cython.int = walls.shape[1]
    i: cython.int
    j: cython.int
    k: cython.int
    a: cython.int
    b: cython.int
    with cython.nogil:
        for k in range(height * width):
            parent[k] = k
        for i in range(height):
            for j in range(width):
                k = i * width + j
                if j + 1 < width and not walls[i, j] & 1:
                    a = _root(parent, k)
                    b = _root(parent, k + 1)
                    parent[max(a, b)] = min(a, b)
                if i + 1 < height and not walls[i, j] & 2:
                    a = _root(parent, k)
                    b = _root(parent, k + width)
                    parent[max(a, b)] = min(a, b)
        for k in range(height * width):
            parent[k] = parent[parent[k]]
