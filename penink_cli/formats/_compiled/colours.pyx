# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
# cython: embedsignature=True
"""Stored colours through the curves and the matrix of their profile to sRGB's values."""

from libc.stdint cimport uint8_t, uint16_t

ctypedef fused level:
    uint8_t
    uint16_t


def convert(
    const level[:, ::1] colours, const double[:, ::1] light, const double[:, ::1] matrix, const double[::1] coding,
    level[:, ::1] out,
) -> None:
    """Fill out (n, 3) with sRGB's values of colours (n, 3).

    light: (3, maxval + 1) the light, 0 … 1, of each value of a channel. matrix: (3, 3) from this to sRGB's light.
    coding: (steps + 1,) sRGB's value, 0 … maxval, of light at even steps from 0 to 1; linear between two steps.
    """
    cdef Py_ssize_t i, step, steps = coding.shape[0] - 1
    cdef int c
    cdef double red, green, blue, place
    with nogil:
        for i in range(colours.shape[0]):
            red = light[0, colours[i, 0]]
            green = light[1, colours[i, 1]]
            blue = light[2, colours[i, 2]]
            for c in range(3):
                place = matrix[c, 0] * red + matrix[c, 1] * green + matrix[c, 2] * blue
                place = min(max(place, 0.0), 1.0) * steps
                step = min(<Py_ssize_t>place, steps - 1)
                out[i, c] = <level>(coding[step] + (coding[step + 1] - coding[step]) * (place - step) + 0.5)
