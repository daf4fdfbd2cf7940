/* The loops of `phase.h` over nodes of one colour, or of a row: one node has no part in another, so that the compiler
 * makes vectors of them. Selections stand in place of branches. */

/* Set n nodes (x, y) to what their neighbours say of them, unless these contradict each other wholly. Planes of numbers
 * are `apart` from each other: six of a node's own links, of its left neighbour's and of its upper one's, and two of the
 * phases to the right, to the left, below and above. */
static void PART(agree)(
    float *restrict x, float *restrict y, const float *restrict own, const float *restrict beside,
    const float *restrict above, const float *restrict right, const float *restrict left, const float *restrict down,
    const float *restrict up, long apart, long n
) {
    const long two = 2 * apart, three = 3 * apart, four = 4 * apart, five = 5 * apart;
    for (long k = 0; k < n; k++) {
        float m = own[two + k] * right[apart + k];
        float a = own[k] * right[k] + own[apart + k] * m;
        float b = own[k] * m - own[apart + k] * right[k];
        m = own[five + k] * down[apart + k];
        a = a + (own[three + k] * down[k] + own[four + k] * m);
        b = b + (own[three + k] * m - own[four + k] * down[k]);
        a = a + (beside[k] * left[k] - beside[apart + k] * left[apart + k]);
        b = b + beside[two + k] * (beside[k] * left[apart + k] + beside[apart + k] * left[k]);
        a = a + (above[three + k] * up[k] - above[four + k] * up[apart + k]);
        b = b + above[five + k] * (above[three + k] * up[apart + k] + above[four + k] * up[k]);
        float size = a * a + b * b;
        float by = 1.0f / sqrtf(size);
        x[k] = size > 1e-12f ? a * by : x[k];
        y[k] = size > 1e-12f ? b * by : y[k];
    }
}

/* What is predicted from n nodes, whose lines have the normal (nx, ny), to as many neighbours: w cos ω, w sin ω and the
 * sign. along_here, along_there: the normals' parts along the links, which are h points long; a link is weak where
 * `weak` has the bit. */
static void PART(predict)(
    const float *restrict nx, const float *restrict ny, const float *restrict density, const float *restrict nx_there,
    const float *restrict ny_there, const float *restrict density_there, const float *restrict along_here,
    const float *restrict along_there, const unsigned char *restrict weak, int bit, float h, float leak, float least,
    float along, float *restrict cosine_out, float *restrict sine_out, float *restrict sign_out, long n
) {
    for (long i = 0; i < n; i++) {
        float d = nx[i] * nx_there[i] + ny[i] * ny_there[i];
        float g = d < 0.0f ? -1.0f : 1.0f;
        float a = along_here[i], b = g * along_there[i];
        float w = (least + (1.0f - least) * fabsf(d)) * (1.0f + along * (1.0f - 0.25f * (a + b) * (a + b)));
        w = weak[i] & bit ? w * leak : w;
        /* cosine and sine of an angle in turns, by a polynomial on an eighth of a turn: the same on every machine */
        float turns = 0.5f * h * (density[i] * a + density_there[i] * b);
        float eighths = 4.0f * (turns - floorf(turns + 0.5f));
        float quarter = floorf(eighths + 0.5f);
        float z = (eighths - quarter) * 1.5707963267948966f;
        float z2 = z * z;
        float sine = z * (1.0f + z2 * (-0.16666667f + z2 * (0.008333333f - z2 * 0.00019841270f)));
        float cosine = 1.0f + z2 * (-0.5f + z2 * (0.041666667f + z2 * (-0.0013888889f + z2 * 0.000024801587f)));
        int k = (int)quarter & 3;
        float c = k & 1 ? sine : cosine, s = k & 1 ? cosine : sine;
        c = k == 1 || k == 2 ? -c : c;
        s = k & 2 ? -s : s;
        cosine_out[i] = w * c;
        sine_out[i] = w * s;
        sign_out[i] = g;
    }
}

/* The angles, in turns from -1/2 to 1/2, of n vectors that are not nought (Abramowitz and Stegun 4.4.49). */
static void PART(angles)(const float *restrict x, const float *restrict y, float *restrict out, long n) {
    for (long k = 0; k < n; k++) {
        float a = fabsf(x[k]), b = fabsf(y[k]);
        float t = (a > b ? b : a) / (a > b ? a : b);
        float t2 = t * t;
        float angle = 0.15915494309189535f * t
            * (0.9998660f + t2 * (-0.3302995f + t2 * (0.1801410f + t2 * (-0.0851330f + t2 * 0.0208351f))));
        angle = b >= a ? 0.25f - angle : angle;
        angle = x[k] < 0.0f ? 0.5f - angle : angle;
        out[k] = y[k] < 0.0f ? -angle : angle;
    }
}
