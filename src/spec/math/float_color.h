/* Colour in binary32. The pixel routine computes with it where a texture or a target has more than 8 bits,
 * floating point, a sign or sRGB. The functions are those of the packed colours (color.h, stage.h, fog.h,
 * blend.h), but a channel of 1 here is 255 there:
 *
 *   interpolated colours   clamped to 0..1, NaN gives 0
 *   packed words           byte / 255, correctly rounded
 *
 * Nothing else is clamped unless its definition specifies it. A texel of floating point reaches a target of
 * floating point unchanged. */
#ifndef SPEC_MATH_FLOAT_COLOR_H
#define SPEC_MATH_FLOAT_COLOR_H

#include "contract/language.h"

struct float_color {
    flt channel[4]; /* red, green, blue, alpha */
};

/* To 0..1; NaN gives 0. */
static inline flt saturate(struct env *e, flt value)
{
    flt low = max_f(E, value, lit_f(E, 0.0f));
    return min_f(E, low, lit_f(E, 1.0f));
}

static inline struct float_color float_replicate(flt value)
{
    struct float_color r = {{value, value, value, value}};
    return r;
}

static inline struct float_color float_join(struct float_color color, flt alpha)
{
    color.channel[3] = alpha;
    return color;
}

/* Byte c of a word. */
static inline itg word_byte(struct env *e, itg word, int c)
{
    if (c == 3)
        return ushr_i(E, word, 24);
    if (c)
        word = ushr_i(E, word, 8 * c);
    return and_i(E, word, lit_i(E, 255));
}

static inline struct float_color float_unpack(struct env *e, itg word)
{
    struct float_color r;
    for (int c = 0; c < 4; c++) {
        itg byte = word_byte(E, word, c);
        flt number = float_f(E, byte);
        r.channel[c] = div_f(E, number, lit_f(E, 255.0f));
    }
    return r;
}

/* A packed colour of the job. */
static inline struct float_color float_packed(struct env *e, size_t field)
{
    itg word = uniform_i(E, BASE_JOB, (int)field);
    return float_unpack(E, word);
}

static inline flt float_invert(struct env *e, flt value)
{
    return sub_f(E, lit_f(E, 1.0f), value);
}

/* a * weight + b * (1 - weight), exactly a or b at the ends. */
static inline flt float_lerp(struct env *e, flt a, flt b, flt weight)
{
    flt inverse = float_invert(E, weight);
    flt first = mul_f(E, a, weight);
    return mad_f(E, b, inverse, first);
}

#endif
