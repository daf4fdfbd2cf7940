# cython: boundscheck=False, wraparound=False, cdivision=True
"""The loops of the threshold rule: which runs of a screen's strokes a picture's tone lets through.

The self-drawing renderers are this module in PostScript and JavaScript, step by step.
"""

from libc.math cimport ceil, floor, sqrt
from penink_cli.ground._compiled.real cimport sine_of

from penink_cli.blasting import constants

cdef double WAY_STEPS = constants.WAY_STEPS
cdef double GIVE = constants.GIVE
cdef double SAMPLE = constants.SAMPLE
cdef double STEEP = constants.STEEP
cdef double EARLY = constants.EARLY
cdef double[6] WAVER = constants.WAVER
cdef double[5] WAVE = constants.WAVE


cdef inline int _cell(double x, double scale, int n) noexcept nogil:
    cdef int i = <int>floor(x * scale)
    if i < 0:
        return 0
    return n - 1 if i >= n else i


cdef double _edge_between(
    double x0, double y0, double x1, double y1, double[::1] ax, double[::1] ay, double[::1] bx, double[::1] by,
    int[::1] first, int[::1] items, int columns, int rows, double near,
) noexcept nogil:
    """Where an edge crosses the segment, 0 … 1 along it, the crossing nearest to `near`; else -1. Sample units."""
    cdef int i, j, k
    cdef double best = 9.0, answer = -1.0
    cdef int i0 = <int>floor(min(x0, x1)) + 1
    cdef int i1 = <int>floor(max(x0, x1)) + 1
    cdef int j0 = <int>floor(min(y0, y1)) + 1
    cdef int j1 = <int>floor(max(y0, y1)) + 1
    for j in range(max(j0, 0), min(j1, rows - 1) + 1):
        for i in range(max(i0, 0), min(i1, columns - 1) + 1):
            for k in range(first[j * columns + i], first[j * columns + i + 1]):
                e = items[k]
                p = (bx[e] - ax[e]) * (y0 - ay[e]) - (by[e] - ay[e]) * (x0 - ax[e])
                q = (bx[e] - ax[e]) * (y1 - ay[e]) - (by[e] - ay[e]) * (x1 - ax[e])
                if (p > 0) == (q > 0):
                    continue
                a = (x1 - x0) * (ay[e] - y0) - (y1 - y0) * (ax[e] - x0)
                b = (x1 - x0) * (by[e] - y0) - (y1 - y0) * (bx[e] - x0)
                if (a > 0) == (b > 0):
                    continue
                t = p / (p - q)
                if abs(t - near) < best:
                    best = abs(t - near)
                    answer = t
    return answer


