# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled loop: cubic Bézier segments through runs of points. Only `curve_fitting` imports this module.

    1 · · · · 2      `segment`: 0 and 3 are the first and the last point. The points there tell the directions to 1 and
    ·  ╭───╮  ·      from 2: only how far off 1 and 2 are is fitted. A run that no cubic fits is split at its worst
    · ╱  ×  ╲ ·      point ×, and both parts have one direction there.
    0         3

           1                    `over_chord`: 1 and 2 stand over the thirds of the chord from 0 to 3, p and q to the
         p ┆    2               left of it. So the curve is the graph of a polynomial over its chord, and two numbers
    0 ─────┴────┴ q ──── 3      tell all of it.

Arrays are (n, 2) x, y in the same unit, whatever it is; parameters run 0 … 1 along a segment.
"""

from libc.math cimport fabs, sqrt
from libc.stdlib cimport free
from penink_cli.ground._compiled.memory cimport room

cdef int _ROUNDS = 4  # of moving points along the curve before it is given up and split
cdef double _WORTH = 16.0  # squared error, in squared tolerances, from which those rounds are not tried
cdef Py_ssize_t _REACH = 4  # points to each side that tell a direction

# Points first … last; unit vectors in which the curve leaves the one and those from which it comes to the other.
cdef struct Piece:
    Py_ssize_t first, last
    double leaving_x, leaving_y, arriving_x, arriving_y


def fit(const double[:, ::1] points, double tolerance, bint ring, double[:, ::1] control) -> int:
    """Fill in control (3 n - 2, 2) of the segments through points (n, 2), n > 1: how many of its rows are used."""
    cdef Py_ssize_t n = points.shape[0], used = 1, waiting = 1, worst
    cdef Piece one, other
    cdef double* t = NULL
    cdef Piece* stack = NULL
    try:
        t = <double*>room(n, sizeof(double))
        stack = <Piece*>room(n + 1, sizeof(Piece))
        with nogil:
            one.first, one.last = 0, n - 1
            if ring and n > 2 * _REACH:
                direction(points, n - _REACH, 0, _REACH - 1, &one.leaving_x, &one.leaving_y)
                one.arriving_x, one.arriving_y = -one.leaving_x, -one.leaving_y
            else:
                worst = min(_REACH, n - 1)
                direction(points, 0, (worst + 1) // 2, worst, &one.leaving_x, &one.leaving_y)
                direction(points, n - 1, n - 1 - (worst + 1) // 2, n - 1 - worst, &one.arriving_x, &one.arriving_y)
            stack[0] = one
            control[0, 0], control[0, 1] = points[0, 0], points[0, 1]
            while waiting:
                waiting -= 1
                one = stack[waiting]
                worst = segment(points, &one, tolerance, t, &control[used - 1, 0])
                if worst < 0:
                    used += 3
                    continue
                other = one
                one.last = other.first = worst
                direction_at(points, &other, &one)
                stack[waiting], stack[waiting + 1] = other, one
                waiting += 2
        return used
    finally:
        free(t)
        free(stack)


cdef void direction_at(const double[:, ::1] points, Piece* after, Piece* before) noexcept nogil:
    """The direction of the curve where two pieces meet: of the points around, those of both pieces."""
    cdef Py_ssize_t first = max(before.first, after.first - _REACH)
    cdef Py_ssize_t last = min(after.last, after.first + _REACH)
    direction(points, first, first + (last - first + 1) // 2, last, &after.leaving_x, &after.leaving_y)
    before.arriving_x, before.arriving_y = -after.leaving_x, -after.leaving_y


cdef void direction(
    const double[:, ::1] points, Py_ssize_t first, Py_ssize_t middle, Py_ssize_t last, double* x, double* y
) noexcept nogil:
    """Unit vector from the first towards the last of three points; where these are one, towards the middle one."""
    cdef double dx = points[last, 0] - points[first, 0], dy = points[last, 1] - points[first, 1]
    cdef double length = sqrt(dx * dx + dy * dy)
    if length == 0:
        dx, dy = points[middle, 0] - points[first, 0], points[middle, 1] - points[first, 1]
        length = sqrt(dx * dx + dy * dy)
        if length == 0:
            length = 1.0
    x[0], y[0] = dx / length, dy / length


cdef Py_ssize_t segment(
    const double[:, ::1] points, Piece* piece, double tolerance, double* t, double* c
) noexcept nogil:
    """One cubic's control points (4, 2) in c, and the worst point, to split it at, or -1 where it serves."""
    cdef Py_ssize_t k, worst, first = piece.first, last = piece.last
    cdef int attempt
    cdef double x, y, path, error, most
    cdef double limit = tolerance * tolerance
    t[first] = 0.0
    for k in range(first, last):
        x, y = points[k + 1, 0] - points[k, 0], points[k + 1, 1] - points[k, 1]
        t[k + 1] = t[k] + sqrt(x * x + y * y)
    path = t[last]
    if last - first == 1 or path == 0:
        x, y = points[last, 0] - points[first, 0], points[last, 1] - points[first, 1]
        c[2], c[3] = points[first, 0] + x / 3, points[first, 1] + y / 3
        c[4], c[5] = points[last, 0] - x / 3, points[last, 1] - y / 3
        c[6], c[7] = points[last, 0], points[last, 1]
        return -1
    for k in range(first, last + 1):
        t[k] /= path
    for attempt in range(_ROUNDS + 1):
        least_squares(points, piece, t, path, c)
        most = -1.0
        worst = first
        for k in range(first, last + 1):
            at(c, t[k], &x, &y)
            x -= points[k, 0]
            y -= points[k, 1]
            error = x * x + y * y
            if error > most:
                most, worst = error, k
        if most <= limit:
            return -1
        if most > _WORTH * limit or attempt == _ROUNDS:
            break
        nearer(points, first, last, c, t)
    return min(max(worst, first + 1), last - 1)


