/* Addressing: from a texture coordinate to the texels of an image along one axis.
 *
 * A coordinate becomes texels in 24.8 fixed point, round(u * width * 256), so positions and the weights of
 * linear filtering have 8 bits. A point filter takes the texel that contains the position; a linear filter
 * blends the two texels whose centres are nearest. Every texel index ends within the image whatever the
 * coordinate is (NaN and infinity too), so gathers need no mask.
 *
 * Addressing maps each tap's index i to one from 0 to size - 1:
 *
 *   WRAP         i modulo size
 *   MIRROR       j = i modulo 2 * size; j, or 2 * size - 1 - j where j >= size
 *   MIRROR_ONCE  i or -1 - i, whichever is not negative, at most size - 1
 *   CLAMP        the nearest of 0 to size - 1
 *   BORDER       as CLAMP; a texel whose index had to change, on this axis, is the border colour instead,
 *                each of those that are blended by itself
 *
 * A linear filter of bytes reads the neighbour that follows a texel in memory if the axis is u and the mode
 * is CLAMP, or WRAP of a power of two. Rows end with a copy of their first texel (render/texture/texture.h),
 * and a position that is clamped before it is split has the fraction 0 at either edge, so the texel after the
 * edge has no weight.
 *
 * On a power of two, WRAP and MIRROR take bits of the index. Otherwise the coordinate's whole periods are
 * subtracted first, u - floor(u) or u - 2 * floor(u / 2), and an index beyond an edge is brought back. */
#ifndef SPEC_TEXTURE_ADDRESS_H
#define SPEC_TEXTURE_ADDRESS_H

#include "contract/language.h"
#include "spec/math/color.h"

struct axis {
    itg index[2];   /* of the texel and, linear only, its neighbour */
    itg wanted[2];  /* the same before addressing */
    bool adjoining; /* the neighbour follows the texel in memory; index[1] is not used */
    itg fraction;   /* the fraction of the way to the neighbour, 0 to 255; linear only */
    fix weight;     /* the same in both halves; linear only */
};

/* The filter of the lanes: linear if any lane is; mixed if only the lanes of `smooth` are. */
struct tap {
    bool linear, mixed;
    bool pairs; /* neighbours may be read together with their texels */
    msk smooth;
};

/* The image that is sampled. If all lanes sample the same image, its description is in the job; if each lane
 * has a level of its own, it is in the fields here. Axes are u, v and w. */
struct level {
    int number;  /* of the sampler */
    bool each;   /* the fields of this structure are used */
    bool placed; /* the image begins `offset` texels after the texture */
    itg offset, pitch;
    itg size[3], last[3];
    flt size_256[3];
    itg slice_texels;
};

/* A field of the texture's description in the job. */
static inline int texture_field(int number, size_t field)
{
    return (int)(offsetof(struct job, texture) + (size_t)number * sizeof(struct texture_job) + field);
}

#define TEXTURE_FIELD(number, field) texture_field(number, offsetof(struct texture_job, field))

static inline itg level_size(struct env *e, const struct level *l, int axis)
{
    static const size_t field[3] = {offsetof(struct texture_job, width), offsetof(struct texture_job, height),
                                    offsetof(struct texture_job, depth)};
    return l->each ? l->size[axis] : uniform_i(E, BASE_JOB, texture_field(l->number, field[axis]));
}

static inline itg level_last(struct env *e, const struct level *l, int axis)
{
    static const size_t field[3] = {offsetof(struct texture_job, last_u),
                                    offsetof(struct texture_job, last_v),
                                    offsetof(struct texture_job, last_w)};
    return l->each ? l->last[axis] : uniform_i(E, BASE_JOB, texture_field(l->number, field[axis]));
}

static inline flt job_size_256(struct env *e, int number, int axis)
{
    static const size_t field[3] = {offsetof(struct texture_job, width_256),
                                    offsetof(struct texture_job, height_256),
                                    offsetof(struct texture_job, depth_256)};
    return uniform_f(E, BASE_JOB, texture_field(number, field[axis]));
}

static inline flt level_size_256(struct env *e, const struct level *l, int axis)
{
    return l->each ? l->size_256[axis] : job_size_256(E, l->number, axis);
}

static inline itg level_pitch(struct env *e, const struct level *l)
{
    return l->each ? l->pitch : uniform_i(E, BASE_JOB, TEXTURE_FIELD(l->number, pitch));
}

static inline itg level_last_256(struct env *e, const struct level *l, int axis)
{
    static const size_t field[3] = {offsetof(struct texture_job, last_u_256),
                                    offsetof(struct texture_job, last_v_256),
                                    offsetof(struct texture_job, last_w_256)};
    return l->each ? shl_i(E, l->last[axis], 8)
                   : uniform_i(E, BASE_JOB, texture_field(l->number, field[axis]));
}

static inline itg clamp_index(struct env *e, itg index, itg last)
{
    itg low = max_i(E, index, lit_i(E, 0));
    return min_i(E, low, last);
}

/* Maps an index from [-size, 2 * size) to [0, size), and any other to an edge. */
static inline itg wrap_index(struct env *e, itg index, itg size, itg last)
{
    msk below = gt_i(E, lit_i(E, 0), index);
    itg raised = add_i(E, index, size);
    itg r = select_i(E, below, raised, index);
    msk above = gt_i(E, r, last);
    itg lowered = sub_i(E, r, size);
    r = select_i(E, above, lowered, r);
    return clamp_index(E, r, last);
}

