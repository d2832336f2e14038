/* Blending by primitive: a draw has primitives that its states blend, and others that are shadows or subpixel
 * text of a colour of their own. The triangle record has the number of the blending and the colour p, those
 * of the provoking vertex; the next record has its own. s is the new colour, after the alpha test and the
 * clip mask, d the stored one.
 *
 *   number        blending         mask m
 *   1, SHADOW     drop shadow      alpha of s, in all channels
 *   2, SUBPIXEL   subpixel text    s, a part of the pixel for each channel
 *   others        the states
 *
 *   result        m * p + d * (1 - m * p alpha)
 *
 * p is premultiplied by its alpha, and clamped to 0..1. In bytes p is quantized, 1 is 255, each product is
 * rounded, and the sum is at most 255. In binary32 each operation is rounded. */
#ifndef SPEC_PIXEL_PRIMITIVE_BLEND_H
#define SPEC_PIXEL_PRIMITIVE_BLEND_H

#include "contract/key_query.h"
#include "contract/language.h"
#include "spec/math/color.h"
#include "spec/math/float_color.h"
#include "spec/pixel/interpolate.h"
#include "spec/pixel/source.h"
#include "spec/texture/sample.h"

/* The lanes that have a blending of their own. `shadow` and `lanes` are undefined if the key has none. */
struct primitive_blend {
    const struct pixel_source *source;
    msk shadow, lanes;
};

/* Component c of the varying: the number, then red, green, blue, alpha. */
static inline flt primitive_value(struct env *e, const struct pixel_source *s, int c)
{
    return interpolate(E, s->k, s->layout, s->at, s->w, VARYING_blending, c);
}

/* The lanes of a group can belong to several records. */
static inline struct primitive_blend primitive_blend_begin(struct env *e, const struct pixel_source *s)
{
    struct primitive_blend r = {.source = s};
    if (!pixel_blends_by_primitive(s->k))
        return r;
    flt number = primitive_value(E, s, 0);
    r.shadow = eq_f(E, number, lit_f(E, BLENDING_SHADOW));
    msk text = eq_f(E, number, lit_f(E, BLENDING_SUBPIXEL));
    r.lanes = or_m(E, r.shadow, text);
    return r;
}

static inline struct float_color primitive_color(struct env *e, const struct pixel_source *s)
{
    struct float_color r;
    for (int c = 0; c < 4; c++) {
        flt value = primitive_value(E, s, BLENDING_COLOR + c);
        r.channel[c] = saturate(E, value);
    }
    return r;
}

/* --- Bytes --- */

static inline fix primitive_mask(struct env *e, msk shadow, fix alpha, fix channels)
{
    itg all = int_of(E, alpha);
    itg each = int_of(E, channels);
    itg mask = select_i(E, shadow, all, each);
    return fix_of(E, mask);
}

/* `covering` is the colour's alpha in both halves. */
static inline fix primitive_pair(struct env *e, fix mask, fix color, fix covering, fix stored)
{
    fix new = modulate(E, mask, color);
    fix covered = modulate(E, mask, covering);
    fix left = sub_x(E, lit_x(E, 255), covered);
    fix old = modulate(E, stored, left);
    return add_saturated(E, new, old);
}

static inline struct color primitive_blend_own(struct env *e, const struct primitive_blend *b, struct color s,
                                               itg stored)
{
    struct color r;
    struct color d = color_unpack(E, stored);
    struct float_color exact = primitive_color(E, b->source);
    struct color p = color_quantize(E, exact.channel);
    fix covering = color_alpha(E, p);
    fix alpha = color_alpha(E, s);
    fix rb = primitive_mask(E, b->shadow, alpha, s.rb);
    fix ga = primitive_mask(E, b->shadow, alpha, s.ga);
    r.rb = primitive_pair(E, rb, p.rb, covering, d.rb);
    r.ga = primitive_pair(E, ga, p.ga, covering, d.ga);
    return r;
}

/* `blended` is the result of the states. */
static inline struct color primitive_blend(struct env *e, const struct primitive_blend *b, struct color s,
                                           itg stored, struct color blended)
{
    if (!pixel_blends_by_primitive(b->source->k))
        return blended;
    itg rb = int_of(E, blended.rb);
    itg ga = int_of(E, blended.ga);
    set_i(E, VARIABLE_PAIR_SUM, rb);
    set_i(E, VARIABLE_PAIR_SUM + 1, ga);
    WHEN (E, b->lanes) {
        struct color own = primitive_blend_own(E, b, s, stored);
        itg own_rb = int_of(E, own.rb);
        itg own_ga = int_of(E, own.ga);
        itg new_rb = select_i(E, b->lanes, own_rb, rb);
        itg new_ga = select_i(E, b->lanes, own_ga, ga);
        set_i(E, VARIABLE_PAIR_SUM, new_rb);
        set_i(E, VARIABLE_PAIR_SUM + 1, new_ga);
    }
    rb = get_i(E, VARIABLE_PAIR_SUM);
    ga = get_i(E, VARIABLE_PAIR_SUM + 1);
    blended.rb = fix_of(E, rb);
    blended.ga = fix_of(E, ga);
    return blended;
}

/* --- Binary32 --- */

static inline flt float_primitive_channel(struct env *e, flt mask, flt color, flt covering, flt stored)
{
    flt new = mul_f(E, mask, color);
    flt covered = mul_f(E, mask, covering);
    flt left = float_invert(E, covered);
    flt old = mul_f(E, stored, left);
    return add_f(E, new, old);
}

static inline struct float_color float_primitive_blend(struct env *e, const struct primitive_blend *b,
                                                       const struct float_color *s,
                                                       const struct float_color *d,
                                                       struct float_color blended)
{
    if (!pixel_blends_by_primitive(b->source->k))
        return blended;
    for (int c = 0; c < 4; c++)
        set_f(E, VARIABLE_SUM + c, blended.channel[c]);
    WHEN (E, b->lanes) {
        struct float_color p = primitive_color(E, b->source);
        for (int c = 0; c < 4; c++) {
            flt mask = select_f(E, b->shadow, s->channel[3], s->channel[c]);
            flt own = float_primitive_channel(E, mask, p.channel[c], p.channel[3], d->channel[c]);
            flt new = select_f(E, b->lanes, own, blended.channel[c]);
            set_f(E, VARIABLE_SUM + c, new);
        }
    }
    for (int c = 0; c < 4; c++)
        blended.channel[c] = get_f(E, VARIABLE_SUM + c);
    return blended;
}

#endif
