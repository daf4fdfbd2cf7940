cimport cython


cdef enum:
    INPUTS = 6  # estimates mixed for each binary decision
    TOLD = 4  # of them from contexts, where the others are probabilities that are told
    NODES = 64  # places of binary decisions in the code of one number


@cython.final
cdef class Coder:
    cdef bint reading
    cdef int[::1] context  # (INPUTS,) what the next decisions depend on: estimates are kept for each context

    cdef int[:, ::1] _p  # (INPUTS, TABLE) estimates that a decision is 1, of 65536
    cdef unsigned char[:, ::1] _n  # (INPUTS, TABLE) how often each was corrected
    cdef int[:, ::1] _weights  # (MIXERS · NODES, INPUTS) of 65536
    cdef int[::1] _squash
    cdef int[::1] _stretch
    cdef int[::1] _rate
    cdef int[::1] _index
    cdef int[::1] _input
    cdef bytearray _bytes
    cdef unsigned char[::1] _data
    cdef Py_ssize_t _at
    cdef Py_ssize_t _size
    cdef unsigned long long _low
    cdef unsigned int _range
    cdef unsigned int _code
    cdef int _cache
    cdef Py_ssize_t _pending

    cdef bint exhausted(self)
    cdef long long whole(self, int mixer, long long value)
    cdef void expect_told(self)
    cdef int told(self, int node, int mixer, int bit, double one, double other)
    cdef unsigned int _next(self)
    cdef void _shift(self)
    cdef int _code_bit(self, int bit, int p)
    cdef int _bit(self, int node, int mixer, int bit)
    cdef int _decision(self, int row, int node, int contexts, int slope, int bit)
