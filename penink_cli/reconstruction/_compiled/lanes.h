/* Numbers side by side: four floats, or as many floats or doubles as the machine computes at once, a *vector*.
 *
 * Left to itself the compiler vectorises the loops over the eight pixels of a row only in part, and keeps their sums in
 * memory. Arithmetic on these types is that of their numbers, each rounded as it would be alone, so the bytes of the
 * output depend neither on them nor on how many there are: sixteen bytes with SSE2 and NEON, thirty-two with AVX2 and
 * sixty-four with AVX-512, for which kernels are compiled again. Where there is nothing of it the loops say the same.
 */
#ifndef PENINK_LANES_H
#define PENINK_LANES_H

#include <math.h>
#include <string.h>

#if defined(__AVX512F__)
#define LANES 64
#elif defined(__AVX2__)
#define LANES 32
#else
#define LANES 16
#endif
#if defined(__x86_64__) && defined(__SSE2__) && defined(__GNUC__)
#include <immintrin.h>
#define MAY_HAVE_AVX2
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

typedef float Four __attribute__((vector_size(16), may_alias));
typedef float Floats __attribute__((vector_size(LANES), may_alias));
typedef double Doubles __attribute__((vector_size(LANES), may_alias));
#if LANES > 32
typedef double Quads __attribute__((vector_size(32), may_alias));
#else
typedef double Quads __attribute__((vector_size(LANES), may_alias));
#endif

enum {
    FLOATS = LANES / sizeof(float), /* in one vector */
    DOUBLES = LANES / sizeof(double),
    FOUR_QUADS = 32 / sizeof(Quads), /* vectors of Quads that hold four */
    PACK = 4 * FLOATS /* floats that make a vector of bytes */
};

#define EACH(v) for (unsigned i = 0; i < sizeof(v) / sizeof((v)[0]); i++)

/* How many numbers side by side the processor this runs on is good at, in bytes. AVX-512 counts from the generation on
 * that has VBMI2: earlier ones slow their clock down for it. */
static inline int lanes_here(void) {
#ifdef MAY_HAVE_AVX2
    if (!__builtin_cpu_supports("avx2")) return 16;
    return __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vbmi2") ? 64 : 32;
#else
    return 16;
#endif
}

static inline Four all_four(float x) { return (Four){x, x, x, x}; }
static inline Four four_at(const float *x) { Four v; memcpy(&v, x, sizeof v); return v; }

#ifdef __SSE2__

static inline Four less_four(Four v, Four w) { return (Four)_mm_min_ps((__m128)v, (__m128)w); }
static inline Four more_four(Four v, Four w) { return (Four)_mm_max_ps((__m128)v, (__m128)w); }
static inline int above_four(Four v, Four w) { return _mm_movemask_ps(_mm_cmpgt_ps((__m128)v, (__m128)w)); }

#else

static inline Four less_four(Four v, Four w) { EACH(v) v[i] = v[i] < w[i] ? v[i] : w[i]; return v; }
static inline Four more_four(Four v, Four w) { EACH(v) v[i] = v[i] > w[i] ? v[i] : w[i]; return v; }
static inline int above_four(Four v, Four w) { int m = 0; EACH(v) m |= (v[i] > w[i]) << i; return m; }

#endif

#if LANES == 64

static inline Floats all_floats(float x) { return (Floats)_mm512_set1_ps(x); }
static inline Doubles all_doubles(double x) { return (Doubles)_mm512_set1_pd(x); }
static inline Floats root_floats(Floats v) { return (Floats)_mm512_sqrt_ps((__m512)v); }
static inline Doubles root_doubles(Doubles v) { return (Doubles)_mm512_sqrt_pd((__m512d)v); }
static inline Floats less_floats(Floats v, Floats w) { return (Floats)_mm512_min_ps((__m512)v, (__m512)w); }
static inline Doubles less_doubles(Doubles v, Doubles w) { return (Doubles)_mm512_min_pd((__m512d)v, (__m512d)w); }
static inline Floats more_floats(Floats v, Floats w) { return (Floats)_mm512_max_ps((__m512)v, (__m512)w); }
static inline Doubles more_doubles(Doubles v, Doubles w) { return (Doubles)_mm512_max_pd((__m512d)v, (__m512d)w); }
static inline int above_floats(Floats v, Floats w) {
    return _mm512_cmp_ps_mask((__m512)v, (__m512)w, _CMP_GT_OQ);
}
static inline int above_doubles(Doubles v, Doubles w) {
    return _mm512_cmp_pd_mask((__m512d)v, (__m512d)w, _CMP_GT_OQ);
}
static inline Quads all_quads(double x) { return (Quads)_mm256_set1_pd(x); }

