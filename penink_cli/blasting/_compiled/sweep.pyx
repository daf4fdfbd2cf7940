# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled loops of the sweep: lines laid as far apart as a density asks, then evened out.

    0.0   0.0   0.0        A column of numbers here is a column of the grid, dark on the right, and the numbers are its
    0.4   0.5   1.0        phase: how many lines have passed from the first row to this one. The first line runs where
    0.8   1.0   2.0        phase is 1, from the left below to the right above; where it is 2 the next one. So lines are
    1.2   1.5   3.0        as close as the tone asks.

Columns run along the hatch, rows across it: `phase[column, row]`. The next line of a column is due where its phase
reaches the column's count. See the Python module `sweep`.

Only `sweep` imports this module.
"""

from libc.math cimport fabs, floor


cdef inline double _chance(unsigned long long seed, unsigned long long a, unsigned long long b) noexcept nogil:
    """A number in [0, 1) that depends on the three integers alone (splitmix64)."""
    cdef unsigned long long z = seed * <unsigned long long>0x9E3779B97F4A7C15 + 1
    z += a * <unsigned long long>0xD1B54A32D192ED03
    z += b * <unsigned long long>0x8CB92BA72F3D8DD7
    z = (z ^ (z >> 30)) * <unsigned long long>0xBF58476D1CE4E5B9
    z = (z ^ (z >> 27)) * <unsigned long long>0x94D049BB133111EB
    z = z ^ (z >> 31)
    return (z >> 11) * 1.1102230246251565e-16


cdef inline double _phase_at(double[:, ::1] phase, Py_ssize_t j, double v) noexcept nogil:
    """Phase of column j at row v, by interpolation, and on at the border's rate beyond the grid."""
    cdef Py_ssize_t k = <Py_ssize_t>v  # what is cut off before the first row tells no other one
    cdef Py_ssize_t n = phase.shape[1]
    k = 0 if k < 0 else (n - 2 if k > n - 2 else k)
    return phase[j, k] + (v - k) * (phase[j, k + 1] - phase[j, k])


cdef inline double _rate_at(double[:, ::1] phase, Py_ssize_t j, double v) noexcept nogil:
    """Lines a row in column j at row v."""
    cdef Py_ssize_t k = <Py_ssize_t>v
    cdef Py_ssize_t n = phase.shape[1]
    k = 0 if k < 0 else (n - 2 if k > n - 2 else k)
    return phase[j, k + 1] - phase[j, k]


cdef inline double _apart(double[:, ::1] phase, Py_ssize_t j, double v, double w) noexcept nogil:
    """How many spacings lie between rows v and w of column j, by the narrower spacing of the two places.

    Phase would not do: it stands still where the paper is white, so all places there are equally near.
    """
    cdef double a = _rate_at(phase, j, v)
    cdef double b = _rate_at(phase, j, w)
    return fabs(v - w) * (a if a > b else b)


cdef class Terms:
    """What the hand keeps to while it lays lines.

    shortest: runs of fewer columns wait for the next line. least, most: columns a stroke has. steepest: rows a column.
    memory: how much of a line's deviation from its due place the next one keeps. drift: how far, in spacings, chance
    moves the line after a stroke either way. heal, reach: how much of a mismatch of phase at a run's end is mended
    with each line, over so many columns.
    """

    cdef Py_ssize_t shortest, least, most, reach
    cdef double steepest, memory, drift, heal

    def __init__(
        self, *, Py_ssize_t shortest, Py_ssize_t least, Py_ssize_t most, double steepest, double memory, double drift,
        double heal, Py_ssize_t reach,
    ) -> None:
        self.shortest = shortest
        self.least = least
        self.most = most
        self.steepest = steepest
        self.memory = memory
        self.drift = drift
        self.heal = heal
        self.reach = reach


