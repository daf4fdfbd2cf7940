# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: smooth curves through the points of chains. See smoothing.py."""


def smooth(double[:, ::1] place, double[::1] weight, int[::1] first, double[:, ::1] band) -> None:
    """Move the points of each run to where Σ wᵢ |qᵢ − pᵢ|² + Σ |third difference of q|² is least.

    Third differences cost nothing on a parabola, so that a circle is not drawn inward. One system
    with three diagonals above the main one for each run, solved as L D Lᵀ.

    place: (n, 2) run after run, moved; weight: (n,) positive; first: (c + 1,) offsets of the runs.
    band: (n, 4) room to work in.
    """
    cdef Py_ssize_t run, i, d, e, begin, end
    cdef double f
    cdef double[4] third
    third[0] = -1.0
    third[1] = 3.0
    third[2] = -3.0
    third[3] = 1.0
    with nogil:
        for run in range(first.shape[0] - 1):
            begin = first[run]
            end = first[run + 1]
            if end - begin < 4:
                continue
            for i in range(begin, end):
                band[i, 0] = weight[i]
                band[i, 1] = band[i, 2] = band[i, 3] = 0.0
                place[i, 0] *= weight[i]
                place[i, 1] *= weight[i]
            for i in range(begin, end - 3):
                for d in range(4):
                    for e in range(d, 4):
                        band[i + d, e - d] += third[d] * third[e]
            for i in range(begin, end):
                for d in range(1, min(4, end - i)):
                    f = band[i, d] / band[i, 0]
                    for e in range(d, min(4, end - i)):
                        band[i + d, e - d] -= f * band[i, e]
                    place[i + d, 0] -= f * place[i, 0]
                    place[i + d, 1] -= f * place[i, 1]
            for i in range(end - 1, begin - 1, -1):
                f = 1.0 / band[i, 0]
                place[i, 0] *= f
                place[i, 1] *= f
                for d in range(1, min(4, end - i)):
                    f = band[i, d] / band[i, 0]
                    place[i, 0] -= f * place[i + d, 0]
                    place[i, 1] -= f * place[i + d, 1]
