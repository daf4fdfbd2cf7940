# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: a picture through a bank of oriented filters. See oriented.py."""


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
    """Rows top … bottom of out (h, w): the weighted sums of padded at as many offsets, in order.

    offset: from a place's number in padded, a row longer than one of out by the filters' reach on both sides.
    """
    cdef Py_ssize_t i
    with nogil:
        for i in range(top, bottom):
            penink_taps(&padded[i, 0], &offset[0], &weight[0], weight.shape[0], &out[i, 0], out.shape[1])


def strongest(const float[:, :, ::1] bank, float[:, ::1] most, float[:, ::1] mean, float[:, ::1] light_most,
              float[:, ::1] light_mean, Py_ssize_t top, Py_ssize_t bottom):
    """The greatest of all directions' responses, and their mean, those below 0 being 0; of those below 0 the same."""
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
    """Responses times factor, less what is around, or 0; those below 0 by what is told of light ones."""
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
