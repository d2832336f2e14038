/* Targets in the float path: blending, quantization and write, as target.h defines them. */
#ifndef SPEC_PIXEL_FLOAT_TARGET_H
#define SPEC_PIXEL_FLOAT_TARGET_H

#include "contract/language.h"
#include "spec/math/float_color.h"
#include "spec/math/nan.h"
#include "spec/math/srgb.h"
#include "spec/pixel/float_blend.h"
#include "spec/pixel/primitive_blend.h"
#include "spec/pixel/target.h"
#include "spec/pixel/write.h"

static inline struct float_color load_planes(struct env *e, int offset)
{
    struct float_color r;
    for (int c = 0; c < 4; c++)
        r.channel[c] = load_f(E, BASE_COLOR, offset + c * TILE_PLANE_BYTES);
    return r;
}

/* A channel as its stored code q of n bits. */
static inline itg target_level(struct env *e, const struct pixel_key *k, int target, int c, flt value)
{
    int bits = storage_bits[target][c];
    flt levels = lit_f(E, (float)((1 << bits) - 1));
    flt limited = saturate(E, value);
    if (!k->dither || c == 3 || !storage_is_narrow(target)) {
        flt scaled = mul_f(E, limited, levels);
        return round_i(E, scaled);
    }
    itg both = load_i(E, BASE_LANES, (int)offsetof(struct lane_table, dither));
    itg low = and_i(E, both, lit_i(E, 0xffff));
    flt number = float_f(E, low);
    flt threshold = div_f(E, number, lit_f(E, 255.0f));
    flt sum = mad_f(E, limited, levels, threshold);
    return trunc_i(E, sum);
}

static inline itg target_byte(struct env *e, const struct pixel_key *k, int target, int c, flt value)
{
    int bits = storage_bits[target][c];
    if (target == TARGET_SRGB && c < 3) {
        flt limited = saturate(E, value);
        return srgb_encode(E, limited);
    }
    itg level = target_level(E, k, target, c, value);
    if (bits == 8)
        return level;
    itg scaled = mul_i(E, level, lit_i(E, expansion_scale(bits)));
    itg biased = add_i(E, scaled, lit_i(E, expansion_bias(bits)));
    return ushr_i(E, biased, 6);
}

/* The channel `value` as it is stored over `old`. */
static inline flt target_float(struct env *e, const struct pixel_key *k, int target, int c, flt value,
                               flt old)
{
    int bits = storage_bits[target][c];
    if (bits) {
        flt levels = lit_f(E, (float)((1 << bits) - 1));
        itg level = target_level(E, k, target, c, value);
        if (logic_operates(k, target)) {
            flt scaled = mul_f(E, old, levels);
            itg stored = round_i(E, scaled);
            level = logic_code(E, k->logic, bits, level, stored);
        }
        flt number = float_f(E, level);
        return div_f(E, number, levels);
    }
    if (target == TARGET_HALF)
        value = half_f(E, value);
    return one_nan(E, value);
}

static inline struct float_color target_unpack(struct env *e, int target, itg word)
{
    struct float_color r = float_unpack(E, word);
    for (int c = 0; c < 3 && target == TARGET_SRGB; c++) {
        itg byte = word_byte(E, word, c);
        r.channel[c] = srgb_decode(E, byte);
    }
    return r;
}

static inline itg target_pack(struct env *e, const struct pixel_key *k, int target,
                              const struct float_color *color)
{
    itg word = target_byte(E, k, target, 0, color->channel[0]);
    for (int c = 1; c < 4; c++) {
        itg byte = target_byte(E, k, target, c, color->channel[c]);
        itg place = shl_i(E, byte, 8 * c);
        word = or_i(E, word, place);
    }
    return word;
}

static inline struct float_color float_clamped(struct env *e, int target, struct float_color color)
{
    for (int c = 0; c < 4 && storage_bits[target][c]; c++)
        color.channel[c] = saturate(E, color.channel[c]);
    return color;
}

/* color[0] is the target's, color[1] the second if the key reads it. */
static inline struct float_color float_blend_clamped(struct env *e, const struct pixel_key *k, int target,
                                                     const struct float_color *color,
                                                     const struct primitive_blend *own,
                                                     const struct float_color *old)
{
    struct float_color new = float_clamped(E, target, color[0]), second = new;
    if (blend_reads_second(k))
        second = float_clamped(E, target, color[1]);
    struct float_color blended = float_blend(E, k, &new, &second, old);
    return float_primitive_blend(E, own, &new, old, blended);
}

static inline void write_float_word(struct env *e, const struct pixel_key *k, int t, int sample, msk live,
                                    const struct float_color *color, const struct primitive_blend *own)
{
    int target = k->target[t], offset = target_offset(k, t, sample);
    itg stored = load_i(E, BASE_COLOR, offset);
    struct float_color old = target_unpack(E, target, stored);
    struct float_color blended = float_blend_clamped(E, k, target, color, own, &old);
    if (target == TARGET_L8)
        blended.channel[1] = blended.channel[2] = blended.channel[0];
    itg word = target_pack(E, k, target, &blended);
    word = logic_word(E, k, target, word, stored);
    write_word(E, k->write_mask[t], offset, live, word, stored);
}

static inline void write_float_planes(struct env *e, const struct pixel_key *k, int t, int sample, msk live,
                                      const struct float_color *color, const struct primitive_blend *own)
{
    int target = k->target[t], offset = target_offset(k, t, sample);
    struct float_color old = load_planes(E, offset);
    struct float_color blended = float_blend_clamped(E, k, target, color, own, &old);
    for (int c = 0; c < 4; c++) {
        if (!(k->write_mask[t] >> c & 1))
            continue;
        flt value = target_float(E, k, target, c, blended.channel[c], old.channel[c]);
        flt merged = select_f(E, live, value, old.channel[c]);
        store_f(E, BASE_COLOR, offset + c * TILE_PLANE_BYTES, merged);
    }
}

static inline void write_float_target(struct env *e, const struct pixel_key *k, int t, int sample, msk live,
                                      const struct float_color *color, const struct primitive_blend *own)
{
    OBSERVE(E, color_exact, t, *color);
    if (storage_planes[k->target[t]] == 1)
        write_float_word(E, k, t, sample, live, color, own);
    else
        write_float_planes(E, k, t, sample, live, color, own);
}

#endif
