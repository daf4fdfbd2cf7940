# cython: boundscheck=False, wraparound=False, cdivision=True
"""The phase of a hatch: how many of its lines have passed from the first row of a column to each other one.

    v     cover   lines a point    phase        A column runs across the hatch. Where the pen paints .5 pt, a cover of
    0     .25          .5           0           .25 is a line every two points. The phase is the sum of that over the
    1     .25          .5           .5          rows, so a line is due wherever it has grown by one.
    2     .5          1.0          1.0
    3                              2.0

Only the Python module `sweep` imports this module; the kernel `sweep` lays the lines.
"""

from libc.math cimport fabs


cdef class Pressed:
    """The pen: finer where it is to cover less than 1 / steep, down to the finest line; a device adds `gained`.

    most: lines in a point, at the most.
    """

    cdef double finest, pen, steep, gained, most

    def __init__(self, double finest, double pen, double steep, double gained, double most) -> None:
        self.finest = finest
        self.pen = pen
        self.steep = steep
        self.gained = gained
        self.most = most

    cdef inline double painted(self, double cover) noexcept nogil:
        """The width of a line where so much is to be covered."""
        return self.finest + (self.pen - self.finest) * min(cover * self.steep, 1.0) + self.gained


def integrate(
    const double[:, ::1] coverage, double width, double height, double pad, double c, double s, const double[::1] u,
    const double[::1] v, const double[:, ::1] aside, Pressed pen, double row_pt, double[:, ::1] phase,
) -> None:
    """Fill in the phase of columns at u (k,), whose rows are at v (m,), points: (k, m + 1).

    coverage: of the cells of a sheet of width × height; as far as `pad` points from it that of its border goes on.
    c, s: cosine and sine of the hatch. aside: (k, m) how far each place is pushed across it, or empty.
    """
    cdef Py_ssize_t i, j, row, column
    cdef Py_ssize_t rows = coverage.shape[0], columns = coverage.shape[1]
    cdef double across, x, y, cover, total
    cdef double columns_a_pt = columns / width, rows_a_pt = rows / height
    cdef bint pushed = aside.shape[0] > 0
    with nogil:
        for i in range(u.shape[0]):
            total = 0.0
            phase[i, 0] = 0.0
            for j in range(v.shape[0]):
                across = v[j] + aside[i, j] if pushed else v[j]
                x = u[i] * c - across * s
                y = u[i] * s + across * c
                if fabs(x - width / 2) < width / 2 + pad and fabs(y - height / 2) < height / 2 + pad:
                    column = min(columns - 1, max(0, <Py_ssize_t>(x * columns_a_pt)))
                    row = min(rows - 1, max(0, <Py_ssize_t>(y * rows_a_pt)))
                    cover = coverage[row, column]
                    total += min(pen.most, cover / pen.painted(cover)) * row_pt
                phase[i, j + 1] = total
