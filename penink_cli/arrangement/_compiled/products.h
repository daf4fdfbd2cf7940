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

#endif
