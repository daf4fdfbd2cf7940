/* The inner loops of `due.pyx`, over blocks of 16 cells of a row: sums that stay in registers.
 *
 * Included by due.h once for each width of vectors: PART(name) is the name of that make, VECTOR its bytes.
 */

typedef float PART(Numbers) __attribute__((vector_size(VECTOR), aligned(4), may_alias));
typedef int PART(Chosen) __attribute__((vector_size(VECTOR), aligned(4), may_alias));

#define NUMBERS PART(Numbers)
#define CHOSEN PART(Chosen)
#define WIDTH (VECTOR / 4)
#define AT(place) (*(const NUMBERS *)(place))
#define EACH_VECTOR _Pragma("GCC unroll 4") for (int m = 0; m < BLOCK / WIDTH; m++)

static inline NUMBERS PART(all)(float x) { return (NUMBERS){0} + x; }

/* Values where the guide is near what it is here, else 0. */
static inline NUMBERS PART(beside)(NUMBERS values, NUMBERS guide, NUMBERS here, NUMBERS step) {
    return (NUMBERS)((CHOSEN)values & ((NUMBERS)((CHOSEN)(guide - here) & 0x7fffffff) < step));
}

/* Take so many rows of the kernel (each 16 long) times ink from the residual, where the guide is near. */
static void PART(splat)(
    float *residual, const float *guide, long wide, const float *kernel, long rows, float here, float ink, float step
) {
    NUMBERS from = PART(all)(here), least = PART(all)(step), amount = PART(all)(ink);
    for (long i = 0; i < rows; i++) {
        float *out = residual + wide * i;
        EACH_VECTOR *(NUMBERS *)(out + WIDTH * m) -= PART(beside)(
            amount * AT(kernel + BLOCK * i + WIDTH * m), AT(guide + wide * i + WIDTH * m), from, least
        );
    }
}

/* out = line[0] · rows[0] + line[1] · rows[1] + … over so many blocks; rows are `apart` from each other. */
static void PART(weigh)(
    float *restrict out, const float *restrict rows, long apart, const float *restrict line, long n, long blocks
) {
    for (long b = 0; b < blocks; b++) {
        NUMBERS sum[BLOCK / WIDTH];
        EACH_VECTOR sum[m] = PART(all)(0);
        for (long i = 0; i < n; i++) {
            NUMBERS weight = PART(all)(line[i]);
            EACH_VECTOR sum[m] += weight * AT(rows + apart * i + BLOCK * b + WIDTH * m);
        }
        EACH_VECTOR *(NUMBERS *)(out + BLOCK * b + WIDTH * m) = sum[m];
    }
}

/* out = kernel · values over one block, of what lies where the guide is near what it is at each cell.
 * values, guide: the first of n rows `wide` apart, of n + 15. kernel: (n, 16), its rows end in zeros: two of its columns
 * at a time, whose products are added first. */
static void PART(weigh_beside)(
    float *restrict out, const float *restrict values, const float *restrict guide, long wide,
    const float *restrict kernel, long n, float step
) {
    NUMBERS sum[BLOCK / WIDTH], here[BLOCK / WIDTH], least = PART(all)(step);
    EACH_VECTOR sum[m] = PART(all)(0);
    EACH_VECTOR here[m] = AT(guide + wide * (n / 2) + n / 2 + WIDTH * m);
    for (long i = 0; i < n; i++) {
        for (long j = 0; j < n; j += 2) {
            const float *v = values + wide * i + j, *g = guide + wide * i + j, *k = kernel + BLOCK * i + j;
            NUMBERS one = PART(all)(k[0]), other = PART(all)(k[1]);
            EACH_VECTOR sum[m] += PART(beside)(one * AT(v + WIDTH * m), AT(g + WIDTH * m), here[m], least)
                + PART(beside)(other * AT(v + 1 + WIDTH * m), AT(g + 1 + WIDTH * m), here[m], least);
        }
    }
    EACH_VECTOR *(NUMBERS *)(out + WIDTH * m) = sum[m];
}

#undef NUMBERS
#undef CHOSEN
#undef WIDTH
#undef AT
#undef EACH_VECTOR
