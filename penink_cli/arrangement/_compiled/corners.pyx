# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: straight stretches of chains fitted beside the places that may be corners. Only `corners` imports this."""


def stretches(
    const double[:, ::1] p, const long long[::1] first, const long long[::1] place, const long long[::1] length,
    Py_ssize_t begin, Py_ssize_t step, const double[:, ::1] weight, double[:, :, ::1] out,
) -> None:
    """Mean, slope and bend of as many points of a chain as there are weights, for each place (n,).

    p: (m, 2) the points of all chains. first, place, length: of each place where its chain begins, its number there,
    and the chain's points; chains go on from their ends to their beginnings. begin: from the place to the first point;
    step: 1 or -1. weight: (2, k) of each point in slope and bend. out: (3, n, 2), not more than once around a chain.
    """
    cdef Py_ssize_t i, k, at, n = weight.shape[1]
    cdef double x, y
    cdef double[6] sums
    with nogil:
        for i in range(place.shape[0]):
            for k in range(6):
                sums[k] = 0.0
            for k in range(n):
                at = place[i] + begin + step * k
                if at < 0:
                    at += length[i]
                elif at >= length[i]:
                    at -= length[i]
                x, y = p[first[i] + at, 0], p[first[i] + at, 1]
                sums[0] += x / n
                sums[1] += y / n
                sums[2] += weight[0, k] * x
                sums[3] += weight[0, k] * y
                sums[4] += weight[1, k] * x
                sums[5] += weight[1, k] * y
            for k in range(6):
                out[k // 2, i, k % 2] = sums[k]
