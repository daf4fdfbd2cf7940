# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled loops of the phase field: what is predicted from node to node, and sweeps that bring all nodes to agree.

A node holds a unit complex number ψ, the phase of the lines there. The normal of a line has two ends, so a neighbour
whose normal points the other way holds the conjugate. Each node keeps what is predicted towards its right and its
lower neighbour in six numbers: w cos ω, w sin ω and ±1, w the weight of the link, ω the change of phase along it and
the sign that of the normals' product; ψ of the node is then T(ψ of the neighbour) e^{-iω}, T conjugating if need be.

Rows of arrays are the sheet's from `low` on. Angles are in turns. Only `phase` imports this module.
"""

from libc.math cimport fabsf, floorf, sqrtf


cdef inline void _turned(float turns, float *c, float *s) noexcept nogil:
    """Cosine and sine of an angle, by a polynomial on an eighth of a turn: the same on every machine."""
    cdef float y = <float>4.0 * (turns - floorf(turns + <float>0.5))
    cdef float q = floorf(y + <float>0.5)
    cdef float z = (y - q) * <float>1.5707963267948966
    cdef float z2 = z * z
    cdef float tail = <float>-0.16666667 + z2 * (<float>0.008333333 - z2 * <float>0.00019841270)
    cdef float sine = z * (<float>1.0 + z2 * tail)
    cdef float cosine = <float>1.0 + z2 * (<float>-0.5 + z2 * (<float>0.041666667 + z2 * (
        <float>-0.0013888889 + z2 * <float>0.000024801587)))
    cdef int k = (<int>q) & 3
    if k == 0:
        c[0] = cosine
        s[0] = sine
    elif k == 1:
        c[0] = -sine
        s[0] = cosine
    elif k == 2:
        c[0] = -cosine
        s[0] = -sine
    else:
        c[0] = sine
        s[0] = -cosine


cdef inline float _turns(float c, float s) noexcept nogil:
    """The angle, in turns from -1/2 to 1/2, of a vector that is not nought (Abramowitz and Stegun 4.4.49)."""
    cdef float a = fabsf(c)
    cdef float b = fabsf(s)
    cdef float x = b / a if a > b else a / b
    cdef float x2 = x * x
    cdef float angle = <float>0.15915494309189535 * x * (<float>0.9998660 + x2 * (<float>-0.3302995 + x2 * (
        <float>0.1801410 + x2 * (<float>-0.0851330 + x2 * <float>0.0208351))))
    if b >= a:
        angle = <float>0.25 - angle
    if c < <float>0.0:
        angle = <float>0.5 - angle
    return -angle if s < <float>0.0 else angle


cdef inline float _chance(unsigned long long seed, unsigned long long a) noexcept nogil:
    """A number in [0, 1) that depends on the two integers alone (splitmix64)."""
    cdef unsigned long long z = (
        seed * <unsigned long long>0x9E3779B97F4A7C15 + a * <unsigned long long>0xD1B54A32D192ED03 + 1
    )
    z = (z ^ (z >> 30)) * <unsigned long long>0xBF58476D1CE4E5B9
    z = (z ^ (z >> 27)) * <unsigned long long>0x94D049BB133111EB
    return <float>((z ^ (z >> 31)) >> 40) * <float>5.9604644775390625e-08


def links(
    const float[:, ::1] nx, const float[:, ::1] ny, const float[:, ::1] density, const unsigned char[:, ::1] weak,
    float dx, float dy, float leak, float least, float along, Py_ssize_t low, float[:, :, ::1] out,
):
    """What is predicted from each node of a band to its right and its lower neighbour.

    nx, ny: the unit normal of the lines at every node; density: lines a point; dx, dy: points between nodes.
    weak: bit 0 where an edge crosses the link to the right, bit 1 the one downwards; such a link weighs `leak` as much.
    least: what a link between normals at right angles weighs. along: how much more one along the lines weighs.
    """
    cdef Py_ssize_t rows = density.shape[0]
    cdef Py_ssize_t columns = density.shape[1]
    cdef Py_ssize_t i, j, r, k, q
    cdef float d, g, a, b, w, c, s, h
    with nogil:
        for r in range(out.shape[0]):
            j = low + r
            for i in range(columns):
                for k in range(2):
                    if (i + 1 >= columns) if k == 0 else (j + 1 >= rows):
                        out[r, i, 3 * k] = 0.0
                        out[r, i, 3 * k + 1] = 0.0
                        out[r, i, 3 * k + 2] = 1.0
                        continue
                    q = j + k
                    d = nx[j, i] * nx[q, i + 1 - k] + ny[j, i] * ny[q, i + 1 - k]
                    g = <float>-1.0 if d < 0.0 else <float>1.0
                    a = ny[j, i] if k else nx[j, i]
                    b = g * (ny[q, i + 1 - k] if k else nx[q, i + 1 - k])
                    h = dy if k else dx
                    w = (least + (<float>1.0 - least) * fabsf(d)) * (
                        <float>1.0 + along * (<float>1.0 - <float>0.25 * (a + b) * (a + b)))
                    if weak[j, i] & (1 << k):
                        w = w * leak
                    _turned(<float>0.5 * h * (density[j, i] * a + density[q, i + 1 - k] * b), &c, &s)
                    out[r, i, 3 * k] = w * c
                    out[r, i, 3 * k + 1] = w * s
                    out[r, i, 3 * k + 2] = g


def coarsen(const float[:, :, ::1] fine, Py_ssize_t low, float[:, :, ::1] coarse):
    """Links between every second node, each two fine ones in a row; low, even: the first of the fine rows.

    Fills the rows of coarse whose two fine rows are both there, and the last one. The sum of two angles is exact, as a
    product of complex numbers; of two weights the lesser counts.
    """
    cdef Py_ssize_t columns = fine.shape[1]
    cdef Py_ssize_t r, i, j, k, p, q
    cdef float c1, s1, g1, c2, s2, w1, w2, w
    with nogil:
        for r in range(0, fine.shape[0], 2):
            j = (low + r) >> 1
            for i in range(coarse.shape[1]):
                for k in range(2):
                    coarse[j, i, 3 * k] = 0.0
                    coarse[j, i, 3 * k + 1] = 0.0
                    coarse[j, i, 3 * k + 2] = 1.0
                    p = r + k
                    q = 2 * i + 1 - k
                    if p >= fine.shape[0] or q >= columns:
                        continue
                    c1 = fine[r, 2 * i, 3 * k]
                    s1 = fine[r, 2 * i, 3 * k + 1]
                    g1 = fine[r, 2 * i, 3 * k + 2]
                    c2 = fine[p, q, 3 * k]
                    s2 = g1 * fine[p, q, 3 * k + 1]
                    w1 = sqrtf(c1 * c1 + s1 * s1)
                    w2 = sqrtf(c2 * c2 + s2 * s2)
                    if w1 <= 0.0 or w2 <= 0.0:
                        continue
                    w = <float>1.0 / (w1 if w1 > w2 else w2)  # the lesser weight, as both are in the product
                    coarse[j, i, 3 * k] = w * (c1 * c2 - s1 * s2)
                    coarse[j, i, 3 * k + 1] = w * (c1 * s2 + s1 * c2)
                    coarse[j, i, 3 * k + 2] = g1 * fine[p, q, 3 * k + 2]


cdef inline void _agree(
    const float *link, float *psi, Py_ssize_t columns, Py_ssize_t rows, Py_ssize_t r, Py_ssize_t i
) noexcept nogil:
    """Set node i of row r to what its neighbours say of it, unless they contradict each other wholly."""
    cdef Py_ssize_t p = r * columns + i
    cdef const float *l = link + 6 * p
    cdef float *z = psi + 2 * p
    cdef float x, y, m, n
    x = 0.0
    y = 0.0
    if i + 1 < columns:
        m = l[2] * z[3]
        x = l[0] * z[2] + l[1] * m
        y = l[0] * m - l[1] * z[2]
    if r + 1 < rows:
        n = z[2 * columns]
        m = l[5] * z[2 * columns + 1]
        x = x + (l[3] * n + l[4] * m)
        y = y + (l[3] * m - l[4] * n)
    if i > 0:
        x = x + (l[-6] * z[-2] - l[-5] * z[-1])
        y = y + l[-4] * (l[-6] * z[-1] + l[-5] * z[-2])
    if r > 0:
        l = l - 6 * columns
        n = z[-2 * columns]
        m = z[1 - 2 * columns]
        x = x + (l[3] * n - l[4] * m)
        y = y + l[5] * (l[3] * m + l[4] * n)
    n = x * x + y * y
    if n > <float>1e-12:
        n = <float>1.0 / sqrtf(n)
        z[0] = x * n
        z[1] = y * n


def relax(
    const float[:, :, ::1] links, const float[:, :, ::1] coarse, Py_ssize_t low, unsigned long long seed,
    Py_ssize_t sweeps, float[:, :, ::1] psi,
):
    """Fill the nodes of a band from the coarser level, then let each agree with its neighbours, red and black in turn.

    links, psi: (rows of the band, columns, …); low, even: its first row on the sheet. coarse: the coarser level's ψ,
    all rows, or none at the coarsest level, where chance begins. Rows near a border of the band that is not the sheet's
    are wrong up to 2 sweeps + 2 rows off.
    """
    cdef Py_ssize_t rows = psi.shape[0]
    cdef Py_ssize_t columns = psi.shape[1]
    cdef Py_ssize_t r, i, colour, turn
    cdef float *z = &psi[0, 0, 0]
    cdef const float *l = &links[0, 0, 0]
    with nogil:
        for r in range(rows):
            for i in range(columns):
                psi[r, i, 0] = 0.0
                psi[r, i, 1] = 0.0
        if coarse.shape[0] > 0:
            for r in range(0, rows, 2):
                for i in range(0, columns, 2):
                    psi[r, i, 0] = coarse[(low + r) >> 1, i >> 1, 0]
                    psi[r, i, 1] = coarse[(low + r) >> 1, i >> 1, 1]
            # nodes with two neighbours that are known, then those between four
            for turn in range(2):
                for r in range(rows):
                    for i in range(columns):
                        if (r & 1) + (i & 1) == turn + 1:
                            _agree(l, z, columns, rows, r, i)
        for r in range(rows):
            for i in range(columns):
                if psi[r, i, 0] * psi[r, i, 0] + psi[r, i, 1] * psi[r, i, 1] < <float>0.25:
                    _turned(_chance(seed, (low + r) * columns + i), &psi[r, i, 0], &psi[r, i, 1])
        for _ in range(sweeps):
            for colour in range(2):
                for r in range(rows):
                    for i in range((r + colour) & 1, columns, 2):
                        _agree(l, z, columns, rows, r, i)


def turns(const float[:, :, ::1] psi, float[:, ::1] out):
    """The phase of each node, in turns."""
    cdef Py_ssize_t r, i
    with nogil:
        for r in range(psi.shape[0]):
            for i in range(psi.shape[1]):
                out[r, i] = _turns(psi[r, i, 0], psi[r, i, 1])


def weaken(const double[:, ::1] segments, unsigned char[:, ::1] weak):
    """Mark the links that segments (m, 4), in nodes, cross: bit 0 to the right of a node, bit 1 below it."""
    cdef Py_ssize_t rows = weak.shape[0]
    cdef Py_ssize_t columns = weak.shape[1]
    cdef Py_ssize_t k, i, j, low, high
    cdef double x0, y0, x1, y1, a, b, t
    with nogil:
        for k in range(segments.shape[0]):
            x0 = segments[k, 0]
            y0 = segments[k, 1]
            x1 = segments[k, 2]
            y1 = segments[k, 3]
            # rows that it passes: where it meets each is between two nodes
            a = y0 if y0 < y1 else y1
            b = y1 if y0 < y1 else y0
            if b > a and b >= 0.0 and a < rows:
                low = <Py_ssize_t>a + 1 if a >= 0.0 else 0
                high = <Py_ssize_t>b if b < rows else rows - 1
                for j in range(low, high + 1):
                    t = x0 + (x1 - x0) * ((j - y0) / (y1 - y0))
                    if 0.0 <= t < columns:
                        weak[j, <Py_ssize_t>t] |= 1
            a = x0 if x0 < x1 else x1
            b = x1 if x0 < x1 else x0
            if b > a and b >= 0.0 and a < columns:
                low = <Py_ssize_t>a + 1 if a >= 0.0 else 0
                high = <Py_ssize_t>b if b < columns else columns - 1
                for i in range(low, high + 1):
                    t = y0 + (y1 - y0) * ((i - x0) / (x1 - x0))
                    if 0.0 <= t < rows:
                        weak[<Py_ssize_t>t, i] |= 2
