/* Depth: clamped to 0..1 (NaN gives 0), compared with the stored value, written where the test passes.
 *
 * It is z / w interpolated linearly, or in a w-buffer w * w_scale + w_offset with w at the pixel. As an
 * integer of n bits it is z * (2^n - 1), computed in binary32 and rounded to nearest even. As an integer of
 * 32 bits it is z * 2^32 rounded the same way, less 1 above one half. As 24-bit floating point it is the
 * nearest value, ties to even, of those that contract/key_pixel.h describes. New depth is converted to the
 * stored format before they are compared.
 *
 * The depth test follows the stencil test (spec/pixel/stencil.h) and precedes everything else. The write
 * follows immediately, or after shading if shading decides which pixels remain. A depth that a shader outputs
 * replaces the triangle's; it is clamped as well, it is the same for all samples, and all tests follow it. */
#ifndef SPEC_PIXEL_DEPTH_H
#define SPEC_PIXEL_DEPTH_H

#include "contract/language.h"
#include "spec/pixel/compare.h"
#include "spec/pixel/interpolate.h"

static inline msk depth_compare(struct env *e, int function, flt new, flt stored)
{
    switch ((enum compare)function) {
    case COMPARE_NEVER: return lit_m(E, 0);
    case COMPARE_LESS: return lt_f(E, new, stored);
    case COMPARE_EQUAL: return eq_f(E, new, stored);
    case COMPARE_LESS_EQUAL: return le_f(E, new, stored);
    case COMPARE_GREATER: return lt_f(E, stored, new);
    case COMPARE_NOT_EQUAL: return ne_f(E, new, stored);
    case COMPARE_GREATER_EQUAL: return le_f(E, stored, new);
    case COMPARE_ALWAYS:
    case COMPARE_COUNT: break;
    }
    return lit_m(E, -1);
}

/* The byte offset of a sample's word from its pixel's first. */
static inline int sample_word(const struct pixel_position *at)
{
    return at->sample * TILE_PLANE_BYTES;
}

/* The new depth and the stored one: as binary32, or as integers in the same order. */
struct depth {
    flt new, stored;
    itg code, stored_code;
};

static inline flt clamp_depth(struct env *e, flt depth)
{
    flt low = max_f(E, depth, lit_f(E, 0.0f));
    return min_f(E, low, lit_f(E, 1.0f));
}

/* The triangle's depth at the pixel. */
static inline flt pixel_depth(struct env *e, const struct pixel_position *at,
                              const struct triangle_layout *layout)
{
    flt plane = evaluate_plane(E, at, layout->depth);
    return clamp_depth(E, plane);
}

/* The depth of a w-buffer at the pixel. */
static inline flt pixel_w_depth(struct env *e, const struct pixel_key *k, const struct pixel_position *at,
                                const struct triangle_layout *layout)
{
    flt w = pixel_w(E, k, at, layout, PRECISION_EXACT);
    flt scale = uniform_f(E, BASE_JOB, (int)offsetof(struct job, w_scale));
    flt offset = uniform_f(E, BASE_JOB, (int)offsetof(struct job, w_offset));
    flt value = mad_f(E, w, scale, offset);
    return clamp_depth(E, value);
}

/* Two halves of 16 bits, each exact until it is rounded; above 2^31 modulo 2^32. */
static inline itg depth_unorm32(struct env *e, flt depth)
{
    flt scaled = mul_f(E, depth, lit_f(E, 65536.0f));
    itg high = trunc_i(E, scaled);
    flt whole = float_f(E, high);
    flt fraction = sub_f(E, scaled, whole);
    flt rest = mul_f(E, fraction, lit_f(E, 65536.0f));
    itg low = round_i(E, rest);
    itg upper = shl_i(E, high, 16);
    itg sum = add_i(E, upper, low);
    msk above = lt_f(E, lit_f(E, 0.5f), depth);
    itg less = mask_i(E, above);
    return add_i(E, sum, less);
}

static inline itg depth_float24(struct env *e, flt depth)
{
    flt units = mul_f(E, depth, lit_f(E, DEPTH_FLOAT24_UNITS));
    itg small = round_i(E, units);
    itg bits = bits_i(E, depth);
    itg last = ushr_i(E, bits, 3);
    itg odd = and_i(E, last, lit_i(E, 1));
    itg half = add_i(E, bits, lit_i(E, 3 - DEPTH_FLOAT24_BIAS));
    itg rounded = add_i(E, half, odd);
    itg normal = ushr_i(E, rounded, 3);
    msk is_small = lt_f(E, depth, lit_f(E, DEPTH_FLOAT24_NORMAL));
    return select_i(E, is_small, small, normal);
}