cdef class Front:
    """Where the next line of each column is due, and which column is the first.

    phase: (columns, rows) lines from the first row on. count: (columns,) the phase at which each column's next line is
    due. tree: a tournament of when they are due, (2 × a power of two not below columns): every node is the smaller of
    its two children, leaf j belongs to column j. at, cuts, waits: (columns,) each, the row at which the next line is
    looked for; the row where a line was last cut in two here; how often a run was too short to be drawn.
    """

    cdef double[:, ::1] phase
    cdef double[::1] count, tree, cuts
    cdef long long[::1] at
    cdef unsigned char[::1] waits
    cdef Py_ssize_t leaves

    def __init__(
        self, double[:, ::1] phase, double[::1] count, double[::1] tree, long long[::1] at, double[::1] cuts,
        unsigned char[::1] waits,
    ) -> None:
        cdef Py_ssize_t i
        self.phase = phase
        self.count = count
        self.tree = tree
        self.at = at
        self.cuts = cuts
        self.waits = waits
        self.leaves = tree.shape[0] // 2
        for i in range(self.leaves):
            tree[self.leaves + i] = self.due(i) if i < phase.shape[0] else 1e30
        for i in range(self.leaves - 1, 0, -1):
            tree[i] = min(tree[2 * i], tree[2 * i + 1])

    cdef double due(self, Py_ssize_t j) noexcept nogil:
        """The row at which column j reaches its count of lines, 1e30 if it never does."""
        cdef double* phase = &self.phase[j, 0]
        cdef double count = self.count[j]
        cdef Py_ssize_t k = self.at[j]
        cdef Py_ssize_t n = self.phase.shape[1]
        while k > 0 and phase[k] > count:
            k -= 1
        while k < n - 1 and phase[k + 1] <= count:
            k += 1
        if k >= n - 1:
            self.at[j] = n - 2
            return 1e30
        self.at[j] = k
        return k + (count - phase[k]) / (phase[k + 1] - phase[k])

    cdef void renew(self, Py_ssize_t j) noexcept nogil:
        """Find anew when column j is due, whose count has changed."""
        cdef double a, b
        cdef double* tree = &self.tree[0]
        cdef Py_ssize_t i = self.leaves + j
        tree[i] = self.due(j)
        i >>= 1
        while i >= 1:
            a = tree[2 * i]
            b = tree[2 * i + 1]
            tree[i] = a if a < b else b
            i >>= 1

    cdef Py_ssize_t first(self) noexcept nogil:
        """The column that is due first, the leftmost of several."""
        cdef Py_ssize_t i = 1
        while i < self.leaves:
            i = 2 * i if self.tree[2 * i] <= self.tree[2 * i + 1] else 2 * i + 1
        return i - self.leaves


