/* A row of a picture through one filter: sums of taps that stay in registers, four places to a vector.
 *
 * Each place's sum is of its taps in order, each rounded as it would be alone, so no byte depends on the vectors. */
#ifndef PENINK_TAPS_H
#define PENINK_TAPS_H

#include <stddef.h>

typedef float penink_four __attribute__((vector_size(16), aligned(4), may_alias));

/* out[q] = weight[0] * in[offset[0] + q] + weight[1] * in[offset[1] + q] + …, n taps, for width places. */
static void penink_taps(
    const float *restrict in, const ptrdiff_t *restrict offset, const float *restrict weight, ptrdiff_t n,
    float *restrict out, ptrdiff_t width
) {
    ptrdiff_t q = 0, t;
    for (; q + 32 <= width; q += 32) {
        penink_four a = {0, 0, 0, 0}, b = a, c = a, d = a, e = a, f = a, g = a, h = a;
        for (t = 0; t < n; t++) {
            const penink_four *p = (const penink_four *)(in + offset[t] + q);
            float w = weight[t];
            a += w * p[0];
            b += w * p[1];
            c += w * p[2];
            d += w * p[3];
            e += w * p[4];
            f += w * p[5];
            g += w * p[6];
            h += w * p[7];
        }
        penink_four *o = (penink_four *)(out + q);
        o[0] = a, o[1] = b, o[2] = c, o[3] = d, o[4] = e, o[5] = f, o[6] = g, o[7] = h;
    }
    for (; q + 4 <= width; q += 4) {
        penink_four a = {0, 0, 0, 0};
        for (t = 0; t < n; t++) a += weight[t] * *(const penink_four *)(in + offset[t] + q);
        *(penink_four *)(out + q) = a;
    }
    for (; q < width; q++) {
        float a = 0;
        for (t = 0; t < n; t++) a += weight[t] * in[offset[t] + q];
        out[q] = a;
    }
}

#endif
