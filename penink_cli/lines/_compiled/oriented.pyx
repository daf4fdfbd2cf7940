# cython: boundscheck=False, wraparound=False, cdivision=True
"""Compiled: a picture through a bank of oriented filters. See oriented.py."""


def respond(
    const float[:, ::1] padded, const int[::1] down, const int[::1] across, const float[::1] weight,
    float[:, ::1] out, Py_ssize_t top, Py_ssize_t bottom,
):
    """Rows top … bottom of out (h, w): the weighted sum of padded at (row + down, column + across), taps in order.

    The number of taps is a multiple of four.
    """
    cdef Py_ssize_t i, q, t
    cdef Py_ssize_t n = weight.shape[0], w = out.shape[1]
    cdef const float *a
    cdef const float *b
    cdef const float *c
    cdef const float *d
    cdef float *into
    cdef float wa, wb, wc, wd
    with nogil:
        for i in range(top, bottom):
            into = &out[i, 0]
            for q in range(w):
                into[q] = 0.0
            for t in range(0, n, 4):
                a = &padded[i + down[t], across[t]]
                b = &padded[i + down[t + 1], across[t + 1]]
                c = &padded[i + down[t + 2], across[t + 2]]
                d = &padded[i + down[t + 3], across[t + 3]]
                wa, wb, wc, wd = weight[t], weight[t + 1], weight[t + 2], weight[t + 3]
                for q in range(w):
                    into[q] = (((into[q] + wa * a[q]) + wb * b[q]) + wc * c[q]) + wd * d[q]


def strongest(const float[:, :, ::1] bank, float sign, float[:, ::1] most, float[:, ::1] mean,
              Py_ssize_t top, Py_ssize_t bottom):
    """The greatest of all directions' responses of this sign, and their mean, responses of the other sign being 0."""
    cdef Py_ssize_t i, q, k
    cdef Py_ssize_t n = bank.shape[0], w = bank.shape[2]
    cdef float v
    cdef float part = <float>(1.0 / n)
    cdef float *m
    cdef float *s
    cdef const float *r
    with nogil:
        for i in range(top, bottom):
            m = &most[i, 0]
            s = &mean[i, 0]
            for q in range(w):
                m[q] = 0.0
                s[q] = 0.0
            for k in range(n):
                r = &bank[k, i, 0]
                for q in range(w):
                    v = sign * r[q]
                    v = v if v > 0.0 else <float>0.0
                    m[q] = v if v > m[q] else m[q]
                    s[q] = s[q] + part * v


def weighed(const float[:, :, ::1] bank, float sign, const float[:, ::1] factor, const float[:, ::1] less,
            float[:, :, ::1] out, Py_ssize_t top, Py_ssize_t bottom):
    """Responses of this sign times factor, less what is around; 0 where nothing is left."""
    cdef Py_ssize_t i, q, k
    cdef Py_ssize_t n = bank.shape[0], w = bank.shape[2]
    cdef float v
    cdef const float *r
    cdef const float *f
    cdef const float *s
    cdef float *into
    with nogil:
        for k in range(n):
            for i in range(top, bottom):
                r = &bank[k, i, 0]
                f = &factor[i, 0]
                s = &less[i, 0]
                into = &out[k, i, 0]
                for q in range(w):
                    v = sign * r[q]
                    v = v if v > 0.0 else <float>0.0
                    v = v * f[q] - s[q]
                    into[q] = v if v > 0.0 else <float>0.0
