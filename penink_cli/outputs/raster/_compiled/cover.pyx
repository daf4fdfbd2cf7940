# cython: boundscheck=False, wraparound=False, cdivision=True
"""How much of each pixel strokes cover: 16 × 16 points a pixel, one bit each.

Where strokes overlap their union counts, not their sum. Sums of areas cannot tell the two apart;
bits can. A point is inked if it lies in a stroke. 256 points are as many as 8-bit grey has steps; on
a crosshatch at 150 dpi the low-passed picture differs from one of 64 × 64 points by 0.01 % RMS.

A Bézier segment is cut into straight pieces that leave it by at most 1/50 pixel. The ink of a piece
is a capsule, all that lies within half a pen's width of it; where the width changes, it is the hull
of two discs. Both are convex, so each row of points meets one in a single span: between the two long
sides where the row crosses both, else between the outermost of sides and round ends.
"""

from libc.math cimport fabs, sqrt

cdef double FLAT = 0.02  # pixels that a straight piece may leave its curve by


cdef struct Points:
    # The points of some pixel rows, a bit each: 16 rows of points a pixel row, a word of 16 points a pixel.
    unsigned short* bits
    Py_ssize_t width  # pixels, and words of a row
    double top  # number of the first pixel row
    long long rows  # of points


cdef inline void _span(unsigned short* row, double left, double right, long long most) noexcept nogil:
    """Set the points of a row whose middles lie between left and right, in pixels. most: the row's last point.

    Bit 0 is the leftmost point of a pixel.
    """
    cdef long long low, high, a, b, k
    cdef unsigned int first, final
    left = left * 16.0 - 0.5
    right = right * 16.0 - 0.5
    if right < 0.0 or left > most:
        return
    low = 0
    if left > 0.0:
        low = <long long>left
        if low < left:
            low += 1
    high = most if right >= most else <long long>right
    if low > high:
        return
    a = low >> 4
    b = high >> 4
    first = (0xFFFF << (low & 15)) & 0xFFFF
    final = 0xFFFF >> (15 - (high & 15))
    if a == b:
        row[a] |= first & final
        return
    row[a] |= first
    for k in range(a + 1, b):
        row[k] = 0xFFFF
    row[b] |= final


cdef void _capsule(const Points* band, double ax, double ay, double bx, double by, double r) noexcept nogil:
    """Ink all within r of the line from a to b."""
    cdef unsigned short* bits = band.bits
    cdef Py_ssize_t width = band.width
    cdef double top = band.top
    cdef long long rows = band.rows
    cdef double y, half, left, right, x
    cdef long long end
    cdef double dx = bx - ax
    cdef double dy = by - ay
    cdef double length = sqrt(dx * dx + dy * dy)
    cdef double nx = 0.0, ny = 0.0, slope = 0.0, inner_low = 1.0, inner_high = 0.0
    cdef double low = min(ay, by)
    cdef double high = max(ay, by)
    cdef double from_row = (low - r - top) * 16.0 - 0.5
    cdef double to_row = (high + r - top) * 16.0 - 0.5
    cdef long long j = 0
    cdef long long most = 16 * width - 1
    if to_row < 0.0 or from_row > rows - 1 or max(ax, bx) + r < 0.0 or min(ax, bx) - r > width:
        return
    if from_row > 0.0:
        j = <long long>from_row
    end = rows - 1 if to_row >= rows - 1 else <long long>to_row
    if length > 0.0:
        nx = -dy * r / length
        ny = dx * r / length
        if dy != 0.0:
            slope = dx / dy
            if ny < 0.0:  # so that +n is the side further down
                nx = -nx
                ny = -ny
            inner_low = low + ny
            inner_high = high - ny
    while j <= end:
        y = top + (j + 0.5) / 16.0
        if inner_low <= y <= inner_high:  # the row crosses both long sides
            left = ax + nx + (y - ay - ny) * slope
            right = ax - nx + (y - ay + ny) * slope
            if left > right:
                left, right = right, left
        else:
            left = 1e300
            right = -1e300
            half = r * r - (y - ay) * (y - ay)
            if half >= 0.0:
                half = sqrt(half)
                left = ax - half
                right = ax + half
            half = r * r - (y - by) * (y - by)
            if half >= 0.0:
                half = sqrt(half)
                left = min(left, bx - half)
                right = max(right, bx + half)
            if dy != 0.0:
                if low + ny <= y <= high + ny:
                    x = ax + nx + (y - ay - ny) * slope
                    left = min(left, x)
                    right = max(right, x)
                if low - ny <= y <= high - ny:
                    x = ax - nx + (y - ay + ny) * slope
                    left = min(left, x)
                    right = max(right, x)
        if left <= right:
            _span(bits + j * width, left, right, most)
        j += 1