#elif LANES == 32

static inline Floats all_floats(float x) { return (Floats)_mm256_set1_ps(x); }
static inline Doubles all_doubles(double x) { return (Doubles)_mm256_set1_pd(x); }
static inline Floats root_floats(Floats v) { return (Floats)_mm256_sqrt_ps((__m256)v); }
static inline Doubles root_doubles(Doubles v) { return (Doubles)_mm256_sqrt_pd((__m256d)v); }
static inline Floats less_floats(Floats v, Floats w) { return (Floats)_mm256_min_ps((__m256)v, (__m256)w); }
static inline Doubles less_doubles(Doubles v, Doubles w) { return (Doubles)_mm256_min_pd((__m256d)v, (__m256d)w); }
static inline Floats more_floats(Floats v, Floats w) { return (Floats)_mm256_max_ps((__m256)v, (__m256)w); }
static inline Doubles more_doubles(Doubles v, Doubles w) { return (Doubles)_mm256_max_pd((__m256d)v, (__m256d)w); }
static inline int above_floats(Floats v, Floats w) {
    return _mm256_movemask_ps(_mm256_cmp_ps((__m256)v, (__m256)w, _CMP_GT_OQ));
}
static inline int above_doubles(Doubles v, Doubles w) {
    return _mm256_movemask_pd(_mm256_cmp_pd((__m256d)v, (__m256d)w, _CMP_GT_OQ));
}
static inline Quads all_quads(double x) { return all_doubles(x); }

#else

static inline Floats all_floats(float x) { return all_four(x); }
static inline Doubles all_doubles(double x) { return (Doubles){x, x}; }
static inline Quads all_quads(double x) { return all_doubles(x); }
static inline Floats less_floats(Floats v, Floats w) { return less_four(v, w); }
static inline Floats more_floats(Floats v, Floats w) { return more_four(v, w); }
static inline int above_floats(Floats v, Floats w) { return above_four(v, w); }
#ifdef __SSE2__
static inline Floats root_floats(Floats v) { return (Floats)_mm_sqrt_ps((__m128)v); }
static inline Doubles root_doubles(Doubles v) { return (Doubles)_mm_sqrt_pd((__m128d)v); }
static inline Doubles less_doubles(Doubles v, Doubles w) { return (Doubles)_mm_min_pd((__m128d)v, (__m128d)w); }
static inline Doubles more_doubles(Doubles v, Doubles w) { return (Doubles)_mm_max_pd((__m128d)v, (__m128d)w); }
static inline int above_doubles(Doubles v, Doubles w) {
    return _mm_movemask_pd(_mm_cmpgt_pd((__m128d)v, (__m128d)w));
}
#else
static inline Floats root_floats(Floats v) { EACH(v) v[i] = sqrtf(v[i]); return v; }
static inline Doubles root_doubles(Doubles v) { EACH(v) v[i] = sqrt(v[i]); return v; }
static inline Doubles less_doubles(Doubles v, Doubles w) { EACH(v) v[i] = v[i] < w[i] ? v[i] : w[i]; return v; }
static inline Doubles more_doubles(Doubles v, Doubles w) { EACH(v) v[i] = v[i] > w[i] ? v[i] : w[i]; return v; }
static inline int above_doubles(Doubles v, Doubles w) { int m = 0; EACH(v) m |= (v[i] > w[i]) << i; return m; }
#endif

#endif

/* The numbers of v where those of t are positive, else those of w. */
static inline Floats chosen_floats(Floats t, Floats v, Floats w) {
    EACH(v) v[i] = t[i] > 0 ? v[i] : w[i];
    return v;
}
static inline Doubles chosen_doubles(Doubles t, Doubles v, Doubles w) {
    EACH(v) v[i] = t[i] > 0 ? v[i] : w[i];
    return v;
}

/* The numbers without their sign. */
static inline Four size_four(Four v) { return more_four(v, -v); }