cpdef bint runs(
    unsigned char[:, ::1] tone, double width, double height, double[:, :, ::1] control, double[::1] enters,
    double[::1] fresh, int[::1] line, unsigned char[:, ::1] way, unsigned char[::1] level, double cosine, double sine,
    double tile_u, double tile_v, double wave, double turn, int[:, ::1] copies, int columns, int rows, double[::1] ax,
    double[::1] ay, double[::1] bx, double[::1] by, int[::1] first, int[::1] items, double pen, double gain, bint whole,
    int gap, double short, double deep, double block, double[:, ::1] ink, double[:, ::1] points, long long[::1] ends,
    long long[::1] size,
):
    """Append the runs of one screen as polylines; False where the room given does not suffice.

    width, height: of the picture in points; tone (m, n) fills it.
    control: (s, 4, 2) in the screen's u, v; enters: (s,) in 255ths; fresh: (s,) ink of a point of length;
        line: (s,) the line it is part of, -1 for none.
    way: (64, lines) how lines give way, 128 for not at all, in 24ths of a point; level: (256,) row of it for a tone.
    wave, turn: lines wander sideways by about so much, turn radians a point.
    copies: (c, 2) the tiles.
    ax … items: edges in sample units and the squares (columns × rows) they are in.
    pen: effective width; gain: what of it, of an upright stroke, the device adds. What is drawn is
        added to ink, blocks of `block` points square.
    points, ends: size[0] points of size[1] runs, each up to its end; size is brought up to date.
    """
    cdef double[4096] d, px, py
    cdef int s, c, i, k, start, last, got, every
    cdef int n = tone.shape[1]
    cdef int m = tone.shape[0]
    cdef double sx = n / width
    cdef double sy = m / height
    cdef double gx = (columns - 1) / width  # page to sample units, and half a sample
    cdef double gy = (rows - 1) / height
    for s in range(control.shape[0]):
        # coefficients of the cubic in u, v
        u0 = control[s, 0, 0]
        v0 = control[s, 0, 1]
        u1 = 3 * (control[s, 1, 0] - u0)
        v1 = 3 * (control[s, 1, 1] - v0)
        u2 = 3 * (control[s, 2, 0] - 2 * control[s, 1, 0] + u0)
        v2 = 3 * (control[s, 2, 1] - 2 * control[s, 1, 1] + v0)
        u3 = control[s, 3, 0] - u0 - u1 - u2
        v3 = control[s, 3, 1] - v0 - v1 - v2
        length = sqrt((control[s, 3, 0] - u0) ** 2 + (control[s, 3, 1] - v0) ** 2)
        if line[s] >= 0:  # the device has only its extent along the line
            length = control[s, 3, 0] - u0
        k = <int>ceil(length / SAMPLE)
        k = min(max(k, 1), 4094)
        step = length / k
        limit = enters[s]
        for c in range(copies.shape[0]):
            du = u0 + copies[c, 0] * tile_u
            dv = v0 + copies[c, 1] * tile_v
            # the middle tells whether the stroke can reach the picture
            mx = (du + u1 / 2 + u2 / 4 + u3 / 8) * cosine - (dv + v1 / 2 + v2 / 4 + v3 / 8) * sine
            my = (du + u1 / 2 + u2 / 4 + u3 / 8) * sine + (dv + v1 / 2 + v2 / 4 + v3 / 8) * cosine
            reach = length / 2 + 4 + wave
            if mx < -reach or my < -reach or mx > width + reach or my > height + reach:
                continue
            total = 0.0
            aside = 0.0
            for i in range(k + 1):
                t = <double>i / k
                u = du + t * (u1 + t * (u2 + t * u3))
                v = dv + t * (v1 + t * (v2 + t * v3)) + aside
                if line[s] >= 0:
                    aim = v
                    v += (
                        WAVER[0] * sine_of(WAVER[1] * u + WAVER[2] * v)
                        + WAVER[3] * sine_of(WAVER[4] * u + WAVER[5] * v)
                    )
                    if wave > 0:
                        v += wave * (
                            WAVE[0] * sine_of(turn * (u + aim / WAVE[1]))
                            + WAVE[2] * sine_of(turn * (WAVE[3] * u - aim / WAVE[4]))
                        )
                x = u * cosine - v * sine
                y = u * sine + v * cosine
                px[i] = x
                py[i] = y
                got = tone[_cell(y, sy, m), _cell(x, sx, n)]
                d[i] = got - limit
                total += d[i]
                if line[s] >= 0:
                    aim = (<int>way[level[got], line[s]] - 128) / WAY_STEPS
                    if i == 0:
                        aside = aim
                        px[0] -= aside * sine
                        py[0] += aside * cosine
                    elif d[i] > 0:
                        aside += GIVE * (aim - aside)
            if size[0] + 2 * k + 8 > points.shape[0] or size[1] + k > ends.shape[0]:
                return False
            every = 3 if line[s] >= 0 else 1
            if whole:
                if total > 0:
                    _polyline(0, k, k, every, px, py, points, ends, size)
                    _count(
                        0, k, fresh[s] * (length + 0.785 * pen) / (k + 1), 0.0, k, gain, 0.0, width, height,
                        block, px, py, ink,
                    )  # fmt: skip
                continue
            start = -1
            last = -1
            peak = 0.0
            for i in range(k + 2):
                if i <= k and d[i] > 0:
                    if start < 0:
                        start = i
                        peak = 0.0
                    last = i
                    peak = max(peak, d[i])
                elif start >= 0 and (i > k or i - last > gap or d[i] < -deep):
                    if last - start >= short or peak > deep or last - start == k:
                        ta = <double>start
                        tb = <double>last
                        if start > 0:
                            ta = _end(
                                start, -1, k, step, d, px, py, gx, gy, ax, ay, bx, by, first, items, columns, rows, pen
                            )
                        if last < k:
                            tb = _end(
                                last, 1, k, step, d, px, py, gx, gy, ax, ay, bx, by, first, items, columns, rows, pen
                            )
                        if tb > ta:
                            _polyline(ta, tb, k, every, px, py, points, ends, size)
                            each = fresh[s] * step * (tb - ta) / (last - start + 1)
                            _count(
                                start, last, each, step if wave > 0 else 0.0, k, gain, abs(cosine) + abs(sine),
                                width, height, block, px, py, ink,
                            )
                    start = -1
    return True


