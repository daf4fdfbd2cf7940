/* The loops of `filters.h`, with VECTOR bytes to a vector: sums stay in registers until all their parts are in them. Each
 * place's parts are added up in order, so no byte depends on the vectors. */

typedef float PART(places) __attribute__((vector_size(VECTOR), aligned(4), may_alias));

/* out[q] = weight[0] * before[0][q] + weight[1] * (before[1][q] + after[1][q]) + …, n of them, for width places. */
static void PART(symmetric)(
    const float *const *before, const float *const *after, const float *restrict weight, ptrdiff_t n,
    float *restrict out, ptrdiff_t width
) {
    const ptrdiff_t lanes = VECTOR / sizeof(float);
    ptrdiff_t q = 0, k;
    for (; q + 4 * lanes <= width; q += 4 * lanes) {
        const PART(places) *u = (const PART(places) *)(before[0] + q), *v;
        PART(places) a = weight[0] * u[0], b = weight[0] * u[1], c = weight[0] * u[2], d = weight[0] * u[3];
        for (k = 1; k < n; k++) {
            u = (const PART(places) *)(before[k] + q), v = (const PART(places) *)(after[k] + q);
            a += weight[k] * (u[0] + v[0]);
            b += weight[k] * (u[1] + v[1]);
            c += weight[k] * (u[2] + v[2]);
            d += weight[k] * (u[3] + v[3]);
        }
        PART(places) *o = (PART(places) *)(out + q);
        o[0] = a, o[1] = b, o[2] = c, o[3] = d;
    }
    for (; q < width; q++) {
        float a = weight[0] * before[0][q];
        for (k = 1; k < n; k++) a += weight[k] * (before[k][q] + after[k][q]);
        out[q] = a;
    }
}

/* out[q] = part[0] * row[0][q] + part[1] * row[1][q] + …, n rows of that type, for width places; what is `divided` is in
 * parts of whole. So many places at a time that their sums stay near. */
#define SUMMED(name, type, OVER) \
    static void PART(name)( \
        const type *const *row, const float *restrict part, ptrdiff_t n, float whole, float *restrict out, \
        ptrdiff_t width \
    ) { \
        (void)whole; \
        for (ptrdiff_t q = 0; q < width; q += 512) { \
            ptrdiff_t count = width - q < 512 ? width - q : 512; \
            float *restrict sum = out + q; \
            for (ptrdiff_t j = 0; j < count; j++) sum[j] = part[0] * ((float)row[0][q + j] OVER); \
            for (ptrdiff_t k = 1; k < n; k++) { \
                const type *restrict r = row[k] + q; \
                const float by = part[k]; \
                for (ptrdiff_t j = 0; j < count; j++) sum[j] += by * ((float)r[j] OVER); \
            } \
        } \
    }
SUMMED(bytes_summed, unsigned char, )
SUMMED(bytes_divided, unsigned char, / whole)
SUMMED(shorts_summed, unsigned short, )
SUMMED(shorts_divided, unsigned short, / whole)
SUMMED(floats_summed, float, )
#undef SUMMED

/* Each of w pixels of so many channels: the sum of its parts of a row, times area. part[begin[x]] … are those of pixel x,
 * the first of which is the row's pixel column[x]. Channels are added up three at a time, or one by one. */
static inline void PART(of_channels)(
    const float *restrict row, const float *restrict part, const ptrdiff_t *begin, const ptrdiff_t *column, float area,
    float *restrict out, ptrdiff_t w, ptrdiff_t channels, const int three
) {
    for (ptrdiff_t x = 0; x < w; x++) {
        const float *r = row + column[x] * channels;
        float a = 0.0f, b = 0.0f, c = 0.0f;
        for (ptrdiff_t q = begin[x]; q < begin[x + 1]; q++, r += channels) {
            a += part[q] * r[0];
            if (three) b += part[q] * r[1], c += part[q] * r[2];
        }
        out[channels * x] = a * area;
        if (three) out[channels * x + 1] = b * area, out[channels * x + 2] = c * area;
    }
}

static void PART(gathered)(
    const float *row, const float *part, const ptrdiff_t *begin, const ptrdiff_t *column, float area, float *out,
    ptrdiff_t w, ptrdiff_t channels
) {
    ptrdiff_t c = 0;
    for (; c + 3 <= channels; c += 3) PART(of_channels)(row + c, part, begin, column, area, out + c, w, channels, 1);
    for (; c < channels; c++) PART(of_channels)(row + c, part, begin, column, area, out + c, w, channels, 0);
}
