# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: values stretched along one axis, by means over cells or linear in between, and looked up. See `sheet`.

Running sums go from the first value to the last, so that the numbers are the same whatever the machine.
"""

ctypedef fused real:
    float
    double


cdef inline double between(double v, double least) noexcept nogil:
    """A mean within least … 1, which a rounding may have left."""
    v = v if v > least else least
    return v if v < 1.0 else 1.0


def means_down(
    const real[:, ::1] values, const long long[::1] at, const double[::1] part, double least, double[:, ::1] room,
    double[:, ::1] out,
) -> None:
    """Means of values (h, w) over n parts of each column, out (n, w); these begin so far into rows `at`, (n + 1,).

    room: (2, w) to work in.
    """
    cdef Py_ssize_t n = out.shape[0], w = out.shape[1], h = values.shape[0], i, j, row = 0
    cdef double scale = <double>n / <double>h, edge
    cdef double* sums = &room[0, 0]  # of the rows above
    cdef double* before = &room[1, 0]  # the sum up to where the part begins
    with nogil:
        for j in range(w):
            sums[j] = 0.0
        for i in range(n + 1):
            while row < at[i]:
                for j in range(w):
                    sums[j] += values[row, j]
                row += 1
            for j in range(w):
                edge = sums[j] * (1.0 - part[i]) + (sums[j] + values[row, j]) * part[i]
                if i:
                    out[i - 1, j] = between((edge - before[j]) * scale, least)
                before[j] = edge


def means_across(
    const real[:, ::1] values, const long long[::1] at, const double[::1] part, double least, double[:, ::1] out
) -> None:
    """The same along rows: values (h, w), out (h, n)."""
    cdef Py_ssize_t n = out.shape[1], w = values.shape[1], i, k, column
    cdef double scale = <double>n / <double>w, total, edge, before
    with nogil:
        for i in range(out.shape[0]):
            total = before = 0.0
            column = 0
            for k in range(n + 1):
                while column < at[k]:
                    total += values[i, column]
                    column += 1
                edge = total * (1.0 - part[k]) + (total + values[i, column]) * part[k]
                if k:
                    out[i, k - 1] = between((edge - before) * scale, least)
                before = edge


def blends_down(const real[:, ::1] values, const long long[::1] at, const double[::1] part, double[:, ::1] out) -> None:
    """Values between rows `at` and the next ones, out (n, w): so great a part of the way."""
    cdef Py_ssize_t i, j, row, after
    with nogil:
        for i in range(out.shape[0]):
            row, after = at[i], min(at[i] + 1, values.shape[0] - 1)
            for j in range(out.shape[1]):
                out[i, j] = values[row, j] * (1.0 - part[i]) + values[after, j] * part[i]


def blends_across(
    const real[:, ::1] values, const long long[::1] at, const double[::1] part, double[:, ::1] out
) -> None:
    """The same along rows: values (h, w), out (h, n)."""
    cdef Py_ssize_t i, k
    with nogil:
        for i in range(out.shape[0]):
            for k in range(out.shape[1]):
                out[i, k] = (
                    values[i, at[k]] * (1.0 - part[k]) + values[i, min(at[k] + 1, values.shape[1] - 1)] * part[k]
                )


def look_up(
    const real[:, ::1] values, const double[:, ::1] points, double across, double down, double[::1] out
) -> None:
    """Values (rows, columns) at points (n, 2), bilinear; so many columns and rows are one unit of these."""
    cdef Py_ssize_t rows = values.shape[0], columns = values.shape[1], k, i, j, right, below
    cdef double x, y, u, v, upper, lower
    with nogil:
        for k in range(out.shape[0]):
            x = min(max(points[k, 0] * across - 0.5, 0.0), <double>(columns - 1))
            y = min(max(points[k, 1] * down - 0.5, 0.0), <double>(rows - 1))
            j = <Py_ssize_t>x
            i = <Py_ssize_t>y
            u = x - j
            v = y - i
            right = min(j + 1, columns - 1)
            below = min(i + 1, rows - 1)
            upper = values[i, j] * (1.0 - u) + values[i, right] * u
            lower = values[below, j] * (1.0 - u) + values[below, right] * u
            out[k] = upper * (1.0 - v) + lower * v
