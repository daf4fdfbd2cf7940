# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: the grey step across each edge, between what lies on its two sides. See strengths.py.

    · · · · · ·            A station m on the edge sees the pixels beside it (o) to which a line crosses no edge. From
     · · o o · ·           them a flood goes on, on that side of the edge's line, within reach and across no edge (·).
    ─────m──────           A plane is fitted to what it finds clean, the near pixels counting more, and read at m; the
      · o o · \\ x          step is the difference of the two sides' planes. What lies beyond another edge (x) is of
     · · · · · \\ x         another thing.
"""

from libc.math cimport floor, sqrt
from penink_cli.geometry._compiled.flood cimport flood
from penink_cli.ground._compiled.real cimport exponential

MAX_REACH = 24  # pixels from a station along each axis; the window is 2 · 24 + 1 wide, and fits a word

cdef double _STIFFNESS = 1.0  # pixels²: holds a plane's slope back, the more the farther its pixels lie to one side
cdef double _ALIKE = 0.1  # pixels: where none is clean, those count that lie so little nearer to edges than the best
cdef double _LEAST_LEFT = 0.25  # of a step, between mixtures: less is not magnified to the whole


cdef struct Station:
    # A place on an edge, and the window of pixels around: `tall` rows from `row` on, `wide` columns from `column` on.
    int edge, row, column, tall, wide
    double x, y, reach
    unsigned long long[49] right, down  # a bit for each pixel from which a step leads on and crosses no edge
    double[49] across, along  # weights of columns and rows: a pixel's is their product


cdef struct Side:
    double value  # grey at the station
    double mixed  # the part of it that is the other side's
    double variance  # of the value, where a pixel's is 1


cdef struct Step:
    double grey  # of the side to the left of the edge less that to its right
    double variance  # where a pixel's is 1; below 0 where one side has no pixel
    double mixed  # the part of it that was reckoned out


cdef class Photo:
    """A photo and its edges, and what is known of each of its pixels.

    grey: (h, w). away: (h, w) distance of pixels' centres from edges, infinite where nothing is mixed.
    met: (h, w) which steps between centres meet an edge, as of `geometry.walls`.
    near: the edges, pixels, by the squares that they are near, a `geometry.edge_index.EdgeGrid`.
    mixed: (k,) the part of a pixel that is the other side's, by its distance in `parts` of a pixel.
    clean: pixels farther from edges are trusted.
    """

    cdef float[:, ::1] grey, away
    cdef unsigned char[:, ::1] met
    cdef double[:, ::1] ends
    cdef double cell
    cdef Py_ssize_t columns
    cdef long long[::1] begin, items
    cdef double[::1] mixed
    cdef double parts, clean, far

    def __init__(
        self, float[:, ::1] grey, float[:, ::1] away, unsigned char[:, ::1] met, near, double[::1] mixed, double parts,
        double clean,
    ) -> None:
        self.grey = grey
        self.away = away
        self.met = met
        self.ends = near.ends
        self.cell = near.size
        self.columns = near.columns
        self.begin = near.begin
        self.items = near.items
        self.mixed = mixed
        self.parts = parts
        self.far = (mixed.shape[0] - 1) / parts
        self.clean = clean

    cdef void look(self, int edge, double t, double reach, Station* here) noexcept nogil:
        """Stand at the part t of an edge and see so far, pixels."""
        cdef int r, c
        cdef double d
        cdef unsigned long long right, down, one = 1
        cdef unsigned char* met
        cdef double spread = -4.5 / (reach * reach)  # a third of the reach is the weights' deviation
        here.edge = edge
        here.reach = reach
        here.x = self.ends[edge, 0] + t * (self.ends[edge, 2] - self.ends[edge, 0])
        here.y = self.ends[edge, 1] + t * (self.ends[edge, 3] - self.ends[edge, 1])
        here.row = max(0, <int>floor(here.y - here.reach))
        here.column = max(0, <int>floor(here.x - here.reach))
        here.tall = min(<int>self.grey.shape[0], <int>floor(here.y + here.reach) + 1) - here.row
        here.wide = min(<int>self.grey.shape[1], <int>floor(here.x + here.reach) + 1) - here.column
        for r in range(here.tall):
            d = here.row + r + 0.5 - here.y
            here.along[r] = exponential(spread * d * d)
            right = down = 0
            met = &self.met[here.row + r, here.column]
            for c in range(here.wide):
                right |= <unsigned long long>(~met[c] & 1) << c
                down |= <unsigned long long>((~met[c] >> 1) & 1) << c
            here.right[r] = right & ((one << (here.wide - 1)) - 1)
            here.down[r] = down
        for c in range(here.wide):
            d = here.column + c + 0.5 - here.x
            here.across[c] = exponential(spread * d * d)

    cdef bint sees(self, Station* here, double dx, double dy) noexcept nogil:
        """Whether no edge but the station's own lies between it and the place (dx, dy) from there."""
        cdef double a, b, ax, ay, bx, by
        cdef Py_ssize_t i, j, k
        cdef int e
        cdef Py_ssize_t left = <Py_ssize_t>((here.x + min(0.0, dx)) / self.cell)
        cdef Py_ssize_t right = <Py_ssize_t>((here.x + max(0.0, dx)) / self.cell)
        cdef Py_ssize_t top = <Py_ssize_t>((here.y + min(0.0, dy)) / self.cell)
        cdef Py_ssize_t bottom = <Py_ssize_t>((here.y + max(0.0, dy)) / self.cell)
        for i in range(top, bottom + 1):
            for j in range(left, right + 1):
                for k in range(self.begin[i * self.columns + j], self.begin[i * self.columns + j + 1]):
                    e = <int>self.items[k]
                    if e == here.edge:
                        continue
                    ax = self.ends[e, 0] - here.x
                    ay = self.ends[e, 1] - here.y
                    bx = self.ends[e, 2] - here.x
                    by = self.ends[e, 3] - here.y
                    a = dx * ay - dy * ax
                    b = dx * by - dy * bx
                    if (a >= 0) == (b >= 0):
                        continue
                    # the edge crosses the line of sight, between the two where they lie on different sides of it
                    a = (bx - ax) * -ay - (by - ay) * -ax
                    b = (bx - ax) * (dy - ay) - (by - ay) * (dx - ax)
                    if (a >= 0) != (b >= 0):
                        return False
        return True

    cdef bint beside(self, Station* here, double nx, double ny, unsigned long long* seen) noexcept nogil:
        """Bits of the pixels next to the station that it sees on the side of the normal (nx, ny); False for none."""
        cdef int r, c
        cdef int around = 1
        cdef int row = <int>floor(here.y + 0.5) - here.row
        cdef int column = <int>floor(here.x + 0.5) - here.column
        cdef double dx, dy
        cdef unsigned long long one = 1
        cdef bint found = False
        for r in range(here.tall):
            seen[r] = 0
        while around <= 4:  # pixels to each side: two suffice for most
            for r in range(max(0, row - around), min(here.tall, row + around)):
                for c in range(max(0, column - around), min(here.wide, column + around)):
                    dx = here.column + c + 0.5 - here.x
                    dy = here.row + r + 0.5 - here.y
                    if dx * nx + dy * ny > 0 and self.sees(here, dx, dy):
                        seen[r] |= one << c
                        found = True
            if found:
                return True
            around *= 2
        return False

    cdef void reached(self, Station* here, double nx, double ny, unsigned long long* seen) noexcept nogil:
        """Spread `seen` over what can be reached on that side of the edge's line."""
        cdef int r, first, last
        cdef double dy, low, high
        cdef unsigned long long[49] right, down
        cdef unsigned long long side, one = 1
        for r in range(here.tall):
            dy = here.row + r + 0.5 - here.y
            high = sqrt(max(0.0, here.reach * here.reach - dy * dy))
            low = -high
            if nx > 0:
                low = max(low, -dy * ny / nx)
            elif nx < 0:
                high = min(high, -dy * ny / nx)
            elif dy * ny <= 0:
                high = low - 1
            # columns whose centres lie between them
            first = max(0, <int>floor(here.x + low - 0.5) + 1 - here.column)
            last = min(here.wide - 1, <int>floor(here.x + high - 0.5) - here.column)
            side = ((one << (last + 1)) - 1) & ~((one << first) - 1) if first <= last else 0
            right[r] = here.right[r] & side & (side >> 1)
            down[r] = here.down[r] & side
            if r:
                down[r - 1] &= side
        flood(seen, right, down, 0, here.tall, here.wide)

    cdef bint side(self, Station* here, double nx, double ny, Side* side) noexcept nogil:
        """What the normal (nx, ny) points to from the station; False where no pixel of that is seen."""
        cdef int r, c, sweep
        cdef double dx, dy, d, w, v, m, det, bx, by, least, low, high, r0, r1, r2, v0, v1, m0, m1, sum_w
        cdef double s = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0, sv = 0, sxv = 0, syv = 0
        cdef double sm = 0, sxm = 0, sym = 0
        cdef double q0, q1, q2, q = 0, qx = 0, qy = 0, qxx = 0, qxy = 0, qyy = 0
        cdef unsigned long long[49] seen
        cdef unsigned long long bits
        cdef float* grey
        cdef float* away
        if not self.beside(here, nx, ny, seen):
            return False
        self.reached(here, nx, ny, seen)
        least, low, high = self.clean, 2.0, -1.0
        for sweep in range(3):  # clean pixels; where there are none, how far from edges the best are; then these
            if sweep == 1:
                least = -1
            for r in range(here.tall):
                bits = seen[r]
                if bits == 0:
                    continue
                grey = &self.grey[here.row + r, here.column]
                away = &self.away[here.row + r, here.column]
                r0 = r1 = r2 = v0 = v1 = m0 = m1 = q0 = q1 = q2 = 0
                c = -1
                while bits:
                    c += 1
                    bits >>= 1
                    if not (seen[r] >> c) & 1:
                        continue
                    d = away[c]
                    if sweep == 1:
                        least = max(least, d)
                    elif d > least:
                        dx = here.column + c + 0.5 - here.x
                        v = grey[c]
                        w = here.across[c]
                        low = min(low, v)
                        high = max(high, v)
                        if d <= self.far:
                            m = w * self.mixed[<Py_ssize_t>(d * self.parts + 0.5)]
                            m0 += m
                            m1 += m * dx
                        r0 += w
                        v0 += w * v
                        q0 += w * w
                        q1 += w * w * dx
                        q2 += w * w * dx * dx
                        w *= dx
                        r1 += w
                        v1 += w * v
                        r2 += w * dx
                dy = here.row + r + 0.5 - here.y
                w = here.along[r]
                s += w * r0
                sx += w * r1
                sxx += w * r2
                sv += w * v0
                sxv += w * v1
                sm += w * m0
                sxm += w * m1
                v = w * w
                q += v * q0
                qx += v * q1
                qxx += v * q2
                qy += v * q0 * dy
                qxy += v * q1 * dy
                qyy += v * q0 * dy * dy
                w *= dy
                sy += w * r0
                sxy += w * r1
                syy += w * dy * r0
                syv += w * v0
                sym += w * m0
            if s > 0:
                break
            if sweep == 1:
                least -= _ALIKE
        sum_w = s
        sx /= s
        sy /= s
        sv /= s
        sm /= s
        sxx = sxx / s - sx * sx + _STIFFNESS
        syy = syy / s - sy * sy + _STIFFNESS
        sxy = sxy / s - sx * sy
        det = sxx * syy - sxy * sxy
        # the plane's value at the station is a weighted sum of the pixels', and what is mixed the same sum of theirs
        bx = (sx * syy - sy * sxy) / det
        by = (sy * sxx - sx * sxy) / det
        w = 0.5 * (high - low)
        side.value = min(high + w, max(low - w, sv - bx * (sxv / s - sx * sv) - by * (syv / s - sy * sv)))
        # each pixel counts w / s (1 + bx sx + by sy − bx x − by y)
        v = 1 + bx * sx + by * sy
        side.variance = (
            v * v * q + bx * bx * qxx + by * by * qyy + 2 * (bx * by * qxy - v * bx * qx - v * by * qy)
        ) / (sum_w * sum_w)
        side.mixed = max(0.0, sm - bx * (sxm / s - sx * sm) - by * (sym / s - sy * sm))
        return True

    cdef Step step(self, int edge, double t, double reach) noexcept nogil:
        """The step at the part t of an edge, by pixels so far away."""
        cdef double dx = self.ends[edge, 2] - self.ends[edge, 0]
        cdef double dy = self.ends[edge, 3] - self.ends[edge, 1]
        cdef double pure
        cdef Station here
        cdef Side left, right
        cdef Step step
        self.look(edge, t, reach, &here)
        step.grey, step.variance, step.mixed = 0, -1, 0
        if self.side(&here, -dy, dx, &left) and self.side(&here, dy, -dx, &right):
            pure = max(_LEAST_LEFT, 1.0 - left.mixed - right.mixed)
            step.grey = (right.value - left.value) / pure
            step.variance = (left.variance + right.variance) / (pure * pure)
            step.mixed = (left.mixed + right.mixed) / pure
        return step

    def measure(
        self, int[::1] edge, double[::1] t, double reach, Py_ssize_t first, Py_ssize_t last, double[:, ::1] out
    ) -> None:
        """Fill rows first … last − 1 of out (n, 3): the step at part t (n,) of edge (n,), its variance and mixture.

        The step is signed: what is to the left of the edge less what is to its right. The variance is that where a
        pixel's is 1, below 0 where one side has no pixel. The mixture is the part of the step that was reckoned out of
        pixels near edges. reach: how far from the station pixels may be, at most MAX_REACH.
        """
        cdef Py_ssize_t k
        cdef Step step
        with nogil:
            for k in range(first, last):
                step = self.step(edge[k], t[k], reach)
                out[k, 0] = step.grey
                out[k, 1] = step.variance
                out[k, 2] = step.mixed
