# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled loops of the phase field: what is predicted from node to node, and sweeps that bring all nodes to agree.

A node holds a unit complex number ψ, the phase of the lines there. The normal of a line has two ends, so a neighbour
whose normal points the other way holds the conjugate. Each node keeps what is predicted towards its right and its
lower neighbour in six numbers: w cos ω, w sin ω and ±1, w the weight of the link, ω the change of phase along it and
the sign that of the normals' product; ψ of the node is then T(ψ of the neighbour) e^{-iω}, T conjugating if need be.

Nodes are red and black, as on a chessboard. Those of one colour have neighbours of the other alone, so all of them can
be set at once; in memory they lie side by side. Each row is kept in two parts, that of the even columns and that of the
odd ones, which are `wide(columns)` numbers with one of nought before and after:

    columns  0  1  2  3  4        even  . 0 2 4 .
                                  odd   . 1 3 . .

`links` are (rows, 12, wide): six planes of the even part, six of the odd. ψ is (rows, 4, wide): x and y of the even
part, x and y of the odd. Rows of arrays are the sheet's from `low` on. Angles are in turns. Only `phase` imports this.
"""

from libc.math cimport floorf, sqrtf
from libc.string cimport memcpy, memset

cdef extern from "phase.h" nogil:
    int best_lanes()
    int lanes
    void agree(
        float* x, float* y, const float* own, const float* beside, const float* above, const float* right,
        const float* left, const float* down, const float* up, long apart, long n
    )
    void predict(
        const float* nx, const float* ny, const float* density, const float* nx_there, const float* ny_there,
        const float* density_there, const float* along_here, const float* along_there, const unsigned char* weak,
        int bit, float h, float leak, float least, float along, float* cosine, float* sine, float* sign, long n
    )
    void angles(const float* x, const float* y, float* out, long n)


def take_lanes(int wanted) -> int:
    """Take the make for vectors of so many bytes, 16 or 32, or what this processor has: the same numbers by both."""
    global lanes
    lanes = min(wanted, best_lanes())
    return lanes


take_lanes(32)


def wide(Py_ssize_t columns) -> int:
    """How many numbers a part of a row has room for."""
    return (columns + 1) // 2 + 2


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
    float dx, float dy, float leak, float least, float along, Py_ssize_t low, float[:, ::1] row, float[:, :, ::1] out,
):
    """What is predicted from each node of a band to its right and its lower neighbour.

    nx, ny: the unit normal of the lines at every node; density: lines a point; dx, dy: points between nodes.
    weak: bit 0 where an edge crosses the link to the right, bit 1 the one downwards; such a link weighs `leak` as much.
    least: what a link between normals at right angles weighs. along: how much more one along the lines weighs.
    row: (3, columns), room.
    """
    cdef Py_ssize_t rows = density.shape[0]
    cdef Py_ssize_t columns = density.shape[1]
    cdef Py_ssize_t j, r, k, q, i, n
    cdef float none
    with nogil:
        for r in range(out.shape[0]):
            j = low + r
            memset(&out[r, 0, 0], 0, sizeof(float) * out.shape[1] * out.shape[2])
            for k in range(2):
                n = columns if k else columns - 1
                if k and j + 1 >= rows:
                    n = 0
                q = j + 1 if k else j
                i = 0 if k else 1
                if n:
                    predict(
                        &nx[j, 0], &ny[j, 0], &density[j, 0], &nx[q, i], &ny[q, i], &density[q, i],
                        &ny[j, 0] if k else &nx[j, 0], &ny[q, i] if k else &nx[q, i], &weak[j, 0], 1 << k,
                        dy if k else dx, leak, least, along, &row[0, 0], &row[1, 0], &row[2, 0], n,
                    )
                for q in range(3):
                    none = 1.0 if q == 2 else 0.0
                    for i in range(n, columns):
                        row[q, i] = none
                    for i in range((columns + 1) // 2):
                        out[r, 3 * k + q, i + 1] = row[q, 2 * i]
                    for i in range(columns // 2):
                        out[r, 6 + 3 * k + q, i + 1] = row[q, 2 * i + 1]


def coarsen(const float[:, :, ::1] fine, Py_ssize_t low, Py_ssize_t columns, float[:, :, ::1] coarse):
    """Links between every second node, each two fine ones in a row; low, even: the first of the fine rows.

    columns: of the coarse nodes. Fills the rows of coarse whose two fine rows are both there, and the last one. The sum
    of two angles is exact, as a product of complex numbers; of two weights the lesser counts.
    """
    cdef Py_ssize_t r, i, j, k, p, q, to
    cdef float c1, s1, g1, c2, s2, w1, w2, w
    with nogil:
        for r in range(0, fine.shape[0], 2):
            j = (low + r) >> 1
            memset(&coarse[j, 0, 0], 0, sizeof(float) * coarse.shape[1] * coarse.shape[2])
            for i in range(columns):
                for k in range(2):
                    to = 6 * (i & 1) + 3 * k
                    coarse[j, to + 2, (i >> 1) + 1] = 1.0
                    p = r + k
                    q = 3 * k if k else 6  # the lower neighbour's link downwards, or the right one's to the right
                    if p >= fine.shape[0]:
                        continue
                    c1 = fine[r, 3 * k, i + 1]
                    s1 = fine[r, 3 * k + 1, i + 1]
                    g1 = fine[r, 3 * k + 2, i + 1]
                    c2 = fine[p, q, i + 1]
                    s2 = g1 * fine[p, q + 1, i + 1]
                    w1 = sqrtf(c1 * c1 + s1 * s1)
                    w2 = sqrtf(c2 * c2 + s2 * s2)
                    if w1 <= 0.0 or w2 <= 0.0:
                        continue
                    w = <float>1.0 / (w1 if w1 > w2 else w2)  # the lesser weight, as both are in the product
                    coarse[j, to, (i >> 1) + 1] = w * (c1 * c2 - s1 * s2)
                    coarse[j, to + 1, (i >> 1) + 1] = w * (c1 * s2 + s1 * c2)
                    coarse[j, to + 2, (i >> 1) + 1] = g1 * fine[p, q + 2, i + 1]


cdef void _settle(
    const float* links, const float* nothing, float* psi, Py_ssize_t columns, Py_ssize_t apart, Py_ssize_t r,
    Py_ssize_t p
) noexcept nogil:
    """Set the nodes of a row's part p to what their neighbours say of them. psi: from the row above the first on."""
    cdef const float* own = links + 12 * apart * r + 6 * p * apart + 1
    cdef const float* beside = links + 12 * apart * r + 6 * (1 - p) * apart + p
    cdef float* z = psi + 4 * apart * (r + 1) + 2 * p * apart + 1
    cdef float* other = psi + 4 * apart * (r + 1) + 2 * (1 - p) * apart + p
    agree(
        z, z + apart, own, beside, own - 12 * apart if r else nothing, other + 1, other, z + 4 * apart, z - 4 * apart,
        apart, (columns + 1 - p) // 2,
    )


