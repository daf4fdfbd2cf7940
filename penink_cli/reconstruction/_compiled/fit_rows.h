/* A row of pixels, each of which depends on 5 × 5 samples, from these and back to them: see fit.pyx.
 *
 * Every number is a sum in the order of the plain loops, four columns of samples to a vector and the fifth beside them,
 * so no byte depends on vectors. */
#ifndef PENINK_FIT_ROWS_H
#define PENINK_FIT_ROWS_H

#include <stddef.h>

typedef float penink_columns __attribute__((vector_size(16), aligned(4), may_alias));

/* out[q] = Σ weight[q][5 i + j] · samples[i][base[q] + j], for n pixels. */
static void see_row(
    const float *restrict weight, const int *restrict base, const float *restrict samples, ptrdiff_t stride,
    float *restrict out, ptrdiff_t n
) {
    for (ptrdiff_t q = 0; q < n; q++) {
        const float *w = weight + 25 * q, *s = samples + base[q];
        penink_columns sums = {0};
        float fifth = 0;
        for (int i = 0; i < 5; i++) {
            sums += *(const penink_columns *)(w + 5 * i) * *(const penink_columns *)(s + i * stride);
            fifth += w[5 * i + 4] * s[i * stride + 4];
        }
        out[q] = (sums[0] + sums[1]) + (sums[2] + sums[3]) + fifth;
    }
}

/* samples[i][base[q] + j] += weight[q][5 i + j] · pixels[q]; neighbours mostly have the same samples, which stay in
 * registers so long. */
static void unsee_row(
    const float *restrict weight, const int *restrict base, float *restrict samples, ptrdiff_t stride,
    const float *restrict pixels, ptrdiff_t n
) {
    for (ptrdiff_t q = 0; q < n;) {
        float *s = samples + base[q];
        int here = base[q];
        penink_columns sums[5];
        float fifth[5];
        for (int i = 0; i < 5; i++) {
            sums[i] = *(const penink_columns *)(s + i * stride);
            fifth[i] = s[i * stride + 4];
        }
        for (; q < n && base[q] == here; q++) {
            const float *w = weight + 25 * q;
            for (int i = 0; i < 5; i++) {
                sums[i] += *(const penink_columns *)(w + 5 * i) * pixels[q];
                fifth[i] += w[5 * i + 4] * pixels[q];
            }
        }
        for (int i = 0; i < 5; i++) {
            *(penink_columns *)(s + i * stride) = sums[i];
            s[i * stride + 4] = fifth[i];
        }
    }
}

#endif
