cdef extern from "rows.h" nogil:
    ctypedef struct Outline:
        float end_rate
        float end_lo
        float end_hi
        float side_rate
        float side_lo
        float side_hi
    void meet_rows(const Outline* bar, float d, long count, float* lo, float* hi)
    void whole_places(const float* at, float x, float most, long count, int* out)
    int bits_set(const unsigned long long* words, long count)