def lay(Front front, Terms terms, unsigned long long seed, double[:, ::1] strokes, long long[:, ::1] spans):
    """Lay lines in the order in which they fall due; returns how many strokes there are.

    strokes: (n, 3) out: the middle column, the row there, the slope. spans: (n, 4) out: the first and the last column,
    then whether the stroke goes on as another one (1) or ends there (0), at either end.
    """
    cdef Py_ssize_t i, j, left, right, a, b, c, gap, trial
    cdef double v, w, d, rate, best, score, tolerance, sx, sxx, sy, sxy, m, middle, row, slope, error
    cdef int side
    cdef double[:, ::1] phase = front.phase
    cdef double[::1] count = front.count, cuts = front.cuts
    cdef double* tree = &front.tree[0]
    cdef double* due = tree + front.leaves  # the tournament's leaves
    cdef Py_ssize_t columns = phase.shape[0]
    cdef Py_ssize_t room = strokes.shape[0]
    cdef Py_ssize_t n = 0
    cdef unsigned long long runs = 0
    with nogil:
        while n < room and tree[1] < 1e29:
            j = front.first()
            v = due[j]
            rate = _rate_at(phase, j, v)
            runs += 1
            tolerance = 0.36 + 0.2 * _chance(seed, runs, 1)
            # grow the run to the left and to the right, over small gaps
            left = j
            right = j
            for side in range(2):
                w = v
                gap = 0
                a = j
                while True:
                    a = a - 1 if side == 0 else a + 1
                    if a < 0 or a >= columns:
                        break
                    d = due[a]
                    if d < 1e29 and _apart(phase, a, d, w) <= tolerance:
                        w = w + 0.5 * (d - w)
                        gap = 0
                        if side == 0:
                            left = a
                        else:
                            right = a
                    else:
                        gap += 1
                        if gap > 2:
                            break
            if right - left + 1 < terms.shortest:
                # too short to be a stroke: wait for the neighbours' next line, but not for ever
                for a in range(left, right + 1):
                    front.waits[a] += 1
                    if front.waits[a] > 3:
                        count[a] += 0.5
                        front.waits[a] = 0
                    else:
                        count[a] += 0.18
                    front.renew(a)
                continue
            a = left
            while a <= right and n < room:
                # where this stroke ends: away from the ends on the lines before
                b = right
                if right - a + 1 > terms.most:
                    best = 1e30
                    for trial in range(6):
                        c = <Py_ssize_t>(_chance(seed, runs * 64 + trial, a + 2) * (terms.most - terms.least))
                        c += a + terms.least
                        c = right - terms.least if c > right - terms.least else c
                        score = 0.0
                        for i in range(c - 5 if c > 5 else 0, (c + 6) if c + 6 < columns else columns):
                            d = (v - cuts[i]) * rate
                            if d < 3.5:
                                score += (6 - (c - i if c > i else i - c)) * (3.5 - d)
                        if score < best:
                            best = score
                            b = c
                # the straight line that fits best where each column is due
                while True:
                    m = b - a + 1
                    middle = 0.5 * (a + b)
                    sx = 0.0
                    sxx = 0.0
                    sy = 0.0
                    sxy = 0.0
                    for c in range(a, b + 1):
                        d = due[c]
                        # a column that is bridged, and due elsewhere, has no say
                        if d > 1e29 or fabs(d - v) * rate > 4.0:
                            m -= 1.0
                            continue
                        sx += c - middle
                        sxx += (c - middle) * (c - middle)
                        sy += d
                        sxy += (c - middle) * d
                    if m < 1.0:
                        row = v
                        slope = 0.0
                    else:
                        d = sxx - sx * sx / m
                        slope = (sxy - sx * sy / m) / d if d > 0.5 else 0.0
                        slope = max(-terms.steepest, min(terms.steepest, slope))
                        row = (sy - slope * sx) / m
                    # it ends where it would be half a spacing off
                    c = a
                    while c <= b:
                        d = due[c]
                        w = row + slope * (c - middle)
                        if d < 1e29 and _apart(phase, c, d, w) > 0.7 and c - a >= terms.shortest:
                            break
                        c += 1
                    if c > b:
                        break
                    b = c - 1
                strokes[n, 0] = middle
                strokes[n, 1] = row
                strokes[n, 2] = slope
                spans[n, 0] = a
                spans[n, 1] = b
                spans[n, 2] = 1 if a > left else 0
                spans[n, 3] = 1 if b < right else 0
                n += 1
                score = 1.0 + terms.drift * (2.0 * _chance(seed, n, 0) - 1.0)
                for c in range(a, b + 1):
                    w = row + slope * (c - middle)
                    error = _phase_at(phase, c, w) - count[c]
                    error = 0.75 if error > 0.75 else (-0.75 if error < -0.75 else error)
                    count[c] += score + terms.memory * error
                    front.waits[c] = 0
                    front.renew(c)
                if b < right:
                    cuts[b] = row
                    v = row + slope * (b + 1 - middle)
                a = b + 1
            # where the lines beyond an end of the run are out of step with these, pull these towards them: else
            # line after line would end at the same place, in a seam
            for side in range(2):
                b = left if side == 0 else right
                c = left - 1 if side == 0 else right + 1
                if c < 0 or c >= columns or due[c] > 1e29 or due[b] > 1e29:
                    continue
                d = due[c] - due[b]
                w = _rate_at(phase, b, due[b])
                error = _rate_at(phase, c, due[c])
                d *= w if w > error else error
                if fabs(d) > 1.5:
                    continue
                d -= floor(d + 0.5)
                for i in range(terms.reach):
                    c = b + i if side == 0 else b - i
                    if c < left or c > right:
                        break
                    w = 1.0 - <double>i / terms.reach
                    count[c] += terms.heal * d * w * w
                    front.renew(c)
    return n


