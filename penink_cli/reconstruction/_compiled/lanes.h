/* Numbers side by side: four floats, or as many floats or doubles as the machine computes at once, a *vector*.
 *
 * Left to itself the compiler vectorises the loops over the eight pixels of a row only in part, and keeps their sums in
 * memory. Arithmetic on these types is that of their numbers, each rounded as it would be alone, so the bytes of the
 * output depend neither on them nor on how many there are: sixteen bytes with SSE2 and NEON, thirty-two with AVX2, for
 * which kernels are compiled again. Where there is nothing of it the loops say the same.
 *
 * What it is worth (enlargement of noise by 4 and 8, one thread, 2026): AVX2 takes .65 to .87 of the time of SSE2 with
 * edges, .70 to .74 without. AVX-512 took .95 to 1.02 of the time of AVX2, and was dropped: twins by AVX-512 were 90 lines.
 */
#ifndef PENINK_LANES_H
#define PENINK_LANES_H

#include <math.h>
#include <string.h>

#if defined(__AVX2__)
#define VECTOR_BYTES 32
#else
#define VECTOR_BYTES 16
#endif
#if defined(__x86_64__) && defined(__SSE2__) && defined(__GNUC__)
#include <immintrin.h>
#define MAY_HAVE_AVX2
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

typedef float Four __attribute__((vector_size(16), may_alias));
typedef float Floats __attribute__((vector_size(VECTOR_BYTES), may_alias));
typedef double Doubles __attribute__((vector_size(VECTOR_BYTES), may_alias));

enum {
    FLOATS = VECTOR_BYTES / sizeof(float), /* in one vector */
    DOUBLES = VECTOR_BYTES / sizeof(double),
    FOUR_DOUBLES = 4 / DOUBLES, /* vectors that hold four doubles */
    PACK = 4 * FLOATS /* floats that make a vector of bytes */
};

#define EACH(v) for (unsigned i = 0; i < sizeof(v) / sizeof((v)[0]); i++)

/* The bytes of a vector that the processor this runs on computes at once. */
static inline int vector_bytes_here(void) {
#ifdef MAY_HAVE_AVX2
    return __builtin_cpu_supports("avx2") ? 32 : 16;
#else
    return 16;
#endif
}

static inline Four broadcast_four(float x) { return (Four){x, x, x, x}; }
static inline Four load_four(const float *x) { Four v; memcpy(&v, x, sizeof v); return v; }

#ifdef __SSE2__

static inline Four min_four(Four v, Four w) { return (Four)_mm_min_ps((__m128)v, (__m128)w); }
static inline Four max_four(Four v, Four w) { return (Four)_mm_max_ps((__m128)v, (__m128)w); }
static inline int greater_four(Four v, Four w) { return _mm_movemask_ps(_mm_cmpgt_ps((__m128)v, (__m128)w)); }

#else

static inline Four min_four(Four v, Four w) { EACH(v) v[i] = v[i] < w[i] ? v[i] : w[i]; return v; }
static inline Four max_four(Four v, Four w) { EACH(v) v[i] = v[i] > w[i] ? v[i] : w[i]; return v; }
static inline int greater_four(Four v, Four w) { int m = 0; EACH(v) m |= (v[i] > w[i]) << i; return m; }

#endif

#if VECTOR_BYTES == 32

static inline Floats broadcast_floats(float x) { return (Floats)_mm256_set1_ps(x); }
static inline Doubles broadcast_doubles(double x) { return (Doubles)_mm256_set1_pd(x); }
static inline Floats sqrt_floats(Floats v) { return (Floats)_mm256_sqrt_ps((__m256)v); }
static inline Doubles sqrt_doubles(Doubles v) { return (Doubles)_mm256_sqrt_pd((__m256d)v); }
static inline Floats min_floats(Floats v, Floats w) { return (Floats)_mm256_min_ps((__m256)v, (__m256)w); }
static inline Doubles min_doubles(Doubles v, Doubles w) { return (Doubles)_mm256_min_pd((__m256d)v, (__m256d)w); }
static inline Floats max_floats(Floats v, Floats w) { return (Floats)_mm256_max_ps((__m256)v, (__m256)w); }
static inline Doubles max_doubles(Doubles v, Doubles w) { return (Doubles)_mm256_max_pd((__m256d)v, (__m256d)w); }
static inline int greater_floats(Floats v, Floats w) {
    return _mm256_movemask_ps(_mm256_cmp_ps((__m256)v, (__m256)w, _CMP_GT_OQ));
}
static inline int greater_doubles(Doubles v, Doubles w) {
    return _mm256_movemask_pd(_mm256_cmp_pd((__m256d)v, (__m256d)w, _CMP_GT_OQ));
}

#else

