# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: lines followed through the responses of a bank of oriented filters. See tracing.py.

Directions are counted in quarters of a bin: 4 n of them are half a turn, 8 n a whole one. A bank holds the responses of
dark lines, above 0, and of light ones, below; `sign` says which are followed, and the others are 0.

             ╱         One step of a walk: of five directions, three quarters of a bin apart, the one whose response a
           ╱           pixel on is greatest. Straight on is preferred a little. Then the place is moved across the
    • ────────         line, by at most .35 pixel, to the vertex of a parabola through three responses. A line ends
           ╲           where it has been weak for `WEAK` steps, or along another for `TAKEN`.
             ╲
"""

from libc.math cimport sqrt

cdef enum:
    WEAK = 6  # steps that a line may go on below the lower threshold
    TAKEN = 3  # and along another
    LOOK = 64  # responses that are looked at together, most of which are faint


cdef inline float _own(float response, float sign) noexcept nogil:
    """A response of this sign, or 0."""
    response = sign * response
    return response if response > 0.0 else <float>0.0


cdef inline float _at(
    const float *layer, float sign, Py_ssize_t h, Py_ssize_t w, double x, double y
) noexcept nogil:
    """One layer at (x, y), between pixel centres at whole numbers; beyond the frame as at its rim."""
    cdef Py_ssize_t i, j
    cdef double fx, fy
    x = 0.0 if x < 0.0 else (w - 1.001 if x > w - 1.001 else x)
    y = 0.0 if y < 0.0 else (h - 1.001 if y > h - 1.001 else y)
    i, j = <Py_ssize_t>y, <Py_ssize_t>x
    fy, fx = y - i, x - j
    layer += i * w + j
    return <float>(
        (_own(layer[0], sign) * (1.0 - fx) + _own(layer[1], sign) * fx) * (1.0 - fy)
        + (_own(layer[w], sign) * (1.0 - fx) + _own(layer[w + 1], sign) * fx) * fy
    )


cdef inline double _towards(
    const float[:, :, ::1] bank, float sign, Py_ssize_t f, double x, double y
) noexcept nogil:
    """The response in direction f at (x, y), between the two layers nearest to it."""
    cdef Py_ssize_t n = bank.shape[0], h = bank.shape[1], w = bank.shape[2]
    cdef Py_ssize_t k
    cdef double d
    f = f % (4 * n)
    f = f + 4 * n if f < 0 else f
    k = f >> 2
    d = 0.25 * (f & 3)
    if d == 0.0:
        return _at(&bank[k, 0, 0], sign, h, w, x, y)
    return _at(&bank[k, 0, 0], sign, h, w, x, y) * (1.0 - d) + _at(&bank[(k + 1) % n, 0, 0], sign, h, w, x, y) * d


cdef inline bint _reached(const float *responses, Py_ssize_t n, float sign, float high) noexcept nogil:
    """Whether any of n responses reaches high."""
    cdef Py_ssize_t q
    cdef int reached = 0
    for q in range(n):
        reached |= sign * responses[q] >= high
    return reached != 0


def peaks(const float[:, :, ::1] bank, float sign, const double[:, ::1] unit, float high, int[:, ::1] out):
    """Count where a response reaches high and is the greatest among its neighbours across the line and in direction.

    unit: (8 n, 2) the unit vector of each quarter. out: (m, 3) the first m of them, as layer, row, column.
    """
    cdef Py_ssize_t n = bank.shape[0], h = bank.shape[1], w = bank.shape[2]
    cdef Py_ssize_t k, i, j, left, right, found = 0
    cdef float c
    cdef double nx, ny
    cdef const float* here
    cdef const float* after
    cdef const float* before
    with nogil:
        for k in range(n):
            nx, ny = -unit[4 * k, 1], unit[4 * k, 0]
            for i in range(2, h - 2):
                here, after, before = &bank[k, i, 0], &bank[(k + 1) % n, i, 0], &bank[(k + n - 1) % n, i, 0]
                right = 2
                while right < w - 2:
                    left, right = right, min(right + LOOK, w - 2)
                    if not _reached(here + left, right - left, sign, high):
                        continue
                    for j in range(left, right):
                        c = sign * here[j]
                        if c < high or sign * after[j] > c or sign * before[j] >= c:
                            continue
                        if _at(&bank[k, 0, 0], sign, h, w, j + nx, i + ny) > c:
                            continue
                        if _at(&bank[k, 0, 0], sign, h, w, j - nx, i - ny) >= c:
                            continue
                        if found < out.shape[0]:
                            out[found, 0], out[found, 1], out[found, 2] = <int>k, <int>i, <int>j
                        found += 1
    return found


cdef Py_ssize_t _walk(
    const float[:, :, ::1] bank, float sign, const unsigned int[:, ::1] used, const double[:, ::1] unit, double low,
    Py_ssize_t f, double x, double y, double[:, ::1] out, double sx, double sy, Py_ssize_t most, bint *closed,
) noexcept nogil:
    """Points of a line from (x, y) in direction f on, as x, y, response, direction; how many of them."""
    cdef Py_ssize_t n = bank.shape[0], h = bank.shape[1], w = bank.shape[2]
    cdef Py_ssize_t m = 0, weak = 0, taken = 0, turn, g, best_g, i, j, q
    cdef double v, raw, best, mx, my, bx, by, nx, ny, left, middle, right, d
    closed[0] = False
    while m < most:
        best, best_g, bx, by, middle = -1.0, f, x, y, 0.0
        for turn in range(-2, 3):
            g = f + 3 * turn
            g = (g + 8 * n) % (8 * n)
            mx, my = x + unit[g, 0], y + unit[g, 1]
            raw = _towards(bank, sign, g, mx, my)
            v = raw * (1.0 - 0.03 * (turn if turn >= 0 else -turn))
            if v > best:
                best, best_g, bx, by, middle = v, g, mx, my, raw
        nx, ny = -unit[best_g, 1], unit[best_g, 0]
        left = _towards(bank, sign, best_g, bx - 0.7 * nx, by - 0.7 * ny)
        right = _towards(bank, sign, best_g, bx + 0.7 * nx, by + 0.7 * ny)
        d = left - 2.0 * middle + right
        if d < -1e-9:
            d = 0.35 * (left - right) / d
            d = -0.35 if d < -0.35 else (0.35 if d > 0.35 else d)
            bx, by = bx + d * nx, by + d * ny
        if bx < 0.0 or by < 0.0 or bx > w - 1 or by > h - 1:
            break
        v = _towards(bank, sign, best_g, bx, by)
        weak = weak + 1 if v < low else 0
        if weak > WEAK:
            break
        i, j = <Py_ssize_t>(by + 0.5), <Py_ssize_t>(bx + 0.5)
        q = ((best_g + 2) >> 2) % n
        taken = taken + 1 if (used[i, j] >> q) & 1 else 0
        if taken > TAKEN:
            break
        x, y, f = bx, by, best_g
        out[m, 0], out[m, 1], out[m, 2], out[m, 3] = x, y, v, f
        m += 1
        if m > 24 and (x - sx) * (x - sx) + (y - sy) * (y - sy) < 1.44:
            closed[0] = True
            return m
    m -= weak if weak > taken else taken
    return m if m > 0 else 0


cdef void _take(
    unsigned int[:, ::1] used, Py_ssize_t n, const double[:, ::1] line, Py_ssize_t m, double wide
) noexcept nogil:
    """Mark what lies along a line, and in nearly its direction, of n, as used."""
    cdef Py_ssize_t h = used.shape[0], w = used.shape[1]
    cdef Py_ssize_t t, k, i, j
    cdef unsigned int layers
    cdef double x, y
    for t in range(m):
        x, y = line[t, 0], line[t, 1]
        layers = 0
        for k in range(-4, 5):
            layers |= <unsigned int>1 << (((((<Py_ssize_t>line[t, 3]) + 2) >> 2) + k + 2 * n) % n)
        for i in range(max(0, <Py_ssize_t>(y - wide + 0.5)), min(h, <Py_ssize_t>(y + wide + 1.5))):
            for j in range(max(0, <Py_ssize_t>(x - wide + 0.5)), min(w, <Py_ssize_t>(x + wide + 1.5))):
                if (i - y) * (i - y) + (j - x) * (j - x) <= wide * wide:
                    used[i, j] |= layers


def follow(
    const float[:, :, ::1] bank, float sign, const double[:, ::1] unit, const int[:, ::1] seeds, Py_ssize_t begin,
    double low, double wide, Py_ssize_t least, unsigned int[:, ::1] used, double[:, ::1] there, double[:, ::1] back,
    double[:, ::1] points, long long[::1] first,
):
    """Lines from the seeds (s, 3) on, from seed `begin`, until there is no room for another.

    used: (h, w) at each place a bit for each layer that a line has taken there, of at most 32 layers.
    points: (p, 4) x, y, response, direction of all lines; first: where each begins. there, back: (m, 4) room for half a
    line. Returns the seed to go on with, the number of lines, and 1 where seeds are left.
    """
    cdef Py_ssize_t s, k, i, j, a, b, t, size, lines = 0, at = 0
    cdef Py_ssize_t n = bank.shape[0], room = there.shape[0]
    cdef bint closed = False
    with nogil:
        first[0] = 0
        s = begin
        while s < seeds.shape[0]:
            if at + 2 * room + 1 > points.shape[0] or lines + 2 > first.shape[0]:
                break
            k, i, j = seeds[s, 0], seeds[s, 1], seeds[s, 2]
            s += 1
            if (used[i, j] >> k) & 1:
                continue
            b = 0
            a = _walk(bank, sign, used, unit, low, 4 * k, j, i, there, j, i, room, &closed)
            if not closed:
                b = _walk(bank, sign, used, unit, low, 4 * (k + n), j, i, back, j, i, room, &closed)
                closed = False
            size = at
            for t in range(b - 1, -1, -1):
                points[at, 0], points[at, 1], points[at, 2] = back[t, 0], back[t, 1], back[t, 2]
                points[at, 3] = (<Py_ssize_t>back[t, 3] + 4 * n) % (8 * n)
                at += 1
            points[at, 0], points[at, 1], points[at, 2], points[at, 3] = j, i, sign * bank[k, i, j], 4 * k
            at += 1
            for t in range(a):
                points[at, 0], points[at, 1] = there[t, 0], there[t, 1]
                points[at, 2], points[at, 3] = there[t, 2], there[t, 3]
                at += 1
            _take(used, n, points[size:at], at - size, wide)
            if at - size < least:
                at = size
                continue
            lines += 1
            first[lines] = at
    return s, lines, s < seeds.shape[0]


cdef void _smooth(
    const double[:, ::1] line, Py_ssize_t m, Py_ssize_t channel, const double[::1] taps, double[:, ::1] out,
    bint ring, bint mirror
) noexcept nogil:
    """One channel of a line's points low-passed; beyond its ends points are mirrored in them, responses in value."""
    cdef Py_ssize_t i, t, a, b
    cdef double v, va, vb
    for i in range(m):
        v = taps[0] * line[i, channel]
        for t in range(1, taps.shape[0]):
            a, b = i - t, i + t
            if ring:
                va = line[(a % m + m) % m, channel]
                vb = line[b % m, channel]
            else:
                va = line[a, channel] if a >= 0 else line[min(-a, m - 1), channel]
                vb = line[b, channel] if b < m else line[max(2 * m - 2 - b, 0), channel]
                if mirror and a < 0:
                    va = 2.0 * line[0, channel] - va
                if mirror and b >= m:
                    vb = 2.0 * line[m - 1, channel] - vb
            v += taps[t] * (va + vb)
        out[i, channel] = v


