# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled loops that make pen strokes of polylines: evening and smoothing them, cutting, fitting cubics.

    ────────   ───────────   ────      Lines are cut to a hand's length. Of some places for a cut the one is taken that
    ───   ──────────   ──────────      is farthest from the ends on the lines beside, along the line and across.

          bow                      A stroke is not drawn on its line but as a hand would draw it: shifted to the side,
        ╭─────╮   ╱ tilt           tilted about its middle, bowed. Cubics are fitted to that, as many as the tolerance
    ───╯───────╰─╱── the line      asks.

Only `pen_lines` imports this module.
"""

from libc.math cimport fabs, floor, sqrt

cdef enum:
    #: Places tried for a cut.
    TRIES = 10
    #: Cubics that one stroke may have.
    MOST_CUBICS = 24


cdef inline double _chance(unsigned long long seed, unsigned long long a, unsigned long long b) noexcept nogil:
    """A number in [0, 1) that depends on the three integers alone (splitmix64)."""
    cdef unsigned long long z = (
        seed * <unsigned long long>0x9E3779B97F4A7C15 + a * <unsigned long long>0xD1B54A32D192ED03
        + b * <unsigned long long>0x8CB92BA72F3D8DD7 + 1
    )
    z = (z ^ (z >> 30)) * <unsigned long long>0xBF58476D1CE4E5B9
    z = (z ^ (z >> 27)) * <unsigned long long>0x94D049BB133111EB
    return ((z ^ (z >> 31)) >> 11) * 1.1102230246251565e-16


ctypedef fused Number:
    float
    double


def lengths(const Number[:, ::1] points, const long long[::1] first, double[::1] out):
    """How long each polyline is."""
    cdef Py_ssize_t i, p
    cdef double x, y, run
    with nogil:
        for i in range(first.shape[0] - 1):
            run = 0.0
            for p in range(first[i], first[i + 1] - 1):
                x = points[p + 1, 0] - points[p, 0]
                y = points[p + 1, 1] - points[p, 1]
                run += sqrt(x * x + y * y)
            out[i] = run


def even(
    const float[:, ::1] points, const long long[::1] first, const double[::1] length, const long long[::1] which,
    const long long[::1] begin, double[:, ::1] out,
):
    """Some of the lines anew in equal steps, which[k] from begin[k] on in out, its ends among its points."""
    cdef Py_ssize_t i, j, p, k, n
    cdef double x, y, step, run, leg, f, due
    with nogil:
        for j in range(which.shape[0]):
            i = which[j]
            n = begin[j + 1] - begin[j] - 1
            step = length[i] / n
            p = first[i]
            run = 0.0
            x = points[p + 1, 0] - points[p, 0]
            y = points[p + 1, 1] - points[p, 1]
            leg = sqrt(x * x + y * y)
            for k in range(n):
                due = k * step
                while run + leg < due and p + 2 < first[i + 1]:
                    run += leg
                    p += 1
                    x = points[p + 1, 0] - points[p, 0]
                    y = points[p + 1, 1] - points[p, 1]
                    leg = sqrt(x * x + y * y)
                f = (due - run) / leg if leg > 1e-12 else 0.0
                f = 1.0 if f > 1.0 else f
                out[begin[j] + k, 0] = points[p, 0] + f * x
                out[begin[j] + k, 1] = points[p, 1] + f * y
            out[begin[j + 1] - 1, 0] = points[first[i + 1] - 1, 0]
            out[begin[j + 1] - 1, 1] = points[first[i + 1] - 1, 1]


def look_up(
    const float[:, ::1] values, const double[:, ::1] points, double left, double top, double dx, double dy,
    float[::1] out,
):
    """The value at the node nearest to each point, node (row j, column i) being at (left + i dx, top + j dy)."""
    cdef Py_ssize_t p, i, j
    with nogil:
        for p in range(points.shape[0]):
            i = <Py_ssize_t>floor((points[p, 0] - left) / dx + 0.5)
            j = <Py_ssize_t>floor((points[p, 1] - top) / dy + 0.5)
            i = 0 if i < 0 else (values.shape[1] - 1 if i >= values.shape[1] else i)
            j = 0 if j < 0 else (values.shape[0] - 1 if j >= values.shape[0] else j)
            out[p] = values[j, i]


def smooth(
    double[:, ::1] points, const long long[::1] first, const unsigned char[::1] rounds, const unsigned char[::1] ring
):
    """Move each point to the binomial mean of itself and its neighbours, as many rounds as are asked for at it.

    The ends of a line stay; a ring has none.
    """
    cdef Py_ssize_t i, p, a, b
    cdef int k, most
    cdef double x, y, x0, y0
    with nogil:
        for i in range(first.shape[0] - 1):
            a = first[i]
            b = first[i + 1]
            most = 0
            for p in range(a, b):
                if rounds[p] > most:
                    most = rounds[p]
            for k in range(most):
                # (x0, y0): what the neighbour before was before this round
                p = b - 2 if ring[i] else a
                x0 = points[p, 0]
                y0 = points[p, 1]
                for p in range(a if ring[i] else a + 1, b - 1):
                    x = points[p, 0]
                    y = points[p, 1]
                    if rounds[p] > k:
                        points[p, 0] = 0.25 * (x0 + 2.0 * x + points[p + 1, 0])
                        points[p, 1] = 0.25 * (y0 + 2.0 * y + points[p + 1, 1])
                    x0 = x
                    y0 = y
                if ring[i]:
                    points[b - 1, 0] = points[a, 0]
                    points[b - 1, 1] = points[a, 1]


cdef class Lines:
    """Polylines in equal steps on each. points: (p, 2); first: (lines + 1,) where each begins; length: (lines,)."""

    cdef const double[:, ::1] points
    cdef const long long[::1] first
    cdef const double[::1] length

    def __init__(self, const double[:, ::1] points, const long long[::1] first, const double[::1] length) -> None:
        self.points = points
        self.first = first
        self.length = length


cdef class Ends:
    """Where strokes end, in lists by cells: a new end finds those that lie near it.

    head: (rows, columns) the newest end in each cell, -1 for none; cells are `cell` wide, from left, top. link: (n,)
    the end before each in its cell, -1 for none; tips: (n, 2) where they are. There is room for n, `count` are there.
    """

    cdef int[:, ::1] head
    cdef int[::1] link
    cdef double[:, ::1] tips
    cdef double cell, left, top
    cdef int count

    def __init__(
        self, int[:, ::1] head, int[::1] link, double[:, ::1] tips, double cell, double left, double top
    ) -> None:
        self.head = head
        self.link = link
        self.tips = tips
        self.cell = cell
        self.left = left
        self.top = top
        self.count = 0

    cdef double crowd(self, double x, double y, double tx, double ty, double reach) noexcept nogil:
        """How crowded an end at (x, y) would be by others near it: along its line (tx, ty), or within reach across."""
        cdef Py_ssize_t row, column
        cdef double along, across
        cdef double cost = 0.0
        cdef Py_ssize_t i = <Py_ssize_t>floor((y - self.top) / self.cell)
        cdef Py_ssize_t j = <Py_ssize_t>floor((x - self.left) / self.cell)
        cdef int e
        for row in range(max(0, i - 1), min(self.head.shape[0], i + 2)):
            for column in range(max(0, j - 1), min(self.head.shape[1], j + 2)):
                e = self.head[row, column]
                while e >= 0:
                    along = fabs((self.tips[e, 0] - x) * tx + (self.tips[e, 1] - y) * ty)
                    across = fabs((self.tips[e, 1] - y) * tx - (self.tips[e, 0] - x) * ty)
                    if along < 5.0 and across < reach:
                        cost += (5.0 - along) * (1.3 * reach - across) / reach
                    e = self.link[e]
        return cost

    cdef void add(self, double x, double y) noexcept nogil:
        """One more end, if it lies in a cell and there is room."""
        cdef Py_ssize_t i = <Py_ssize_t>floor((y - self.top) / self.cell)
        cdef Py_ssize_t j = <Py_ssize_t>floor((x - self.left) / self.cell)
        if 0 <= i < self.head.shape[0] and 0 <= j < self.head.shape[1] and self.count < self.tips.shape[0]:
            self.tips[self.count, 0] = x
            self.tips[self.count, 1] = y
            self.link[self.count] = self.head[i, j]
            self.head[i, j] = self.count
            self.count += 1


def chop(
    Lines lines, Ends ends, const unsigned char[:, ::1] goes_on, const double[::1] spacing, double shortest,
    double least, double most, unsigned long long seed, long long[::1] line, double[:, ::1] span,
    unsigned char[:, ::1] joined,
):
    """Cut lines into strokes from least to most long whose ends keep clear of the ends of others; returns how many.

    Lines shorter than shortest give none. goes_on: (lines, 2) whether a line goes on as another one at its ends.
    spacing: (lines,) how far apart lines are there. ends: none yet, room for as many as there may be strokes.
    line, span, joined: of which line each stroke is, from where to where on it, and whether it goes on at its ends.
    """
    cdef Py_ssize_t i, k, t, q, c
    cdef Py_ssize_t n = 0
    cdef Py_ssize_t room = line.shape[0]
    cdef const double[:, ::1] points = lines.points
    cdef double length, at, end, where, step, f, x, y, tx, ty, d, cost, best, bx, by, reach
    cdef bint last
    cdef bint before
    with nogil:
        for i in range(lines.first.shape[0] - 1):
            length = lines.length[i]
            if length < shortest:
                continue
            q = lines.first[i + 1] - lines.first[i] - 1
            step = length / q
            at = 0.0
            before = goes_on[i, 0]
            reach = 2.2 * spacing[i]
            reach = 3.0 if reach < 3.0 else (10.0 if reach > 10.0 else reach)
            k = 0
            bx = 0.0
            by = 0.0
            while True:
                last = length - at <= most
                end = length
                if not last:
                    best = 1e30
                    for t in range(TRIES):
                        where = at + least + _chance(seed, i * 4096 + k, t) * (most - least)
                        if where > length - least:
                            where = length - least - _chance(seed, i * 4096 + k, t + 64) * 2.0
                        c = <Py_ssize_t>(where / step)
                        c = q - 1 if c >= q else c
                        f = where / step - c
                        c = lines.first[i] + c
                        tx = points[c + 1, 0] - points[c, 0]
                        ty = points[c + 1, 1] - points[c, 1]
                        x = points[c, 0] + f * tx
                        y = points[c, 1] + f * ty
                        d = sqrt(tx * tx + ty * ty) + 1e-12
                        cost = ends.crowd(x, y, tx / d, ty / d, reach)
                        if cost < best:
                            best = cost
                            end = where
                            bx = x
                            by = y
                    ends.add(bx, by)
                if n < room:
                    line[n] = i
                    span[n, 0] = at
                    span[n, 1] = end
                    joined[n, 0] = before
                    joined[n, 1] = goes_on[i, 1] if last else 1
                n += 1
                if last:
                    break
                before = 1
                at = end
                k += 1
    return n


cdef inline void _at(
    const double *p, Py_ssize_t steps, double step, double s, double *x, double *y
) noexcept nogil:
    """The point s along a polyline p of so many equal steps, straight on beyond its ends."""
    cdef Py_ssize_t k
    cdef double f, dx, dy, d
    if 0.0 <= s <= steps * step:
        k = <Py_ssize_t>(s / step)
        k = steps - 1 if k >= steps else k
        f = s / step - k
        x[0] = p[2 * k] + f * (p[2 * k + 2] - p[2 * k])
        y[0] = p[2 * k + 1] + f * (p[2 * k + 3] - p[2 * k + 1])
        return
    # the direction of the last few points
    k = 5 if steps > 5 else steps
    if s < 0.0:
        dx = p[0] - p[2 * k]
        dy = p[1] - p[2 * k + 1]
        s = -s
    else:
        s = s - steps * step
        p = p + 2 * steps
        dx = p[0] - p[-2 * k]
        dy = p[1] - p[1 - 2 * k]
    d = s / (sqrt(dx * dx + dy * dy) + 1e-12)
    x[0] = p[0] + d * dx
    y[0] = p[1] + d * dy


cdef inline void _by_hand(
    const double *p, Py_ssize_t steps, double step, double s0, double s1, const double *hand, double u,
    double *x, double *y, double *nx, double *ny
) noexcept nogil:
    """The point at u, 0 … 1, of the stroke from s0 to s1: beside the line by shift, tilt and bow of the hand.

    (nx, ny): the line's unit normal there.
    """
    cdef double s = s0 + u * (s1 - s0)
    cdef double aside = hand[0] + hand[1] * (2.0 * u - 1.0) + hand[2] * (4.0 * u * (1.0 - u) - 0.6666666666666666)
    cdef double x0, y0, x1, y1, d
    _at(p, steps, step, s - 1.5, &x0, &y0)
    _at(p, steps, step, s + 1.5, &x1, &y1)
    _at(p, steps, step, s, x, y)
    x1 = x1 - x0
    y1 = y1 - y0
    d = 1.0 / (sqrt(x1 * x1 + y1 * y1) + 1e-12)
    nx[0] = -d * y1
    ny[0] = d * x1
    x[0] = x[0] + aside * nx[0]
    y[0] = y[0] + aside * ny[0]


cdef double _fit(
    const double *p, Py_ssize_t steps, double step, double s0, double s1, const double *hand, Py_ssize_t k, double *out
) noexcept nogil:
    """Control points (3 k + 1, 2) of the stroke as k cubics, through it at every third; returns how far off."""
    cdef Py_ssize_t m, t
    cdef double q1x, q1y, q2x, q2y, x, y, u, v, w, dx, dy, nx, ny
    cdef double worst = 0.0
    cdef double *c
    for m in range(k + 1):
        _by_hand(p, steps, step, s0, s1, hand, (<double>m) / k, &out[6 * m], &out[6 * m + 1], &nx, &ny)
    for m in range(k):
        c = out + 6 * m
        _by_hand(p, steps, step, s0, s1, hand, (m + 0.3333333333333333) / k, &q1x, &q1y, &nx, &ny)
        _by_hand(p, steps, step, s0, s1, hand, (m + 0.6666666666666666) / k, &q2x, &q2y, &nx, &ny)
        c[2] = (18.0 * q1x - 5.0 * c[0] - 9.0 * q2x + 2.0 * c[6]) / 6.0
        c[3] = (18.0 * q1y - 5.0 * c[1] - 9.0 * q2y + 2.0 * c[7]) / 6.0
        c[4] = (18.0 * q2x - 5.0 * c[6] - 9.0 * q1x + 2.0 * c[0]) / 6.0
        c[5] = (18.0 * q2y - 5.0 * c[7] - 9.0 * q1y + 2.0 * c[1]) / 6.0
    # smooth joints: both handles along the mean of the two
    for m in range(1, k):
        c = out + 6 * m
        dx = 0.5 * (c[2] - c[-2])
        dy = 0.5 * (c[3] - c[-1])
        c[2] = c[0] + dx
        c[3] = c[1] + dy
        c[-2] = c[0] - dx
        c[-1] = c[1] - dy
    for m in range(k):
        c = out + 6 * m
        for t in range(3):
            u = 0.16666666666666666 + t * 0.3333333333333333
            v = 1.0 - u
            _by_hand(p, steps, step, s0, s1, hand, (m + u) / k, &x, &y, &nx, &ny)
            w = v * v * v
            dx = w * c[0] + 3.0 * u * v * (v * c[2] + u * c[4]) + u * u * u * c[6] - x
            dy = w * c[1] + 3.0 * u * v * (v * c[3] + u * c[5]) + u * u * u * c[7] - y
            # only aside counts: along the line nobody sees it
            w = fabs(dx * nx + dy * ny)
            worst = w if w > worst else worst
    return worst


def cubics(
    Lines lines, const long long[::1] line, const double[:, ::1] span, const double[:, ::1] hand, double tolerance,
    long long[::1] count,
):
    """How many cubics (n,) each stroke needs to be within tolerance of the line that the hand draws along.

    line, span: of which line each is, from where to where, beyond its ends too. hand: (n, 3) shift to the side, the
    same more at the end and less at the start, and bow, points.
    """
    cdef Py_ssize_t n, k, steps, i
    cdef double[6 * MOST_CUBICS + 2] out
    cdef double step
    with nogil:
        for n in range(line.shape[0]):
            i = lines.first[line[n]]
            steps = lines.first[line[n] + 1] - i - 1
            step = lines.length[line[n]] / steps
            k = 1
            while k < MOST_CUBICS and _fit(
                &lines.points[i, 0], steps, step, span[n, 0], span[n, 1], &hand[n, 0], k, out
            ) > tolerance:
                k += 1 if k < 4 else (k + 1) // 2
            count[n] = k if k < MOST_CUBICS else MOST_CUBICS


def draw(
    Lines lines, const long long[::1] line, const double[:, ::1] span, const double[:, ::1] hand,
    const long long[::1] count, const long long[::1] begin, double[:, ::1] out,
):
    """Control points of each stroke as count cubics, from begin on in out (see `cubics`)."""
    cdef Py_ssize_t n, steps, i
    cdef double step
    with nogil:
        for n in range(line.shape[0]):
            i = lines.first[line[n]]
            steps = lines.first[line[n] + 1] - i - 1
            step = lines.length[line[n]] / steps
            _fit(
                &lines.points[i, 0], steps, step, span[n, 0], span[n, 1], &hand[n, 0], count[n], &out[begin[n], 0]
            )
