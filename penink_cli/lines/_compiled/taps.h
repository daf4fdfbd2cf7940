/* A row of a picture through one filter: sums of taps that stay in registers, made for any processor and for AVX2.
 *
 * Each place's sum is of its taps in order, each rounded as it would be alone, so no byte depends on the vectors. */
#ifndef PENINK_TAPS_H
#define PENINK_TAPS_H

#include <stddef.h>

#define VECTOR 16
#define PART(name) penink_##name##_16
#include "taps_loop.h"
#undef VECTOR
#undef PART

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#pragma GCC push_options
#pragma GCC target("avx2")
#define VECTOR 32
#define PART(name) penink_##name##_32
#include "taps_loop.h"
#undef VECTOR
#undef PART
#pragma GCC pop_options
static int best_lanes(void) { return __builtin_cpu_supports("avx2") ? 32 : 16; }
#define MAKE(name) (lanes == 32 ? penink_##name##_32 : penink_##name##_16)
#else
static int best_lanes(void) { return 16; }
#define MAKE(name) penink_##name##_16
#endif

static int lanes = 16;

/* out[q] = weight[0] * in[offset[0] + q] + weight[1] * in[offset[1] + q] + …, n taps, for width places. */
#define penink_taps MAKE(sums)

#endif
