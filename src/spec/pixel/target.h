/* The conversion of colours to and from targets (def/state/target.def).
 *
 *   n bits, packed path   q = round(c * (2^n - 1) / 255), c being 0 to 255
 *   n bits, float path    q = round(c * (2^n - 1)), nearest even, c clamped to 0..1
 *   word                  the byte round(q * 255 / (2^n - 1))
 *   plane                 q / (2^n - 1), correctly rounded; for floating point c, or c rounded to binary16
 *
 * With dithering, red, green and blue of targets with less than 8 bits are rounded down after t / 255 is
 * added to c * (2^n - 1). t = round(255 * (2 * b + 1) / 32), b being 0 to 15 in the order of the 4x4 Bayer
 * matrix at the pixel's position in its block (struct lane_table). NaN becomes 0 in targets that cannot store
 * it, in the others always the same NaN.
 *
 * A logic operation (logic.h) has the code q and the stored one as operands. */
#ifndef SPEC_PIXEL_TARGET_H
#define SPEC_PIXEL_TARGET_H

#include "contract/language.h"
#include "spec/math/color.h"
#include "spec/pixel/blend.h"
#include "spec/pixel/logic.h"
#include "spec/pixel/primitive_blend.h"
#include "spec/pixel/write.h"

/* The byte offset of target t's planes of a sample from the pixel's first word. Only the first target can
 * have several samples; they follow one another. */
static inline int target_offset(const struct pixel_key *k, int t, int sample)
{
    int planes = sample * storage_planes[k->target[0]];
    for (int i = 0; i < t; i++)
        planes += storage_planes[k->target[i]];
    return planes * TILE_PLANE_BYTES;
}

/* (q * scale + bias) >> 6 is round(q * 255 / (2^bits - 1)). */
static inline int expansion_scale(int bits)
{
    enum { OF_BYTES = 64 };
    return bits == 1 ? 255 * 64 : bits == 4 ? 17 * 64 : bits == 5 ? 527 : bits == 6 ? 259 : OF_BYTES;
}

static inline int expansion_bias(int bits)
{
    return bits == 5 ? 23 : bits == 6 ? 33 : 0;
}

static inline fix constant_pair(struct env *e, int low, int high)
{
    itg both = lit_i(E, low | high << 16);
    return fix_of(E, both);
}

/* floor(sum / 255) for sums below 65535. */
static inline fix floor_255(struct env *e, fix sum)
{
    fix next = add_x(E, sum, lit_x(E, 1));
    fix part = ushr_x(E, sum, 8);
    fix both = add_x(E, next, part);
    return ushr_x(E, both, 8);
}

/* The thresholds of a pair. Alpha, if it is the upper one, is rounded and not dithered. */
static inline fix dither_pair(struct env *e, bool high_is_alpha)
{
    itg both = load_i(E, BASE_LANES, (int)offsetof(struct lane_table, dither));
    if (high_is_alpha) {
        itg low = and_i(E, both, lit_i(E, 0xffff));
        both = or_i(E, low, lit_i(E, 127 << 16));
    }
    return fix_of(E, both);
}

/* The bytes of codes of `low` and `high` bits. */
static inline fix expand_pair(struct env *e, fix q, int low, int high)
{
    fix scale = constant_pair(E, expansion_scale(low), expansion_scale(high));
    fix scaled = mul_x(E, q, scale);
    fix bias = constant_pair(E, expansion_bias(low), expansion_bias(high));
    fix biased = add_x(E, scaled, bias);
    return ushr_x(E, biased, 6);
}

/* Quantizes the low channel to `low` bits and the high one to `high` bits. */
static inline fix narrow_pair(struct env *e, const struct pixel_key *k, fix pair, int low, int high,
                              bool high_is_alpha)
{
    fix levels = constant_pair(E, (1 << low) - 1, (1 << high) - 1);
    fix product = mul_x(E, pair, levels), q;
    if (k->dither) {
        fix thresholds = dither_pair(E, high_is_alpha);
        fix sum = add_x(E, product, thresholds);
        q = floor_255(E, sum);
    } else
        q = divide_255(E, product);
    return expand_pair(E, q, low, high);
}

static inline struct color narrow_color(struct env *e, const struct pixel_key *k, int target,
                                        struct color color)
{
    const uint8_t *bits = storage_bits[target];
    if (!storage_is_narrow(target))
        return color;
    color.rb = narrow_pair(E, k, color.rb, bits[0], bits[2], 0);
    color.ga = narrow_pair(E, k, color.ga, bits[1], bits[3], 1);
    return color;
}

/* The bytes of the codes in the highest bits of bytes. */
static inline fix code_pair(struct env *e, fix pair, int low, int high)
{
    fix scale = constant_pair(E, 1 << low, 1 << high);
    fix raised = mul_x(E, pair, scale);
    fix q = ushr_x(E, raised, 8);
    return expand_pair(E, q, low, high);
}

/* The logic operation on words of bytes. The code of a byte is in its highest bits, whatever the format:
 * q * 255 / (2^n - 1) is less than q + 1 times 2^(8 - n). */
static inline itg logic_word(struct env *e, const struct pixel_key *k, int target, itg word, itg stored)
{
    if (!logic_operates(k, target))
        return word;
    itg all = logic_bits(E, k->logic, word, stored);
    if (!storage_is_narrow(target))
        return all;
    const uint8_t *bits = storage_bits[target];
    struct color color = color_unpack(E, all);
    color.rb = code_pair(E, color.rb, bits[0], bits[2]);
    color.ga = code_pair(E, color.ga, bits[1], bits[3]);
    return color_pack(E, color);
}

/* The channels as the target has them: luminance is red. */
static inline struct color target_channels(struct env *e, int target, struct color color)
{
    if (target != TARGET_L8)
        return color;
    itg rb = int_of(E, color.rb);
    itg red = and_i(E, rb, lit_i(E, 0xffff));
    itg ga = int_of(E, color.ga);
    itg alpha = and_i(E, ga, lit_i(E, -0x10000));
    itg both = or_i(E, red, alpha);
    color.rb = both_halves(E, red);
    color.ga = fix_of(E, both);
    return color;
}

/* Blends the colour into a target and writes it. `second` is the second colour, if the key reads it; `own`
 * the blending of primitives. */
static inline void write_target(struct env *e, const struct pixel_key *k, int t, int sample, msk live,
                                struct color color, struct color second, const struct primitive_blend *own)
{
    itg stored = load_i(E, BASE_COLOR, target_offset(k, t, sample));
    OBSERVE(E, color, t, color);
    struct color blended = blend(E, k, color, second, stored);
    blended = primitive_blend(E, own, color, stored, blended);
    blended = narrow_color(E, k, k->target[t], blended);
    blended = target_channels(E, k->target[t], blended);
    itg word = color_pack(E, blended);
    word = logic_word(E, k, k->target[t], word, stored);
    write_word(E, k->write_mask[t], target_offset(k, t, sample), live, word, stored);
}

#endif