cdef void _cone(
    const Points* band, double ax, double ay, double bx, double by, double ra, double rb
) noexcept nogil:
    """Ink the hull of two discs: what a disc covers on its way from a to b while its radius goes from ra to rb."""
    cdef double dx = bx - ax
    cdef double dy = by - ay
    cdef double length = sqrt(dx * dx + dy * dy)
    cdef double y, half, left, right, x, lean, across, from_row, to_row
    cdef long long j = 0, end, most = 16 * band.width - 1
    cdef int side
    # the two long sides, from s to e, touch the discs at ra · m and rb · m, m the unit vector at right angles to them
    cdef double[2] sx, sy, ex, ey
    if ra == rb or length <= fabs(ra - rb):
        if length > fabs(ra - rb):
            _capsule(band, ax, ay, bx, by, ra)
        elif ra > rb:  # one disc holds the other
            _capsule(band, ax, ay, ax, ay, ra)
        else:
            _capsule(band, bx, by, bx, by, rb)
        return
    from_row = (min(ay - ra, by - rb) - band.top) * 16.0 - 0.5
    to_row = (max(ay + ra, by + rb) - band.top) * 16.0 - 0.5
    if to_row < 0.0 or from_row > band.rows - 1 or max(ax + ra, bx + rb) < 0.0 or min(ax - ra, bx - rb) > band.width:
        return
    if from_row > 0.0:
        j = <long long>from_row
    end = band.rows - 1 if to_row >= band.rows - 1 else <long long>to_row
    lean = (ra - rb) / length
    across = sqrt(1.0 - lean * lean)
    for side in range(2):
        x = (lean * dx + across * dy) / length
        y = (lean * dy - across * dx) / length
        sx[side] = ax + ra * x
        sy[side] = ay + ra * y
        ex[side] = bx + rb * x
        ey[side] = by + rb * y
        across = -across
    while j <= end:
        y = band.top + (j + 0.5) / 16.0
        left = 1e300
        right = -1e300
        half = ra * ra - (y - ay) * (y - ay)
        if half >= 0.0:
            half = sqrt(half)
            left = ax - half
            right = ax + half
        half = rb * rb - (y - by) * (y - by)
        if half >= 0.0:
            half = sqrt(half)
            left = min(left, bx - half)
            right = max(right, bx + half)
        for side in range(2):
            if sy[side] != ey[side] and min(sy[side], ey[side]) <= y <= max(sy[side], ey[side]):
                x = sx[side] + (y - sy[side]) * ((ex[side] - sx[side]) / (ey[side] - sy[side]))
                left = min(left, x)
                right = max(right, x)
        if left <= right:
            _span(band.bits + j * band.width, left, right, most)
        j += 1


