/* A texture stage in binary32. Order and arguments are those of stage.h; the operations are
 *
 *   SELECT         a, not clamped
 *   MODULATE       a * b; 2X and 4X: twice and four times that
 *   ADD            a + b
 *   ADD_SIGNED     a + b - 1/2; 2X: twice that
 *   SUBTRACT       a - b
 *   MULTIPLY_ADD   c + a * b, rounded once
 *   LERP           a * c + b * (1 - c)
 *   DOT            4 * (sum over red, green, blue of (a - 1/2) * (b - 1/2)), in all four channels
 *
 * All results but those of SELECT are clamped to 0..1, also after premodulation and the addition of specular:
 * Direct3D 9's stages compute colours in that range, but pass other values through. 1/2 is exact here, so a
 * signed operation differs from its packed form by at most 1/510. */
#ifndef SPEC_PIXEL_FLOAT_STAGE_H
#define SPEC_PIXEL_FLOAT_STAGE_H

#include "contract/language.h"
#include "spec/math/float_color.h"

struct float_values {
    struct float_color diffuse, specular, texture, current, temporary;
};

static inline struct float_color float_source(struct env *e, int stage, int source,
                                              const struct float_values *v)
{
    switch ((enum source)source) {
    case SOURCE_DIFFUSE: return v->diffuse;
    case SOURCE_TEXTURE: return v->texture;
    case SOURCE_CURRENT: return v->current;
    case SOURCE_SPECULAR: return v->specular;
    case SOURCE_TEMPORARY: return v->temporary;
    case SOURCE_CONSTANT:
        return float_packed(E, offsetof(struct job, stage_constant) + sizeof(uint32_t) * (size_t)stage);
    case SOURCE_FACTOR:
    case SOURCE_COUNT: break;
    }
    return float_packed(E, offsetof(struct job, texture_factor));
}

static inline struct float_color float_argument(struct env *e, int stage, int argument,
                                                const struct float_values *v)
{
    struct float_color r = float_source(E, stage, argument % SOURCE_COUNT, v);
    if (argument / ARGUMENT_REPLICATE & 1)
        r = float_replicate(r.channel[3]);
    if (argument / ARGUMENT_COMPLEMENT)
        for (int c = 0; c < 4; c++)
            r.channel[c] = float_invert(E, r.channel[c]);
    return r;
}

static inline flt float_add_signed(struct env *e, int operation, flt a, flt b)
{
    flt sum = add_f(E, a, b);
    flt r = sub_f(E, sum, lit_f(E, 0.5f));
    return operation == STAGE_ADD_SIGNED ? r : add_f(E, r, r);
}

static inline flt float_modulate(struct env *e, int operation, flt a, flt b)
{
    flt r = mul_f(E, a, b);
    if (operation == STAGE_MODULATE_2X)
        r = mul_f(E, r, lit_f(E, 2.0f));
    if (operation == STAGE_MODULATE_4X)
        r = mul_f(E, r, lit_f(E, 4.0f));
    return r;
}

static inline flt float_operation(struct env *e, int operation, flt a, flt b, flt c)
{
    switch ((enum stage)operation) {
    case STAGE_ADD: return add_f(E, a, b);
    case STAGE_ADD_SIGNED:
    case STAGE_ADD_SIGNED_2X: return float_add_signed(E, operation, a, b);
    case STAGE_SUBTRACT: return sub_f(E, a, b);
    case STAGE_MULTIPLY_ADD: return mad_f(E, a, b, c);
    case STAGE_LERP: return float_lerp(E, a, b, c);
    case STAGE_MODULATE:
    case STAGE_MODULATE_2X:
    case STAGE_MODULATE_4X: return float_modulate(E, operation, a, b);
    case STAGE_SELECT:
    case STAGE_DOT:
    case STAGE_COUNT: break;
    }
    return a;
}

static inline struct float_color float_dot(struct env *e, const struct float_color *a,
                                           const struct float_color *b)
{
    flt sum = lit_f(E, 0.0f);
    for (int c = 0; c < 3; c++) {
        flt x = sub_f(E, a->channel[c], lit_f(E, 0.5f));
        flt y = sub_f(E, b->channel[c], lit_f(E, 0.5f));
        sum = mad_f(E, x, y, sum);
    }
    flt scaled = mul_f(E, sum, lit_f(E, 4.0f));
    flt limited = saturate(E, scaled);
    return float_replicate(limited);
}

/* Channels first to last by the operation and arguments of one half. */
static inline struct float_color float_half(struct env *e, int stage, int operation,
                                            const uint8_t argument[STAGE_ARGUMENTS], int first, int last,
                                            const struct float_values *values)
{
    struct float_color v[STAGE_ARGUMENTS], r;
    for (int i = 0; i < STAGE_ARGUMENTS; i++)
        v[i] = i < stage_arguments[operation] ? float_argument(E, stage, argument[i], values) : v[0];
    if (operation == STAGE_SELECT)
        return v[0];
    if (operation == STAGE_DOT)
        return float_dot(E, &v[0], &v[1]);
    r = v[0];
    for (int c = first; c <= last; c++) {
        flt result = float_operation(E, operation, v[0].channel[c], v[1].channel[c], v[2].channel[c]);
        r.channel[c] = saturate(E, result);
    }
    return r;
}

static inline struct float_color float_premodulated(struct env *e, int channels, struct float_color current,
                                                    const struct float_color *texture)
{
    for (int c = 0; c < 4; c++)
        if (channels & (c < 3 ? PREMODULATE_COLOR : PREMODULATE_ALPHA)) {
            flt product = mul_f(E, current.channel[c], texture->channel[c]);
            current.channel[c] = saturate(E, product);
        }
    return current;
}

static inline void float_stage(struct env *e, const struct pixel_key *k, int stage, struct float_values *v)
{
    struct float_values read = *v;
    int joint = stage_is_joint(k, stage);
    if (k->premodulate[stage])
        read.current = float_premodulated(E, k->premodulate[stage], v->current, &v->texture);
    struct float_color result =
        float_half(E, stage, k->color_stage[stage], color_arguments(k, stage), 0, joint ? 3 : 2, &read);
    if (!joint) {
        struct float_color alpha =
            float_half(E, stage, k->alpha_stage[stage], alpha_arguments(k, stage), 3, 3, &read);
        result = float_join(result, alpha.channel[3]);
    }
    OBSERVE(E, stage_exact, stage, result);
    if (k->temporary[stage])
        v->temporary = result;
    else
        v->current = result;
}

static inline struct float_color float_specular(struct env *e, struct float_color color,
                                                const struct float_color *specular)
{
    for (int c = 0; c < 3; c++) {
        flt sum = add_f(E, color.channel[c], specular->channel[c]);
        color.channel[c] = saturate(E, sum);
    }
    return color;
}

#endif
