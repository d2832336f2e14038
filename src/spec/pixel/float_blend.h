/* Blending in binary32: the factors and operations of blend.h on unscaled channels.
 *
 *   ADD                 s * f + d * g, every product rounded
 *   SUBTRACT            s * f - d * g
 *   REVERSE_SUBTRACT    d * g - s * f
 *   MINIMUM, MAXIMUM    of s and d
 *   ADVANCED            advanced_blend.h
 *
 * If the target has floating point, nothing is clamped. Otherwise s is clamped to 0..1 before blending, and
 * the result when it is quantized. Bytes of a target are read as byte / 255. */
#ifndef SPEC_PIXEL_FLOAT_BLEND_H
#define SPEC_PIXEL_FLOAT_BLEND_H

#include "contract/language.h"
#include "spec/math/float_color.h"
#include "spec/pixel/advanced_blend.h"
#include "spec/pixel/blend.h"

/* The colours of a pixel: new, the shader's second, stored. */
struct float_blend_colors {
    const struct float_color *s, *second, *d;
};

/* A factor that is neither ZERO, ONE nor an inverse. */
static inline struct float_color float_factor_direct(struct env *e, int factor,
                                                     const struct float_blend_colors *c)
{
    switch ((enum factor)factor) {
    case FACTOR_SOURCE_COLOR: return *c->s;
    case FACTOR_TARGET_COLOR: return *c->d;
    case FACTOR_SECOND_COLOR: return *c->second;
    case FACTOR_SOURCE_ALPHA: return float_replicate(c->s->channel[3]);
    case FACTOR_TARGET_ALPHA: return float_replicate(c->d->channel[3]);
    case FACTOR_SECOND_ALPHA: return float_replicate(c->second->channel[3]);
    case FACTOR_SATURATED_ALPHA: {
        flt inverse = float_invert(E, c->d->channel[3]);
        flt smaller = min_f(E, c->s->channel[3], inverse);
        struct float_color r = float_replicate(smaller);
        return float_join(r, lit_f(E, 1.0f));
    }
    case FACTOR_CONSTANT: return float_packed(E, offsetof(struct job, blend_constant));
    case FACTOR_CONSTANT_ALPHA: {
        struct float_color constant = float_packed(E, offsetof(struct job, blend_constant));
        return float_replicate(constant.channel[3]);
    }
    case FACTOR_ZERO:
    case FACTOR_ONE:
    case FACTOR_INVERSE_SOURCE_COLOR:
    case FACTOR_INVERSE_SOURCE_ALPHA:
    case FACTOR_INVERSE_TARGET_ALPHA:
    case FACTOR_INVERSE_TARGET_COLOR:
    case FACTOR_INVERSE_CONSTANT:
    case FACTOR_INVERSE_CONSTANT_ALPHA:
    case FACTOR_INVERSE_SECOND_COLOR:
    case FACTOR_INVERSE_SECOND_ALPHA:
    case FACTOR_COUNT: break;
    }
    return *c->s;
}

static inline struct float_color float_factor(struct env *e, int factor, const struct float_blend_colors *c)
{
    if (factor >= FACTOR_SATURATED_ALPHA || !(factor & 1))
        return float_factor_direct(E, factor, c);
    struct float_color r = float_factor_direct(E, factor - 1, c);
    if (factor_is_uniform(factor)) {
        flt inverse = float_invert(E, r.channel[0]);
        return float_replicate(inverse);
    }
    for (int i = 0; i < 4; i++)
        r.channel[i] = float_invert(E, r.channel[i]);
    return r;
}

/* Channels first to last of a colour times a factor. */
static inline struct float_color float_term(struct env *e, int factor, struct float_color color, int first,
                                            int last, const struct float_blend_colors *colors)
{
    if (factor == FACTOR_ONE)
        return color;
    if (factor == FACTOR_ZERO)
        return float_replicate(lit_f(E, 0.0f));
    struct float_color value = float_factor(E, factor, colors);
    for (int c = first; c <= last; c++)
        color.channel[c] = mul_f(E, color.channel[c], value.channel[c]);
    return color;
}

static inline flt float_combine(struct env *e, int blend, flt s, flt d)
{
    switch ((enum blend)blend) {
    case BLEND_ADD: return add_f(E, s, d);
    case BLEND_SUBTRACT: return sub_f(E, s, d);
    case BLEND_REVERSE_SUBTRACT: return sub_f(E, d, s);
    case BLEND_MINIMUM: return min_f(E, s, d);
    case BLEND_MAXIMUM: return max_f(E, s, d);
    case BLEND_COPY:
    case BLEND_ADVANCED:
    case BLEND_COUNT: break;
    }
    return s;
}

/* Blends channels first to last by the key's factors and operation for colour or for alpha. */
static inline struct float_color float_blend_channels(struct env *e, const struct pixel_key *k, int kind,
                                                      int first, int last,
                                                      const struct float_blend_colors *colors)
{
    int blend = k->blend[kind];
    bool extreme = blend == BLEND_MINIMUM || blend == BLEND_MAXIMUM;
    int source_factor = extreme ? FACTOR_ONE : k->source_factor[kind];
    int target_factor = extreme ? FACTOR_ONE : k->target_factor[kind];
    if (blend == BLEND_COPY)
        return *colors->s;
    struct float_color r = float_term(E, source_factor, *colors->s, first, last, colors);
    if (blend == BLEND_ADD && target_factor == FACTOR_ZERO)
        return r;
    struct float_color old = float_term(E, target_factor, *colors->d, first, last, colors);
    for (int c = first; c <= last; c++)
        r.channel[c] = float_combine(E, blend, r.channel[c], old.channel[c]);
    return r;
}

/* `second` is read only if the key reads it. */
static inline struct float_color float_blend(struct env *e, const struct pixel_key *k,
                                             const struct float_color *s, const struct float_color *second,
                                             const struct float_color *d)
{
    const struct float_blend_colors colors = {s, second, d};
    if (blend_is_advanced(k->blend[BLEND_COLOR]))
        return advanced_blend(E, k->blend[BLEND_COLOR] - BLEND_ADVANCED, s, d);
    if (!blend_is_separate(k))
        return float_blend_channels(E, k, BLEND_COLOR, 0, 3, &colors);
    struct float_color color = float_blend_channels(E, k, BLEND_COLOR, 0, 2, &colors);
    struct float_color alpha = float_blend_channels(E, k, BLEND_ALPHA, 3, 3, &colors);
    return float_join(color, alpha.channel[3]);
}

#endif