/* The index reflected at the image's lower edge: -1 becomes 0. */
static inline itg fold_index(struct env *e, itg index)
{
    itg reflected = xor_i(E, index, lit_i(E, -1));
    return max_i(E, index, reflected);
}

/* Mirrors an index from [-2 * size, 2 * size); 2 * size becomes 0 again, and any other an edge. */
static inline itg mirror_index(struct env *e, itg index, itg size, itg last)
{
    itg folded = fold_index(E, index);
    itg end = add_i(E, size, last);
    itg reflected = sub_i(E, end, folded);
    itg r = min_i(E, folded, reflected);
    return max_i(E, r, lit_i(E, 0));
}

/* The bit `size` of the index is set in reflected images. */
static inline itg mirror_power_index(struct env *e, itg index, itg size, itg last)
{
    itg bit = and_i(E, index, size);
    msk odd = eq_i(E, bit, size);
    itg flip = mask_i(E, odd);
    itg turned = xor_i(E, index, flip);
    return and_i(E, turned, last);
}

static inline itg address_index(struct env *e, int address, itg index, const struct level *l, int axis)
{
    itg last = level_last(E, l, axis), size, folded;
    switch ((enum address_mode)address) {
    case ADDRESS_WRAP: size = level_size(E, l, axis); return wrap_index(E, index, size, last);
    case ADDRESS_WRAP_POWER: return and_i(E, index, last);
    case ADDRESS_CLAMP:
    case ADDRESS_BORDER: return clamp_index(E, index, last);
    case ADDRESS_MIRROR: size = level_size(E, l, axis); return mirror_index(E, index, size, last);
    case ADDRESS_MIRROR_POWER: size = level_size(E, l, axis); return mirror_power_index(E, index, size, last);
    case ADDRESS_MIRROR_ONCE: folded = fold_index(E, index); return min_i(E, folded, last);
    case ADDRESS_COUNT: break;
    }
    return index;
}

/* The coordinate without its whole periods, for axes that are not a power of two of texels. */
static inline flt address_period(struct env *e, int address, flt coordinate)
{
    if (address == ADDRESS_WRAP) {
        flt whole = floor_f(E, coordinate);
        return sub_f(E, coordinate, whole);
    }
    if (address == ADDRESS_MIRROR) {
        flt half = mul_f(E, coordinate, lit_f(E, 0.5f));
        flt whole = floor_f(E, half);
        flt even = add_f(E, whole, whole);
        return sub_f(E, coordinate, even);
    }
    return coordinate;
}

/* The distance from the position to the centre of the first of two texels: half a texel; 0 in lanes with a
 * point filter. */
static inline itg tap_offset(struct env *e, const struct tap *tap)
{
    itg half = lit_i(E, 128);
    return tap->mixed ? select_i(E, tap->smooth, half, lit_i(E, 0)) : half;
}

static inline itg tap_fraction(struct env *e, const struct tap *tap, itg position)
{
    itg fraction = and_i(E, position, lit_i(E, 255));
    return tap->mixed ? select_i(E, tap->smooth, fraction, lit_i(E, 0)) : fraction;
}

/* Addresses an axis along which each texel's neighbour follows it in memory. */
static inline void address_pairs(struct env *e, const struct level *l, const struct tap *tap, int address,
                                 int axis, itg position, struct axis *r)
{
    r->adjoining = true;
    if (address == ADDRESS_CLAMP) {
        itg last_256 = level_last_256(E, l, axis);
        position = clamp_index(E, position, last_256);
    }
    itg index = shr_i(E, position, 8);
    if (address == ADDRESS_WRAP_POWER) {
        itg last = level_last(E, l, axis);
        index = and_i(E, index, last);
    }
    r->index[0] = r->index[1] = r->wanted[0] = r->wanted[1] = index;
    r->fraction = tap_fraction(E, tap, position);
    r->weight = both_halves(E, r->fraction);
}

static inline void address_axis(struct env *e, const struct level *l, const struct tap *tap, int address,
                                int axis, flt coordinate, struct axis *r)
{
    flt inner = address_period(E, address, coordinate);
    flt size_256 = level_size_256(E, l, axis);
    flt scaled = mul_f(E, inner, size_256);
    itg position = round_i(E, scaled);
    if (tap->linear) {
        itg offset = tap_offset(E, tap);
        position = sub_i(E, position, offset);
        if (tap->pairs && axis == 0 && (address == ADDRESS_WRAP_POWER || address == ADDRESS_CLAMP)) {
            address_pairs(E, l, tap, address, axis, position, r);
            return;
        }
    }
    itg index = shr_i(E, position, 8);
    r->adjoining = false;
    r->index[0] = address_index(E, address, index, l, axis);
    r->wanted[0] = index;
    if (tap->linear) {
        itg next = add_i(E, index, lit_i(E, 1));
        r->index[1] = address_index(E, address, next, l, axis);
        r->wanted[1] = next;
        r->fraction = tap_fraction(E, tap, position);
        r->weight = both_halves(E, r->fraction);
    }
}

#endif