cdef void _segment(const Points* band, const double* p, double r, double end_r) noexcept nogil:
    """Ink one Bézier segment with the control points p[0] … p[7], of radius r at its start and end_r at its end."""
    cdef int k
    cdef double t, s, bx, by, last
    cdef double ux = p[0] - 2.0 * p[2] + p[4]
    cdef double uy = p[1] - 2.0 * p[3] + p[5]
    cdef double vx = p[2] - 2.0 * p[4] + p[6]
    cdef double vy = p[3] - 2.0 * p[5] + p[7]
    cdef double bend = sqrt(max(ux * ux + uy * uy, vx * vx + vy * vy))
    cdef int pieces = 1
    cdef double ax = p[0]
    cdef double ay = p[1]
    # A chord leaves its curve by at most an eighth of the second derivative, 6 · bend / pieces².
    bend = sqrt(0.75 * bend / FLAT)
    if bend > 1.0:
        pieces = 1 + <int>min(bend, 10000.0)
    for k in range(1, pieces + 1):
        t = <double>k / pieces
        s = 1.0 - t
        bx = s * s * s * p[0] + 3.0 * s * s * t * p[2] + 3.0 * s * t * t * p[4] + t * t * t * p[6]
        by = s * s * s * p[1] + 3.0 * s * s * t * p[3] + 3.0 * s * t * t * p[5] + t * t * t * p[7]
        if r == end_r:
            _capsule(band, ax, ay, bx, by, r)
        else:
            last = r + (end_r - r) * (<double>(k - 1) / pieces)
            _cone(band, ax, ay, bx, by, last, r + (end_r - r) * t)
        ax = bx
        ay = by


def band(
    const double[:, ::1] points, const long long[::1] first, const double[::1] radii, const double[::1] knot_radii,
    const int[::1] members, Py_ssize_t top, unsigned short[:, ::1] bits, unsigned long long[::1] counts,
    const unsigned char[::1] greys, unsigned char[:, ::1] out,
) -> None:
    """Draw the strokes `members` into the pixel rows from `top` on.

    points, first: of all strokes, in pixels, see Strokes. radii: half the pens' widths, pixels; knot_radii: half the
    widths at all knots, or empty where no stroke swells. bits (16 · rows, w), w the width rounded up to a multiple of
    4, and counts (w / 4,) are room to work in. greys: (257,) maps the number of a pixel's inked points to the value
    stored in out (rows, width).
    """
    cdef unsigned long long* four
    cdef unsigned long long x
    cdef Py_ssize_t i, j, k, sub, stroke, knot
    cdef double r, end_r
    cdef Py_ssize_t rows = out.shape[0]
    cdef Py_ssize_t width = bits.shape[1]
    cdef Py_ssize_t words = width // 4
    cdef unsigned short* room = &bits[0, 0]
    cdef Points band = Points(room, width, top, 16 * rows)
    cdef unsigned long long* sums = &counts[0]
    cdef unsigned long long ones = 0x5555555555555555, pairs = 0x3333333333333333, fours = 0x0F0F0F0F0F0F0F0F
    with nogil:
        for k in range(16 * rows * width):
            room[k] = 0
        for i in range(members.shape[0]):
            stroke = members[i]
            k = first[stroke]
            if first[stroke + 1] == k + 1:
                _capsule(&band, points[k, 0], points[k, 1], points[k, 0], points[k, 1], radii[stroke])
            knot = (k + 2 * stroke) // 3
            r = end_r = radii[stroke]
            while k + 3 < first[stroke + 1]:
                if knot_radii.shape[0] > 0:
                    r = knot_radii[knot]
                    end_r = knot_radii[knot + 1]
                _segment(&band, &points[k, 0], r, end_r)
                k += 3
                knot += 1
        for j in range(rows):
            # Bits set in each byte of four pixels at a time; 16 rows of up to 8 fit into a byte.
            for k in range(words):
                sums[k] = 0
            for sub in range(16):
                four = <unsigned long long*>(room + (16 * j + sub) * width)
                for k in range(words):
                    x = four[k]
                    x = x - ((x >> 1) & ones)
                    x = (x & pairs) + ((x >> 2) & pairs)
                    sums[k] += (x + (x >> 4)) & fours
            for k in range(out.shape[1]):
                x = sums[k // 4] >> (16 * (k % 4))
                out[j, k] = greys[(x & 255) + ((x >> 8) & 255)]