#ifdef MAY_HAVE_AVX2
/* `below_zero` for processors with AVX2, whatever else is compiled for: half the instructions. */
__attribute__((target("avx2"))) static unsigned long long below_zero_wide(float v, float x, float y, float *least) {
    const __m256 sign = _mm256_set1_ps(-0.0f);
    const __m256i order = _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7);
    const __m256 ramp = _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7);
    const __m256 down = _mm256_set1_ps(2 * y);
    const __m256 top = _mm256_add_ps(_mm256_set1_ps(v), _mm256_mul_ps(ramp, _mm256_set1_ps(x)));
    __m256 even = top, odd = _mm256_add_ps(top, _mm256_set1_ps(y));
    __m256 closest = _mm256_andnot_ps(sign, even);
    __m256i pairs[4];
    for (int r = 0; r < 4; r++) {
        closest = _mm256_min_ps(closest, _mm256_andnot_ps(sign, even));
        closest = _mm256_min_ps(closest, _mm256_andnot_ps(sign, odd));
        pairs[r] = _mm256_packs_epi32(_mm256_castps_si256(even), _mm256_castps_si256(odd)); /* keeps the signs */
        even = _mm256_add_ps(even, down);
        odd = _mm256_add_ps(odd, down);
    }
    const __m256i low = _mm256_permutevar8x32_epi32(_mm256_packs_epi16(pairs[0], pairs[1]), order);
    const __m256i high = _mm256_permutevar8x32_epi32(_mm256_packs_epi16(pairs[2], pairs[3]), order);
    __m128 four = _mm_min_ps(_mm256_castps256_ps128(closest), _mm256_extractf128_ps(closest, 1));
    four = _mm_min_ps(four, _mm_movehl_ps(four, four));
    *least = _mm_cvtss_f32(_mm_min_ss(four, _mm_shuffle_ps(four, four, 1)));
    return (unsigned)_mm256_movemask_epi8(low) | (unsigned long long)(unsigned)_mm256_movemask_epi8(high) << 32;
}
#endif

/* A tile of 8 × 8 pixels, pixel (r, c) at bit 8 r + c: those where v + c x + r y is negative.
 *
 * least: how close to zero that comes anywhere; either is off by a few roundings. wide: whether there is AVX2.
 */
static inline unsigned long long below_zero(float v, float x, float y, float *least, int wide) {
    unsigned long long m = 0;
#ifdef MAY_HAVE_AVX2
    if (wide) return below_zero_wide(v, x, y, least);
#endif
#ifdef __SSE2__
    const Four ramp = {0, 1, 2, 3};
    const Four left = all_four(v) + ramp * all_four(x), right = left + all_four(4 * x);
    const __m128 sign = _mm_set1_ps(-0.0f);
    __m128 closest = _mm_set1_ps(INFINITY);
    __m128i both[8];
    for (int r = 0; r < 8; r++) {
        const Four down = all_four(r * y), a = left + down, b = right + down;
        closest = _mm_min_ps(closest, _mm_min_ps(_mm_andnot_ps(sign, (__m128)a), _mm_andnot_ps(sign, (__m128)b)));
        both[r] = _mm_packs_epi32((__m128i)a, (__m128i)b); /* keeps the signs */
    }
    for (int r = 6; r >= 0; r -= 2) m = m << 16 | (unsigned)_mm_movemask_epi8(_mm_packs_epi16(both[r], both[r + 1]));
    closest = _mm_min_ps(closest, _mm_movehl_ps(closest, closest));
    *least = _mm_cvtss_f32(_mm_min_ss(closest, _mm_shuffle_ps(closest, closest, 1)));
#else
    (void)wide;
    *least = INFINITY;
    for (int k = 0; k < 64; k++) {
        const float at = v + (k & 7) * x + (k >> 3) * y;
        m |= (unsigned long long)(at < 0) << k;
        *least = fabsf(at) < *least ? fabsf(at) : *least;
    }
#endif
    return m;
}

/* A tile of 8 × 8 pixels as vectors, row after row: for each pixel of vector k the number of its row, `stride` apart, */
static inline Floats floats_by_row(const float *x, int k, int stride) {
#if LANES == 64
    const __m256 one = _mm256_set1_ps(x[2 * k * stride]), other = _mm256_set1_ps(x[(2 * k + 1) * stride]);
    return (Floats)_mm512_insertf32x8(_mm512_castps256_ps512(one), other, 1);
#else
    return all_floats(x[k * FLOATS / 8 * stride]);
#endif
}
static inline Doubles doubles_by_row(const double *x, int k, int stride) { return all_doubles(x[k * DOUBLES / 8 * stride]); }

/* that of its column, */
static inline Floats floats_by_column(const float *x, int k) {
    Floats v;
#if LANES == 64
    (void)k;
    v = (Floats)_mm512_broadcast_f32x8(_mm256_loadu_ps(x));
#else
    memcpy(&v, x + k * FLOATS % 8, sizeof v);
#endif
    return v;
}
static inline Doubles doubles_by_column(const double *x, int k) {
    Doubles v;
    memcpy(&v, x + k * DOUBLES % 8, sizeof v);
    return v;
}

