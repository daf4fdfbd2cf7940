/* The inner loops of `due.pyx`, made twice: for any processor, and for AVX2, whose vectors are twice as wide.
 *
 * Arithmetic on vectors is that of their numbers, each rounded as it would be alone, and no products are fused: no byte
 * of the output depends on which make is taken.
 */
#ifndef PENINK_DUE_H
#define PENINK_DUE_H

#define BLOCK 16

#define VECTOR 16
#define PART(name) name##_16
#include "due_loops.h"
#undef VECTOR
#undef PART

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#pragma GCC push_options
#pragma GCC target("avx2")
#define VECTOR 32
#define PART(name) name##_32
#include "due_loops.h"
#undef VECTOR
#undef PART
#pragma GCC pop_options
static int best_lanes(void) { return __builtin_cpu_supports("avx2") ? 32 : 16; }
#define MAKE(name) (lanes == 32 ? name##_32 : name##_16)
#else
static int best_lanes(void) { return 16; }
#define MAKE(name) name##_16
#endif

static int lanes = 16;

#define splat_block MAKE(splat)
#define weigh MAKE(weigh)
#define weigh_beside MAKE(weigh_beside)

#endif
