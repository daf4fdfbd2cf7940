/* Sums of products over short runs of doubles, in an order that vectors of two keep: the same bits everywhere. */
#ifndef PENINK_PRODUCTS_H
#define PENINK_PRODUCTS_H

typedef double penink_two __attribute__((vector_size(16), aligned(8), may_alias));

/* a · b over count numbers: four sums, of every fourth product each, added up at the end. */
static inline double dot(const double *a, const double *b, int count) {
    penink_two even = {0.0, 0.0}, odd = {0.0, 0.0};
    double rest = 0.0;
    int k = 0;
    for (; k + 4 <= count; k += 4) {
        even += *(const penink_two *)(a + k) * *(const penink_two *)(b + k);
        odd += *(const penink_two *)(a + k + 2) * *(const penink_two *)(b + k + 2);
    }
    for (; k < count; k++) rest += a[k] * b[k];
    even += odd;
    return (even[0] + even[1]) + rest;
}

/* out += weight · in over count numbers that lie apart. */
static inline void add_scaled(double *restrict out, const double *restrict in, double weight, int count) {
    int k = 0;
    for (; k + 2 <= count; k += 2) *(penink_two *)(out + k) += weight * *(const penink_two *)(in + k);
    for (; k < count; k++) out[k] += weight * in[k];
}

/* out += weight · in, and with it more += other · in. */
static inline void add_scaled_twice(
    double *restrict out, double *restrict more, const double *restrict in, double weight, double other, int count
) {
    int k = 0;
    for (; k + 2 <= count; k += 2) {
        penink_two v = *(const penink_two *)(in + k);
        *(penink_two *)(out + k) += weight * v;
        *(penink_two *)(more + k) += other * v;
    }
    for (; k < count; k++) {
        out[k] += weight * in[k];
        more[k] += other * in[k];
    }
}

/* out = weights[0] · rows[0] + weights[1] · rows[1] + … over width numbers, in that order; 0 of no rows. */
static inline void weighted_rows(double *restrict out, const double *const *rows, const double *weights, int n, int width) {
    int k = 0, d;
    for (; k + 8 <= width; k += 8) { /* four sums that stay in registers */
        penink_two a = {0.0, 0.0}, b = a, c = a, e = a;
        for (d = 0; d < n; d++) {
            const penink_two *row = (const penink_two *)(rows[d] + k);
            a += weights[d] * row[0];
            b += weights[d] * row[1];
            c += weights[d] * row[2];
            e += weights[d] * row[3];
        }
        *(penink_two *)(out + k) = a;
        *(penink_two *)(out + k + 2) = b;
        *(penink_two *)(out + k + 4) = c;
        *(penink_two *)(out + k + 6) = e;
    }
    for (; k + 2 <= width; k += 2) {
        penink_two a = {0.0, 0.0};
        for (d = 0; d < n; d++) a += weights[d] * *(const penink_two *)(rows[d] + k);
        *(penink_two *)(out + k) = a;
    }
    for (; k < width; k++) {
        double a = 0.0;
        for (d = 0; d < n; d++) a += weights[d] * rows[d][k];
        out[k] = a;
    }
}

#endif