/* and one where it is in a set, else zero; bits: a table of bytes as eight such numbers. */
static inline Floats floats_among(const float *bits, unsigned long long set, int k) {
#if LANES == 64
    (void)bits;
    return (Floats)_mm512_maskz_mov_ps((__mmask16)(set >> 16 * k), _mm512_set1_ps(1));
#else
    return floats_by_column(bits + 8 * (set >> k * FLOATS / 8 * 8 & 255), k);
#endif
}
static inline Doubles doubles_among(const double *bits, unsigned long long set, int k) {
    return doubles_by_column(bits + 8 * (set >> k * DOUBLES / 8 * 8 & 255), k);
}

/* Eight numbers below 256, rounded half up and stored as bytes, negative ones as 0. */
static inline void keep_bytes(const float *v, unsigned char *out) {
#ifdef __SSE2__
#ifdef __AVX2__
    __m256i both = _mm256_cvttps_epi32(_mm256_loadu_ps(v) + _mm256_set1_ps(0.5f));
    __m128i a = _mm256_castsi256_si128(both), b = _mm256_extracti128_si256(both, 1);
#else
    __m128i a = _mm_cvttps_epi32((__m128)(four_at(v) + all_four(0.5f)));
    __m128i b = _mm_cvttps_epi32((__m128)(four_at(v + 4) + all_four(0.5f)));
#endif
    a = _mm_packs_epi32(a, b);
    _mm_storel_epi64((__m128i *)out, _mm_packus_epi16(a, a));
#else
    for (int i = 0; i < 8; i++) {
        float x = v[i] + 0.5f;
        out[i] = x > 0 ? (unsigned char)x : 0;
    }
#endif
}

/* Four vectors, numbers of any size, each rounded half up and stored as a byte 0 … most. */
static inline void pack_bytes(const Floats *v, unsigned char most, unsigned char *out) {
#if LANES == 64
    const __m512 half = _mm512_set1_ps(0.5f);
    const __m512i order = _mm512_setr_epi32(0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15);
    __m512i a = _mm512_packs_epi32(_mm512_cvttps_epi32(v[0] + half), _mm512_cvttps_epi32(v[1] + half));
    __m512i b = _mm512_packs_epi32(_mm512_cvttps_epi32(v[2] + half), _mm512_cvttps_epi32(v[3] + half));
    a = _mm512_permutexvar_epi32(order, _mm512_packus_epi16(a, b));
    _mm512_storeu_si512(out, _mm512_min_epu8(a, _mm512_set1_epi8((char)most)));
#elif LANES == 32
    const __m256 half = _mm256_set1_ps(0.5f);
    const __m256i order = _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7);
    __m256i a = _mm256_packs_epi32(_mm256_cvttps_epi32(v[0] + half), _mm256_cvttps_epi32(v[1] + half));
    __m256i b = _mm256_packs_epi32(_mm256_cvttps_epi32(v[2] + half), _mm256_cvttps_epi32(v[3] + half));
    a = _mm256_permutevar8x32_epi32(_mm256_packus_epi16(a, b), order);
    _mm256_storeu_si256((__m256i *)out, _mm256_min_epu8(a, _mm256_set1_epi8((char)most)));
#elif defined(__SSE2__)
    const __m128 half = _mm_set1_ps(0.5f);
    __m128i a = _mm_packs_epi32(_mm_cvttps_epi32(v[0] + half), _mm_cvttps_epi32(v[1] + half));
    __m128i b = _mm_packs_epi32(_mm_cvttps_epi32(v[2] + half), _mm_cvttps_epi32(v[3] + half));
    _mm_storeu_si128((__m128i *)out, _mm_min_epu8(_mm_packus_epi16(a, b), _mm_set1_epi8((char)most)));
#else
    for (int i = 0; i < PACK; i++) {
        float x = ((const float *)v)[i] + 0.5f;
        out[i] = x > most ? most : x > 0 ? (unsigned char)x : 0;
    }
#endif
}

/* Sixteen sets of eight the other way round: eight sets of sixteen. */
static inline void turn_sets(const unsigned char *sets, int *out) {
#ifdef __SSE2__
    __m128i v;
    memcpy(&v, sets, sizeof v);
    for (int r = 7; r >= 0; r--) {
        out[r] = _mm_movemask_epi8(v);
        v = _mm_add_epi8(v, v);
    }
#else
    for (int r = 0; r < 8; r++) {
        out[r] = 0;
        for (int s = 0; s < 16; s++) out[r] |= (sets[s] >> r & 1) << s;
    }
#endif
}

/* The lowest bit set of a set that is not empty. */
static inline int lowest(unsigned long long set) { return __builtin_ctzll(set); }

#endif
