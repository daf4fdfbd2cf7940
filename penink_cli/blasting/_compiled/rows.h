/* What 16 rows of subpixels meet of a bar, four rows at once.
 *
 * Left to itself the compiler does these one by one. Arithmetic on vectors is that of their numbers, each rounded as it
 * would be alone, so no byte of the output depends on them. Floats are exact here to a thousandth of a subpixel.
 */
#ifndef PENINK_ROWS_H
#define PENINK_ROWS_H

#include <string.h>

typedef float Places __attribute__((vector_size(16)));
typedef int Wholes __attribute__((vector_size(16)));
typedef unsigned long long Words __attribute__((vector_size(16)));

/* The lines along a bar's ends and sides: across a row d below its start the bar's rectangle reaches from the larger of
 * two of them, lo + rate * d, to the smaller of two others. */
typedef struct { float end_rate, end_lo, end_hi, side_rate, side_lo, side_hi; } Outline;

static inline Places all_places(float x) { return (Places){x, x, x, x}; }

#ifdef __SSE2__
#include <emmintrin.h>
static inline Places nearer(Places v, Places w) { return (Places)_mm_min_ps((__m128)v, (__m128)w); }
static inline Places farther(Places v, Places w) { return (Places)_mm_max_ps((__m128)v, (__m128)w); }
#else
static inline Places nearer(Places v, Places w) {
    for (int i = 0; i < 4; i++) v[i] = v[i] < w[i] ? v[i] : w[i];
    return v;
}
static inline Places farther(Places v, Places w) {
    for (int i = 0; i < 4; i++) v[i] = v[i] > w[i] ? v[i] : w[i];
    return v;
}
#endif

/* Where rows d, d + 1, … below a bar's start meet its rectangle: from lo to hi. */
static inline void meet_rows(const Outline *bar, float d, long count, float *lo, float *hi) {
    Places row = all_places(d) + (Places){0, 1, 2, 3};
    for (long n = 0; n < count; n += 4) {
        Places end = all_places(bar->end_rate) * row, side = all_places(bar->side_rate) * row;
        Places from = farther(all_places(bar->end_lo) + end, all_places(bar->side_lo) + side);
        Places to = nearer(all_places(bar->end_hi) + end, all_places(bar->side_hi) + side);
        memcpy(lo + n, &from, sizeof from);
        memcpy(hi + n, &to, sizeof to);
        row += all_places(4);
    }
}

/* Places plus x, clipped to 0 … most, to whole numbers by truncation. */
static inline void whole_places(const float *at, float x, float most, long count, int *out) {
    for (long n = 0; n < count; n += 4) {
        Places v;
        memcpy(&v, at + n, sizeof v);
        v = nearer(farther(v + all_places(x), all_places(0)), all_places(most));
        Wholes whole = __builtin_convertvector(v, Wholes);
        memcpy(out + n, &whole, sizeof whole);
    }
}

/* How many bits are set in words, 16 at the most; what fills the last pair is 0. */
static inline int bits_set(const unsigned long long *words, long count) {
    const unsigned long long pairs = 0x3333333333333333ull, halves = 0x0F0F0F0F0F0F0F0Full;
    Words total = {0, 0};
    for (long n = 0; n < count; n += 2) {
        Words v;
        memcpy(&v, words + n, sizeof v);
        v -= (v >> 1) & 0x5555555555555555ull;
        v = (v & pairs) + ((v >> 2) & pairs);
        total += (v + (v >> 4)) & halves;
    }
    total = (total & 0x00FF00FF00FF00FFull) + ((total >> 8) & 0x00FF00FF00FF00FFull);
    return (int)(((total[0] + total[1]) * 0x0001000100010001ull) >> 48);
}

#endif