static inline Floats broadcast_floats(float x) { return broadcast_four(x); }
static inline Doubles broadcast_doubles(double x) { return (Doubles){x, x}; }
static inline Floats min_floats(Floats v, Floats w) { return min_four(v, w); }
static inline Floats max_floats(Floats v, Floats w) { return max_four(v, w); }
static inline int greater_floats(Floats v, Floats w) { return greater_four(v, w); }
#ifdef __SSE2__
static inline Floats sqrt_floats(Floats v) { return (Floats)_mm_sqrt_ps((__m128)v); }
static inline Doubles sqrt_doubles(Doubles v) { return (Doubles)_mm_sqrt_pd((__m128d)v); }
static inline Doubles min_doubles(Doubles v, Doubles w) { return (Doubles)_mm_min_pd((__m128d)v, (__m128d)w); }
static inline Doubles max_doubles(Doubles v, Doubles w) { return (Doubles)_mm_max_pd((__m128d)v, (__m128d)w); }
static inline int greater_doubles(Doubles v, Doubles w) {
    return _mm_movemask_pd(_mm_cmpgt_pd((__m128d)v, (__m128d)w));
}
#else
static inline Floats sqrt_floats(Floats v) { EACH(v) v[i] = sqrtf(v[i]); return v; }
static inline Doubles sqrt_doubles(Doubles v) { EACH(v) v[i] = sqrt(v[i]); return v; }
static inline Doubles min_doubles(Doubles v, Doubles w) { EACH(v) v[i] = v[i] < w[i] ? v[i] : w[i]; return v; }
static inline Doubles max_doubles(Doubles v, Doubles w) { EACH(v) v[i] = v[i] > w[i] ? v[i] : w[i]; return v; }
static inline int greater_doubles(Doubles v, Doubles w) { int m = 0; EACH(v) m |= (v[i] > w[i]) << i; return m; }
#endif

#endif

/* The numbers of v where those of t are positive, else those of w. */
static inline Floats select_floats(Floats t, Floats v, Floats w) {
    EACH(v) v[i] = t[i] > 0 ? v[i] : w[i];
    return v;
}
static inline Doubles select_doubles(Doubles t, Doubles v, Doubles w) {
    EACH(v) v[i] = t[i] > 0 ? v[i] : w[i];
    return v;
}

/* The numbers without their sign. */
static inline Four abs_four(Four v) { return max_four(v, -v); }

#ifdef MAY_HAVE_AVX2
/* `negative_pixels` for processors with AVX2, whatever else is compiled for: half the instructions. */
__attribute__((target("avx2"))) static unsigned long long negative_pixels_avx2(float v, float x, float y, float *least) {
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
static inline unsigned long long negative_pixels(float v, float x, float y, float *least, int wide) {
    unsigned long long m = 0;
#ifdef MAY_HAVE_AVX2
    if (wide) return negative_pixels_avx2(v, x, y, least);
#endif
#ifdef __SSE2__
    const Four ramp = {0, 1, 2, 3};
    const Four left = broadcast_four(v) + ramp * broadcast_four(x), right = left + broadcast_four(4 * x);
    const __m128 sign = _mm_set1_ps(-0.0f);
    __m128 closest = _mm_set1_ps(INFINITY);
    __m128i both[8];
    for (int r = 0; r < 8; r++) {
        const Four down = broadcast_four(r * y), a = left + down, b = right + down;
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
    return broadcast_floats(x[k * FLOATS / 8 * stride]);
}
static inline Doubles doubles_by_row(const double *x, int k, int stride) { return broadcast_doubles(x[k * DOUBLES / 8 * stride]); }

/* that of its column, */
static inline Floats floats_by_column(const float *x, int k) {
    Floats v;
    memcpy(&v, x + k * FLOATS % 8, sizeof v);
    return v;
}
static inline Doubles doubles_by_column(const double *x, int k) {
    Doubles v;
    memcpy(&v, x + k * DOUBLES % 8, sizeof v);
    return v;
}

/* and one where it is in a set, else zero; bits: a table of bytes as eight such numbers. */
static inline Floats floats_where(const float *bits, unsigned long long set, int k) {
    return floats_by_column(bits + 8 * (set >> k * FLOATS / 8 * 8 & 255), k);
}
static inline Doubles doubles_where(const double *bits, unsigned long long set, int k) {
    return doubles_by_column(bits + 8 * (set >> k * DOUBLES / 8 * 8 & 255), k);
}

/* Eight numbers below 256, rounded half up and stored as bytes, negative ones as 0. */
static inline void round_to_bytes(const float *v, unsigned char *out) {
#ifdef __SSE2__
#ifdef __AVX2__
    __m256i both = _mm256_cvttps_epi32(_mm256_loadu_ps(v) + _mm256_set1_ps(0.5f));
    __m128i a = _mm256_castsi256_si128(both), b = _mm256_extracti128_si256(both, 1);
#else
    __m128i a = _mm_cvttps_epi32((__m128)(load_four(v) + broadcast_four(0.5f)));
    __m128i b = _mm_cvttps_epi32((__m128)(load_four(v + 4) + broadcast_four(0.5f)));
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
#if VECTOR_BYTES == 32
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
static inline void transpose_sets(const unsigned char *sets, int *out) {
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