def measure(
    double[:, ::1] points, const long long[::1] first, const double[::1] narrow, const double[::1] wide,
    double part, double[:, ::1] room, const float[:, ::1] around, const float[:, ::1] ground,
    const float[:, ::1] cos2, const float[:, ::1] sin2, long long[:, ::1] span, double[:, ::1] told,
):
    """Smooth lines in place, trim their ends, and tell of each what its rank depends on.

    narrow, wide: half a low-pass for places and for responses. part: ends are trimmed below this part of the mean
    response. around, ground (h, w): the surroundings' response and tone; cos2, sin2: the field (double angle).
    span: (n, 2) first and last (exclusive) of the points that are left. told: (n, 7) length, mean response, turning in
    all (radians, as twice the sines of half of them), means of around, ground and cos 2Δ to the field, 1 if closed.
    """
    cdef Py_ssize_t i, t, a, b, m, r, c
    cdef double mean, dx, dy, ex, ey, length, other, turn, step, co, si, agree, w
    cdef double[:, ::1] line
    cdef bint ring
    with nogil:
        for i in range(first.shape[0] - 1):
            line = points[first[i]:first[i + 1]]
            m = line.shape[0]
            dx, dy = line[m - 1, 0] - line[0, 0], line[m - 1, 1] - line[0, 1]
            ring = m > 24 and dx * dx + dy * dy < 2.25
            told[i, 6] = ring
            for c in range(3):
                _smooth(line, m, c, narrow if c < 2 else wide, room, ring, c < 2)
            mean = 0.0
            for t in range(m):
                line[t, 0], line[t, 1], line[t, 2] = room[t, 0], room[t, 1], room[t, 2]
                mean += room[t, 2]
            mean = part * mean / m
            a, b = 0, m
            if not ring:
                while a < b and line[a, 2] < mean:
                    a += 1
                while b > a and line[b - 1, 2] < mean:
                    b -= 1
            span[i, 0], span[i, 1] = first[i] + a, first[i] + b
            for c in range(6):
                told[i, c] = 0.0
            if b - a < 2:
                continue
            length = turn = agree = 0.0
            for t in range(a, b):
                r, c = <Py_ssize_t>(line[t, 1] + 0.5), <Py_ssize_t>(line[t, 0] + 0.5)
                r = 0 if r < 0 else (around.shape[0] - 1 if r >= around.shape[0] else r)
                c = 0 if c < 0 else (around.shape[1] - 1 if c >= around.shape[1] else c)
                told[i, 1] += line[t, 2]
                told[i, 3] += around[r, c]
                told[i, 4] += ground[r, c]
                if t + 1 < b:
                    dx, dy = line[t + 1, 0] - line[t, 0], line[t + 1, 1] - line[t, 1]
                    step = sqrt(dx * dx + dy * dy)
                    length += step
                    if step > 0.0:
                        co, si = (dx * dx - dy * dy) / (step * step), 2.0 * dx * dy / (step * step)
                        agree += step * (co * cos2[r, c] + si * sin2[r, c])
                if t - a >= 6 and (t - a) % 3 == 0:  # turning between chords of three steps
                    dx, dy = line[t, 0] - line[t - 3, 0], line[t, 1] - line[t - 3, 1]
                    ex, ey = line[t - 3, 0] - line[t - 6, 0], line[t - 3, 1] - line[t - 6, 1]
                    step, other = sqrt(dx * dx + dy * dy), sqrt(ex * ex + ey * ey)
                    if step > 0.0 and other > 0.0:
                        w = 2.0 - 2.0 * (dx * ex + dy * ey) / (step * other)
                        turn += sqrt(w) if w > 0.0 else 0.0
            told[i, 0], told[i, 2] = length, turn
            told[i, 1] /= b - a
            told[i, 3] /= b - a
            told[i, 4] /= b - a
            told[i, 5] = agree / length if length > 0.0 else 0.0
