/* Colour in packed integers: the four 8-bit channels of a pixel as two pairs of 16-bit integers.
 *
 *   texel, target word   A | B | G | R      (red in the low byte)
 *   rb                   0 B | 0 R          blue above red
 *   ga                   0 A | 0 G          alpha above green
 *
 * Channels are 0 to 255 and mean 0 to 1. Every stage reads and returns channels in that range, correctly
 * rounded, as Direct3D's fixed-function stages do where texture and target have 8 bits. Products stay below
 * 2^16. */
#ifndef SPEC_MATH_COLOR_H
#define SPEC_MATH_COLOR_H

#include "contract/language.h"

struct color {
    fix rb, ga;
};

static inline struct color color_unpack(struct env *e, itg word)
{
    struct color r;
    itg rb = and_i(E, word, lit_i(E, 0x00ff00ff));
    r.rb = fix_of(E, rb);
    fix pairs = fix_of(E, word);
    r.ga = ushr_x(E, pairs, 8);
    return r;
}

/* A packed colour of the job. */
static inline struct color packed_color(struct env *e, size_t field)
{
    itg word = uniform_i(E, BASE_JOB, (int)field);
    return color_unpack(E, word);
}

/* Red, green and blue of one colour, alpha of another. */
static inline struct color color_join(struct env *e, struct color color, struct color alpha)
{
    itg color_ga = int_of(E, color.ga);
    itg alpha_ga = int_of(E, alpha.ga);
    itg green = and_i(E, color_ga, lit_i(E, 0x0000ffff));
    itg top = and_i(E, alpha_ga, lit_i(E, -0x10000));
    itg both = or_i(E, green, top);
    color.ga = fix_of(E, both);
    return color;
}

static inline itg color_pack(struct env *e, struct color color)
{
    fix high = shl_x(E, color.ga, 8);
    itg ga = int_of(E, high);
    itg rb = int_of(E, color.rb);
    return or_i(E, rb, ga);
}

/* round(product / 255) for products up to 255 * 255: t = product + 128; (t + (t >> 8)) >> 8 (Blinn 1995).
 * The sum is t * 257 / 256, rounded down, so the result is the high half of t * 257. */
static inline fix divide_255(struct env *e, fix product)
{
    fix t = add_x(E, product, lit_x(E, 128));
    return high_x(E, t, lit_x(E, 257));
}

static inline fix modulate(struct env *e, fix a, fix b)
{
    fix product = mul_x(E, a, b);
    return divide_255(E, product);
}

/* round((a * weight + b * (255 - weight)) / 255) */
static inline fix lerp_255(struct env *e, fix a, fix b, fix weight)
{
    fix inverse = sub_x(E, lit_x(E, 255), weight);
    fix first = mul_x(E, a, weight);
    fix second = mul_x(E, b, inverse);
    fix sum = add_x(E, first, second);
    return divide_255(E, sum);
}

static inline fix add_saturated(struct env *e, fix a, fix b)
{
    fix sum = add_x(E, a, b);
    return min_x(E, sum, lit_x(E, 255));
}

/* max(0, a - b) */
static inline fix subtract_saturated(struct env *e, fix a, fix b)
{
    fix common = min_x(E, a, b);
    return sub_x(E, a, common);
}

/* The low half of each lane in both halves. */
static inline fix both_halves(struct env *e, itg low)
{
    itg high = shl_i(E, low, 16);
    itg both = or_i(E, low, high);
    return fix_of(E, both);
}

/* The alpha of a colour in both halves. */
static inline fix color_alpha(struct env *e, struct color color)
{
    itg ga = int_of(E, color.ga);
    itg both = upper_i(E, ga);
    return fix_of(E, both);
}

/* A channel of 0 to 1 as 0 to 255, nearest even; below 0 and NaN give 0, above 1 gives 255. */
static inline itg quantize(struct env *e, flt channel)
{
    flt scaled = mul_f(E, channel, lit_f(E, 255.0f));
    flt low = max_f(E, scaled, lit_f(E, 0.0f));
    flt limited = min_f(E, low, lit_f(E, 255.0f));
    return round_i(E, limited);
}

/* The same for a channel above -1/510 and below 1 + 1/510, which needs no limits. */
static inline itg quantize_within(struct env *e, flt channel)
{
    flt scaled = mul_f(E, channel, lit_f(E, 255.0f));
    return round_i(E, scaled);
}

/* The channels of the mask `within` need no limits. */
static inline struct color color_quantize_within(struct env *e, const flt channel[4], unsigned within)
{
    struct color r;
    itg byte[4];
    for (int c = 0; c < 4; c++)
        byte[c] = within >> c & 1 ? quantize_within(E, channel[c]) : quantize(E, channel[c]);
    itg blue = shl_i(E, byte[2], 16);
    itg alpha = shl_i(E, byte[3], 16);
    itg rb = or_i(E, byte[0], blue);
    itg ga = or_i(E, byte[1], alpha);
    r.rb = fix_of(E, rb);
    r.ga = fix_of(E, ga);
    return r;
}

static inline struct color color_quantize(struct env *e, const flt channel[4])
{
    return color_quantize_within(E, channel, 0);
}

/* Adds red, green and blue, at most to 255; alpha stays. */
static inline struct color add_specular(struct env *e, struct color color, struct color specular)
{
    struct color sum;
    sum.rb = add_saturated(E, color.rb, specular.rb);
    sum.ga = add_saturated(E, color.ga, specular.ga);
    return color_join(E, sum, color);
}

#endif
