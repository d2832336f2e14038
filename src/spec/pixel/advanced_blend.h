/* Advanced blending in binary32: the blend modes of "Compositing and Blending Level 1" (W3C), with the
 * weights of KHR_blend_equation_advanced.
 *
 * The new colour s and the stored colour d are premultiplied: their base colours are S = s / sa and
 * D = d / da, sa and da being the alphas. Both cover the part `both` = sa * da of the pixel. The result is
 *
 *   colour   both * f(S, D) + s * (1 - da) + d * (1 - sa)
 *   alpha    sa + da - both
 *
 * Here is both * f(S, D), in which most alphas cancel, so that colours are not divided by them. With
 * a = s * da and b = d * sa, which are both * S and both * D:
 *
 *   MULTIPLY      s * d
 *   SCREEN        a + b - s * d
 *   OVERLAY       2 * s * d if 2 * d <= da, else both - 2 * (sa - s) * (da - d)
 *   HARD_LIGHT    the same, but if 2 * s <= sa
 *   DARKEN        min(a, b)
 *   LIGHTEN       max(a, b)
 *   COLOR_DODGE   0 if d <= 0, both if s >= sa, else min(both, b * sa / (sa - s))
 *   COLOR_BURN    both if d >= da, 0 if s <= 0, else both - min(both, (da - d) * sa * sa / s)
 *   SOFT_LIGHT    b + (2 * s - sa) * da * g(D), with D = 0 if da is 0, and g(D) =
 *                   D - D * D                        if 2 * s <= sa
 *                   ((16 * D - 12) * D + 3) * D      else if D <= 1/4
 *                   sqrt(D) - D                      else
 *   DIFFERENCE    max(a, b) - min(a, b)
 *   EXCLUSION     a + b - 2 * s * d
 *   HUE           the hue of a, the saturation of b, the luminosity of b
 *   SATURATION    the hue of b, the saturation of a, the luminosity of b
 *   COLOR         the hue and saturation of a, the luminosity of b
 *   LUMINOSITY    the hue and saturation of b, the luminosity of a
 *
 * Luminosity is 0.30 red + 0.59 green + 0.11 blue, saturation the difference of the largest and the smallest
 * channel. A colour with channels outside 0 to `both` moves towards its luminosity until they are inside. */
#ifndef SPEC_PIXEL_ADVANCED_BLEND_H
#define SPEC_PIXEL_ADVANCED_BLEND_H

#include "contract/language.h"
#include "spec/math/float_color.h"

/* A pixel's alphas. */
struct coverage {
    flt source, target, both;
};

/* A channel of both colours, and their products. */
struct advanced_channel {
    flt s, d;
    flt a, b;    /* s * da, d * sa */
    flt product; /* s * d */
};

static inline struct advanced_channel advanced_channel(struct env *e, const struct coverage *alpha, flt s,
                                                       flt d)
{
    struct advanced_channel r = {.s = s, .d = d};
    r.a = mul_f(E, s, alpha->target);
    r.b = mul_f(E, d, alpha->source);
    r.product = mul_f(E, s, d);
    return r;
}

/* --- Channels by themselves --- */

static inline flt advanced_screen(struct env *e, const struct advanced_channel *c, flt product)
{
    flt sum = add_f(E, c->a, c->b);
    return sub_f(E, sum, product);
}

/* `value` is of the colour that decides, and has the alpha `alpha`. */
static inline flt advanced_hard_light(struct env *e, const struct advanced_channel *c,
                                      const struct coverage *alpha, flt value, flt value_alpha)
{
    flt twice = add_f(E, value, value);
    msk dark = le_f(E, twice, value_alpha);
    flt multiplied = add_f(E, c->product, c->product);
    flt new = sub_f(E, alpha->source, c->s);
    flt old = sub_f(E, alpha->target, c->d);
    flt inverse = mul_f(E, new, old);
    flt screened = mad_f(E, inverse, lit_f(E, -2.0f), alpha->both);
    return select_f(E, dark, multiplied, screened);
}

static inline flt advanced_dodge(struct env *e, const struct advanced_channel *c,
                                 const struct coverage *alpha)
{
    flt rest = sub_f(E, alpha->source, c->s);
    flt scaled = mul_f(E, c->b, alpha->source);
    flt lighter = div_f(E, scaled, rest);
    flt limited = min_f(E, lighter, alpha->both);
    msk full = le_f(E, alpha->source, c->s);
    flt dodged = select_f(E, full, alpha->both, limited);
    msk black = le_f(E, c->d, lit_f(E, 0.0f));
    return select_f(E, black, lit_f(E, 0.0f), dodged);
}