cdef class Laid:
    """The strokes that were laid, and in each column those that cross it, from the first row on.

    strokes: (n, 3) the middle column, the row there, the slope. spans: (n, 5) as of `lay`, and from `find` on where
    each stroke's columns begin in place. begin: (columns + 1,) where each column's list begins in lists. place: for
    each stroke's columns in turn (stroke by stroke), the place in its column's list, counted from the start of lists.
    """

    cdef double[:, ::1] strokes
    cdef long long[:, ::1] spans
    cdef long long[::1] begin, lists, place

    def __init__(
        self, double[:, ::1] strokes, long long[:, ::1] spans, long long[::1] begin, long long[::1] lists,
        long long[::1] place,
    ) -> None:
        self.strokes = strokes
        self.spans = spans
        self.begin = begin
        self.lists = lists
        self.place = place

    def find(self) -> None:
        """Fill the lists."""
        cdef Py_ssize_t i, c, k
        cdef long long s, other
        cdef double v
        cdef Py_ssize_t base = 0
        cdef double[:, ::1] strokes = self.strokes
        cdef long long[:, ::1] spans = self.spans
        cdef long long[::1] begin = self.begin, lists = self.lists, place = self.place
        cdef Py_ssize_t n = strokes.shape[0]
        with nogil:
            for c in range(begin.shape[0]):
                begin[c] = 0
            for i in range(n):
                for c in range(spans[i, 0], spans[i, 1] + 1):
                    begin[c + 1] += 1
            for c in range(begin.shape[0] - 1):
                begin[c + 1] += begin[c]
            # fill from the back of each list, strokes in the order of laying, which is nearly that of rows
            for i in range(n - 1, -1, -1):
                for c in range(spans[i, 0], spans[i, 1] + 1):
                    begin[c + 1] -= 1
                    lists[begin[c + 1]] = i
            # begin[c + 1] now is where column c begins: shift back
            for c in range(begin.shape[0] - 1):
                begin[c] = begin[c + 1]
            begin[begin.shape[0] - 1] = lists.shape[0]
            for c in range(begin.shape[0] - 1):
                for k in range(begin[c] + 1, begin[c + 1]):
                    s = lists[k]
                    v = strokes[s, 1] + strokes[s, 2] * (c - strokes[s, 0])
                    i = k - 1
                    while i >= begin[c]:
                        other = lists[i]
                        if strokes[other, 1] + strokes[other, 2] * (c - strokes[other, 0]) <= v:
                            break
                        lists[i + 1] = other
                        i -= 1
                    lists[i + 1] = s
            # where each stroke stands: its offset into place is that of its first column
            for i in range(n):
                spans[i, 4] = base
                base += spans[i, 1] - spans[i, 0] + 1
            for c in range(begin.shape[0] - 1):
                for k in range(begin[c], begin[c + 1]):
                    s = lists[k]
                    place[spans[s, 4] + c - spans[s, 0]] = k

    def relax(self, double[:, ::1] phase, Py_ssize_t rounds, double steepest) -> None:
        """Move each stroke rigidly to where the phases to both neighbours are equal, a few times over.

        steepest: rows a column.
        """
        cdef Py_ssize_t _, i, c, k
        cdef long long s
        cdef double v, w, x, here, above, below, rate, e, m, sx, sxx, sy, sxy, slope, shift, limit
        cdef double[:, ::1] strokes = self.strokes
        cdef long long[:, ::1] spans = self.spans
        cdef long long[::1] begin = self.begin, lists = self.lists, place = self.place
        cdef Py_ssize_t n = strokes.shape[0]
        with nogil:
            for _ in range(rounds):
                for i in range(n):
                    m = 0.0
                    sx = 0.0
                    sxx = 0.0
                    sy = 0.0
                    sxy = 0.0
                    limit = 1e30
                    for c in range(spans[i, 0], spans[i, 1] + 1):
                        x = c - strokes[i, 0]
                        v = strokes[i, 1] + strokes[i, 2] * x
                        rate = _rate_at(phase, c, v)
                        if rate < 1e-4:
                            continue
                        here = _phase_at(phase, c, v)
                        above = -1.0
                        below = -1.0
                        k = place[spans[i, 4] + c - spans[i, 0]]
                        if k > begin[c]:
                            s = lists[k - 1]
                            w = strokes[s, 1] + strokes[s, 2] * (c - strokes[s, 0])
                            above = here - _phase_at(phase, c, w)
                        if k + 1 < begin[c + 1]:
                            s = lists[k + 1]
                            w = strokes[s, 1] + strokes[s, 2] * (c - strokes[s, 0])
                            below = _phase_at(phase, c, w) - here
                        # a neighbour more than two lines away is no neighbour
                        if k > begin[c] and above < 2.2:
                            e = 0.5 * (below - above) if k + 1 < begin[c + 1] and below < 2.2 else 1.0 - above
                        elif k + 1 < begin[c + 1] and below < 2.2:
                            e = below - 1.0
                        else:
                            continue
                        e /= rate
                        m += 1.0
                        sx += x
                        sxx += x * x
                        sy += e
                        sxy += x * e
                        limit = 0.3 / rate if 0.3 / rate < limit else limit
                    if m < 1.0:
                        continue
                    w = sxx - sx * sx / m
                    slope = (sxy - sx * sy / m) / w if w > 0.5 else 0.0
                    shift = (sy - slope * sx) / m
                    shift = limit if shift > limit else (-limit if shift < -limit else shift)
                    strokes[i, 1] += 0.6 * shift
                    slope = strokes[i, 2] + 0.4 * slope
                    strokes[i, 2] = steepest if slope > steepest else (-steepest if slope < -steepest else slope)
