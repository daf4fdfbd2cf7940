# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Compiled loops over ink: painting strokes, trying them out, choosing the runs worth drawing.

Everything here is in *subpixels*, eight to the side of a cell (see `sheet`). The ink
already drawn is one bit a subpixel, `bits[cell row, cell column, subpixel row]`, the
leftmost subpixel in the lowest bit; `counts` is the number of set bits of each cell.

Only `sheet` imports this module. Nothing here uses a transcendental function or a sum
whose order could depend on anything but the input, so the bytes are the same everywhere.
"""

import cython
from cython.cimports.libc.math import ceil, fabs, fabsf, sqrt

COMPILED = cython.compiled
#: Which part of a pixel's width an edge gains on the mean; measured on strokes in all directions, 300 to 1200 dpi.
GAIN = cython.declare(cython.double, 0.985)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _span(
    bits: cython.uchar[:, :, ::1], counts: cython.uchar[:, ::1],
    row: cython.Py_ssize_t, c0: cython.Py_ssize_t, c1: cython.Py_ssize_t, write: cython.bint,
) -> cython.int:
    """Subpixels c0 ≤ c < c1 of one row: how many are not inked yet; ink them if told to."""
    y: cython.Py_ssize_t = row >> 3
    s: cython.Py_ssize_t = row & 7
    x: cython.Py_ssize_t
    x1: cython.Py_ssize_t = (c1 - 1) >> 3
    total: cython.int = 0
    mask: cython.uint
    n: cython.uint
    for x in range(c0 >> 3, x1 + 1):
        mask = 255
        if x == c0 >> 3:
            mask &= 255 << (c0 & 7)
        if x == x1:
            mask &= 255 >> (7 - ((c1 - 1) & 7))
        mask &= ~cython.cast(cython.uint, bits[y, x, s])
        mask &= 255
        if mask:
            n = mask - ((mask >> 1) & 0x55)
            n = (n & 0x33) + ((n >> 2) & 0x33)
            n = (n + (n >> 4)) & 15
            total += n
            if write:
                bits[y, x, s] |= cython.cast(cython.uchar, mask)
                counts[y, x] += cython.cast(cython.uchar, n)
    return total


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _bar(
    bits: cython.uchar[:, :, ::1], counts: cython.uchar[:, ::1],
    x0: cython.double, y0: cython.double, x1: cython.double, y1: cython.double, r: cython.double,
    cap0: cython.bint, cap1: cython.bint, write: cython.bint,
) -> cython.int:
    """The bar of half width r from (x0, y0) to (x1, y1), with the round caps asked for.

    It is convex, so each row of subpixels meets it in one interval: the hull of what
    the row meets of the rectangle and of the two discs.
    """
    rows: cython.Py_ssize_t = bits.shape[0] * 8
    columns: cython.Py_ssize_t = bits.shape[1] * 8
    ux: cython.double = x1 - x0
    uy: cython.double = y1 - y0
    length: cython.double = sqrt(ux * ux + uy * uy)
    side: cython.double
    low: cython.double
    high: cython.double
    row: cython.Py_ssize_t
    first: cython.Py_ssize_t
    last: cython.Py_ssize_t
    c0: cython.Py_ssize_t
    c1: cython.Py_ssize_t
    lo: cython.double
    hi: cython.double
    d: cython.double
    h: cython.double
    # across a row d below the start, the rectangle reaches from the larger of two lines in d
    # (its end and its side) to the smaller of two others
    end_rate: cython.double = 0.0
    end_lo: cython.double = -1e30
    end_hi: cython.double = 1e30
    side_rate: cython.double = 0.0
    side_lo: cython.double = -1e30
    side_hi: cython.double = 1e30
    total: cython.int = 0
    if length > 1e-9:
        ux /= length
        uy /= length
        # a bar along a row or a column is tilted by nothing that shows
        if fabs(ux) < 1e-7:
            ux = 1e-7
        if fabs(uy) < 1e-7:
            uy = 1e-7
        end_rate = -uy / ux
        h = length / ux
        end_lo = h if h < 0.0 else 0.0
        end_hi = 0.0 if h < 0.0 else h
        side_rate = ux / uy
        side_hi = fabs(r / uy)
        side_lo = -side_hi
    else:
        end_lo = 1e30
        ux = 1.0
    side = r if (cap0 or cap1) else r * fabs(ux)
    low = (y0 if y0 < y1 else y1) - side
    high = (y1 if y0 < y1 else y0) + side
    if high <= 0.0 or low >= rows:
        return 0
    # rounding is by truncation, for what is not negative: ceil is a call where SSE 4.1 may not be assumed
    first = cython.cast(cython.Py_ssize_t, low + 0.5) if low > 0.5 else 0
    last = cython.cast(cython.Py_ssize_t, high + 0.5) if high < rows else rows
    for row in range(first, last):
        d = row + 0.5 - y0
        lo = end_lo + end_rate * d
        h = side_lo + side_rate * d
        lo = h if h > lo else lo
        hi = end_hi + end_rate * d
        h = side_hi + side_rate * d
        hi = h if h < hi else hi
        if lo < hi:
            lo += x0
            hi += x0
        else:
            lo = 1e30
            hi = -1e30
        if cap0 and fabs(d) < r:
            h = sqrt(r * r - d * d)
            lo = x0 - h if x0 - h < lo else lo
            hi = x0 + h if x0 + h > hi else hi
        if cap1:
            d = row + 0.5 - y1
            if fabs(d) < r:
                h = sqrt(r * r - d * d)
                lo = x1 - h if x1 - h < lo else lo
                hi = x1 + h if x1 + h > hi else hi
        if lo < hi and hi > 0.0 and lo < columns:
            c0 = cython.cast(cython.Py_ssize_t, lo + 0.5) if lo > 0.5 else 0
            c1 = cython.cast(cython.Py_ssize_t, hi + 0.5) if hi < columns else columns
            if c0 < c1:
                total += _span(bits, counts, row, c0, c1, write)
    return total


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _cell(subpixels: cython.double) -> cython.Py_ssize_t:
    """The row or column of cells that a place is in; -1 before the first."""
    return cython.cast(cython.Py_ssize_t, subpixels * 0.125) if subpixels >= 0.0 else -1


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _half_width(width: cython.double, gain: cython.double, dx: cython.double, dy: cython.double) -> cython.double:
    """Half the width that the device paints, see `sheet.Sheet`."""
    length: cython.double = sqrt(dx * dx + dy * dy)
    if length < 1e-9:
        # a disc touches as many pixels as one this much wider: Ghostscript's, from 0.4 to 2.5 pt at 300 to 1200 dpi,
        # are 1.15 to 1.18 pixels wider, for it draws polygons inscribed in them
        return 0.5 * (width + 1.16 * gain)
    return 0.5 * (width + GAIN * gain * (fabs(dx) + fabs(dy)) / length)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _splat(
    residual: cython.float[:, ::1], guide: cython.float[:, ::1], kernel: cython.float[:, ::1],
    y: cython.Py_ssize_t, x: cython.Py_ssize_t, ink: cython.float, step: cython.float,
) -> cython.void:
    """Take ink (cells) at cell (y, x) from the residual around it, on this side of any strong step of tone."""
    r: cython.Py_ssize_t = kernel.shape[0] // 2
    top: cython.Py_ssize_t = y - r if y > r else 0
    bottom: cython.Py_ssize_t = y + r + 1 if y + r + 1 < residual.shape[0] else residual.shape[0]
    left: cython.Py_ssize_t = x - r if x > r else 0
    right: cython.Py_ssize_t = x + r + 1 if x + r + 1 < residual.shape[1] else residual.shape[1]
    here: cython.float = guide[y, x]
    none: cython.float = 0.0  # a literal would be a double, and the loop four times slower
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    n: cython.Py_ssize_t = right - left
    k: cython.p_float
    g: cython.p_float
    out: cython.p_float
    w: cython.float
    for i in range(top, bottom):
        k = cython.address(kernel[i - y + r, left - x + r])
        g = cython.address(guide[i, left])
        out = cython.address(residual[i, left])
        for j in range(n):
            w = ink * k[j]
            out[j] -= w if fabsf(g[j] - here) < step else none


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _draw(
    bits: cython.uchar[:, :, ::1], counts: cython.uchar[:, ::1],
    residual: cython.float[:, ::1], guide: cython.float[:, ::1], kernel: cython.float[:, ::1], step: cython.float,
    points: cython.double[:, ::1], p0: cython.Py_ssize_t, p1: cython.Py_ssize_t,
    ox: cython.double, oy: cython.double, width: cython.double, gain: cython.double, splat: cython.bint,
) -> cython.longlong:
    """Ink the polyline points[p0 … p1] moved by (ox, oy), and take what is new from the residual.

    Returns the number of subpixels newly inked.
    """
    fresh: cython.longlong = 0
    i: cython.Py_ssize_t
    dx: cython.double
    dy: cython.double
    ex: cython.double = 0.0
    ey: cython.double = 0.0
    x: cython.Py_ssize_t
    y: cython.Py_ssize_t
    ink: cython.int = 0
    r: cython.double
    cap: cython.bint
    last: cython.bint
    new: cython.int
    if p0 == p1:
        r = _half_width(width, gain, 0.0, 0.0)
        ink = _bar(bits, counts, points[p0, 0] + ox, points[p0, 1] + oy, points[p0, 0] + ox, points[p0, 1] + oy,
                   r, True, False, True)
        if splat and ink:
            x = _cell(points[p0, 0] + ox)
            y = _cell(points[p0, 1] + oy)
            if 0 <= x < counts.shape[1] and 0 <= y < counts.shape[0]:
                _splat(residual, guide, kernel, y, x, ink * 0.015625, step)
        return ink
    for i in range(p0, p1):
        dx = points[i + 1, 0] - points[i, 0]
        dy = points[i + 1, 1] - points[i, 1]
        r = _half_width(width, gain, dx, dy)
        last = i + 1 == p1
        # a joint needs a disc only where the line turns by more than some 5 degrees
        cap = i == p0
        if not cap and fabs(dx * ey - dy * ex) > 0.09 * sqrt((dx * dx + dy * dy) * (ex * ex + ey * ey)):
            cap = True
        ex = dx
        ey = dy
        new = _bar(bits, counts, points[i, 0] + ox, points[i, 1] + oy, points[i + 1, 0] + ox, points[i + 1, 1] + oy,
                   r, cap, last, True)
        ink += new
        fresh += new
        # two points to a splat: they are about a cell apart and the kernel is much wider
        if splat and ink and (last or (i - p0) & 1):
            x = _cell(points[i, 0] + ox)
            y = _cell(points[i, 1] + oy)
            if 0 <= x < counts.shape[1] and 0 <= y < counts.shape[0]:
                _splat(residual, guide, kernel, y, x, ink * 0.015625, step)
            ink = 0
    return fresh


def paint(
    bits: cython.uchar[:, :, ::1], counts: cython.uchar[:, ::1],
    residual: cython.float[:, ::1], guide: cython.float[:, ::1], kernel: cython.float[:, ::1], step: cython.float,
    points: cython.double[:, ::1], first: cython.longlong[::1], widths: cython.double[::1],
    order: cython.longlong[::1], gain: cython.double, splat: cython.bint, fresh: cython.longlong[::1],
):
    """Ink the polylines named in order, unconditionally. fresh: (n,) out, how many subpixels each newly inks."""
    k: cython.Py_ssize_t
    i: cython.Py_ssize_t
    with cython.nogil:
        for k in range(order.shape[0]):
            i = order[k]
            fresh[i] = _draw(bits, counts, residual, guide, kernel, step, points, first[i], first[i + 1] - 1, 0.0, 0.0,
                             widths[i], gain, splat)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _gains(
    bits: cython.uchar[:, :, ::1], counts: cython.uchar[:, ::1],
    residual: cython.float[:, ::1], guide: cython.float[:, ::1], weight: cython.float[:, ::1],
    lenience: cython.double, profile: cython.double[::1],
    points: cython.double[:, ::1], p0: cython.Py_ssize_t, p1: cython.Py_ssize_t,
    ox: cython.double, oy: cython.double, width: cython.double, gain: cython.double,
    ink: cython.double[::1], own: cython.double[::1], due: cython.double[::1],
) -> cython.Py_ssize_t:
    """For each piece of a polyline: new ink (cells), the tone still due there, the tone the stroke itself would add.

    Returns the number of pieces; a dot is one.
    """
    n: cython.Py_ssize_t = p1 - p0 if p1 > p0 else 1
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    q: cython.Py_ssize_t = p0
    x: cython.Py_ssize_t
    y: cython.Py_ssize_t
    dx: cython.double
    dy: cython.double
    mx: cython.double
    my: cython.double
    d: cython.double
    reach: cython.Py_ssize_t = profile.shape[0]
    for i in range(n):
        q = p0 + i
        if p1 == p0:
            mx = points[q, 0] + ox
            my = points[q, 1] + oy
            ink[i] = _bar(bits, counts, mx, my, mx, my, _half_width(width, gain, 0.0, 0.0), True, False, False)
        else:
            dx = points[q + 1, 0] - points[q, 0]
            dy = points[q + 1, 1] - points[q, 1]
            ink[i] = _bar(bits, counts, points[q, 0] + ox, points[q, 1] + oy,
                          points[q + 1, 0] + ox, points[q + 1, 1] + oy, _half_width(width, gain, dx, dy),
                          False, False, False)
            mx = points[q, 0] + 0.5 * dx + ox
            my = points[q, 1] + 0.5 * dy + oy
        ink[i] *= 0.015625
        x = _cell(mx)
        y = _cell(my)
        x = 0 if x < 0 else (counts.shape[1] - 1 if x >= counts.shape[1] else x)
        y = 0 if y < 0 else (counts.shape[0] - 1 if y >= counts.shape[0] else y)
        # where part of the kernel is cut off, less is due for the same want of ink: both sides are put at full weight
        due[i] = residual[y, x] / weight[y, x] + lenience * guide[y, x]
        own[i] = 0.0
    # the kernel along the stroke, by distance in quarter cells; pieces are 1/16 … 1 cell or so apart
    for i in range(n):
        own[i] += ink[i] * profile[0]
        for j in range(i + 1, n):
            dx = points[p0 + j, 0] - points[p0 + i, 0]
            dy = points[p0 + j, 1] - points[p0 + i, 1]
            d = 0.5 * sqrt(dx * dx + dy * dy)
            if d >= reach:
                break
            own[i] += ink[j] * profile[cython.cast(cython.Py_ssize_t, d)]
            own[j] += ink[i] * profile[cython.cast(cython.Py_ssize_t, d)]
    return n


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _runs(
    n: cython.Py_ssize_t, ink: cython.double[::1], own: cython.double[::1], due: cython.double[::1],
    cost: cython.double, shortest: cython.Py_ssize_t, shortest_wall: cython.Py_ssize_t,
    wall0: cython.bint, wall1: cython.bint, caution: cython.double,
    total: cython.double[::1], best: cython.double[::1], start: cython.longlong[::1],
) -> cython.double:
    """The runs of pieces worth drawing: the two states are pen up and pen down.

    best[j] is the largest gain of what lies before point j, with the pen up there, and
    start[j] where the run ends that ends at j began (-1: none ends there). A run is at
    least `shortest` pieces long, or `shortest_wall` where it ends at a wall.
    """
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    opened: cython.double = -1e30
    where: cython.Py_ssize_t = 0
    v: cython.double
    need: cython.Py_ssize_t
    total[0] = 0.0
    best[0] = 0.0
    start[0] = -1
    for j in range(1, n + 1):
        total[j] = total[j - 1] + ink[j - 1] * (2.0 * due[j - 1] - caution * own[j - 1])
        best[j] = best[j - 1]
        start[j] = -1
        i = j - shortest
        if i >= 0 and best[i] - total[i] > opened:
            opened = best[i] - total[i]
            where = i
        if i >= 0 and total[j] + opened - cost > best[j]:
            best[j] = total[j] + opened - cost
            start[j] = where
        if wall0 and j >= shortest_wall and total[j] - cost > best[j]:
            best[j] = total[j] - cost
            start[j] = 0
        if wall1 and j == n:
            need = shortest_wall if shortest_wall < shortest else shortest
            for i in range(0, n - need + 1):
                v = total[n] - total[i] + best[i] - cost
                if v > best[n]:
                    best[n] = v
                    start[n] = i
    return best[n]


def place(
    bits: cython.uchar[:, :, ::1], counts: cython.uchar[:, ::1],
    residual: cython.float[:, ::1], guide: cython.float[:, ::1], kernel: cython.float[:, ::1], step: cython.float,
    weight: cython.float[:, ::1], profile: cython.double[::1],
    points: cython.double[:, ::1], first: cython.longlong[::1], widths: cython.double[::1], walls: cython.uchar[::1],
    order: cython.longlong[::1], gain: cython.double,
    shifts: cython.double[::1], spacing: cython.double[::1],
    whole: cython.bint, strict: cython.bint, caution: cython.double, lenience: cython.double, cost: cython.double,
    shortest: cython.double, shortest_wall: cython.double,
    runs: cython.longlong[:, :, ::1], moved: cython.double[:, ::1], scratch: cython.double[:, ::1],
    starts: cython.longlong[::1],
):
    """Try the polylines named in order, one after the other, and draw of each what is worth drawing.

    Normally that is its best runs; if whole, all of it if that lowers the squared error; if strict, all of it
    unless that makes any place darker than it is due: the paper's rule.

    caution: what a stroke adds itself counts so many times: 1 is where the squared error is least.
    lenience: this part of the tone wanted is taken to be due besides, so that mere noise cuts no stroke.
    shifts: the sideways moves tried, in units of spacing[i] (subpixels).
    runs: (n, most, 2) out, points first … last of each run of polyline i, -1 where there is none.
    moved: (n, 2) out, the move chosen.
    scratch: (5, longest + 2), starts: (longest + 2).
    """
    k: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    m: cython.Py_ssize_t
    n: cython.Py_ssize_t
    p0: cython.Py_ssize_t
    p1: cython.Py_ssize_t
    found: cython.Py_ssize_t
    most: cython.Py_ssize_t = runs.shape[1]
    nx: cython.double
    ny: cython.double
    ox: cython.double
    oy: cython.double
    bx: cython.double
    by: cython.double
    d: cython.double
    value: cython.double
    good: cython.double
    least: cython.Py_ssize_t
    least_wall: cython.Py_ssize_t
    long: cython.double
    ink = scratch[0]
    own = scratch[1]
    due = scratch[2]
    total = scratch[3]
    best = scratch[4]
    with cython.nogil:
        for k in range(order.shape[0]):
            i = order[k]
            p0 = first[i]
            p1 = first[i + 1] - 1
            nx = -(points[p1, 1] - points[p0, 1])
            ny = points[p1, 0] - points[p0, 0]
            d = sqrt(nx * nx + ny * ny)
            if d > 1e-9:
                nx /= d
                ny /= d
            else:
                nx = 0.0
                ny = 1.0
            # lengths of runs become numbers of pieces; a loop is much longer than its ends are apart
            n = p1 - p0
            long = 0.0
            for j in range(p0, p1):
                long += sqrt((points[j + 1, 0] - points[j, 0]) ** 2 + (points[j + 1, 1] - points[j, 1]) ** 2)
            if long > 1.2 * d:
                d = long
            least = 1
            least_wall = 1
            if n > 0:
                d = d / n if d > 1e-9 else 8.0
                least = cython.cast(cython.Py_ssize_t, ceil(shortest / d))
                least_wall = cython.cast(cython.Py_ssize_t, ceil(shortest_wall / d))
                least = max(least, 1)
                least_wall = max(least_wall, 1)
                if least > n and not whole and not strict and walls[i] == 0:
                    continue
            good = 0.0
            bx = 0.0
            by = 0.0
            m = -1
            for j in range(shifts.shape[0]):
                ox = nx * shifts[j] * spacing[i]
                oy = ny * shifts[j] * spacing[i]
                n = _gains(bits, counts, residual, guide, weight, lenience, profile, points, p0, p1, ox, oy,
                           widths[i], gain, ink, own, due)
                if not whole and not strict:
                    value = _runs(n, ink, own, due, cost, least, least_wall, (walls[i] & 1) != 0, (walls[i] & 2) != 0,
                                  caution, total, best, starts)
                elif not strict:
                    value = -cost
                    for found in range(n):
                        value += ink[found] * (2.0 * due[found] - caution * own[found])
                else:
                    value = 1.0
                    for found in range(n):
                        if due[found] < own[found]:
                            value = -1.0
                            break
                if value > good:
                    good = value
                    bx = ox
                    by = oy
                    m = j
            if m < 0:
                continue
            moved[i, 0] = bx
            moved[i, 1] = by
            if whole or strict:
                runs[i, 0, 0] = p0
                runs[i, 0, 1] = p1
                _draw(bits, counts, residual, guide, kernel, step, points, p0, p1, bx, by, widths[i], gain, True)
                continue
            if m != shifts.shape[0] - 1:
                n = _gains(bits, counts, residual, guide, weight, lenience, profile, points, p0, p1, bx, by,
                           widths[i], gain, ink, own, due)
                _runs(n, ink, own, due, cost, least, least_wall, (walls[i] & 1) != 0, (walls[i] & 2) != 0, caution,
                      total, best, starts)
            j = n
            found = 0
            while j > 0 and found < most:
                if starts[j] < 0 or best[j] == best[j - 1]:
                    j -= 1
                    continue
                runs[i, found, 0] = p0 + starts[j]
                runs[i, found, 1] = p0 + j
                _draw(bits, counts, residual, guide, kernel, step, points, p0 + starts[j], p0 + j, bx, by,
                      widths[i], gain, True)
                found += 1
                j = starts[j]


def press(
    bits: cython.uchar[:, :, ::1], counts: cython.uchar[:, ::1], gain: cython.double,
    residual: cython.float[:, ::1], guide: cython.float[:, ::1], kernel: cython.float[:, ::1], step: cython.float,
    profile: cython.double[::1],
    points: cython.double[:, ::1], first: cython.longlong[::1], widths: cython.double[::1],
    lightest: cython.double[::1], heaviest: cython.double[::1],
    order: cython.longlong[::1], scratch: cython.double[:, ::1],
):
    """Change the width of each stroke, one after the other, to where the squared error is least.

    widths: (n,) in and out, subpixels, between lightest and heaviest. The residual, whose cells are twice as wide and
    high as those of counts, is kept up to date to first order only: what a wider stroke newly covers is taken to be as
    bare as the paper is now, a subpixel on either side of it.
    """
    k: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    n: cython.Py_ssize_t
    p0: cython.Py_ssize_t
    x: cython.Py_ssize_t
    y: cython.Py_ssize_t
    dx: cython.double
    dy: cython.double
    d: cython.double
    pull: cython.double
    resistance: cython.double
    change: cython.double
    reach: cython.Py_ssize_t = profile.shape[0]
    # cells that a subpixel more of width covers newly, by piece; and where the piece is
    fresh = scratch[0]
    mx = scratch[1]
    my = scratch[2]
    with cython.nogil:
        for k in range(order.shape[0]):
            i = order[k]
            p0 = first[i]
            n = first[i + 1] - 1 - p0
            if n < 1:
                continue
            pull = 0.0
            resistance = 0.0
            for j in range(n):
                dx = points[p0 + j + 1, 0] - points[p0 + j, 0]
                dy = points[p0 + j + 1, 1] - points[p0 + j, 1]
                mx[j] = points[p0 + j, 0] + 0.5 * dx
                my[j] = points[p0 + j, 1] + 0.5 * dy
                x = _cell(mx[j])
                y = _cell(my[j])
                if x < 0 or y < 0 or x >= counts.shape[1] or y >= counts.shape[0]:
                    fresh[j] = 0.0
                    continue
                fresh[j] = 0.001953125 * _bar(
                    bits, counts, points[p0 + j, 0], points[p0 + j, 1], points[p0 + j + 1, 0], points[p0 + j + 1, 1],
                    _half_width(widths[i], gain, dx, dy) + 1.0, False, False, False,
                )  # fmt: skip
                x >>= 1
                y >>= 1
                pull += fresh[j] * residual[y, x]
            for j in range(n):
                resistance += fresh[j] * fresh[j] * profile[0]
                for x in range(j + 1, n):
                    dx = mx[x] - mx[j]
                    dy = my[x] - my[j]
                    d = 0.25 * sqrt(dx * dx + dy * dy)
                    if d >= reach:
                        break
                    resistance += 2.0 * fresh[j] * fresh[x] * profile[cython.cast(cython.Py_ssize_t, d)]
            if resistance < 1e-12:
                continue
            change = widths[i] + pull / resistance
            change = lightest[i] if change < lightest[i] else (heaviest[i] if change > heaviest[i] else change)
            change -= widths[i]
            widths[i] += change
            for j in range(n):
                if fresh[j] > 0.0 and (j & 1 or j == n - 1):
                    d = fresh[j] + (fresh[j - 1] if j & 1 else 0.0)
                    d *= change
                    x = _cell(mx[j]) >> 1
                    y = _cell(my[j]) >> 1
                    _splat(residual, guide, kernel, y, x, cython.cast(cython.float, d), step)


def gather(
    error: cython.float[:, ::1], guide: cython.float[:, ::1], kernel: cython.float[:, ::1], step: cython.float,
    out: cython.float[:, ::1], top: cython.Py_ssize_t, bottom: cython.Py_ssize_t,
):
    """out = kernel * error for rows top … bottom, on each cell's own side of any strong step of tone."""
    r: cython.Py_ssize_t = kernel.shape[0] // 2
    y: cython.Py_ssize_t
    x: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    lo: cython.Py_ssize_t
    hi: cython.Py_ssize_t
    w: cython.float
    k: cython.float
    none: cython.float = 0.0
    o: cython.p_float
    e: cython.p_float
    g: cython.p_float
    here: cython.p_float
    with cython.nogil:
        for y in range(top, bottom):
            o = cython.address(out[y, 0])
            here = cython.address(guide[y, 0])
            for x in range(error.shape[1]):
                o[x] = 0.0
            for i in range(-r if y >= r else -y, (r if y + r < error.shape[0] else error.shape[0] - 1 - y) + 1):
                e = cython.address(error[y + i, 0])
                g = cython.address(guide[y + i, 0])
                for j in range(-r, r + 1):
                    k = kernel[i + r, j + r]
                    lo = -j if j < 0 else 0
                    hi = error.shape[1] - j if j > 0 else error.shape[1]
                    for x in range(lo, hi):
                        w = k * e[x + j]
                        o[x] += w if fabsf(g[x + j] - here[x]) < step else none
