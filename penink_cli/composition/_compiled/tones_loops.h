/* The loops of `tones.h` over n pixels: what composing does to each, greys being 0 ink … 1 paper. One pixel has no part in
 * another, so that the compiler makes vectors of them. All numbers are floats, as numpy would have them. */

#ifndef TONES
#define TONES

/* The weight of places without activity; the most that activity adds. */
#define BACKGROUND 0.25f
#define MOST_BUSY 1.5f
/* Relief as light as LIGHTS does not count as lifted by the exposure; relief darker than that by MIDDLE wholly does. */
#define LIGHTS 0.75f
#define MIDDLE 0.2
/* A broad tone lighter than SHINES is a highlight and in no relief; one darker than that by NEARLY may wholly be. */
#define SHINES 0.90f
#define NEARLY 0.15
/* Where the grey around is darker than NOT_DEEP, tones go down; where darker than ALL_DEEP, by SINK. So all of a dark
 * cloth becomes black, and not parts of it. Places that are lighter than STAYS themselves stay. */
#define SINK 0.07f
#define ALL_DEEP 0.13
#define NOT_DEEP 0.21
#define STAYS 0.3
/* A pen cannot show relief in light tones. So where the exposure has made relief lighter by more than LIFT, TAKEN_BACK of
 * the excess is taken back. Greys in relief above DOWN_TO come down by DOWN of what they are above it. */
#define LIFT 0.12f
#define TAKEN_BACK 0.6f
#define DOWN_TO 0.6f
#define DOWN 0.4f
/* Where the exposure has made relief lighter by LIFTED or more, detail is raised by CARVED more, in relief by DEEPER. */
#define LIFTED 0.25
#define CARVED 0.35
#define DEEPER 0.5f
/* Detail finer than broad is grain, as of grass, if it is at least GRAIN times as strong as broader detail. At ALL_GRAIN
 * times only GRAIN_LEFT of the detail is raised. */
#define GRAIN 0.6
#define ALL_GRAIN 0.95
#define GRAIN_LEFT 0.4
/* The share of detail that is kept of what is too fine for a pen; the grey towards which detail grows ever slower. */
#define FINE_SHARE 0.4f
#define LIMIT 0.4
/* Where detail is stronger than STRONG, greys above LIGHT come down; where it is stronger by RANGE, they come down by SUNK
 * of what they are above it. */
#define STRONG 0.045f
#define RANGE 0.05f
#define SUNK 0.6f
#define LIGHT 0.60f

static inline float clipped(float v, float low, float high) {
    v = v > low ? v : low;
    return v < high ? v : high;
}

static inline float above(float v, float low) { return v > low ? v : low; }

static inline float below(float v, float high) { return v < high ? v : high; }

/* The square root of blurred squares, which rounding may leave a little below 0. */
static inline float root(float square) { return sqrtf(above(square, 0.0f)); }

/* Values that grow ever slower towards ±LIMIT. */
static inline float limited(float v) {
    float part = v * (float)(1 / LIMIT);
    return v / sqrtf(1.0f + part * part);
}

#endif

/* Greys so that `low` is 0, and what is 1 / by lighter 1. */
static void PART(stretched)(const float *restrict grey, float low, float by, float *restrict out, long n) {
    for (long k = 0; k < n; k++) out[k] = clipped((grey[k] - low) * by, 0.0f, 1.0f);
}

/* The base that a guided filter makes of grey. */
static void PART(based)(
    const float *restrict grey, const float *restrict slope, const float *restrict offset, float *restrict out, long n
) {
    for (long k = 0; k < n; k++) out[k] = clipped(slope[k] * grey[k] + offset[k], 0.0f, 1.0f);
}

/* The square of what lies between two low-passes, less what is noise. */
static void PART(stirred)(
    const float *restrict fine, const float *restrict broad, float noise, float *restrict out, long n
) {
    for (long k = 0; k < n; k++) {
        float band = fine[k] - broad[k];
        out[k] = above(band * band - noise, 0.0f);
    }
}

static void PART(rooted)(const float *restrict square, float *restrict out, long n) {
    for (long k = 0; k < n; k++) out[k] = root(square[k]);
}

/* How much each place counts for the exposure. */
static void PART(weighed)(const float *restrict activity, float by, float *restrict out, long n) {
    for (long k = 0; k < n; k++) out[k] = BACKGROUND + below(activity[k] * by, MOST_BUSY);
}