static inline flt advanced_burn(struct env *e, const struct advanced_channel *c, const struct coverage *alpha)
{
    flt rest = sub_f(E, alpha->target, c->d);
    flt once = mul_f(E, rest, alpha->source);
    flt scaled = mul_f(E, once, alpha->source);
    flt darker = div_f(E, scaled, c->s);
    flt limited = min_f(E, darker, alpha->both);
    flt left = sub_f(E, alpha->both, limited);
    msk none = le_f(E, c->s, lit_f(E, 0.0f));
    flt burnt = select_f(E, none, lit_f(E, 0.0f), left);
    msk white = le_f(E, alpha->target, c->d);
    return select_f(E, white, alpha->both, burnt);
}

/* g of the stored base colour. */
static inline flt advanced_soft_part(struct env *e, flt base, msk dark)
{
    flt square = mul_f(E, base, base);
    flt darker = sub_f(E, base, square);
    flt inner = mad_f(E, base, lit_f(E, 16.0f), lit_f(E, -12.0f));
    flt outer = mad_f(E, inner, base, lit_f(E, 3.0f));
    flt near_black = mul_f(E, outer, base);
    flt root = sqrt_f(E, base);
    flt lighter = sub_f(E, root, base);
    msk low = le_f(E, base, lit_f(E, 0.25f));
    flt light = select_f(E, low, near_black, lighter);
    return select_f(E, dark, darker, light);
}

static inline flt advanced_soft_light(struct env *e, const struct advanced_channel *c,
                                      const struct coverage *alpha)
{
    flt quotient = div_f(E, c->d, alpha->target);
    msk some = lt_f(E, lit_f(E, 0.0f), alpha->target);
    flt base = select_f(E, some, quotient, lit_f(E, 0.0f));
    flt twice = add_f(E, c->s, c->s);
    msk dark = le_f(E, twice, alpha->source);
    flt part = advanced_soft_part(E, base, dark);
    flt excess = sub_f(E, twice, alpha->source);
    flt weight = mul_f(E, excess, alpha->target);
    return mad_f(E, weight, part, c->b);
}

static inline flt advanced_difference(struct env *e, const struct advanced_channel *c)
{
    flt larger = max_f(E, c->a, c->b);
    flt smaller = min_f(E, c->a, c->b);
    return sub_f(E, larger, smaller);
}

/* both * f of a channel. */
static inline flt advanced_separate(struct env *e, int kind, const struct advanced_channel *c,
                                    const struct coverage *alpha)
{
    switch ((enum advanced)kind) {
    case ADVANCED_MULTIPLY: return c->product;
    case ADVANCED_SCREEN: return advanced_screen(E, c, c->product);
    case ADVANCED_OVERLAY: return advanced_hard_light(E, c, alpha, c->d, alpha->target);
    case ADVANCED_DARKEN: return min_f(E, c->a, c->b);
    case ADVANCED_LIGHTEN: return max_f(E, c->a, c->b);
    case ADVANCED_COLOR_DODGE: return advanced_dodge(E, c, alpha);
    case ADVANCED_COLOR_BURN: return advanced_burn(E, c, alpha);
    case ADVANCED_HARD_LIGHT: return advanced_hard_light(E, c, alpha, c->s, alpha->source);
    case ADVANCED_SOFT_LIGHT: return advanced_soft_light(E, c, alpha);
    case ADVANCED_DIFFERENCE: return advanced_difference(E, c);
    case ADVANCED_EXCLUSION: {
        flt twice = add_f(E, c->product, c->product);
        return advanced_screen(E, c, twice);
    }
    case ADVANCED_HUE:
    case ADVANCED_SATURATION:
    case ADVANCED_COLOR:
    case ADVANCED_LUMINOSITY:
    case ADVANCED_COUNT: break;
    }
    return c->a;
}

/* --- Hue, saturation, luminosity --- */

struct hsl {
    flt channel[3];
};

static inline flt hsl_luminosity(struct env *e, const struct hsl *c)
{
    flt blue = mul_f(E, c->channel[2], lit_f(E, 0.11f));
    flt green = mad_f(E, c->channel[1], lit_f(E, 0.59f), blue);
    return mad_f(E, c->channel[0], lit_f(E, 0.30f), green);
}

static inline flt hsl_smallest(struct env *e, const struct hsl *c)
{
    flt two = min_f(E, c->channel[0], c->channel[1]);
    return min_f(E, two, c->channel[2]);
}

static inline flt hsl_largest(struct env *e, const struct hsl *c)
{
    flt two = max_f(E, c->channel[0], c->channel[1]);
    return max_f(E, two, c->channel[2]);
}

/* `room` / `distance` if `outside` and the distance is above 0, else 1. */
static inline flt hsl_reduction(struct env *e, flt room, flt distance, msk outside)
{
    flt ratio = div_f(E, room, distance);
    msk apart = lt_f(E, lit_f(E, 0.0f), distance);
    msk reduced = and_m(E, outside, apart);
    return select_f(E, reduced, ratio, lit_f(E, 1.0f));
}

