/* sRGB (IEC 61966-2-1). A stored code of 0 to 255 encodes
 *
 *   s = code / 255;  s <= 0.04045:  s / 12.92,  else  ((s + 0.055) / 1.055) ^ 2.4
 *
 * Decoding looks the value up, correctly rounded. Encoding returns the code whose encoded value is nearest to
 * that of the colour. It is estimated to within one, then corrected by a table with the least colour of each
 * code. The tables are the job's (base/srgb.h). */
#ifndef SPEC_MATH_SRGB_H
#define SPEC_MATH_SRGB_H

#include "contract/language.h"
#include "spec/math/color.h"

static inline flt srgb_decode(struct env *e, itg code)
{
    return gather_f(E, BASE_JOB, (int)offsetof(struct job, srgb), code, 4,
                    (int)offsetof(struct srgb_tables, decoded));
}

static inline flt srgb_least(struct env *e, itg code, int further)
{
    int displacement = (int)offsetof(struct srgb_tables, least) + 4 * further;
    return gather_f(E, BASE_JOB, (int)offsetof(struct job, srgb), code, 4, displacement);
}

/* An estimate of the encoded value of 0..1, from its square, fourth and eighth root. The coefficients are
 * those of I. Taylor, "sRGB approximations for HLSL" (2012). */
static inline flt srgb_estimate(struct env *e, flt value)
{
    flt root = sqrt_f(E, value);
    flt fourth = sqrt_f(E, root);
    flt eighth = sqrt_f(E, fourth);
    flt curve = mul_f(E, value, lit_f(E, -0.0225411470f));
    curve = mad_f(E, eighth, lit_f(E, -0.323583601f), curve);
    curve = mad_f(E, fourth, lit_f(E, 0.684122060f), curve);
    curve = mad_f(E, root, lit_f(E, 0.662002687f), curve);
    flt line = mul_f(E, value, lit_f(E, 12.92f));
    msk low = lt_f(E, value, lit_f(E, 0.0031308f));
    return select_f(E, low, line, curve);
}

/* The code of a colour from 0 to 1. */
static inline itg srgb_encode(struct env *e, flt value)
{
    flt estimate = srgb_estimate(E, value);
    itg code = quantize(E, estimate);
    flt least = srgb_least(E, code, 0);
    flt next = srgb_least(E, code, 1);
    msk below = lt_f(E, value, least);
    msk above = le_f(E, next, value);
    itg less = mask_i(E, below);
    itg more = mask_i(E, above);
    itg corrected = add_i(E, code, less);
    return sub_i(E, corrected, more);
}

#endif
