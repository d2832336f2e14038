/* Blending of the new colour s with the stored colour d, in integers from 0 to 255 (Direct3D 9, "Alpha
 * Blending State").
 *
 *   factor f          ZERO 0, ONE 255, COLOR the channel's own, ALPHA alpha's, CONSTANT the draw's,
 *                     CONSTANT_ALPHA its alpha, INVERSE 255 - f,
 *                     SATURATED_ALPHA min(s alpha, 255 - d alpha), 255 for alpha itself
 *   product x * f     round(x * f / 255)
 *
 *   ADD               min(255, s * f + d * g)
 *   ADD, g = 255 - f  round((s * f + d * g) / 255): one rounding for both products
 *   SUBTRACT          max(0, s * f - d * g)
 *   REVERSE_SUBTRACT  max(0, d * g - s * f)
 *   MINIMUM, MAXIMUM  of s and d
 *   ADVANCED          advanced_blend.h, in binary32 of byte / 255; then the nearest bytes
 *
 * Alpha has factors and an operation of its own if the key has separate ones for it. */
#ifndef SPEC_PIXEL_BLEND_H
#define SPEC_PIXEL_BLEND_H

#include "contract/language.h"
#include "spec/math/color.h"
#include "spec/pixel/advanced_blend.h"

/* The colours of a pixel: new, the shader's second, stored. */
struct blend_colors {
    struct color s, second, d;
};

static inline struct color color_invert(struct env *e, struct color color, int uniform)
{
    struct color r;
    r.rb = sub_x(E, lit_x(E, 255), color.rb);
    r.ga = uniform ? r.rb : sub_x(E, lit_x(E, 255), color.ga);
    return r;
}

/* Returns 1 if all channels have the same factor, which is then computed once. */
static inline bool factor_is_uniform(int factor)
{
    return (factor >= FACTOR_SOURCE_ALPHA && factor <= FACTOR_INVERSE_TARGET_ALPHA) ||
           (factor | 1) == FACTOR_INVERSE_CONSTANT_ALPHA || (factor | 1) == FACTOR_INVERSE_SECOND_ALPHA;
}

static inline struct color factor_saturated_alpha(struct env *e, struct color s, struct color d)
{
    struct color r;
    fix source = color_alpha(E, s);
    fix target = color_alpha(E, d);
    fix inverse = sub_x(E, lit_x(E, 255), target);
    r.rb = min_x(E, source, inverse);
    itg both = int_of(E, r.rb);
    itg green = and_i(E, both, lit_i(E, 0xff));
    itg ga = or_i(E, green, lit_i(E, 0xff0000));
    r.ga = fix_of(E, ga);
    return r;
}

/* A factor that is neither ZERO, ONE nor an inverse. factor_value handles inverses, make_term the constants.
 */
