/* Includes LOOPS twice: for any processor, and for AVX2, whose vectors are twice as wide. Each time VECTOR is the bytes of
 * a vector, and PART(name) what a function or type is called; MAKE(name) is the one that suits the processor, once `lanes`
 * has been set to best_lanes(). LOOPS is a path from this folder.
 *
 * Arithmetic on vectors is that of their numbers, each rounded as it would be alone, and no products are fused: no byte of
 * the output depends on which make is taken.
 */
#define VECTOR 16
#define PART(name) name##_16
#include LOOPS
#undef VECTOR
#undef PART

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#pragma GCC push_options
#pragma GCC target("avx2")
#define VECTOR 32
#define PART(name) name##_32
#include LOOPS
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