/* Depth as an integer whose signed order is that of depth. Of a 32-bit one, the upper bit is inverted. */
static inline itg depth_code(struct env *e, const struct pixel_key *k, flt depth)
{
    switch ((enum depth_storage)k->depth_format) {
    case DEPTH_UNORM: {
        flt maximum = uniform_f(E, BASE_JOB, (int)offsetof(struct job, depth_maximum));
        flt scaled = mul_f(E, depth, maximum);
        return round_i(E, scaled);
    }
    case DEPTH_FLOAT24: return depth_float24(E, depth);
    case DEPTH_UNORM32: {
        itg integer = depth_unorm32(E, depth);
        return xor_i(E, integer, lit_i(E, INT32_MIN));
    }
    case DEPTH_FLOAT:
    case DEPTH_STORAGE_COUNT: break;
    }
    return bits_i(E, depth);
}

/* The pixel's depth and the tile's. */
static inline struct depth depth_pair(struct env *e, const struct pixel_key *k,
                                      const struct pixel_position *at, const struct triangle_layout *layout)
{
    struct depth r;
    if (at->depth)
        r.new = *at->depth;
    else
        r.new = k->depth_w ? pixel_w_depth(E, k, at, layout) : pixel_depth(E, at, layout);
    OBSERVE(E, depth_value, at->sample, r.new);
    if (k->depth_format == DEPTH_FLOAT) {
        r.stored = load_f(E, BASE_DEPTH, sample_word(at));
        r.code = r.stored_code = bits_i(E, r.stored);
        return r;
    }
    itg word = load_i(E, BASE_DEPTH, sample_word(at));
    r.stored = bits_f(E, word);
    r.code = depth_code(E, k, r.new);
    if (k->depth_format == DEPTH_UNORM32)
        r.stored_code = xor_i(E, word, lit_i(E, INT32_MIN));
    else
        r.stored_code = ushr_i(E, word, 8);
    return r;
}

/* The lanes of `live` that pass. */
static inline msk depth_pass(struct env *e, const struct pixel_key *k, const struct depth *depth, msk live)
{
    if (k->depth_function == COMPARE_ALWAYS)
        return live;
    if (k->depth_format != DEPTH_FLOAT)
        return keep_compared(E, k->depth_function, depth->code, depth->stored_code, live);
    msk passed = depth_compare(E, k->depth_function, depth->new, depth->stored);
    return and_m(E, live, passed);
}

/* Integer formats keep the stencil in the bits below depth. */
static inline void depth_write(struct env *e, const struct pixel_key *k, const struct pixel_position *at,
                               const struct depth *depth, msk live)
{
    if (k->depth_format == DEPTH_FLOAT) {
        flt merged = select_f(E, live, depth->new, depth->stored);
        store_f(E, BASE_DEPTH, sample_word(at), merged);
        return;
    }
    itg stored = bits_i(E, depth->stored), word;
    if (k->depth_format == DEPTH_UNORM32) {
        word = xor_i(E, depth->code, lit_i(E, INT32_MIN));
    } else {
        itg high = shl_i(E, depth->code, 8);
        itg low = and_i(E, stored, lit_i(E, 255));
        word = or_i(E, high, low);
    }
    itg merged = select_i(E, live, word, stored);
    store_i(E, BASE_DEPTH, sample_word(at), merged);
}

/* Tests depth, and writes it if `writes`. Returns the lanes that are still live. */
static inline msk depth_test(struct env *e, const struct pixel_key *k, const struct pixel_position *at,
                             const struct triangle_layout *layout, int writes, msk live)
{
    if (k->depth_function == COMPARE_ALWAYS && !writes)
        return live;
    struct depth depth = depth_pair(E, k, at, layout);
    live = depth_pass(E, k, &depth, live);
    OBSERVE(E, depth, at->sample, live);
    if (writes)
        depth_write(E, k, at, &depth, live);
    return live;
}

/* Writes depth after shading. It is computed again, which costs less than keeping it through shading. */
static inline void depth_write_late(struct env *e, const struct pixel_key *k, const struct pixel_position *at,
                                    const struct triangle_layout *layout, msk live)
{
    struct depth depth = depth_pair(E, k, at, layout);
    depth_write(E, k, at, &depth, live);
}

#endif
