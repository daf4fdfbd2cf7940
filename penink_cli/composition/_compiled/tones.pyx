# cython: boundscheck=False, wraparound=False
"""Compiled: what composing does to each pixel, as `tones_loops.h` tells it: of rows of pictures, into those of another.

All are float32 (rows, w), as many rows of each. `filters.by_pixels` hands out the rows.
"""

cdef extern from "tones.h" nogil:
    void c_stretched "stretched"(const float* grey, float low, float by, float* out, long n)
    void c_based "based"(const float* grey, const float* slope, const float* offset, float* out, long n)
    void c_stirred "stirred"(const float* fine, const float* broad, float noise, float* out, long n)
    void c_rooted "rooted"(const float* square, float* out, long n)
    void c_weighed "weighed"(const float* activity, float by, float* out, long n)
    void c_lifted_by "lifted_by"(
        const float* carved, const float* exposed, const float* broad, float key, float* out, long n
    )
    void c_without_shine "without_shine"(const float* carved, const float* broad, float* out, long n)
    void c_blanked "blanked"(
        const float* grey, const float* carved, float light, float more, float paper, float* out, long n
    )
    void c_sunk "sunk"(const float* grey, const float* around, float* out, long n)
    void c_less_light "less_light"(const float* lights, const float* lifted, const float* carved, float* out, long n)
    void c_gained "gained"(
        const float* usual, const float* slope, const float* lifted, const float* carved, const float* grain,
        const float* coarse, float gain, float* out, long n
    )
    void c_guarded "guarded"(const float* values, const float* variance, float level, float twice, float* out, long n)
    void c_drawn "drawn"(const float* each, const float* middle, const float* fine, float* out, long n)
    void c_with_room "with_room"(const float* lights, const float* detail, const float* squares, float* out, long n)
    int best_lanes()
    int lanes


def take_lanes(int wanted) -> int:
    """Take the make for vectors of so many bytes, 16 or 32, or what this processor has: the same numbers by both."""
    global lanes
    lanes = min(wanted, best_lanes())
    return lanes


take_lanes(32)


def stretched(const float[:, ::1] grey, float[:, ::1] out, float low, float by):
    with nogil:
        c_stretched(&grey[0, 0], low, by, &out[0, 0], out.shape[0] * out.shape[1])


def based(const float[:, ::1] grey, const float[:, ::1] slope, const float[:, ::1] offset, float[:, ::1] out):
    with nogil:
        c_based(&grey[0, 0], &slope[0, 0], &offset[0, 0], &out[0, 0], out.shape[0] * out.shape[1])


def stirred(const float[:, ::1] fine, const float[:, ::1] broad, float[:, ::1] out, float noise):
    with nogil:
        c_stirred(&fine[0, 0], &broad[0, 0], noise, &out[0, 0], out.shape[0] * out.shape[1])


def rooted(const float[:, ::1] square, float[:, ::1] out):
    with nogil:
        c_rooted(&square[0, 0], &out[0, 0], out.shape[0] * out.shape[1])


def weighed(const float[:, ::1] activity, float[:, ::1] out, float by):
    with nogil:
        c_weighed(&activity[0, 0], by, &out[0, 0], out.shape[0] * out.shape[1])


def lifted_by(
    const float[:, ::1] carved, const float[:, ::1] exposed, const float[:, ::1] broad, float[:, ::1] out, float key
):
    with nogil:
        c_lifted_by(&carved[0, 0], &exposed[0, 0], &broad[0, 0], key, &out[0, 0], out.shape[0] * out.shape[1])


def without_shine(const float[:, ::1] carved, const float[:, ::1] broad, float[:, ::1] out):
    with nogil:
        c_without_shine(&carved[0, 0], &broad[0, 0], &out[0, 0], out.shape[0] * out.shape[1])


def blanked(
    const float[:, ::1] grey, const float[:, ::1] carved, float[:, ::1] out, float light, float more, float paper
):
    with nogil:
        c_blanked(&grey[0, 0], &carved[0, 0], light, more, paper, &out[0, 0], out.shape[0] * out.shape[1])


def sunk(const float[:, ::1] grey, const float[:, ::1] around, float[:, ::1] out):
    with nogil:
        c_sunk(&grey[0, 0], &around[0, 0], &out[0, 0], out.shape[0] * out.shape[1])


def less_light(const float[:, ::1] lights, const float[:, ::1] lifted, const float[:, ::1] carved, float[:, ::1] out):
    with nogil:
        c_less_light(&lights[0, 0], &lifted[0, 0], &carved[0, 0], &out[0, 0], out.shape[0] * out.shape[1])


def gained(
    const float[:, ::1] usual, const float[:, ::1] slope, const float[:, ::1] lifted, const float[:, ::1] carved,
    const float[:, ::1] grain, const float[:, ::1] coarse, float[:, ::1] out, float gain
):
    with nogil:
        c_gained(
            &usual[0, 0], &slope[0, 0], &lifted[0, 0], &carved[0, 0], &grain[0, 0], &coarse[0, 0], gain, &out[0, 0],
            out.shape[0] * out.shape[1]
        )


def guarded(const float[:, ::1] values, const float[:, ::1] variance, float[:, ::1] out, float level, float twice):
    with nogil:
        c_guarded(&values[0, 0], &variance[0, 0], level, twice, &out[0, 0], out.shape[0] * out.shape[1])


def drawn(const float[:, ::1] each, const float[:, ::1] middle, const float[:, ::1] fine, float[:, ::1] out):
    with nogil:
        c_drawn(&each[0, 0], &middle[0, 0], &fine[0, 0], &out[0, 0], out.shape[0] * out.shape[1])


def with_room(const float[:, ::1] lights, const float[:, ::1] detail, const float[:, ::1] squares, float[:, ::1] out):
    with nogil:
        c_with_room(&lights[0, 0], &detail[0, 0], &squares[0, 0], &out[0, 0], out.shape[0] * out.shape[1])
