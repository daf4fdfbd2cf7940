from libc.string cimport memcpy

cdef extern from "lanes.h" nogil:
    enum:
        FLOATS
        DOUBLES
        FOUR_QUADS
        PACK
    ctypedef float Four  # four floats, or as many as
    ctypedef float Floats  # the machine computes at once,
    ctypedef double Doubles  # or doubles,
    ctypedef double Quads  # or up to four of those: these are arrays, but arithmetic is written as on their numbers
    int lanes_here()
    Four all_four(float x)
    Floats all_floats(float x)
    Doubles all_doubles(double x)
    Quads all_quads(double x)
    Four four_at(const float* x)
    Four less_four(Four v, Four w)
    Four more_four(Four v, Four w)
    Four size_four(Four v)
    int above_four(Four v, Four w)
    Floats root_floats(Floats v)
    Doubles root_doubles(Doubles v)
    Floats less_floats(Floats v, Floats w)
    Doubles less_doubles(Doubles v, Doubles w)
    Floats more_floats(Floats v, Floats w)
    Doubles more_doubles(Doubles v, Doubles w)
    int above_floats(Floats v, Floats w)
    int above_doubles(Doubles v, Doubles w)
    Floats chosen_floats(Floats t, Floats v, Floats w)
    Doubles chosen_doubles(Doubles t, Doubles v, Doubles w)
    unsigned long long below_zero(float v, float x, float y, float* least, int wide)
    Floats floats_by_row(const float* x, int k, int stride)
    Doubles doubles_by_row(const double* x, int k, int stride)
    Floats floats_by_column(const float* x, int k)
    Doubles doubles_by_column(const double* x, int k)
    Floats floats_among(const float* bits, unsigned long long set, int k)
    Doubles doubles_among(const double* bits, unsigned long long set, int k)
    void keep_bytes(const float* v, unsigned char* out)
    void pack_bytes(const Floats* v, unsigned char most, unsigned char* out)
    void turn_sets(const unsigned char* sets, int* out)
    int lowest(unsigned long long set)

ctypedef fused Lanes:
    Floats
    Doubles

cdef inline void fill(Lanes* v, double x) noexcept nogil:  # in every place
    if Lanes is Floats:
        v[0] = all_floats(<float>x)
    else:
        v[0] = all_doubles(x)

cdef inline Lanes number(void* numbers, Py_ssize_t i, Lanes* like) noexcept nogil:  # number i, in every place
    if Lanes is Floats:
        return all_floats((<float*>numbers)[i])
    else:
        return all_doubles((<double*>numbers)[i])

cdef inline int vectors(int rows, Lanes* like) noexcept nogil:  # that make up so many rows of eight, or a little more
    if Lanes is Floats:
        return (8 * rows + FLOATS - 1) // FLOATS
    else:
        return (8 * rows + DOUBLES - 1) // DOUBLES

cdef inline Lanes by_row(void* numbers, int k, int stride, Lanes* like) noexcept nogil:  # of the pixels of vector k
    if Lanes is Floats:
        return floats_by_row(<float*>numbers, k, stride)
    else:
        return doubles_by_row(<double*>numbers, k, stride)

cdef inline Lanes by_column(void* numbers, int k, Lanes* like) noexcept nogil:
    if Lanes is Floats:
        return floats_by_column(<float*>numbers, k)
    else:
        return doubles_by_column(<double*>numbers, k)

cdef inline Lanes among(unsigned long long set, int k, Lanes* bits) noexcept nogil:  # one where they are in the set
    if Lanes is Floats:
        return floats_among(<float*>bits, set, k)
    else:
        return doubles_among(<double*>bits, set, k)

cdef inline void* number_at(void* numbers, Py_ssize_t i, Lanes* like) noexcept nogil:  # where number i of an array is
    if Lanes is Floats:
        return <float*>numbers + i
    else:
        return <double*>numbers + i

cdef inline Lanes root(Lanes v) noexcept nogil:
    if Lanes is Floats:
        return root_floats(v)
    else:
        return root_doubles(v)

cdef inline Lanes less(Lanes v, Lanes w) noexcept nogil:  # v < w ? v : w
    if Lanes is Floats:
        return less_floats(v, w)
    else:
        return less_doubles(v, w)

cdef inline Lanes more(Lanes v, Lanes w) noexcept nogil:  # v > w ? v : w
    if Lanes is Floats:
        return more_floats(v, w)
    else:
        return more_doubles(v, w)

cdef inline Lanes chosen(Lanes t, Lanes v, Lanes w) noexcept nogil:  # t > 0 ? v : w
    if Lanes is Floats:
        return chosen_floats(t, v, w)
    else:
        return chosen_doubles(t, v, w)

cdef inline Lanes ease(Lanes u, Lanes least, Lanes most, Lanes three) noexcept nogil:  # S(u), u within least … most
    u = less(more(u, least), most)
    return u * u * (three - (u + u))

cdef inline int above(Lanes v, Lanes w) noexcept nogil:  # the set of places where v > w
    if Lanes is Floats:
        return above_floats(v, w)
    else:
        return above_doubles(v, w)

cdef inline Lanes* lanes_at(void* place, Lanes* like) noexcept nogil:  # a place as one of the same lanes
    return <Lanes*>place

cdef inline Lanes load(void* place, Lanes* like) noexcept nogil:  # from any place, aligned or not
    cdef Lanes v
    memcpy(&v, place, sizeof(Lanes))
    return v

cdef inline void store(void* place, Lanes v) noexcept nogil:
    memcpy(place, &v, sizeof(Lanes))

ctypedef fused Columns:  # numbers of the four columns of samples: one vector, or FOUR_QUADS
    Four
    Quads

cdef inline Columns* columns_at(void* place, Columns* like) noexcept nogil:
    return <Columns*>place

cdef inline Columns spread(void* numbers, int i, Columns* like) noexcept nogil:  # as `number`
    if Columns is Four:
        return all_four((<float*>numbers)[i])
    else:
        return all_quads((<double*>numbers)[i])
