# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: what a pixel can reach without crossing an edge, and values fitted to that. See extraction.py.

The pixels that a walk reaches are kept as bits, a row of the window around it in one word, and so are
the steps that are open.
"""

from libc.math cimport floor
from penink_cli.geometry._compiled.flood cimport flood as flow
from penink_cli.ground._compiled.real cimport exponential
from penink_cli.reconstruction._compiled.scene cimport side_of_query, side_of_vertex

MAX_REACH = 24  # steps of a walk along each axis; the window is 2 · 24 + 1 wide, and fits a word


cdef class Ground:
    """What can be walked on: words of 64 columns with an empty one before each row and one or two after it.

    right, down: (h, words) a bit for each pixel centre from which a step leads to the next without crossing
    an edge. clean: (h, words) a bit for each pixel that counts.
    """

    cdef unsigned long long[:, ::1] right
    cdef unsigned long long[:, ::1] down
    cdef unsigned long long[:, ::1] clean
    cdef int height

    def __init__(
        self, unsigned long long[:, ::1] right, unsigned long long[:, ::1] down, unsigned long long[:, ::1] clean
    ) -> None:
        self.right = right
        self.down = down
        self.clean = clean
        self.height = right.shape[0]

    cdef void flood(self, int i, int j, int reach, unsigned long long* seen) noexcept nogil:
        """Spread the bits of `seen`, rows i − reach … of columns j − reach …, over all that they reach there."""
        cdef int r, row
        cdef unsigned long long[49] right, down
        cdef int side = 2 * reach + 1
        cdef int first = max(0, reach - i)
        cdef int last = min(side, self.height - i + reach)
        cdef unsigned long long one = 1
        cdef unsigned long long inside = (one << side) - 1
        for r in range(first, last):
            row = i - reach + r
            right[r] = _bits(&self.right[row, 0], j - reach) & (inside >> 1)
            down[r] = _bits(&self.down[row, 0], j - reach) & inside
        flow(seen, right, down, first, last, side)


cdef inline unsigned long long _bits(unsigned long long* words, int x) noexcept nogil:
    """The 64 bits from column x ≥ −64 on."""
    cdef int at = x + 64
    cdef int k = at >> 6
    cdef int shift = at & 63
    if shift == 0:
        return words[k]
    return (words[k] >> shift) | (words[k + 1] << (64 - shift))


cdef bint _plane(
    float[:, ::1] values, unsigned long long* seen, int i, int j, int reach, double x, double y, double* across,
    double* down, double stiffness, double* out,
) noexcept nogil:
    """Value at (x, y), in pixel centres, of the plane fitted to the pixels of `seen` around (i, j).

    across, down: weights of the window's columns and rows; a pixel's is their product. `stiffness` holds
    the slope back, the more the farther the pixels lie to one side. False where there are no pixels.
    """
    cdef int r, c
    cdef double dx, dy, w, v, r0, r1, r2, v0, v1, det, bx, by
    cdef unsigned long long bits
    cdef float* row
    cdef int side = 2 * reach + 1
    cdef double s = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0, sv = 0, sxv = 0, syv = 0, low = 1e9, high = -1e9
    for r in range(side):
        bits = seen[r]
        if bits == 0:
            continue
        row = &values[i - reach + r, 0]
        r0 = r1 = r2 = v0 = v1 = 0.0
        c = 0
        while bits:
            if bits & 1:
                dx = j - reach + c - x
                v = row[j - reach + c]
                w = across[c]
                r0 += w
                v0 += w * v
                w *= dx
                r1 += w
                v1 += w * v
                r2 += w * dx
                low = min(low, v)
                high = max(high, v)
            bits >>= 1
            c += 1
        dy = i - reach + r - y
        w = down[r]
        s += w * r0
        sx += w * r1
        sxx += w * r2
        sv += w * v0
        sxv += w * v1
        w *= dy
        sy += w * r0
        sxy += w * r1
        syv += w * v0
        syy += w * dy * r0
    if s < 1e-12:
        return False
    sx /= s
    sy /= s
    sv /= s
    sxx = sxx / s - sx * sx + stiffness
    syy = syy / s - sy * sy + stiffness
    sxy = sxy / s - sx * sy
    sxv = sxv / s - sx * sv
    syv = syv / s - sy * sv
    det = sxx * syy - sxy * sxy
    bx = (sxv * syy - syv * sxy) / det
    by = (syv * sxx - sxv * sxy) / det
    v = sv - bx * sx - by * sy
    w = 0.5 * (high - low)
    out[0] = min(high + w, max(low - w, v))
    return True


cdef double _least_contaminated(
    float[:, ::1] values, float[:, ::1] distance, unsigned long long* seen, int i, int j, int reach, double spread
) noexcept nogil:
    """Mean of the pixels of `seen` that lie farthest from edges, the near ones more."""
    cdef int r, c, sweep
    cdef unsigned long long bits
    cdef double w
    cdef double best = 0, s = 0, sv = 0
    for sweep in range(2):
        for r in range(2 * reach + 1):
            bits = seen[r]
            c = 0
            while bits:
                if bits & 1:
                    if sweep == 0:
                        best = max(best, distance[i - reach + r, j - reach + c])
                    else:
                        w = (r - reach) * (r - reach) + (c - reach) * (c - reach)
                        w = -w / (2 * spread * spread) + 6 * (distance[i - reach + r, j - reach + c] - best)
                        w = exponential(w)
                        s += w
                        sv += w * values[i - reach + r, j - reach + c]
                bits >>= 1
                c += 1
    return sv / s if s > 0 else values[i, j]


def extrapolate(
    float[:, ::1] values, Ground ground, float[:, ::1] distance, double margin, Py_ssize_t first_row,
    Py_ssize_t last_row, int steps, double spread, double stiffness, double[::1] table, float[:, ::1] out,
) -> None:
    """Replace the contaminated pixels (distance ≤ margin) of rows first_row … last_row − 1.

    A plane is fitted to the clean pixels within `steps`; where there are none, up to MAX_REACH
    away; and where the region has none at all, the mean of its least contaminated pixels is taken.

    table: (2 · MAX_REACH + 1,) weights by the distance along an axis, its middle standing for none.
    out: (h, w) filled in these rows.
    """
    cdef Py_ssize_t i, j
    cdef int reach, k
    cdef bint done
    cdef double* weights
    cdef unsigned long long[49] seen, clean
    cdef unsigned long long one = 1
    cdef double value = 0
    with nogil:
        for i in range(first_row, last_row):
            for j in range(values.shape[1]):
                if distance[i, j] > margin:
                    out[i, j] = values[i, j]
                    continue
                reach = min(24, steps)
                while True:
                    for k in range(2 * reach + 1):
                        seen[k] = 0
                        clean[k] = 0
                    seen[reach] = one << reach
                    ground.flood(i, j, reach, seen)
                    for k in range(max(0, reach - i), min(2 * reach + 1, values.shape[0] - i + reach)):
                        if seen[k]:
                            clean[k] = seen[k] & _bits(&ground.clean[i - reach + k, 0], j - reach)
                    weights = &table[24 - reach]
                    done = _plane(values, clean, i, j, reach, j, i, weights, weights, stiffness, &value)
                    if done or reach == 24:
                        break
                    reach = min(24, 2 * reach)
                if not done:
                    value = _least_contaminated(values, distance, seen, i, j, reach, spread)
                out[i, j] = value


cdef class Edges:
    """Edges among the pixels of an image, and which of them are near each square of `cell` pixels.

    near: a `geometry.edge_index.EdgeGrid`, pixels.
    """

    cdef double[:, ::1] ends
    cdef double cell
    cdef Py_ssize_t columns
    cdef long long[::1] begin, items

    def __init__(self, near) -> None:
        self.ends = near.ends
        self.cell = near.size
        self.columns = near.columns
        self.begin = near.begin
        self.items = near.items

    cdef bint hides(self, int e, double px, double py, double qx, double qy) noexcept nogil:
        """Whether edge e cuts the segment from p to q, both shifted by (ε, ε²)."""
        cdef double ax = self.ends[e, 0], ay = self.ends[e, 1], bx = self.ends[e, 2], by = self.ends[e, 3]
        if side_of_query(ax, ay, bx, by, px, py) == side_of_query(ax, ay, bx, by, qx, qy):
            return False
        return side_of_vertex(px, py, qx, qy, ax, ay) != side_of_vertex(px, py, qx, qy, bx, by)

    cdef bint hide(self, double px, double py, double qx, double qy) noexcept nogil:
        """Whether any edge cuts the segment from p to q."""
        cdef Py_ssize_t i, j, k
        for i in range(<Py_ssize_t>(min(py, qy) / self.cell), <Py_ssize_t>(max(py, qy) / self.cell) + 1):
            for j in range(<Py_ssize_t>(min(px, qx) / self.cell), <Py_ssize_t>(max(px, qx) / self.cell) + 1):
                for k in range(self.begin[i * self.columns + j], self.begin[i * self.columns + j + 1]):
                    if self.hides(<int>self.items[k], px, py, qx, qy):
                        return True
        return False


def resample(
    float[:, ::1] values, Ground ground, Edges edges, Py_ssize_t first_row, Py_ssize_t last_row, int steps,
    double spread, double stiffness, float[:, ::1] near, double[:, ::1] out,
) -> None:
    """Fill new samples of some rows, those with a finite `near`, each from the pixels that its place reaches.

    spread, stiffness: as of `_plane`, the weights being a Gaussian.
    """
    cdef Py_ssize_t i, j, k
    cdef int pi, pj, di, dj
    cdef double x, y, px, py, d
    cdef bint any_visible
    cdef unsigned long long[49] seen
    cdef double[49] across, down
    cdef Py_ssize_t height = values.shape[0]
    cdef Py_ssize_t width = values.shape[1]
    cdef double value = 0
    cdef unsigned long long one = 1
    with nogil:
        for i in range(first_row, last_row):
            for j in range(out.shape[1]):
                if near[i, j] > 1e9:
                    continue
                x = (j + 0.5) * width / out.shape[1]
                y = (i + 0.5) * height / out.shape[0]
                pi = <int>floor(y - 0.5)
                pj = <int>floor(x - 0.5)
                any_visible = False
                for k in range(2 * steps + 1):
                    seen[k] = 0
                for di in range(2):
                    for dj in range(2):
                        if not (0 <= pi + di < height and 0 <= pj + dj < width):
                            continue
                        px = pj + dj + 0.5
                        py = pi + di + 0.5
                        if not edges.hide(x, y, px, py):
                            seen[steps + di] |= one << (steps + dj)
                            any_visible = True
                if not any_visible:
                    out[i, j] = values[min(height - 1, <Py_ssize_t>y), min(width - 1, <Py_ssize_t>x)]
                    continue
                ground.flood(pi, pj, steps, seen)
                for k in range(2 * steps + 1):
                    d = pj - steps + k - (x - 0.5)
                    across[k] = exponential(-d * d / (2 * spread * spread))
                    d = pi - steps + k - (y - 0.5)
                    down[k] = exponential(-d * d / (2 * spread * spread))
                _plane(values, seen, pi, pj, steps, x - 0.5, y - 0.5, across, down, stiffness, &value)
                out[i, j] = value
