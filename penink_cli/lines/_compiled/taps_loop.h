/* The loop of `taps.h`, with VECTOR bytes to a vector; PART makes the names. */

typedef float PART(places) __attribute__((vector_size(VECTOR), aligned(4), may_alias));

static void PART(sums)(
    const float *restrict in, const ptrdiff_t *restrict offset, const float *restrict weight, ptrdiff_t n,
    float *restrict out, ptrdiff_t width
) {
    const ptrdiff_t lanes = VECTOR / sizeof(float);
    ptrdiff_t q = 0, t;
    for (; q + 8 * lanes <= width; q += 8 * lanes) {
        PART(places) a = {0}, b = a, c = a, d = a, e = a, f = a, g = a, h = a;
        for (t = 0; t < n; t++) {
            const PART(places) *p = (const PART(places) *)(in + offset[t] + q);
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
        PART(places) *o = (PART(places) *)(out + q);
        o[0] = a, o[1] = b, o[2] = c, o[3] = d, o[4] = e, o[5] = f, o[6] = g, o[7] = h;
    }
    for (; q + lanes <= width; q += lanes) {
        PART(places) a = {0};
        for (t = 0; t < n; t++) a += weight[t] * *(const PART(places) *)(in + offset[t] + q);
        *(PART(places) *)(out + q) = a;
    }
    for (; q < width; q++) {
        float a = 0;
        for (t = 0; t < n; t++) a += weight[t] * in[offset[t] + q];
        out[q] = a;
    }
}
