# cython: boundscheck=False, wraparound=False, cdivision=True
"""How much a place is surrounded by edges, and the solver of a smooth field. Sums are in one fixed order."""


def surrounded(const unsigned char[:, ::1] walls, double reach, const double[:, ::1] rays, double[:, ::1] out):
    """Fill in out (h, w): the part, 0 … 1, of the rays from each place that meet a wall within reach.

    walls: (2 h, 2 w), above 0 where an edge passes. reach: in pixels of walls. rays: (n, 2) unit vectors.
    """
    cdef Py_ssize_t rows = walls.shape[0], columns = walls.shape[1], i, j, k, y, x, met
    cdef double t, dx, dy
    with nogil:
        for i in range(out.shape[0]):
            for j in range(out.shape[1]):
                met = 0
                for k in range(rays.shape[0]):
                    dx, dy = rays[k, 0], rays[k, 1]
                    t = 1.5
                    while t < reach:
                        x = <Py_ssize_t>(2 * j + 1 + t * dx + columns) - columns  # rounded down, below 0 too
                        y = <Py_ssize_t>(2 * i + 1 + t * dy + rows) - rows
                        if x < 0 or y < 0 or x >= columns or y >= rows:
                            break
                        if walls[y, x]:
                            met += 1
                            break
                        t += 0.8
                out[i, j] = <double>met / rays.shape[0]


cdef void applied(
    const double[:, ::1] right, const double[:, ::1] down, const double[:, ::1] own,
    const double[:, :, ::1] x, double[:, :, ::1] out,
) noexcept nogil:
    """out = A x: own · x and, for each link, its weight times the difference to the neighbour; see `solve`."""
    cdef Py_ssize_t h = own.shape[0], w = own.shape[1], p = x.shape[2], i, j, k
    cdef double total
    for i in range(h):
        for j in range(w):
            for k in range(p):
                total = own[i, j] * x[i, j, k]
                if j + 1 < w:
                    total += right[i, j] * (x[i, j, k] - x[i, j + 1, k])
                if j > 0:
                    total += right[i, j - 1] * (x[i, j, k] - x[i, j - 1, k])
                if i + 1 < h:
                    total += down[i, j] * (x[i, j, k] - x[i + 1, j, k])
                if i > 0:
                    total += down[i - 1, j] * (x[i, j, k] - x[i - 1, j, k])
                out[i, j, k] = total


def solve(
    const double[:, ::1] right, const double[:, ::1] down, const double[:, ::1] own,
    const double[:, :, ::1] b, double[:, :, ::1] x, double[:, :, :, ::1] room, double tolerance, int most,
):
    """Solve A x = b for p planes at once by conjugate gradients, preconditioned by the diagonal.

    A is the sum of the diagonal `own` (h, w) and of the Laplacian of a grid of links: right (h, w) has the weights of
    links to the next sample in the row, down (h, w) those to the next row; the last column of right and the last row of
    down are not used. b: (h, w, p). x: (h, w, p), the first guess, then the solution. room: (4, h, w, p) to work in.
    tolerance: of the residual relative to b, in the preconditioner's norm. most: rounds. Returns the rounds it took.
    """
    cdef Py_ssize_t h = own.shape[0], w = own.shape[1], p = x.shape[2], i, j, k
    cdef double[:, :, ::1] r = room[0], z = room[1], d = room[2], q = room[3]
    cdef double diagonal, alpha, beta, rho = 0, before, size = 0, total
    cdef int rounds = 0
    with nogil:
        applied(right, down, own, x, q)
        for i in range(h):
            for j in range(w):
                diagonal = own[i, j]
                if j + 1 < w:
                    diagonal += right[i, j]
                if j > 0:
                    diagonal += right[i, j - 1]
                if i + 1 < h:
                    diagonal += down[i, j]
                if i > 0:
                    diagonal += down[i - 1, j]
                diagonal = 1.0 / diagonal
                for k in range(p):
                    r[i, j, k] = b[i, j, k] - q[i, j, k]
                    z[i, j, k] = diagonal  # the preconditioner's factor
                    d[i, j, k] = diagonal * r[i, j, k]
                    rho += r[i, j, k] * d[i, j, k]
                    size += b[i, j, k] * diagonal * b[i, j, k]
        while rho > tolerance * tolerance * size and rounds < most:
            applied(right, down, own, d, q)
            total = 0
            for i in range(h):
                for j in range(w):
                    for k in range(p):
                        total += d[i, j, k] * q[i, j, k]
            alpha = rho / total
            before = rho
            rho = 0
            for i in range(h):
                for j in range(w):
                    for k in range(p):
                        x[i, j, k] += alpha * d[i, j, k]
                        r[i, j, k] -= alpha * q[i, j, k]
                        rho += r[i, j, k] * z[i, j, k] * r[i, j, k]
            beta = rho / before
            for i in range(h):
                for j in range(w):
                    for k in range(p):
                        d[i, j, k] = z[i, j, k] * r[i, j, k] + beta * d[i, j, k]
            rounds += 1
    return rounds