cdef void least_squares(const double[:, ::1] points, Piece* piece, double* t, double path, double* c) noexcept nogil:
    """The cubic with these ends and end directions whose handles fit the points best at parameters t."""
    cdef Py_ssize_t k, first = piece.first, last = piece.last
    cdef double s, b0, b1, b2, b3, x, y
    cdef double c00 = 0.0, c01 = 0.0, c11 = 0.0, x0 = 0.0, x1 = 0.0
    cdef double chord_x = points[last, 0] - points[first, 0], chord_y = points[last, 1] - points[first, 1]
    cdef double length = sqrt(chord_x * chord_x + chord_y * chord_y)
    cdef double along = max(length, 1e-12)
    cdef double one, other, determinant
    for k in range(first, last + 1):
        s = 1 - t[k]
        b0 = s * s * s
        b1 = 3 * s * s * t[k]
        b2 = 3 * s * t[k] * t[k]
        b3 = t[k] * t[k] * t[k]
        x = points[k, 0] - (b0 + b1) * points[first, 0] - (b2 + b3) * points[last, 0]
        y = points[k, 1] - (b0 + b1) * points[first, 1] - (b2 + b3) * points[last, 1]
        c00 += b1 * b1
        c01 += b1 * b2
        c11 += b2 * b2
        x0 += b1 * (x * piece.leaving_x + y * piece.leaving_y)
        x1 += b2 * (x * piece.arriving_x + y * piece.arriving_y)
    c01 *= piece.leaving_x * piece.arriving_x + piece.leaving_y * piece.arriving_y
    determinant = c00 * c11 - c01 * c01
    one = other = -1.0
    if determinant > 1e-12 * c00 * c11:
        one, other = (x0 * c11 - x1 * c01) / determinant, (c00 * x1 - c01 * x0) / determinant
    if not (1e-3 * along < one < path and 1e-3 * along < other < path):  # a loop, or handles turned round
        one = other = length / 3
    c[0], c[1] = points[first, 0], points[first, 1]
    c[2], c[3] = points[first, 0] + piece.leaving_x * one, points[first, 1] + piece.leaving_y * one
    c[4], c[5] = points[last, 0] + piece.arriving_x * other, points[last, 1] + piece.arriving_y * other
    c[6], c[7] = points[last, 0], points[last, 1]


cdef inline void at(double* c, double t, double* x, double* y) noexcept nogil:
    """The cubic's point at t."""
    cdef double s = 1 - t
    cdef double b0 = s * s * s, b1 = 3 * s * s * t, b2 = 3 * s * t * t, b3 = t * t * t
    x[0] = b0 * c[0] + b1 * c[2] + b2 * c[4] + b3 * c[6]
    y[0] = b0 * c[1] + b1 * c[3] + b2 * c[5] + b3 * c[7]


cdef void nearer(
    const double[:, ::1] points, Py_ssize_t first, Py_ssize_t last, double* c, double* t
) noexcept nogil:
    """Move parameters one step of Newton's nearer to those of the curve's points nearest to the given ones."""
    cdef Py_ssize_t k
    cdef int axis
    cdef double s, moved, slope, product, d0, d1, d2, off, rise, bend, x, y
    cdef double highest = 0.0
    for k in range(first, last + 1):
        s = 1 - t[k]
        at(c, t[k], &x, &y)
        slope = product = 0.0
        for axis in range(2):
            off = (y if axis else x) - points[k, axis]
            d0, d1, d2 = c[2 + axis] - c[axis], c[4 + axis] - c[2 + axis], c[6 + axis] - c[4 + axis]
            rise = 3 * (s * s * d0 + 2 * s * t[k] * d1 + t[k] * t[k] * d2)
            bend = 6 * (s * (d1 - d0) + t[k] * (d2 - d1))
            slope += rise * rise + off * bend
            product += off * rise
        moved = t[k] - (product / slope if fabs(slope) > 1e-12 else 0.0)
        highest = max(highest, min(1.0, max(0.0, moved)))
        t[k] = highest


