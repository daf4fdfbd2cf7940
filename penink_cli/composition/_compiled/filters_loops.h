/* The loops of `filters.h`, with VECTOR bytes to a vector: sums stay in registers until all their parts are in them. Each
 * place's parts are added up in order, so no byte depends on the vectors. */

typedef float PART(places) __attribute__((vector_size(VECTOR), aligned(4), may_alias));
typedef unsigned char PART(bytes) __attribute__((vector_size(VECTOR / 4), aligned(1), may_alias));
typedef unsigned short PART(shorts) __attribute__((vector_size(VECTOR / 2), aligned(2), may_alias));

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
 * parts of whole. */
#define SUMMED(name, type, vector, OVER) \
    static void PART(name)( \
        const type *const *row, const float *restrict part, ptrdiff_t n, float whole, float *restrict out, \
        ptrdiff_t width \
    ) { \
        const ptrdiff_t lanes = VECTOR / sizeof(float); \
        ptrdiff_t q = 0, k; \
        (void)whole; \
        for (; q + 4 * lanes <= width; q += 4 * lanes) { \
            PART(places) a = {0}, b = a, c = a, d = a; \
            for (k = 0; k < n; k++) { \
                const PART(vector) *r = (const PART(vector) *)(row[k] + q); \
                a += part[k] * (__builtin_convertvector(r[0], PART(places)) OVER); \
                b += part[k] * (__builtin_convertvector(r[1], PART(places)) OVER); \
                c += part[k] * (__builtin_convertvector(r[2], PART(places)) OVER); \
                d += part[k] * (__builtin_convertvector(r[3], PART(places)) OVER); \
            } \
            PART(places) *o = (PART(places) *)(out + q); \
            o[0] = a, o[1] = b, o[2] = c, o[3] = d; \
        } \
        for (; q < width; q++) { \
            float a = 0; \
            for (k = 0; k < n; k++) a += part[k] * ((float)row[k][q] OVER); \
            out[q] = a; \
        } \
    }
SUMMED(bytes_summed, unsigned char, bytes, )
SUMMED(bytes_divided, unsigned char, bytes, / whole)
SUMMED(shorts_summed, unsigned short, shorts, )
SUMMED(shorts_divided, unsigned short, shorts, / whole)
SUMMED(floats_summed, float, places, )
#undef SUMMED
