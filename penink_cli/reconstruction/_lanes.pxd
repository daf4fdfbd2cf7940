from libc.string cimport memcpy

cdef extern from "_lanes.h" nogil:
    ctypedef float Four  # four floats, or
    ctypedef double Two  # two doubles: these are arrays, but arithmetic is written as on their numbers
    Four all_four(float x)
    Two all_two(double x)
    Four four_at(const float* x)
    Four lane_four(Four v, int i)
    Two lane_two(Two v, int i)
    Four root_four(Four v)
    Two root_two(Two v)
    Four less_four(Four v, Four w)
    Two less_two(Two v, Two w)
    Four more_four(Four v, Four w)
    Two more_two(Two v, Two w)
    Four chosen_four(Four t, Four v, Four w)
    Two chosen_two(Two t, Two v, Two w)
    Four size_four(Four v)
    int above_four(Four v, Four w)
    int above_two(Two v, Two w)
    int close_four(Four v, float limit)
    unsigned long long beyond_in_rows(Four low, Four high)
    unsigned long long beyond_in_columns(Four low, Four high)
    void keep_bytes(Four low, Four high, unsigned char* out)
    int lowest(unsigned long long set)

ctypedef fused Lanes:
    Four
    Two

cdef inline void fill(Lanes* v, double x) noexcept nogil:  # in every place
    if Lanes is Four:
        v[0] = all_four(<float>x)
    else:
        v[0] = all_two(x)

cdef inline Lanes lane(Lanes* v, int i) noexcept nogil:  # number i of an array, in every place
    if Lanes is Four:
        return lane_four(v[i >> 2], i & 3)
    else:
        return lane_two(v[i >> 1], i & 1)

cdef inline Lanes root(Lanes v) noexcept nogil:
    if Lanes is Four:
        return root_four(v)
    else:
        return root_two(v)

cdef inline Lanes less(Lanes v, Lanes w) noexcept nogil:  # v < w ? v : w
    if Lanes is Four:
        return less_four(v, w)
    else:
        return less_two(v, w)

cdef inline Lanes more(Lanes v, Lanes w) noexcept nogil:  # v > w ? v : w
    if Lanes is Four:
        return more_four(v, w)
    else:
        return more_two(v, w)

cdef inline Lanes chosen(Lanes t, Lanes v, Lanes w) noexcept nogil:  # t > 0 ? v : w
    if Lanes is Four:
        return chosen_four(t, v, w)
    else:
        return chosen_two(t, v, w)

cdef inline int above(Lanes v, Lanes w) noexcept nogil:  # the set of places where v > w
    if Lanes is Four:
        return above_four(v, w)
    else:
        return above_two(v, w)

cdef inline Lanes* lanes_at(void* place, Lanes* like) noexcept nogil:  # a place as one of the same lanes
    return <Lanes*>place

cdef inline Lanes load(void* place, Lanes* like) noexcept nogil:  # from any place, aligned or not
    cdef Lanes v
    memcpy(&v, place, sizeof(Lanes))
    return v

cdef inline void store(void* place, Lanes v) noexcept nogil:
    memcpy(place, &v, sizeof(Lanes))