def relax(
    const float[:, :, ::1] links, const float[:, :, ::1] coarse, Py_ssize_t low, Py_ssize_t columns,
    unsigned long long seed, Py_ssize_t sweeps, float[:, :, ::1] psi, Py_ssize_t first, float[:, :, ::1] out,
):
    """Fill the nodes of a band from the coarser level, then let each agree with its neighbours, red and black in turn.

    links: of the band's rows; low, even: the first of them on the sheet. columns: of nodes. coarse: the coarser
    level's ψ, all rows, or none at the coarsest level, where chance begins. psi: room for ψ of the band's rows, one
    above and one below, noughts. out: ψ of rows from the band's `first` on. Rows near a border of the band that is not
    the sheet's are wrong up to 2 sweeps + 2 rows off.
    """
    cdef Py_ssize_t rows = links.shape[0], apart = links.shape[2]
    cdef Py_ssize_t r, i, p, k, colour
    cdef float* z = &psi[0, 0, 0]
    cdef const float* l = &links[0, 0, 0]
    cdef const float* nothing = z  # of the row above the first: noughts
    with nogil:
        if coarse.shape[0] > 0:
            for r in range(0, rows, 2):
                for i in range((columns + 1) // 2):
                    p = 2 * (i & 1)
                    psi[r + 1, 0, i + 1] = coarse[(low + r) >> 1, p, (i >> 1) + 1]
                    psi[r + 1, 1, i + 1] = coarse[(low + r) >> 1, p + 1, (i >> 1) + 1]
            # nodes with two neighbours that are known, then those between four
            for r in range(rows):
                _settle(l, nothing, z, columns, apart, r, 1 - (r & 1))
            for r in range(1, rows, 2):
                _settle(l, nothing, z, columns, apart, r, 1)
        for r in range(rows):
            for i in range(columns):
                p = 2 * (i & 1)
                k = (i >> 1) + 1
                if psi[r + 1, p, k] * psi[r + 1, p, k] + psi[r + 1, p + 1, k] * psi[r + 1, p + 1, k] < <float>0.25:
                    _turned(_chance(seed, (low + r) * columns + i), &psi[r + 1, p, k], &psi[r + 1, p + 1, k])
        for _ in range(sweeps):
            for colour in range(2):
                for r in range(rows):
                    _settle(l, nothing, z, columns, apart, r, (r + colour) & 1)
        memcpy(&out[0, 0, 0], z + 4 * apart * (first + 1), sizeof(float) * 4 * apart * out.shape[0])


def turns(const float[:, :, ::1] psi, float[:, ::1] row, float[:, ::1] out):
    """The phase of each node (rows, columns), in turns; row: (1, wide), room."""
    cdef Py_ssize_t r, i, p, n
    with nogil:
        for r in range(out.shape[0]):
            for p in range(2):
                n = (out.shape[1] + 1 - p) // 2
                angles(&psi[r, 2 * p, 1], &psi[r, 2 * p + 1, 1], &row[0, 0], n)
                for i in range(n):
                    out[r, 2 * i + p] = row[0, i]


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
