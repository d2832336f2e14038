/* A texture stage: combines the interpolated colours, its texture, constants and the results of earlier
 * stages.
 *
 * The stages run in order. Each result becomes the current colour or the temporary one; at first the current
 * colour is diffuse and the temporary one 0. If the stage before premodulates, a stage reads the current
 * colour multiplied by its own texture, round(a * b / 255).
 *
 * Colour and alpha each have an operation and up to three arguments. All channels are 0 to 255; a, b, c are
 * the arguments that Direct3D 9 calls 1, 2 and 0, and every result is clamped to 0..255:
 *
 *   SELECT         a
 *   MODULATE       p = round(a * b / 255); 2X and 4X: 2 * p, 4 * p
 *   ADD            a + b
 *   ADD_SIGNED     a + b - 128; 2X: 2 * (a + b - 128)
 *   SUBTRACT       a - b
 *   MULTIPLY_ADD   c + round(a * b / 255)
 *   LERP           round((a * c + b * (255 - c)) / 255)
 *   DOT            floor(sum over red, green, blue of (a - 128) * (b - 128) / 64), in all four channels
 *
 * A half would be 127.5 of 255, which a channel cannot hold. 128 is the value that signed maps store for
 * zero, so adding it changes nothing and its dot product is 0. An argument's complement is 255 minus it,
 * after its alpha is replicated. */
#ifndef SPEC_PIXEL_STAGE_H
#define SPEC_PIXEL_STAGE_H

#include "contract/language.h"
#include "spec/math/color.h"

struct stage_values {
    struct color diffuse, specular, texture, current, temporary;
};

static inline struct color stage_source(struct env *e, int stage, int source, const struct stage_values *v)
{
    switch ((enum source)source) {
    case SOURCE_DIFFUSE: return v->diffuse;
    case SOURCE_TEXTURE: return v->texture;
    case SOURCE_CURRENT: return v->current;
    case SOURCE_SPECULAR: return v->specular;
    case SOURCE_TEMPORARY: return v->temporary;
    case SOURCE_CONSTANT:
        return packed_color(E, offsetof(struct job, stage_constant) + sizeof(uint32_t) * (size_t)stage);
    case SOURCE_FACTOR:
    case SOURCE_COUNT: break;
    }
    return packed_color(E, offsetof(struct job, texture_factor));
}

static inline struct color stage_argument(struct env *e, int stage, int argument,
                                          const struct stage_values *v)
{
    struct color r = stage_source(E, stage, argument % SOURCE_COUNT, v);
    if (argument / ARGUMENT_REPLICATE & 1)
        r.rb = r.ga = color_alpha(E, r);
    if (argument / ARGUMENT_COMPLEMENT) {
        r.rb = sub_x(E, lit_x(E, 255), r.rb);
        r.ga = sub_x(E, lit_x(E, 255), r.ga);
    }
    return r;
}

static inline fix double_saturated(struct env *e, fix a)
{
    return add_saturated(E, a, a);
}

static inline fix add_signed(struct env *e, fix a, fix b)
{
    fix sum = add_x(E, a, b);
    return subtract_saturated(E, sum, lit_x(E, 128));
}

static inline fix stage_multiply_add(struct env *e, fix a, fix b, fix addend)
{
    fix product = modulate(E, a, b);
    return add_saturated(E, addend, product);
}

static inline fix stage_modulate(struct env *e, int operation, fix a, fix b)
{
    fix r = modulate(E, a, b);
    if (operation != STAGE_MODULATE)
        r = double_saturated(E, r);
    if (operation == STAGE_MODULATE_4X)
        r = double_saturated(E, r);
    return r;
}

/* One pair of channels. An operation reads the first stage_arguments[operation] arguments. */
static inline fix stage_combine(struct env *e, int operation, fix a, fix b, fix c)
{
    switch ((enum stage)operation) {
    case STAGE_ADD: return add_saturated(E, a, b);
    case STAGE_ADD_SIGNED: {
        fix sum = add_signed(E, a, b);
        return min_x(E, sum, lit_x(E, 255));
    }
    case STAGE_ADD_SIGNED_2X: {
        fix sum = add_signed(E, a, b);
        return double_saturated(E, sum);
    }
    case STAGE_SUBTRACT: return subtract_saturated(E, a, b);
    case STAGE_MULTIPLY_ADD: return stage_multiply_add(E, a, b, c);
    case STAGE_LERP: return lerp_255(E, a, b, c);
    case STAGE_MODULATE:
    case STAGE_MODULATE_2X:
    case STAGE_MODULATE_4X: return stage_modulate(E, operation, a, b);
    case STAGE_SELECT:
    case STAGE_DOT:
    case STAGE_COUNT: break;
    }
    return a;
}

static inline itg signed_pair(struct env *e, fix channels)
{
    fix r = sub_x(E, channels, lit_x(E, 128));
    return int_of(E, r);
}

/* Signed products of red and blue, then of green; alpha is removed before. */
static inline struct color stage_dot(struct env *e, struct color a, struct color b)
{
    itg a_rb = signed_pair(E, a.rb);
    itg b_rb = signed_pair(E, b.rb);
    itg red_and_blue = dot_i(E, a_rb, b_rb);
    itg a_ga = signed_pair(E, a.ga);
    itg a_green = and_i(E, a_ga, lit_i(E, 0xffff));
    itg b_ga = signed_pair(E, b.ga);
    itg green = dot_i(E, a_green, b_ga);
    itg sum = add_i(E, red_and_blue, green);
    itg scaled = shr_i(E, sum, 6);
    itg low = max_i(E, scaled, lit_i(E, 0));
    itg limited = min_i(E, low, lit_i(E, 255));
    struct color r;
    r.rb = r.ga = both_halves(E, limited);
    return r;
}

static inline struct color stage_half(struct env *e, int stage, int operation,
                                      const uint8_t argument[STAGE_ARGUMENTS],
                                      const struct stage_values *values)
{
    struct color v[STAGE_ARGUMENTS], r;
    for (int i = 0; i < STAGE_ARGUMENTS; i++)
        v[i] = i < stage_arguments[operation] ? stage_argument(E, stage, argument[i], values) : v[0];
    if (operation == STAGE_DOT)
        return stage_dot(E, v[0], v[1]);
    r.rb = stage_combine(E, operation, v[0].rb, v[1].rb, v[2].rb);
    r.ga = stage_combine(E, operation, v[0].ga, v[1].ga, v[2].ga);
    return r;
}

static inline struct color stage_premodulated(struct env *e, int channels, struct color current,
                                              struct color texture)
{
    struct color product;
    product.rb = modulate(E, current.rb, texture.rb);
    product.ga = modulate(E, current.ga, texture.ga);
    if (channels == PREMODULATE_COLOR)
        return color_join(E, product, current);
    return channels == PREMODULATE_ALPHA ? color_join(E, current, product) : product;
}

static inline void stage(struct env *e, const struct pixel_key *k, int stage, struct stage_values *v)
{
    struct stage_values read = *v;
    if (k->premodulate[stage])
        read.current = stage_premodulated(E, k->premodulate[stage], v->current, v->texture);
    struct color result = stage_half(E, stage, k->color_stage[stage], color_arguments(k, stage), &read);
    if (!stage_is_joint(k, stage)) {
        struct color alpha = stage_half(E, stage, k->alpha_stage[stage], alpha_arguments(k, stage), &read);
        result = color_join(E, result, alpha);
    }
    OBSERVE(E, stage, stage, result);
    if (k->temporary[stage])
        v->temporary = result;
    else
        v->current = result;
}

#endif
