# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: a picture through a bank of oriented filters. See oriented.py.

A bank is (n, h, w): the responses of n directions at each place, above 0 for dark lines and below for light ones.
"""


cdef extern from "taps.h" nogil:
    void penink_taps(
        const float* values, const Py_ssize_t* offset, const float* weight, Py_ssize_t n, float* out, Py_ssize_t width
    )
    int best_lanes()
    int lanes


def take_lanes(int wanted) -> int:
    """Use vectors of so many bytes, 16 or 32, or the most there are; which ones are used. No byte depends on it."""
    global lanes
    lanes = min(wanted, best_lanes())
    return lanes


take_lanes(32)


def respond(
    const float[:, ::1] padded, const Py_ssize_t[::1] offset, const float[::1] weight,
    float[:, ::1] out, Py_ssize_t top, Py_ssize_t bottom,
):
    """Fill in rows top … bottom - 1 of out (h, w): sums of padded at offset (t,) times weight (t,), in that order.

    padded: the picture (h + 2 r, w + 2 r), with a border of the filter's reach r. offset: from a place of out to a
    place of padded, in numbers of padded.
    """
    cdef Py_ssize_t i
    with nogil:
        for i in range(top, bottom):
            penink_taps(&padded[i, 0], &offset[0], &weight[0], weight.shape[0], &out[i, 0], out.shape[1])


def strongest(const float[:, :, ::1] bank, float[:, ::1] most, float[:, ::1] mean, float[:, ::1] light_most,
              float[:, ::1] light_mean, Py_ssize_t top, Py_ssize_t bottom):
    """Fill in rows top … bottom - 1 of most and mean (h, w): over the directions, of responses, those below 0 as 0.

    light_most, light_mean: (h, w) the same of the responses below 0, with the sign changed.
    """
    cdef Py_ssize_t i, q, k
    cdef Py_ssize_t n = bank.shape[0], w = bank.shape[2]
    cdef float v, u
    cdef float part = <float>(1.0 / n)
    cdef float *m
    cdef float *s
    cdef float *l
    cdef float *t
    cdef const float *r
    with nogil:
        for i in range(top, bottom):
            m, s, l, t = &most[i, 0], &mean[i, 0], &light_most[i, 0], &light_mean[i, 0]
            for q in range(w):
                m[q] = s[q] = l[q] = t[q] = 0.0
            for k in range(n):
                r = &bank[k, i, 0]
                for q in range(w):
                    v = r[q] if r[q] > 0.0 else <float>0.0
                    u = -r[q] if r[q] < 0.0 else <float>0.0
                    m[q] = v if v > m[q] else m[q]
                    l[q] = u if u > l[q] else l[q]
                    s[q] = s[q] + part * v
                    t[q] = t[q] + part * u


def weigh(float[:, :, ::1] bank, const float[:, ::1] factor, const float[:, ::1] less,
          const float[:, ::1] light_factor, const float[:, ::1] light_less, Py_ssize_t top, Py_ssize_t bottom):
    """Replace responses r of rows top … bottom - 1 by r · factor − less where r > 0, or by 0 if that is below 0.

    Where r < 0, −r becomes −r · light_factor − light_less likewise. factor, less, light_factor, light_less: (h, w).
    """
    cdef Py_ssize_t i, q, k
    cdef Py_ssize_t n = bank.shape[0], w = bank.shape[2]
    cdef float v, u
    cdef float *r
    cdef const float *f
    cdef const float *s
    cdef const float *g
    cdef const float *t
    with nogil:
        for i in range(top, bottom):
            f, s, g, t = &factor[i, 0], &less[i, 0], &light_factor[i, 0], &light_less[i, 0]
            for k in range(n):
                r = &bank[k, i, 0]
                for q in range(w):
                    v = r[q] * f[q] - s[q]
                    v = v if v > 0.0 else <float>0.0
                    u = -r[q] * g[q] - t[q]
                    u = u if u > 0.0 else <float>0.0
                    r[q] = v if r[q] > 0.0 else -u
