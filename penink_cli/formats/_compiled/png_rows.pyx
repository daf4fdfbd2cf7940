# cython: boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
# cython: embedsignature=True
"""The filters of PNG rows undone (PNG specification, 9): each byte is stored as its difference from a neighbour."""

from libc.stdlib cimport abs


def unfilter(unsigned char[:, ::1] rows, unsigned char[::1] above, int pixel):
    """Undo the filters in place; the first row whose filter does not exist, or -1.

    rows: (n, 1 + s), each row's filter and its s bytes.
    above: (s,) the row before the first, zeros where there is none; filled with the last row.
    pixel: bytes of a whole pixel, at least 1: so far to the left the neighbour is.
    """
    cdef Py_ssize_t i, j, bytes_ = above.shape[0]
    cdef unsigned char* row
    cdef unsigned char* up = &above[0] if bytes_ else NULL
    cdef int left, corner, near, a, b, c
    for i in range(rows.shape[0]):
        row = &rows[i, 1]
        if rows[i, 0] == 1:
            for j in range(pixel, bytes_):
                row[j] = <unsigned char>(row[j] + row[j - pixel])
        elif rows[i, 0] == 2:
            for j in range(bytes_):
                row[j] = <unsigned char>(row[j] + up[j])
        elif rows[i, 0] == 3:
            for j in range(bytes_):
                left = row[j - pixel] if j >= pixel else 0
                row[j] = <unsigned char>(row[j] + (left + up[j]) // 2)
        elif rows[i, 0] == 4:
            for j in range(bytes_):
                left = row[j - pixel] if j >= pixel else 0
                corner = up[j - pixel] if j >= pixel else 0
                # Paeth: of left, above and corner the one nearest to left + above - corner; of equal ones the first
                a, b, c = abs(up[j] - corner), abs(left - corner), abs(left + up[j] - 2 * corner)
                near = left if a <= b and a <= c else up[j] if b <= c else corner
                row[j] = <unsigned char>(row[j] + near)
        elif rows[i, 0] != 0:
            return i
        up = row
    for j in range(bytes_ if rows.shape[0] else 0):
        above[j] = up[j]
    return -1