cdef void _count(
    int start, int last, double each, double step, int k, double gain, double widens, double width, double height,
    double block, double* px, double* py, double[:, ::1] ink,
) noexcept nogil:
    """Add a run's length to the blocks it passes: each of its samples' share, stretched as its piece is if step > 0.

    gain: what the device adds to an upright or level stroke, of its width. It adds more to a slanting one: waves
    come out darker where they are steep, and the feedback must know.
    widens: |cos| + |sin| of the direction that the pen is for.
    """
    cdef int j, i
    cdef double share
    for j in range(start, last + 1):
        if 0 <= px[j] < width and 0 <= py[j] < height:
            share = each
            if step > 0:
                i = j if j < k else k - 1
                dx = px[i + 1] - px[i]
                dy = py[i + 1] - py[i]
                share *= ((1 - gain * widens) * sqrt(dx * dx + dy * dy) + gain * (abs(dx) + abs(dy))) / step
            ink[<int>(py[j] / block), <int>(px[j] / block)] += share


cdef void _polyline(
    double ta, double tb, int k, int every, double* px, double* py, double[:, ::1] points, long long[::1] ends,
    long long[::1] size,
) noexcept nogil:
    """Append the part of the samples from ta to tb: both ends and each `every`-th sample between."""
    cdef long long at = size[0]
    cdef int i = every * (<int>floor(ta / every) + 1)
    _point(ta, k, px, py, points, at)
    at += 1
    while i < tb:
        if i - ta > 0.5 and tb - i > 0.5:
            _point(i, k, px, py, points, at)
            at += 1
        i += every
    _point(tb, k, px, py, points, at)
    size[0] = at + 1
    ends[size[1]] = at + 1
    size[1] += 1


cdef void _point(double t, int k, double* px, double* py, double[:, ::1] points, long long at) noexcept nogil:
    cdef int i = min(max(<int>floor(t), 0), k - 1)
    f = t - i
    points[at, 0] = px[i] + f * (px[i + 1] - px[i])
    points[at, 1] = py[i] + f * (py[i + 1] - py[i])


cdef double _end(
    int at, int way, int k, double step, double* d, double* px, double* py, double gx, double gy, double[::1] ax,
    double[::1] ay, double[::1] bx, double[::1] by, int[::1] first, int[::1] items, int columns, int rows, double pen,
) noexcept nogil:
    """Where a run really ends whose last sample is `at` and whose next one, `at + way`, is off: in samples.

    Exactly at an edge less half a pen where one is near, else where the tone reaches the threshold.
    """
    cdef int i, j
    cdef int off = at + way
    if d[at] - d[off] > STEEP:
        i = max(0, min(k, at - way))
        j = max(0, min(k, off + way))
        t = _edge_between(
            px[i] * gx - 0.5, py[i] * gy - 0.5, px[j] * gx - 0.5, py[j] * gy - 0.5,
            ax, ay, bx, by, first, items, columns, rows, <double>0.5,
        )  # fmt: skip
        if t >= 0:
            return i + (j - i) * t - way * (pen / 2 / step)
    return at + way * (d[at] / (d[at] - d[off])) - way * (EARLY * pen / step)
