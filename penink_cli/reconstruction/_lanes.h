/* Numbers side by side, four floats or two doubles: what SSE2 and NEON compute at once.
 *
 * Left to itself the compiler vectorises the loops over the eight pixels of a row only in part, and keeps their sums in
 * memory. Arithmetic on these types is that of their numbers, each rounded as it would be alone, so the bytes of the
 * output do not depend on them. Where there is no SSE2 the loops say the same.
 */
#ifndef PENINK_LANES_H
#define PENINK_LANES_H

#include <math.h>
#include <string.h>

typedef float Four __attribute__((vector_size(16), may_alias));
typedef double Two __attribute__((vector_size(16), may_alias));

#ifdef __SSE2__
#include <emmintrin.h>
#endif

static inline Four all_four(float x) { return (Four){x, x, x, x}; }
static inline Two all_two(double x) { return (Two){x, x}; }
static inline Four four_at(const float *x) { Four v; memcpy(&v, x, sizeof v); return v; }

/* Number i of all, in every place. */
static inline Four lane_four(Four v, int i) { return all_four(v[i]); }
static inline Two lane_two(Two v, int i) { return all_two(v[i]); }

#ifdef __SSE2__

static inline Four root_four(Four v) { return (Four)_mm_sqrt_ps((__m128)v); }
static inline Two root_two(Two v) { return (Two)_mm_sqrt_pd((__m128d)v); }
static inline Four less_four(Four v, Four w) { return (Four)_mm_min_ps((__m128)v, (__m128)w); }
static inline Two less_two(Two v, Two w) { return (Two)_mm_min_pd((__m128d)v, (__m128d)w); }
static inline Four more_four(Four v, Four w) { return (Four)_mm_max_ps((__m128)v, (__m128)w); }
static inline Two more_two(Two v, Two w) { return (Two)_mm_max_pd((__m128d)v, (__m128d)w); }
static inline int above_four(Four v, Four w) { return _mm_movemask_ps(_mm_cmpgt_ps((__m128)v, (__m128)w)); }
static inline int above_two(Two v, Two w) { return _mm_movemask_pd(_mm_cmpgt_pd((__m128d)v, (__m128d)w)); }

#else

#define EACH(v) for (unsigned i = 0; i < sizeof(v) / sizeof((v)[0]); i++)
static inline Four root_four(Four v) { EACH(v) v[i] = sqrtf(v[i]); return v; }
static inline Two root_two(Two v) { EACH(v) v[i] = sqrt(v[i]); return v; }
static inline Four less_four(Four v, Four w) { EACH(v) v[i] = v[i] < w[i] ? v[i] : w[i]; return v; }
static inline Two less_two(Two v, Two w) { EACH(v) v[i] = v[i] < w[i] ? v[i] : w[i]; return v; }
static inline Four more_four(Four v, Four w) { EACH(v) v[i] = v[i] > w[i] ? v[i] : w[i]; return v; }
static inline Two more_two(Two v, Two w) { EACH(v) v[i] = v[i] > w[i] ? v[i] : w[i]; return v; }
static inline int above_four(Four v, Four w) { int m = 0; EACH(v) m |= (v[i] > w[i]) << i; return m; }
static inline int above_two(Two v, Two w) { int m = 0; EACH(v) m |= (v[i] > w[i]) << i; return m; }

#endif

/* The numbers of v where those of t are positive, else those of w. */
static inline Four chosen_four(Four t, Four v, Four w) {
    for (int i = 0; i < 4; i++) v[i] = t[i] > 0 ? v[i] : w[i];
    return v;
}
static inline Two chosen_two(Two t, Two v, Two w) {
    for (int i = 0; i < 2; i++) v[i] = t[i] > 0 ? v[i] : w[i];
    return v;
}

/* The numbers without their sign. */
static inline Four size_four(Four v) { return more_four(v, -v); }

/* Which numbers, −1 … 9, are closer than so much to a whole one. */
static inline int close_four(Four v, float limit) {
#ifdef __SSE2__
    Four off = v - (Four)_mm_cvtepi32_ps(_mm_cvtps_epi32((__m128)v));
#else
    Four off;
    EACH(v) off[i] = v[i] - rintf(v[i]);
#endif
    return above_four(all_four(limit), size_four(off));
}

