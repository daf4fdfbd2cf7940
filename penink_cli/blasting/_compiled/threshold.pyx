# cython: boundscheck=False, wraparound=False, cdivision=True
"""The loops of the threshold rule: which runs of a screen's strokes a picture's tone lets through.

The self-drawing renderers are this module in PostScript and JavaScript, step by step.
"""

from libc.math cimport ceil, floor, sqrt
from penink_cli.ground._compiled.real cimport sine_of

from penink_cli.blasting import constants
from penink_cli.ground.angles import direction

cdef double WAY_STEPS = constants.WAY_STEPS
cdef double GIVE = constants.GIVE
cdef double SAMPLE = constants.SAMPLE
cdef double STEEP = constants.STEEP
cdef double EARLY = constants.EARLY
cdef int GAP = constants.GAP
cdef double SHORT = constants.SHORT
cdef double DEEP = constants.DEEP
cdef double[6] WAVER = constants.WAVER
cdef double[5] WAVE = constants.WAVE


cdef enum:
    MOST = 4096  # samples of a stroke, with room for one beyond its end


cdef inline int _cell(double x, double scale, int n) noexcept nogil:
    cdef int i = <int>floor(x * scale)
    if i < 0:
        return 0
    return n - 1 if i >= n else i


cdef class Edges:
    """The edges that runs end at, in sample units, and the squares that they are in.

    ends: (e, 4) ax ay bx by. first, items: those in square c, of columns × rows, are items[first[c] : first[c + 1]].
    """

    cdef double[:, ::1] ends
    cdef int[::1] first, items
    cdef int columns, rows

    def __init__(self, double[:, ::1] ends, int[::1] first, int[::1] items, int columns, int rows) -> None:
        self.ends = ends
        self.first = first
        self.items = items
        self.columns = columns
        self.rows = rows

    cdef double between(self, double x0, double y0, double x1, double y1) noexcept nogil:
        """Where an edge crosses the segment, 0 … 1 along it, the crossing nearest to its middle; else -1."""
        cdef int i, j, k, e
        cdef double best = 9.0, answer = -1.0
        cdef int i0 = <int>floor(min(x0, x1)) + 1
        cdef int i1 = <int>floor(max(x0, x1)) + 1
        cdef int j0 = <int>floor(min(y0, y1)) + 1
        cdef int j1 = <int>floor(max(y0, y1)) + 1
        cdef double ax, ay, ex, ey, p, q, a, b, t
        for j in range(max(j0, 0), min(j1, self.rows - 1) + 1):
            for i in range(max(i0, 0), min(i1, self.columns - 1) + 1):
                for k in range(self.first[j * self.columns + i], self.first[j * self.columns + i + 1]):
                    e = self.items[k]
                    ax = self.ends[e, 0]
                    ay = self.ends[e, 1]
                    ex = self.ends[e, 2]
                    ey = self.ends[e, 3]
                    p = (ex - ax) * (y0 - ay) - (ey - ay) * (x0 - ax)
                    q = (ex - ax) * (y1 - ay) - (ey - ay) * (x1 - ax)
                    if (p > 0) == (q > 0):
                        continue
                    a = (x1 - x0) * (ay - y0) - (y1 - y0) * (ax - x0)
                    b = (x1 - x0) * (ey - y0) - (y1 - y0) * (ex - x0)
                    if (a > 0) == (b > 0):
                        continue
                    t = p / (p - q)
                    if abs(t - 0.5) < best:
                        best = abs(t - 0.5)
                        answer = t
        return answer


cdef class Stroke:
    """The samples 0 … k of one copy of a stroke, `step` points apart: where they are, and by how much tone exceeds
    the threshold there.
    """

    cdef double[MOST] excess, x, y
    cdef int k
    cdef double step

    cdef double end(self, int at, int way, Edges edges, double gx, double gy, double pen) noexcept nogil:
        """Where a run really ends whose last sample is `at` and whose next one, `at + way`, is off: in samples.

        Exactly at an edge less half a pen where one is near, else where the tone reaches the threshold.
        gx, gy: from points to sample units.
        """
        cdef int i, j
        cdef int off = at + way
        cdef double t
        if self.excess[at] - self.excess[off] > STEEP:
            i = max(0, min(self.k, at - way))
            j = max(0, min(self.k, off + way))
            t = edges.between(
                self.x[i] * gx - 0.5, self.y[i] * gy - 0.5, self.x[j] * gx - 0.5, self.y[j] * gy - 0.5
            )
            if t >= 0:
                return i + (j - i) * t - way * (pen / 2 / self.step)
        return (
            at + way * (self.excess[at] / (self.excess[at] - self.excess[off])) - way * (EARLY * pen / self.step)
        )


cdef class Blocks:
    """The ink of what is drawn on a sheet of width × height points, in blocks of `side` points square.

    gain: what of the pen's width the device adds to an upright or level stroke. It adds more to a slanting one: waves
    come out darker where they are steep, and the feedback must know.
    """

    cdef double[:, ::1] ink
    cdef double width, height, side, gain

    def __init__(self, double[:, ::1] ink, double width, double height, double side, double gain) -> None:
        self.ink = ink
        self.width = width
        self.height = height
        self.side = side
        self.gain = gain

    cdef void count(self, Stroke stroke, int start, int last, double each, bint waves, double widens) noexcept nogil:
        """Add a run's length to the blocks it passes: each of its samples' share, stretched as its piece is in waves.

        widens: |cos| + |sin| of the direction that the pen is for.
        """
        cdef int j, i
        cdef double share, dx, dy
        for j in range(start, last + 1):
            if 0 <= stroke.x[j] < self.width and 0 <= stroke.y[j] < self.height:
                share = each
                if waves:
                    i = j if j < stroke.k else stroke.k - 1
                    dx = stroke.x[i + 1] - stroke.x[i]
                    dy = stroke.y[i + 1] - stroke.y[i]
                    share *= (
                        (1 - self.gain * widens) * sqrt(dx * dx + dy * dy) + self.gain * (abs(dx) + abs(dy))
                    ) / stroke.step
                self.ink[<int>(stroke.y[j] / self.side), <int>(stroke.x[j] / self.side)] += share