/* Moves the colour towards its luminosity, until its channels are from 0 to `most`. */
static inline struct hsl hsl_clip(struct env *e, struct hsl c, flt most)
{
    flt gray = hsl_luminosity(E, &c);
    flt low = hsl_smallest(E, &c);
    flt high = hsl_largest(E, &c);
    flt down = sub_f(E, gray, low);
    msk below = lt_f(E, low, lit_f(E, 0.0f));
    flt by_low = hsl_reduction(E, gray, down, below);
    flt up = sub_f(E, high, gray);
    flt room = sub_f(E, most, gray);
    msk above = lt_f(E, most, high);
    flt by_high = hsl_reduction(E, room, up, above);
    flt scale = mul_f(E, by_low, by_high);
    for (int i = 0; i < 3; i++) {
        flt distance = sub_f(E, c.channel[i], gray);
        c.channel[i] = mad_f(E, distance, scale, gray);
    }
    return c;
}

/* `base` with the luminosity of `bright`. */
static inline struct hsl hsl_with_luminosity(struct env *e, struct hsl base, const struct hsl *bright,
                                             flt most)
{
    flt old = hsl_luminosity(E, &base);
    flt new = hsl_luminosity(E, bright);
    flt change = sub_f(E, new, old);
    for (int i = 0; i < 3; i++)
        base.channel[i] = add_f(E, base.channel[i], change);
    return hsl_clip(E, base, most);
}

/* `base` from 0 to the saturation of `vivid`; gray gives black. */
static inline struct hsl hsl_with_saturation(struct env *e, struct hsl base, const struct hsl *vivid)
{
    flt low = hsl_smallest(E, &base);
    flt high = hsl_largest(E, &base);
    flt old = sub_f(E, high, low);
    flt vivid_high = hsl_largest(E, vivid);
    flt vivid_low = hsl_smallest(E, vivid);
    flt new = sub_f(E, vivid_high, vivid_low);
    flt ratio = div_f(E, new, old);
    msk some = lt_f(E, lit_f(E, 0.0f), old);
    flt scale = select_f(E, some, ratio, lit_f(E, 0.0f));
    for (int i = 0; i < 3; i++) {
        flt above = sub_f(E, base.channel[i], low);
        base.channel[i] = mul_f(E, above, scale);
    }
    return base;
}

/* both * f of all channels. */
static inline struct hsl advanced_hsl(struct env *e, int kind, const struct hsl *a, const struct hsl *b,
                                      flt both)
{
    if (kind == ADVANCED_COLOR)
        return hsl_with_luminosity(E, *a, b, both);
    if (kind == ADVANCED_LUMINOSITY)
        return hsl_with_luminosity(E, *b, a, both);
    bool hue = kind == ADVANCED_HUE;
    struct hsl base = hsl_with_saturation(E, hue ? *a : *b, hue ? b : a);
    return hsl_with_luminosity(E, base, b, both);
}

/* --- All channels --- */

static inline bool advanced_is_hsl(int kind)
{
    return kind >= ADVANCED_HUE;
}

static inline struct hsl advanced_overlap(struct env *e, int kind, const struct advanced_channel channel[3],
                                          const struct coverage *alpha)
{
    struct hsl a, b, r;
    for (int i = 0; i < 3; i++) {
        a.channel[i] = channel[i].a;
        b.channel[i] = channel[i].b;
    }
    if (advanced_is_hsl(kind))
        return advanced_hsl(E, kind, &a, &b, alpha->both);
    for (int i = 0; i < 3; i++)
        r.channel[i] = advanced_separate(E, kind, &channel[i], alpha);
    return r;
}

/* `kind` is of enum advanced. */
static inline struct float_color advanced_blend(struct env *e, int kind, const struct float_color *s,
                                                const struct float_color *d)
{
    struct coverage alpha = {.source = s->channel[3], .target = d->channel[3]};
    struct advanced_channel channel[3];
    struct float_color r;
    alpha.both = mul_f(E, alpha.source, alpha.target);
    for (int i = 0; i < 3; i++)
        channel[i] = advanced_channel(E, &alpha, s->channel[i], d->channel[i]);
    struct hsl overlap = advanced_overlap(E, kind, channel, &alpha);
    flt only_source = float_invert(E, alpha.target);
    flt only_target = float_invert(E, alpha.source);
    for (int i = 0; i < 3; i++) {
        flt sum = mad_f(E, s->channel[i], only_source, overlap.channel[i]);
        r.channel[i] = mad_f(E, d->channel[i], only_target, sum);
    }
    flt sum = add_f(E, alpha.source, alpha.target);
    r.channel[3] = sub_f(E, sum, alpha.both);
    return r;
}

#endif