/* By how much relief is lighter for the exposure. */
static void PART(lifted_by)(
    const float *restrict carved, const float *restrict exposed, const float *restrict broad, float key,
    float *restrict out, long n
) {
    for (long k = 0; k < n; k++) {
        float lifted = key * carved[k] * (exposed[k] - broad[k]);
        out[k] = lifted * clipped((LIGHTS - broad[k]) * (float)(1 / MIDDLE), 0.0f, 1.0f);
    }
}

static void PART(without_shine)(const float *restrict carved, const float *restrict broad, float *restrict out, long n) {
    for (long k = 0; k < n; k++) out[k] = carved[k] * clipped((SHINES - broad[k]) * (float)(1 / NEARLY), 0.0f, 1.0f);
}

/* Lights from `light` on rise by `more` of what they exceed it by, to `paper` at the most, unless they are in relief. */
static void PART(blanked)(
    const float *restrict grey, const float *restrict carved, float light, float more, float paper, float *restrict out,
    long n
) {
    for (long k = 0; k < n; k++) {
        float over = above(grey[k] - light, 0.0f);
        out[k] = grey[k] + below(more * over, above(paper - grey[k], 0.0f)) * (1.0f - carved[k]);
    }
}

static void PART(sunk)(const float *restrict grey, const float *restrict around, float *restrict out, long n) {
    for (long k = 0; k < n; k++) {
        float deep = clipped(((float)NOT_DEEP - around[k]) * (float)(1 / (NOT_DEEP - ALL_DEEP)), 0.0f, 1.0f);
        deep *= clipped(((float)STAYS - grey[k]) * (float)(1 / STAYS), 0.0f, 1.0f) * 2.0f;
        out[k] = above(grey[k] - SINK * below(deep, 1.0f), 0.0f);
    }
}

static void PART(less_light)(
    const float *restrict lights, const float *restrict lifted, const float *restrict carved, float *restrict out, long n
) {
    for (long k = 0; k < n; k++) {
        float light = lights[k] - TAKEN_BACK * above(lifted[k] - LIFT, 0.0f);
        out[k] = light - DOWN * carved[k] * above(light - DOWN_TO, 0.0f);
    }
}

/* How much detail is raised: usual is what detail of its strength is raised by, slope the exposure's. */
static void PART(gained)(
    const float *restrict usual, const float *restrict slope, const float *restrict lifted, const float *restrict carved,
    const float *restrict grain, const float *restrict coarse, float gain, float *restrict out, long n
) {
    for (long k = 0; k < n; k++) {
        float each = usual[k] * (gain * clipped(slope[k], 0.8f, 1.4f));
        each *= 1.0f + (float)(CARVED / LIFTED) * clipped(lifted[k], 0.0f, (float)LIFTED);
        each *= 1.0f + DEEPER * carved[k];
        float fine = root(grain[k]) / (root(coarse[k]) + 0.004f);
        float share = clipped((fine - (float)GRAIN) * (float)(1 / (ALL_GRAIN - GRAIN)), 0.0f, 1.0f);
        out[k] = each * (1.0f - (float)(1 - GRAIN_LEFT) * share);
    }
}

/* Detail, damped to 15 % where it is no stronger than noise of that level. */
static void PART(guarded)(
    const float *restrict values, const float *restrict variance, float level, float twice, float *restrict out, long n
) {
    for (long k = 0; k < n; k++) out[k] = values[k] * clipped((root(variance[k]) - level) / twice, 0.15f, 1.0f);
}

static void PART(drawn)(
    const float *restrict each, const float *restrict middle, const float *restrict fine, float *restrict out, long n
) {
    for (long k = 0; k < n; k++) out[k] = limited(each[k] * middle[k]) + FINE_SHARE * each[k] * fine[k];
}

/* Lights with the raised detail upon them. It needs room on both sides: where it is strong, lights come down to carry it,
 * and darks rise a little. */
static void PART(with_room)(
    const float *restrict lights, const float *restrict detail, const float *restrict squares, float *restrict out, long n
) {
    for (long k = 0; k < n; k++) {
        float strong = root(squares[k]);
        float share = clipped((strong - STRONG) / RANGE, 0.0f, 1.0f);
        float more = 1.0f + 0.7f * share * clipped((lights[k] - 0.5f) / 0.3f, 0.0f, 1.0f);
        float result = lights[k] - SUNK * share * above(lights[k] - LIGHT, 0.0f);
        strong = strong * more;
        float over = above(result + 1.6f * strong - 1.0f, 0.0f);
        result -= over * clipped((strong - 0.02f) / 0.05f, 0.0f, 1.0f);
        float under = above(0.06f - (result - strong), 0.0f);
        result += under * clipped(strong / 0.05f, 0.0f, 1.0f);
        out[k] = result + limited(detail[k] * more);
    }
}
