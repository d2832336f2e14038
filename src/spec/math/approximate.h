/* Functions of selectable precision: exact, to about 13 bits, to about 8 bits (enum precision).
 *
 * Exact ones are the operations and polynomials of the rest of the specification. The others have the
 * greatest errors of this table, relative ones but for the logarithm. tests/spec/math/approximate.c measures
 * them:
 *
 *                              partial (13 bits)   approximate (8 bits)
 *   reciprocal      1 / x           1.4e-4               2.6e-3
 *   root      1 / sqrt(x)           1.1e-4               1.8e-3
 *   power             2^x           1.1e-4               2.7e-3
 *   logarithm     log2(x)           1.2e-4 absolute      9e-4 absolute
 *
 * Processors have instructions for the first two, rcpps and rsqrtps, whose bits differ between vendors. These
 * are defined by integer and binary32 operations, so all engines agree on each bit:
 *
 *   1 / x        y = bits(MAGIC - bits(x)) has an error e = 1 - x * y of at most 0.051. y * (1 + e) has the
 *                error e^2 (Newton), y * (1 + e + e^2) has e^3 (Halley)
 *   1 / sqrt(x)  y = bits(MAGIC - bits(x) / 2) has e = 1 - x * y^2 of at most 0.069. y * (1 + e / 2) has
 *                3 / 8 e^2, y * (1 + e / 2 + 3 / 8 e^2) has 5 / 16 e^3
 *   2^x          as exponential2 (spec/math/transcendental.h), with polynomials of degree 3 and 2
 *   log2(x)      exponent + t * p(t), t = mantissa - 1 in [-0.293, 0.415), p of degree 3 and 2: no division
 *
 * The first two are for numbers from 2^-125 to 2^125, of either sign for 1 / x. Zeros, infinities and NaN
 * give what the operations give. Callers that need a value for zeros select it. */
#ifndef SPEC_MATH_APPROXIMATE_H
#define SPEC_MATH_APPROXIMATE_H

#include "contract/language.h"
#include "spec/math/transcendental.h"

static inline flt reciprocal_of(struct env *e, int precision, flt x)
{
    enum { MAGIC = 0x7ef31000 };
    if (precision == PRECISION_EXACT)
        return div_f(E, lit_f(E, 1.0f), x);
    itg bits = bits_i(E, x);
    itg first = sub_i(E, lit_i(E, MAGIC), bits);
    flt y = bits_f(E, first);
    flt product = mul_f(E, x, y);
    if (precision == PRECISION_APPROXIMATE) {
        flt corrected = sub_f(E, lit_f(E, 2.0f), product);
        return mul_f(E, y, corrected);
    }
    flt error = sub_f(E, lit_f(E, 1.0f), product);
    flt sum = mad_f(E, error, error, error);
    return mad_f(E, y, sum, y);
}

static inline flt reciprocal_root_of(struct env *e, int precision, flt x)
{
    enum { MAGIC = 0x5f374480 };
    if (precision == PRECISION_EXACT) {
        flt root = sqrt_f(E, x);
        return div_f(E, lit_f(E, 1.0f), root);
    }
    itg bits = bits_i(E, x);
    itg half = ushr_i(E, bits, 1);
    itg first = sub_i(E, lit_i(E, MAGIC), half);
    flt y = bits_f(E, first);
    flt part = mul_f(E, x, y);
    flt product = mul_f(E, part, y);
    if (precision == PRECISION_APPROXIMATE) {
        flt corrected = mad_f(E, product, lit_f(E, -0.5f), lit_f(E, 1.5f));
        return mul_f(E, y, corrected);
    }
    flt error = sub_f(E, lit_f(E, 1.0f), product);
    flt slope = mad_f(E, error, lit_f(E, 0.375f), lit_f(E, 0.5f));
    flt corrected = mad_f(E, slope, error, lit_f(E, 1.0f));
    return mul_f(E, y, corrected);
}

/* 2^x for x in [-127, 128], or NaN. */
static inline flt exponential2_of(struct env *e, int precision, flt limited)
{
    static const float three[3] = {0x1.640eaap-1f, 0x1.cf7a66p-3f, 0x1.4095eap-4f};
    static const float two[2] = {0x1.520a3p-1f, 0x1.5bebap-2f};
    if (precision == PRECISION_EXACT)
        return exponential2_within(E, limited);
    bool partial = precision == PRECISION_PARTIAL;
    return exponential2_by(E, limited, partial ? three : two, partial ? 3 : 2);
}

/* log2(x) for x > 0; the sign is ignored. */
static inline flt logarithm2_of(struct env *e, int precision, flt x)
{
    static const float three[4] = {0x1.711738p+0f, -0x1.7326a6p-1f, 0x1.08f72ep-1f, -0x1.518ab8p-2f};
    static const float two[3] = {0x1.71f57ep+0f, -0x1.82172ap-1f, 0x1.c7c0cap-2f};
    if (precision == PRECISION_EXACT)
        return logarithm2(E, x);
    bool partial = precision == PRECISION_PARTIAL;
    const float *p = partial ? three : two;
    struct binary_parts parts = binary_parts(E, x);
    flt t = sub_f(E, parts.mantissa, lit_f(E, 1.0f));
    int degree = partial ? 3 : 2;
    flt sum = lit_f(E, p[degree]);
    for (int i = degree - 1; i >= 0; i--)
        sum = mad_f(E, sum, t, lit_f(E, p[i]));
    return mad_f(E, t, sum, parts.exponent);
}

#endif
