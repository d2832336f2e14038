/* Powers, logarithms, sine and cosine, made of other operations: every engine computes the same bits.
 *
 * exponential2: 2^x. With n = floor(x) and f = x - n, 2^f = 1 + f * q(f) on [0, 1). q has degree 5 and a
 * relative error below 2.1e-9 (least maximum by Lawson's algorithm); n is added to the exponent. Below -126
 * the result is 0 (it would be a denormal), from 128 on infinite; NaN gives 0. The relative error is below
 * 1.2e-7 (slightly more than one unit in the last place). Whole x are exact.
 *
 * logarithm2: log2(x) for x > 0. x = 2^n * m with m in [sqrt(1/2), sqrt(2)), s = (m - 1) / (m + 1), and
 * log2(m) = s * r(s^2). r has degree 3 and an error below 7e-10. The error is below 1.5e-7 absolute for
 * |log2(x)| < 1, 1.2e-7 relative beyond. Powers of two are exact. Zero gives a value of about -127. The sign
 * is ignored.
 *
 * power: x^y = 2^(y * log2(x)) for x > 0. The relative error is below 2e-7 + 1.5e-7 * |y| + 2e-7 * |y *
 * log2(x)|. x = 1 and y = 0 are exact.
 *
 * sine_cosine: with t = x / pi, n the integer nearest to t and r = t - n in [-1/2, 1/2], sin(x) is sin(pi *
 * r) and cos(x) is cos(pi * r), both with the sign of (-1)^n. sin(pi * r) = r * s(r^2); s has degree 4 and a
 * relative error below 3e-8 (least relative maximum; s(0) is pi rounded). cos(pi * r) = c(r^2); c has degree
 * 4, an error below 5.5e-8, and c(0) = 1. The reduction loses slightly more than half a unit in the last
 * place of x, as if x had been rounded once more. So the absolute error grows with x: it is below 1.2e-7 +
 * 1.1e-7 * |x|. Results never leave [-1, 1]. From |x| = 2^25 on they are 0 and 1 or -1; of infinities and NaN
 * they are NaN. Zeros keep their sign.
 *
 * tests/spec/shader/transcendental.c measures these bounds. */
#ifndef SPEC_MATH_TRANSCENDENTAL_H
#define SPEC_MATH_TRANSCENDENTAL_H

#include "contract/language.h"

/* 2^x for x in [-127, 128], or NaN, with the `count` coefficients of q. */
static inline flt exponential2_by(struct env *e, flt limited, const float *q, int count)
{
    flt whole = floor_f(E, limited);
    flt fraction = sub_f(E, limited, whole);
    flt sum = lit_f(E, q[count - 1]);
    for (int i = count - 2; i >= 0; i--)
        sum = mad_f(E, sum, fraction, lit_f(E, q[i]));
    flt mantissa = mad_f(E, sum, fraction, lit_f(E, 1.0f));
    itg exponent = round_i(E, whole);
    itg biased = add_i(E, exponent, lit_i(E, 127));
    itg bits = shl_i(E, biased, 23);
    flt scale = bits_f(E, bits);
    return mul_f(E, mantissa, scale);
}

/* 2^x for x in [-127, 128], or NaN. */
static inline flt exponential2_within(struct env *e, flt limited)
{
    static const float q[6] = {0x1.62e42cp-1f, 0x1.ebfd58p-3f,  0x1.c68912p-5f,
                               0x1.3d0b92p-7f, 0x1.46d64ep-10f, 0x1.c54174p-13f};
    return exponential2_by(E, limited, q, 6);
}

static inline flt exponential2(struct env *e, flt x)
{
    flt raised = max_f(E, x, lit_f(E, -127.0f));
    flt limited = min_f(E, raised, lit_f(E, 128.0f));
    return exponential2_within(E, limited);
}

/* A number as mantissa * 2^exponent, without its sign; the mantissa is in [sqrt(1/2), sqrt(2)). */
struct binary_parts {
    flt mantissa, exponent;
};

static inline struct binary_parts binary_parts(struct env *e, flt x)
{
    enum { SQUARE_ROOT_OF_HALF = 0x3f3504f3 };
    struct binary_parts r;
    itg all_bits = bits_i(E, x);
    itg bits = and_i(E, all_bits, lit_i(E, 0x7fffffff));
    itg above = sub_i(E, bits, lit_i(E, SQUARE_ROOT_OF_HALF));
    itg exponent = shr_i(E, above, 23);
    itg placed = shl_i(E, exponent, 23);
    itg mantissa_bits = sub_i(E, bits, placed);
    r.mantissa = bits_f(E, mantissa_bits);
    r.exponent = float_f(E, exponent);
    return r;
}

static inline flt logarithm2(struct env *e, flt x)
{
    static const float r[4] = {0x1.715476p+1f, 0x1.ec70e6p-1f, 0x1.2747060p-1f, 0x1.ba1cbcp-2f};
    struct binary_parts parts = binary_parts(E, x);
    flt less = sub_f(E, parts.mantissa, lit_f(E, 1.0f));
    flt more = add_f(E, parts.mantissa, lit_f(E, 1.0f));
    flt s = div_f(E, less, more);
    flt square = mul_f(E, s, s);
    flt sum = lit_f(E, r[3]);
    for (int i = 2; i >= 0; i--)
        sum = mad_f(E, sum, square, lit_f(E, r[i]));
    return mad_f(E, s, sum, parts.exponent);
}

static inline flt power(struct env *e, flt x, flt y)
{
    flt log = logarithm2(E, x);
    flt exponent = mul_f(E, log, y);
    return exponential2(E, exponent);
}

/* Negates the value if the highest bit of `sign` is set; its other bits are 0. */
static inline flt flip_sign(struct env *e, flt value, itg sign)
{
    itg bits = bits_i(E, value);
    itg flipped = xor_i(E, bits, sign);
    return bits_f(E, flipped);
}

/* A null result is not computed. */
static inline void sine_cosine(struct env *e, flt x, flt *sine, flt *cosine)
{
    static const float s[5] = {0x1.921fb6p+1f, -0x1.4abbfp+2f, 0x1.466f44p+1f, -0x1.32e9e4p-1f,
                               0x1.46ff7ep-4f};
    static const float c[5] = {1.0f, -0x1.3bd3b0p+2f, 0x1.03bd9ap+2f, -0x1.55020ap+0f, 0x1.c29302p-3f};
    flt t = mul_f(E, x, lit_f(E, 0x1.45f306p-2f));
    flt above = add_f(E, t, lit_f(E, 0.5f));
    flt whole = floor_f(E, above);
    flt rest = sub_f(E, t, whole);
    flt square = mul_f(E, rest, rest);
    itg n = round_i(E, whole);
    itg sign = shl_i(E, n, 31);
    if (sine) {
        flt sum = lit_f(E, s[4]);
        for (int i = 3; i >= 0; i--)
            sum = mad_f(E, sum, square, lit_f(E, s[i]));
        flt value = mul_f(E, sum, rest);
        *sine = flip_sign(E, value, sign);
    }
    if (cosine) {
        flt sum = lit_f(E, c[4]);
        for (int i = 3; i >= 0; i--)
            sum = mad_f(E, sum, square, lit_f(E, c[i]));
        *cosine = flip_sign(E, sum, sign);
    }
}

#endif