cdef class Runs:
    """Polylines: the first `points_used` of points (p, 2), and where each of the first `runs_used` ends."""

    cdef readonly double[:, ::1] points
    cdef readonly long long[::1] ends
    cdef readonly long long points_used, runs_used

    def __init__(self, double[:, ::1] points, long long[::1] ends) -> None:
        self.points = points
        self.ends = ends

    cdef bint full(self, int k) noexcept nogil:
        """Whether a stroke of k samples may find no room."""
        return self.points_used + 2 * k + 8 > self.points.shape[0] or self.runs_used + k > self.ends.shape[0]

    cdef void add(self, Stroke stroke, double ta, double tb, int every) noexcept nogil:
        """Append the part of the samples from ta to tb: both ends and each `every`-th sample between."""
        cdef int i = every * (<int>floor(ta / every) + 1)
        self._point(stroke, ta)
        while i < tb:
            if i - ta > 0.5 and tb - i > 0.5:
                self._point(stroke, i)
            i += every
        self._point(stroke, tb)
        self.ends[self.runs_used] = self.points_used
        self.runs_used += 1

    cdef void _point(self, Stroke stroke, double t) noexcept nogil:
        cdef int i = min(max(<int>floor(t), 0), stroke.k - 1)
        cdef double f = t - i
        self.points[self.points_used, 0] = stroke.x[i] + f * (stroke.x[i + 1] - stroke.x[i])
        self.points[self.points_used, 1] = stroke.y[i] + f * (stroke.y[i + 1] - stroke.y[i])
        self.points_used += 1


def runs(
    unsigned char[:, ::1] tone, screen, table, int[:, ::1] copies, Edges edges, Blocks blocks, Runs found
) -> bool:
    """Append the runs of one screen as polylines; False where the room given does not suffice.

    tone: (m, n) in 255ths; it fills the sheet, which `blocks` knows and which what is drawn is added to.
    screen, table: a `screens.Screen` of a `screens.ThresholdTable`, which tell what theirs are.
    copies: (c, 2) the tiles.
    """
    cdef double[:, :, ::1] control = screen.control
    cdef double[::1] enters = screen.enters * 255
    cdef double[::1] fresh = screen.fresh_of_each
    cdef int[::1] line = screen.line
    cdef unsigned char[:, ::1] way = table.way
    cdef unsigned char[::1] level = screen.level
    cdef double cosine, sine
    cosine, sine = direction(screen.angle)
    cdef double tile_u = screen.width, tile_v = screen.height, wave = screen.wave, turn = screen.turn
    cdef double pen = table.pen_pt
    cdef bint whole = table.whole and screen.layer is None
    cdef Stroke stroke = Stroke()
    cdef int s, c, i, k, start, last, got, every
    cdef double u0, v0, u1, v1, u2, v2, u3, v3, length, step, limit, du, dv, mx, my, reach, total, aside, aim
    cdef double t, u, v, x, y, ta, tb, each, peak
    cdef double width = blocks.width, height = blocks.height
    cdef int n = tone.shape[1]
    cdef int m = tone.shape[0]
    cdef double sx = n / width
    cdef double sy = m / height
    cdef double gx = (edges.columns - 1) / width  # page to sample units, and half a sample
    cdef double gy = (edges.rows - 1) / height
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
        stroke.k = k
        stroke.step = step
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
                stroke.x[i] = x
                stroke.y[i] = y
                got = tone[_cell(y, sy, m), _cell(x, sx, n)]
                stroke.excess[i] = got - limit
                total += stroke.excess[i]
                if line[s] >= 0:
                    aim = (<int>way[level[got], line[s]] - 128) / WAY_STEPS
                    if i == 0:
                        aside = aim
                        stroke.x[0] -= aside * sine
                        stroke.y[0] += aside * cosine
                    elif stroke.excess[i] > 0:
                        aside += GIVE * (aim - aside)
            if found.full(k):
                return False
            every = 3 if line[s] >= 0 else 1
            if whole:
                if total > 0:
                    found.add(stroke, 0, k, every)
                    blocks.count(stroke, 0, k, fresh[s] * (length + 0.785 * pen) / (k + 1), False, 0.0)
                continue
            start = -1
            last = -1
            peak = 0.0
            for i in range(k + 2):
                if i <= k and stroke.excess[i] > 0:
                    if start < 0:
                        start = i
                        peak = 0.0
                    last = i
                    peak = max(peak, stroke.excess[i])
                elif start >= 0 and (i > k or i - last > GAP or stroke.excess[i] < -DEEP):
                    if last - start >= SHORT or peak > DEEP or last - start == k:
                        ta = <double>start
                        tb = <double>last
                        if start > 0:
                            ta = stroke.end(start, -1, edges, gx, gy, pen)
                        if last < k:
                            tb = stroke.end(last, 1, edges, gx, gy, pen)
                        if tb > ta:
                            found.add(stroke, ta, tb, every)
                            each = fresh[s] * step * (tb - ta) / (last - start + 1)
                            blocks.count(stroke, start, last, each, wave > 0, abs(cosine) + abs(sine))
                    start = -1
    return True
