# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled loops that try strokes out one after the other and draw of each what is worth drawing.

Lengths are in subpixels, ink in cells (see `ink`). Only `sheet` imports this module.
"""

from libc.math cimport ceil, sqrt
from penink_cli.blasting._compiled.due cimport splat
from penink_cli.blasting._compiled.ink cimport bar, cell, half_width, stroke

#: Lighter than this is paper white. What ink gains, per cell, that belongs in a light place.
cdef double PAPER = 0.002
cdef double WORTH = 0.05


cdef void _draw(
    unsigned long long* bits, Py_ssize_t rows, Py_ssize_t columns, float[:, ::1] residual, float[:, ::1] guide,
    float[:, ::1] kernel, float step, double[:, ::1] points, Py_ssize_t p0, Py_ssize_t p1, double ox, double oy,
    double width, double gain, double[::1] fresh,
) noexcept nogil:
    """Ink the polyline points[p0 … p1] moved by (ox, oy), and take what is new from the residual. fresh: scratch."""
    cdef Py_ssize_t i, x, y
    cdef Py_ssize_t n = p1 - p0
    cdef float ink = 0.0
    stroke(bits, rows, columns, &points[p0, 0], n, ox, oy, width, gain, &fresh[0])
    for i in range(n if n > 0 else 1):
        ink += <float>fresh[i]
        # two points to a splat: they are about a cell apart and the kernel is much wider
        if ink > 0.0 and (i & 1 or i >= n - 1):
            x = cell(points[p0 + i, 0] + ox)
            y = cell(points[p0 + i, 1] + oy)
            if 0 <= x < columns and 0 <= y < rows:
                splat(residual, guide, kernel, y, x, ink * 0.015625, step)
            ink = 0.0


cdef Py_ssize_t _gains(
    unsigned long long* bits, Py_ssize_t rows, Py_ssize_t columns, float[:, ::1] residual, float[:, ::1] guide,
    float[:, ::1] weight, double lenience, double enters, double[::1] profile, double[:, ::1] points, Py_ssize_t p0,
    Py_ssize_t p1, double ox, double oy, double width, double gain, double[::1] ink, double[::1] own, double[::1] due,
    double[::1] share,
) noexcept nogil:
    """For each piece of a polyline: new ink (cells), the tone still due there, the tone the stroke itself would add.

    Returns the number of pieces; a dot is one.
    """
    cdef Py_ssize_t i, j, x, y
    cdef double dx, dy, mx, my, d
    cdef Py_ssize_t n = p1 - p0 if p1 > p0 else 1
    cdef Py_ssize_t q = p0
    cdef Py_ssize_t reach = profile.shape[0]
    for i in range(n):
        q = p0 + i
        if p1 == p0:
            mx = points[q, 0] + ox
            my = points[q, 1] + oy
            ink[i] = bar(bits, rows, columns, mx, my, mx, my, half_width(width, gain, 0.0, 0.0), True, False, False)
        else:
            dx = points[q + 1, 0] - points[q, 0]
            dy = points[q + 1, 1] - points[q, 1]
            ink[i] = bar(
                bits, rows, columns, points[q, 0] + ox, points[q, 1] + oy, points[q + 1, 0] + ox, points[q + 1, 1] + oy,
                half_width(width, gain, dx, dy), False, False, False
            )
            mx = points[q, 0] + 0.5 * dx + ox
            my = points[q, 1] + 0.5 * dy + oy
        ink[i] *= 0.015625
        x = cell(mx)
        y = cell(my)
        x = 0 if x < 0 else (columns - 1 if x >= columns else x)
        y = 0 if y < 0 else (rows - 1 if y >= rows else y)
        # where part of the kernel is cut off, less is due for the same want of ink: both sides are put at full weight
        due[i] = residual[y, x] / weight[y, x] + lenience * guide[y, x]
        share[i] = guide[y, x] if due[i] > 0.0 and guide[y, x] > PAPER and guide[y, x] > enters else 1e30
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
            own[i] += ink[j] * profile[<Py_ssize_t>d]
            own[j] += ink[i] * profile[<Py_ssize_t>d]
        # where it is light a stroke is darker than what it stands for, as far as the kernel reaches: by the rule of the
        # least error none would ever be drawn, so one that is known to belong there is worth its ink
        if share[i] < own[i] and 2.0 * due[i] - WORTH < own[i]:
            own[i] = 2.0 * due[i] - WORTH
    return n


cdef double _runs(
    Py_ssize_t n, double[::1] ink, double[::1] own, double[::1] due, double cost, Py_ssize_t shortest,
    Py_ssize_t shortest_wall, bint wall0, bint wall1, double caution, double[::1] total, double[::1] best,
    long long[::1] start,
) noexcept nogil:
    """The runs of pieces worth drawing: the two states are pen up and pen down.

    best[j] is the largest gain of what lies before point j, with the pen up there, and
    start[j] where the run ends that ends at j began (-1: none ends there). A run is at
    least `shortest` pieces long, or `shortest_wall` where it ends at a wall.
    """
    cdef Py_ssize_t i, j, need
    cdef double v
    cdef double opened = -1e30
    cdef Py_ssize_t where = 0
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
    unsigned long long[:, :, ::1] bits, float[:, ::1] residual, float[:, ::1] guide, float[:, ::1] kernel, float step,
    float[:, ::1] weight, double[::1] profile, double[:, ::1] points, long long[::1] first, double[::1] widths,
    unsigned char[::1] walls, long long[::1] order, double gain, double[::1] shifts, double[::1] spacing, bint whole,
    bint strict, double caution, double lenience, double[::1] enters, double cost, double shortest,
    double shortest_wall, long long[:, :, ::1] runs, double[:, ::1] moved, double[:, ::1] scratch,
    long long[::1] starts,
):
    """Try the polylines named in order, one after the other, and draw of each what is worth drawing.

    Normally that is its best runs; if whole, all of it if that lowers the squared error; if strict, all of it
    unless that makes any place darker than it is due: the paper's rule.

    caution: what a stroke adds itself counts so many times: 1 is where the squared error is least.
    lenience: this part of the tone wanted is taken to be due besides, so that mere noise cuts no stroke.
    enters: (n,) the tone at which each is known to belong in a light place.
    shifts: the sideways moves tried, in units of spacing[i] (subpixels).
    runs: (n, most, 2) out, points first … last of each run of polyline i, -1 where there is none.
    moved: (n, 2) out, the move chosen.
    scratch: (6, longest + 2), starts: (longest + 2).
    """
    cdef Py_ssize_t k, i, j, m, n, p0, p1, found, least, least_wall
    cdef double nx, ny, ox, oy, bx, by, d, value, good, long
    cdef unsigned long long* ink_bits = &bits[0, 0, 0]
    cdef Py_ssize_t rows = residual.shape[0]
    cdef Py_ssize_t columns = residual.shape[1]
    cdef Py_ssize_t most = runs.shape[1]
    ink = scratch[0]
    own = scratch[1]
    due = scratch[2]
    total = scratch[3]
    best = scratch[4]
    fresh = scratch[5]
    with nogil:
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
                least = <Py_ssize_t>ceil(shortest / d)
                least_wall = <Py_ssize_t>ceil(shortest_wall / d)
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
                n = _gains(ink_bits, rows, columns, residual, guide, weight, lenience, enters[i], profile,
                           points, p0, p1, ox, oy, widths[i], gain, ink, own, due, fresh)
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
                _draw(ink_bits, rows, columns, residual, guide, kernel, step, points, p0, p1, bx, by,
                      widths[i], gain, fresh)
                continue
            if m != shifts.shape[0] - 1:
                n = _gains(ink_bits, rows, columns, residual, guide, weight, lenience, enters[i], profile,
                           points, p0, p1, bx, by, widths[i], gain, ink, own, due, fresh)
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
                _draw(ink_bits, rows, columns, residual, guide, kernel, step, points, p0 + starts[j], p0 + j, bx, by,
                      widths[i], gain, fresh)
                found += 1
                j = starts[j]