static inline struct color factor_direct(struct env *e, int factor, const struct blend_colors *c)
{
    struct color r;
    switch ((enum factor)factor) {
    case FACTOR_SOURCE_COLOR: return c->s;
    case FACTOR_TARGET_COLOR: return c->d;
    case FACTOR_SECOND_COLOR: return c->second;
    case FACTOR_SOURCE_ALPHA: r.rb = r.ga = color_alpha(E, c->s); return r;
    case FACTOR_TARGET_ALPHA: r.rb = r.ga = color_alpha(E, c->d); return r;
    case FACTOR_SECOND_ALPHA: r.rb = r.ga = color_alpha(E, c->second); return r;
    case FACTOR_SATURATED_ALPHA: return factor_saturated_alpha(E, c->s, c->d);
    case FACTOR_CONSTANT: {
        itg constant = uniform_i(E, BASE_JOB, (int)offsetof(struct job, blend_constant));
        return color_unpack(E, constant);
    }
    case FACTOR_CONSTANT_ALPHA: {
        itg constant = uniform_i(E, BASE_JOB, (int)offsetof(struct job, blend_constant));
        itg alpha = ushr_i(E, constant, 24);
        r.rb = r.ga = both_halves(E, alpha);
        return r;
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
    return c->s;
}

static inline struct color factor_value(struct env *e, int factor, const struct blend_colors *c)
{
    if (factor >= FACTOR_SATURATED_ALPHA || !(factor & 1))
        return factor_direct(E, factor, c);
    struct color direct = factor_direct(E, factor - 1, c);
    return color_invert(E, direct, factor_is_uniform(factor));
}

/* round(s * f + d * g) with one rounding, g = 255 - f */
static inline fix lerp_pair(struct env *e, fix s, fix d, fix f, fix g)
{
    fix new = mul_x(E, s, f);
    fix old = mul_x(E, d, g);
    fix sum = add_x(E, new, old);
    return divide_255(E, sum);
}

static inline struct color blend_lerp(struct env *e, int factor, const struct blend_colors *c)
{
    struct color r;
    struct color direct = factor_direct(E, factor & ~1, c);
    struct color inverse = color_invert(E, direct, factor_is_uniform(factor));
    struct color f = factor & 1 ? inverse : direct;
    struct color g = factor & 1 ? direct : inverse;
    r.rb = lerp_pair(E, c->s.rb, c->d.rb, f.rb, g.rb);
    r.ga = lerp_pair(E, c->s.ga, c->d.ga, f.ga, g.ga);
    return r;
}

static inline fix combine_pair(struct env *e, int blend, fix s, fix d)
{
    switch ((enum blend)blend) {
    case BLEND_ADD: return add_saturated(E, s, d);
    case BLEND_SUBTRACT: return subtract_saturated(E, s, d);
    case BLEND_REVERSE_SUBTRACT: return subtract_saturated(E, d, s);
    case BLEND_MINIMUM: return min_x(E, s, d);
    case BLEND_MAXIMUM: {
        fix more = subtract_saturated(E, s, d);
        return add_x(E, d, more);
    }
    case BLEND_COPY:
    case BLEND_ADVANCED:
    case BLEND_COUNT: break;
    }
    return s;
}

/* A colour and its factor's value. */
struct term {
    int factor;
    struct color color, value;
};

static inline struct term make_term(struct env *e, int factor, struct color color,
                                    const struct blend_colors *c)
{
    struct term r = {factor, color, color};
    if (factor > FACTOR_ONE)
        r.value = factor_value(E, factor, c);
    return r;
}

static inline fix term_pair(struct env *e, const struct term *term, fix color, fix value)
{
    if (term->factor == FACTOR_ZERO)
        return lit_x(E, 0);
    return term->factor == FACTOR_ONE ? color : modulate(E, color, value);
}

static inline struct color blend_terms(struct env *e, int blend, const struct term *source,
                                       const struct term *target)
{
    struct color r;
    r.rb = term_pair(E, source, source->color.rb, source->value.rb);
    if (target->factor != FACTOR_ZERO || blend != BLEND_ADD) {
        fix d = term_pair(E, target, target->color.rb, target->value.rb);
        r.rb = combine_pair(E, blend, r.rb, d);
    }
    r.ga = term_pair(E, source, source->color.ga, source->value.ga);
    if (target->factor != FACTOR_ZERO || blend != BLEND_ADD) {
        fix d = term_pair(E, target, target->color.ga, target->value.ga);
        r.ga = combine_pair(E, blend, r.ga, d);
    }
    return r;
}

/* Blends all channels by the key's factors and operation for colour or for alpha. */
static inline struct color blend_channels(struct env *e, const struct pixel_key *k, int kind,
                                          const struct blend_colors *c)
{
    int blend = k->blend[kind], source_factor = k->source_factor[kind],
        target_factor = k->target_factor[kind];
    if (blend == BLEND_COPY)
        return c->s;
    if (blend_is_lerp(blend, source_factor, target_factor))
        return blend_lerp(E, source_factor, c);
    if (blend == BLEND_MINIMUM || blend == BLEND_MAXIMUM)
        source_factor = target_factor = FACTOR_ONE;
    struct term source = make_term(E, source_factor, c->s, c);
    struct term target = make_term(E, target_factor, c->d, c);
    return blend_terms(E, blend, &source, &target);
}

/* Red, green and blue of `color`, alpha of `alpha`. */
static inline struct color color_with_alpha(struct env *e, struct color color, struct color alpha)
{
    struct color r = color;
    itg low = int_of(E, color.ga);
    itg high = int_of(E, alpha.ga);
    itg green = and_i(E, low, lit_i(E, 0xff));
    itg above = and_i(E, high, lit_i(E, 0xff0000));
    itg ga = or_i(E, green, above);
    r.ga = fix_of(E, ga);
    return r;
}

static inline struct color blend_advanced(struct env *e, int blend, struct color s, itg stored)
{
    itg new = color_pack(E, s);
    struct float_color source = float_unpack(E, new);
    struct float_color target = float_unpack(E, stored);
    struct float_color r = advanced_blend(E, blend - BLEND_ADVANCED, &source, &target);
    return color_quantize(E, r.channel);
}

/* `second` is read only if the key reads it. */
static inline struct color blend(struct env *e, const struct pixel_key *k, struct color s,
                                 struct color second, itg stored)
{
    int separate = blend_is_separate(k);
    if (k->blend[BLEND_COLOR] == BLEND_COPY && !separate)
        return s;
    if (blend_is_advanced(k->blend[BLEND_COLOR]))
        return blend_advanced(E, k->blend[BLEND_COLOR], s, stored);
    struct blend_colors c = {.s = s, .second = second};
    c.d = color_unpack(E, stored);
    struct color r = blend_channels(E, k, BLEND_COLOR, &c);
    if (!separate)
        return r;
    struct color alpha = blend_channels(E, k, BLEND_ALPHA, &c);
    return color_with_alpha(E, r, alpha);
}

#endif
