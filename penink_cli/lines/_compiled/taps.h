/* A row of a picture through one filter: sums over taps that stay in registers, compiled for any processor and for AVX2.
 *
 * Each place's sum is of its taps in order, so no byte depends on the vectors. */
#ifndef PENINK_TAPS_H
#define PENINK_TAPS_H

#include <stddef.h>

#define LOOPS "../../lines/_compiled/taps_loop.h"
#include "../../ground/_compiled/twice.h"

/* out[q] = weight[0] * in[offset[0] + q] + weight[1] * in[offset[1] + q] + …, n taps, for width places. */
#define penink_taps MAKE(sums)

#endif