cdef bint over_chord(
    const double[:, ::1] points, Py_ssize_t first, Py_ssize_t last, double tolerance, double* p, double* q
) noexcept nogil:
    """Whether a cubic over the chord of points first … last passes all of them within tolerance.

    Its control points are at a third and two thirds of the chord, so far (p, q) to the left of it: the curve is the
    graph of a polynomial, and how far a point is off is looked at across the chord.
    """
    cdef Py_ssize_t k
    cdef double dx = points[last, 0] - points[first, 0], dy = points[last, 1] - points[first, 1]
    cdef double length = sqrt(dx * dx + dy * dy)
    cdef double along, aside, b1, b2, x, y, determinant
    cdef double before = 0.0, c11 = 0.0, c12 = 0.0, c22 = 0.0, y1 = 0.0, y2 = 0.0
    p[0] = q[0] = 0.0
    if last - first < 2:
        return True
    if length < 1e-6:
        return False
    for k in range(first + 1, last):
        x, y = points[k, 0] - points[first, 0], points[k, 1] - points[first, 1]
        along, aside = (x * dx + y * dy) / (length * length), (y * dx - x * dy) / length
        if along <= before or along >= 1.0:
            return False
        before = along
        b1, b2 = 3 * (1 - along) * (1 - along) * along, 3 * (1 - along) * along * along
        c11 += b1 * b1
        c12 += b1 * b2
        c22 += b2 * b2
        y1 += b1 * aside
        y2 += b2 * aside
    determinant = c11 * c22 - c12 * c12
    if last - first > 2 and determinant > 1e-9 * c11 * c22:
        p[0], q[0] = (y1 * c22 - y2 * c12) / determinant, (c11 * y2 - c12 * y1) / determinant
    else:
        p[0] = q[0] = (y1 + y2) / (c11 + 2 * c12 + c22)
    # no steeper than half a right angle at the ends
    if max(fabs(p[0]), fabs(q[0])) > length / 3:
        return False
    for k in range(first + 1, last):
        x, y = points[k, 0] - points[first, 0], points[k, 1] - points[first, 1]
        along, aside = (x * dx + y * dy) / (length * length), (y * dx - x * dy) / length
        b1, b2 = 3 * (1 - along) * (1 - along) * along, 3 * (1 - along) * along * along
        if fabs(b1 * p[0] + b2 * q[0] - aside) > tolerance:
            return False
    return True


def over_chords(
    const double[:, ::1] points, const long long[::1] first, double tolerance, double[:, ::1] control,
    long long[::1] count,
):
    """Runs of points (n, 2), where each begins in first, as few cubics over chords (see `over_chord`).

    control: (3 n, 2), one after the other; count: (runs,) of its rows that each run fills.
    """
    cdef Py_ssize_t i, a, b, last, low, high, used = 0
    cdef double p, q, dx, dy, length
    with nogil:
        for i in range(first.shape[0] - 1):
            a, last = first[i], first[i + 1] - 1
            count[i] = -used
            control[used, 0], control[used, 1] = points[a, 0], points[a, 1]
            used += 1
            while a < last:
                # as far as one serves, by halves: what serves so far mostly serves up to there
                low, high, b = a + 1, last, last
                while low < high:
                    if over_chord(points, a, b, tolerance, &p, &q):
                        low = b
                    else:
                        high = b - 1
                    b = (low + high + 1) // 2
                over_chord(points, a, low, tolerance, &p, &q)
                dx, dy = points[low, 0] - points[a, 0], points[low, 1] - points[a, 1]
                length = max(sqrt(dx * dx + dy * dy), 1e-12)
                control[used, 0] = points[a, 0] + dx / 3 - p * dy / length
                control[used, 1] = points[a, 1] + dy / 3 + p * dx / length
                control[used + 1, 0] = points[low, 0] - dx / 3 - q * dy / length
                control[used + 1, 1] = points[low, 1] - dy / 3 + q * dx / length
                control[used + 2, 0], control[used + 2, 1] = points[low, 0], points[low, 1]
                used += 3
                a = low
            count[i] += used
