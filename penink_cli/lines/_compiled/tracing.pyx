# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: lines followed through the responses of a bank of oriented filters. See tracing.py.

A direction is a number of quarters of the angle between two layers of the bank: of n layers 4 n quarters are half a
turn, 8 n a whole one. The responses of dark lines are above 0, those of light ones below; `sign` says which are
followed, and the others count as 0.

             ╱         One step of a walk: of five directions, each three quarters from the next, the one whose response
           ╱           a pixel on is greatest. Straight on is preferred a little. Then the place is moved across the
    • ────────         line, by at most .35 pixel, to the vertex of a parabola through three responses. A line ends
           ╲           where it has been weak for more than `WEAK` steps, or along another for more than `TAKEN`.
             ╲
"""

from libc.math cimport sqrt
from libc.stdlib cimport free
from penink_cli.ground._compiled.memory cimport room

cdef enum:
    WEAK = 6  # steps that a line may go on below the lower threshold
    TAKEN = 3  # steps that it may go on along another line
    LOOK = 64  # responses that are looked at together, most of which are faint


cdef struct Bank:
    const float* responses  # (n, h, w)
    Py_ssize_t n
    Py_ssize_t h
    Py_ssize_t w
    float sign  # of the responses that count
    const double* unit  # (8 n, 2)


cdef Bank bank_of(const float[:, :, ::1] responses, float sign, const double[:, ::1] unit) noexcept:
    return Bank(
        &responses[0, 0, 0], responses.shape[0], responses.shape[1], responses.shape[2], sign, &unit[0, 0]
    )


cdef inline float _own(float response, float sign) noexcept nogil:
    """A response of this sign, or 0."""
    response = sign * response
    return response if response > 0.0 else <float>0.0


cdef inline float _at(const Bank* bank, Py_ssize_t k, double x, double y) noexcept nogil:
    """Layer k at (x, y), interpolated between pixel centres at whole numbers; beyond the frame it is as at the rim."""
    cdef Py_ssize_t i, j
    cdef Py_ssize_t h = bank.h, w = bank.w
    cdef float sign = bank.sign
    cdef const float* layer = bank.responses + k * h * w
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


cdef inline double _towards(const Bank* bank, Py_ssize_t f, double x, double y) noexcept nogil:
    """The response in direction f at (x, y), interpolated between the two layers nearest to it."""
    cdef Py_ssize_t n = bank.n
    cdef Py_ssize_t k
    cdef double d
    f = f % (4 * n)
    f = f + 4 * n if f < 0 else f
    k = f >> 2
    d = 0.25 * (f & 3)
    if d == 0.0:
        return _at(bank, k, x, y)
    return _at(bank, k, x, y) * (1.0 - d) + _at(bank, (k + 1) % n, x, y) * d


cdef inline bint _reached(const float *responses, Py_ssize_t n, float sign, float high) noexcept nogil:
    """Whether any of n responses reaches high."""
    cdef Py_ssize_t q
    cdef int reached = 0
    for q in range(n):
        reached |= sign * responses[q] >= high
    return reached != 0


def peaks(const float[:, :, ::1] responses, float sign, const double[:, ::1] unit, float high, int[:, ::1] out) -> int:
    """Count where a response reaches high and is the greatest among its neighbours across the line and in direction.

    responses: (n, h, w). unit: (8 n, 2) the unit vector of each quarter. out: (m, 3) filled with the first m places, as
    layer, row, column.
    """
    cdef Bank bank = bank_of(responses, sign, unit)
    cdef Py_ssize_t n = bank.n, h = bank.h, w = bank.w
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
                here = &responses[k, i, 0]
                after, before = &responses[(k + 1) % n, i, 0], &responses[(k + n - 1) % n, i, 0]
                right = 2
                while right < w - 2:
                    left, right = right, min(right + LOOK, w - 2)
                    if not _reached(here + left, right - left, sign, high):
                        continue
                    for j in range(left, right):
                        c = sign * here[j]
                        if c < high or sign * after[j] > c or sign * before[j] >= c:
                            continue
                        if _at(&bank, k, j + nx, i + ny) > c:
                            continue
                        if _at(&bank, k, j - nx, i - ny) >= c:
                            continue
                        if found < out.shape[0]:
                            out[found, 0], out[found, 1], out[found, 2] = <int>k, <int>i, <int>j
                        found += 1
    return found


cdef class Tracer:
    """Follows the lines of one sign through a bank, one after another, and keeps what they take up.

    used: (h, w) at each place a bit for each layer that a line has taken there, of at most 32 layers.
    """

    cdef Bank bank
    cdef object held  # the arrays that the pointers lead into
    cdef unsigned int[:, ::1] used
    cdef double low
    cdef double wide
    cdef double* half  # (2, longest, 4) both halves of a line, as x, y, response, direction
    cdef Py_ssize_t longest

    def __init__(
        self, const float[:, :, ::1] responses, float sign, const double[:, ::1] unit, double low, double wide,
        Py_ssize_t longest, unsigned int[:, ::1] used,
    ):
        """Begin with nothing taken but what `used` (h, w) says.

        responses: (n, h, w). sign: of the responses that count. unit: (8 n, 2) the unit vector of each quarter. low:
        the response below which a line ends. wide: pixels to each side that a line takes. longest: steps to each side.
        """
        self.bank = bank_of(responses, sign, unit)
        self.held = responses, unit
        self.used, self.low, self.wide, self.longest = used, low, wide, longest
        self.half = <double*>room(8 * longest, sizeof(double))

    def __dealloc__(self):
        free(self.half)

    def follow(
        self, const int[:, ::1] seeds, Py_ssize_t begin, Py_ssize_t least, double[:, ::1] points, long long[::1] first
    ) -> tuple[int, int, bool]:
        """Follow lines of at least `least` points from seed `begin` on, while there is room for another.

        seeds: (s, 3) layer, row, column. points: (p, 4) filled with x, y, response, direction of all lines. first:
        filled with the place where each line begins, and with the end of the last. Returns the seed to go on with, the
        number of lines, and whether seeds are left.
        """
        cdef Py_ssize_t s, k, i, j, a, b, t, size, lines = 0, at = 0
        cdef const Bank* bank = &self.bank
        cdef Py_ssize_t n = bank.n
        cdef bint closed = False
        cdef double* there = self.half
        cdef double* back = self.half + 4 * self.longest
        cdef unsigned int* used = &self.used[0, 0]
        with nogil:
            first[0] = 0
            s = begin
            while s < seeds.shape[0]:
                if at + 2 * self.longest + 1 > points.shape[0] or lines + 2 > first.shape[0]:
                    break
                k, i, j = seeds[s, 0], seeds[s, 1], seeds[s, 2]
                s += 1
                if (used[i * bank.w + j] >> k) & 1:
                    continue
                b = 0
                a = _walk(bank, used, self.low, 4 * k, j, i, there, self.longest, &closed)
                if not closed:
                    b = _walk(bank, used, self.low, 4 * (k + n), j, i, back, self.longest, &closed)
                    closed = False
                size = at
                for t in range(b - 1, -1, -1):
                    points[at, 0], points[at, 1], points[at, 2] = back[4 * t], back[4 * t + 1], back[4 * t + 2]
                    points[at, 3] = (<Py_ssize_t>back[4 * t + 3] + 4 * n) % (8 * n)
                    at += 1
                points[at, 0], points[at, 1] = j, i
                points[at, 2], points[at, 3] = bank.sign * bank.responses[(k * bank.h + i) * bank.w + j], 4 * k
                at += 1
                for t in range(a):
                    points[at, 0], points[at, 1] = there[4 * t], there[4 * t + 1]
                    points[at, 2], points[at, 3] = there[4 * t + 2], there[4 * t + 3]
                    at += 1
                _take(bank, used, &points[size, 0], at - size, self.wide)
                if at - size < least:
                    at = size
                    continue
                lines += 1
                first[lines] = at
        return s, lines, s < seeds.shape[0]


cdef Py_ssize_t _walk(
    const Bank* bank, const unsigned int* used, double low, Py_ssize_t f, double x, double y, double* out,
    Py_ssize_t most, bint *closed,
) noexcept nogil:
    """Fill in at most `most` points of a line from (x, y) in direction f on, as x, y, response, direction.

    closed: whether the line comes back to where it began. Returns the number of points.
    """
    cdef Py_ssize_t n = bank.n, h = bank.h, w = bank.w
    cdef Py_ssize_t m = 0, weak = 0, taken = 0, turn, g, best_g, i, j, q
    cdef double v, raw, best, mx, my, bx, by, nx, ny, left, middle, right, d
    cdef double sx = x, sy = y
    closed[0] = False
    while m < most:
        best, best_g, bx, by, middle = -1.0, f, x, y, 0.0
        for turn in range(-2, 3):
            g = f + 3 * turn
            g = (g + 8 * n) % (8 * n)
            mx, my = x + bank.unit[2 * g], y + bank.unit[2 * g + 1]
            raw = _towards(bank, g, mx, my)
            v = raw * (1.0 - 0.03 * (turn if turn >= 0 else -turn))
            if v > best:
                best, best_g, bx, by, middle = v, g, mx, my, raw
        nx, ny = -bank.unit[2 * best_g + 1], bank.unit[2 * best_g]
        left = _towards(bank, best_g, bx - 0.7 * nx, by - 0.7 * ny)
        right = _towards(bank, best_g, bx + 0.7 * nx, by + 0.7 * ny)
        d = left - 2.0 * middle + right
        if d < -1e-9:
            d = 0.35 * (left - right) / d
            d = -0.35 if d < -0.35 else (0.35 if d > 0.35 else d)
            bx, by = bx + d * nx, by + d * ny
        if bx < 0.0 or by < 0.0 or bx > w - 1 or by > h - 1:
            break
        v = _towards(bank, best_g, bx, by)
        weak = weak + 1 if v < low else 0
        if weak > WEAK:
            break
        i, j = <Py_ssize_t>(by + 0.5), <Py_ssize_t>(bx + 0.5)
        q = ((best_g + 2) >> 2) % n
        taken = taken + 1 if (used[i * w + j] >> q) & 1 else 0
        if taken > TAKEN:
            break
        x, y, f = bx, by, best_g
        out[4 * m], out[4 * m + 1], out[4 * m + 2], out[4 * m + 3] = x, y, v, f
        m += 1
        if m > 24 and (x - sx) * (x - sx) + (y - sy) * (y - sy) < 1.44:
            closed[0] = True
            return m
    m -= weak if weak > taken else taken
    return m if m > 0 else 0


cdef void _take(
    const Bank* bank, unsigned int* used, const double* line, Py_ssize_t m, double wide
) noexcept nogil:
    """Mark the places within `wide` of a line of m points (m, 4) as used, on the layers of nearly its direction."""
    cdef Py_ssize_t n = bank.n, h = bank.h, w = bank.w
    cdef Py_ssize_t t, k, i, j
    cdef unsigned int layers
    cdef double x, y
    for t in range(m):
        x, y = line[4 * t], line[4 * t + 1]
        layers = 0
        for k in range(-4, 5):
            layers |= <unsigned int>1 << (((((<Py_ssize_t>line[4 * t + 3]) + 2) >> 2) + k + 2 * n) % n)
        for i in range(max(0, <Py_ssize_t>(y - wide + 0.5)), min(h, <Py_ssize_t>(y + wide + 1.5))):
            for j in range(max(0, <Py_ssize_t>(x - wide + 0.5)), min(w, <Py_ssize_t>(x + wide + 1.5))):
                if (i - y) * (i - y) + (j - x) * (j - x) <= wide * wide:
                    used[i * w + j] |= layers


cdef void _smooth(
    const double[:, ::1] line, Py_ssize_t m, Py_ssize_t channel, const double[::1] taps, double[:, ::1] out,
    bint ring, bint mirror
) noexcept nogil:
    """Fill in one channel of out (m, …): that of a line's points low-passed. taps: one half, the middle weight first.

    ring: the line is closed. Otherwise it goes on beyond its ends mirrored: by places, so that values repeat, or, if
    `mirror`, through the end point, so that it goes straight on.
    """
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
    double part, double[:, ::1] smooth, const float[:, :, ::1] places, long long[:, ::1] span, double[:, ::1] told,
) -> None:
    """Smooth lines in place, trim their ends, and measure of each what its rank depends on.

    points, first: as of `follow`; points (p, 3) without directions. narrow, wide: one half of a low-pass for places,
    and for responses. part: ends are trimmed where the response is below this part of the mean. smooth: (m, 3) room for
    the longest line. places: (4, h, w) response and tone of the surroundings, cos 2θ and sin 2θ of the field.
    span: (n, 2) filled with the first point that is left of each line, and the one past the last. told: (n, 7) filled
    with length, mean response, turning in all (radians, as twice the sines of half the angles), means of the two of the
    surroundings and of cos 2Δ, Δ the angle to the field, and 1 if the line is closed.
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
                _smooth(line, m, c, narrow if c < 2 else wide, smooth, ring, c < 2)
            mean = 0.0
            for t in range(m):
                line[t, 0], line[t, 1], line[t, 2] = smooth[t, 0], smooth[t, 1], smooth[t, 2]
                mean += smooth[t, 2]
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
                r = 0 if r < 0 else (places.shape[1] - 1 if r >= places.shape[1] else r)
                c = 0 if c < 0 else (places.shape[2] - 1 if c >= places.shape[2] else c)
                told[i, 1] += line[t, 2]
                told[i, 3] += places[0, r, c]
                told[i, 4] += places[1, r, c]
                if t + 1 < b:
                    dx, dy = line[t + 1, 0] - line[t, 0], line[t + 1, 1] - line[t, 1]
                    step = sqrt(dx * dx + dy * dy)
                    length += step
                    if step > 0.0:
                        co, si = (dx * dx - dy * dy) / (step * step), 2.0 * dx * dy / (step * step)
                        agree += step * (co * places[2, r, c] + si * places[3, r, c])
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
