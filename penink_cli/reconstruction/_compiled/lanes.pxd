"""Vectors of floats or doubles as one fused type, `Lanes`; see lanes.h. A parameter `like` only tells which."""

from libc.string cimport memcpy

cdef extern from "lanes.h" nogil:
    enum:
        FLOATS
        DOUBLES
        FOUR_DOUBLES
        PACK
    # Vectors. To Cython they are numbers: arithmetic on them is written as on one, and is done on each.
    ctypedef float Four  # 4 floats
    ctypedef float Floats  # FLOATS floats: 4 with SSE2 and NEON, 8 with AVX2
    ctypedef double Doubles  # DOUBLES doubles: 2 or 4
    int vector_bytes_here()
    Four broadcast_four(float x)
    Floats broadcast_floats(float x)
    Doubles broadcast_doubles(double x)
    Four load_four(const float* x)
    Four min_four(Four v, Four w)
    Four max_four(Four v, Four w)
    Four abs_four(Four v)
    int greater_four(Four v, Four w)
    Floats sqrt_floats(Floats v)
    Doubles sqrt_doubles(Doubles v)
    Floats min_floats(Floats v, Floats w)
    Doubles min_doubles(Doubles v, Doubles w)
    Floats max_floats(Floats v, Floats w)
    Doubles max_doubles(Doubles v, Doubles w)
    int greater_floats(Floats v, Floats w)
    int greater_doubles(Doubles v, Doubles w)
    Floats select_floats(Floats t, Floats v, Floats w)
    Doubles select_doubles(Doubles t, Doubles v, Doubles w)
    unsigned long long negative_pixels(float v, float x, float y, float* least, int wide)
    Floats floats_by_row(const float* x, int k, int stride)
    Doubles doubles_by_row(const double* x, int k, int stride)
    Floats floats_by_column(const float* x, int k)
    Doubles doubles_by_column(const double* x, int k)
    Floats floats_where(const float* bits, unsigned long long set, int k)
    Doubles doubles_where(const double* bits, unsigned long long set, int k)
    void round_to_bytes(const float* v, unsigned char* out)
    void pack_bytes(const Floats* v, unsigned char most, unsigned char* out)
    void transpose_sets(const unsigned char* sets, int* out)
    int lowest(unsigned long long set)

ctypedef fused Lanes:
    Floats
    Doubles

cdef inline void fill(Lanes* v, double x) noexcept nogil:  # in every place
    if Lanes is Floats:
        v[0] = broadcast_floats(<float>x)
    else:
        v[0] = broadcast_doubles(x)

cdef inline Lanes broadcast(void* numbers, Py_ssize_t i, Lanes* like) noexcept nogil:  # number i, in every place
    if Lanes is Floats:
        return broadcast_floats((<float*>numbers)[i])
    else:
        return broadcast_doubles((<double*>numbers)[i])

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

cdef inline Lanes where(unsigned long long set, int k, Lanes* bits) noexcept nogil:  # one where they are in the set
    if Lanes is Floats:
        return floats_where(<float*>bits, set, k)
    else:
        return doubles_where(<double*>bits, set, k)

cdef inline void* number_at(void* numbers, Py_ssize_t i, Lanes* like) noexcept nogil:  # where number i of an array is
    if Lanes is Floats:
        return <float*>numbers + i
    else:
        return <double*>numbers + i

cdef inline Lanes square_root(Lanes v) noexcept nogil:
    if Lanes is Floats:
        return sqrt_floats(v)
    else:
        return sqrt_doubles(v)

cdef inline Lanes minimum(Lanes v, Lanes w) noexcept nogil:  # v < w ? v : w
    if Lanes is Floats:
        return min_floats(v, w)
    else:
        return min_doubles(v, w)

cdef inline Lanes maximum(Lanes v, Lanes w) noexcept nogil:  # v > w ? v : w
    if Lanes is Floats:
        return max_floats(v, w)
    else:
        return max_doubles(v, w)

cdef inline Lanes select(Lanes t, Lanes v, Lanes w) noexcept nogil:  # t > 0 ? v : w
    if Lanes is Floats:
        return select_floats(t, v, w)
    else:
        return select_doubles(t, v, w)

cdef inline Lanes smoothstep(Lanes u, Lanes least, Lanes most, Lanes three) noexcept nogil:  # S of the clamped u
    u = minimum(maximum(u, least), most)
    return u * u * (three - (u + u))

cdef inline int greater(Lanes v, Lanes w) noexcept nogil:  # the set of places where v > w
    if Lanes is Floats:
        return greater_floats(v, w)
    else:
        return greater_doubles(v, w)

cdef inline Lanes* lanes_at(void* place, Lanes* like) noexcept nogil:  # a place as one of the same lanes
    return <Lanes*>place

cdef inline Lanes load(void* place, Lanes* like) noexcept nogil:  # from any place, aligned or not
    cdef Lanes v
    memcpy(&v, place, sizeof(Lanes))
    return v

cdef inline void store(void* place, Lanes v) noexcept nogil:
    memcpy(place, &v, sizeof(Lanes))

ctypedef fused Columns:  # numbers of the four columns of samples: one vector, or FOUR_DOUBLES
    Four
    Doubles

cdef inline Columns* columns_at(void* place, Columns* like) noexcept nogil:
    return <Columns*>place

cdef inline Columns broadcast_column(void* numbers, int i, Columns* like) noexcept nogil:  # as `number`
    if Columns is Four:
        return broadcast_four((<float*>numbers)[i])
    else:
        return broadcast_doubles((<double*>numbers)[i])