/* A tile of 8 × 8 pixels, pixel (r, c) at bit 8 r + c: those with c > v_r, the eight v above −1 and below 9. */
static inline unsigned long long beyond_in_rows(Four low, Four high) {
#ifdef __SSE2__
    const __m128i c = _mm_setr_epi8(0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7);
    __m128i a = _mm_cvttps_epi32((__m128)(low + all_four(1))), b = _mm_cvttps_epi32((__m128)(high + all_four(1)));
    a = _mm_packs_epi32(a, b);
    a = _mm_packs_epi16(a, a);
    a = _mm_unpacklo_epi8(a, a);
    b = _mm_unpackhi_epi16(a, a);
    a = _mm_unpacklo_epi16(a, a);
    unsigned m0 = _mm_movemask_epi8(_mm_cmpgt_epi8(_mm_unpacklo_epi32(a, a), c));
    unsigned m1 = _mm_movemask_epi8(_mm_cmpgt_epi8(_mm_unpackhi_epi32(a, a), c));
    unsigned m2 = _mm_movemask_epi8(_mm_cmpgt_epi8(_mm_unpacklo_epi32(b, b), c));
    unsigned m3 = _mm_movemask_epi8(_mm_cmpgt_epi8(_mm_unpackhi_epi32(b, b), c));
    return ~((unsigned long long)(m2 | m3 << 16) << 32 | (m0 | m1 << 16));
#else
    unsigned long long m = 0;
    for (int r = 0; r < 8; r++)
        m |= (unsigned long long)(0xFF & 0xFF << (int)((r < 4 ? low[r] : high[r - 4]) + 1)) << 8 * r;
    return m;
#endif
}

/* Likewise those with r > v_c. */
static inline unsigned long long beyond_in_columns(Four low, Four high) {
#ifdef __SSE2__
    const __m128i two = _mm_set1_epi8(2);
    __m128i r = _mm_setr_epi8(0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1);
    __m128i a = _mm_cvttps_epi32((__m128)(low + all_four(1))), b = _mm_cvttps_epi32((__m128)(high + all_four(1)));
    a = _mm_packs_epi32(a, b);
    a = _mm_packs_epi16(a, a);
    unsigned m0 = _mm_movemask_epi8(_mm_cmpgt_epi8(a, r));
    r = _mm_add_epi8(r, two);
    unsigned m1 = _mm_movemask_epi8(_mm_cmpgt_epi8(a, r));
    r = _mm_add_epi8(r, two);
    unsigned m2 = _mm_movemask_epi8(_mm_cmpgt_epi8(a, r));
    r = _mm_add_epi8(r, two);
    unsigned m3 = _mm_movemask_epi8(_mm_cmpgt_epi8(a, r));
    return ~((unsigned long long)(m2 | m3 << 16) << 32 | (m0 | m1 << 16));
#else
    unsigned long long m = 0;
    for (int c = 0; c < 8; c++) {
        int first = (int)((c < 4 ? low[c] : high[c - 4]) + 1);
        m |= first < 8 ? 0x0101010101010101ULL << (8 * first + c) : 0;
    }
    return m;
#endif
}

/* Eight numbers below 256, rounded half up and stored as bytes, negative ones as 0. */
static inline void keep_bytes(Four low, Four high, unsigned char *out) {
#ifdef __SSE2__
    __m128i a = _mm_cvttps_epi32((__m128)(low + all_four(0.5f)));
    __m128i b = _mm_cvttps_epi32((__m128)(high + all_four(0.5f)));
    a = _mm_packs_epi32(a, b);
    _mm_storel_epi64((__m128i *)out, _mm_packus_epi16(a, a));
#else
    for (int i = 0; i < 8; i++) {
        float v = (i < 4 ? low[i] : high[i - 4]) + 0.5f;
        out[i] = v > 0 ? (unsigned char)v : 0;
    }
#endif
}

/* The lowest bit set of a set that is not empty. */
static inline int lowest(unsigned long long set) { return __builtin_ctzll(set); }

#endif
