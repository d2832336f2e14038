/* The scalar functions of shader arithmetic (shader_arithmetic.h), and their results for zeros, infinities
 * and NaN. The error bounds of exponential, logarithm and power are those of
 * transcendental.h, at less than the exact precision those of approximate.h.
 *
 * Legacy multiplication, a state, makes a product +0 if a factor is a zero, and adds products unfused. */
#ifndef SPEC_SHADER_SHADER_FUNCTION_H
#define SPEC_SHADER_SHADER_FUNCTION_H

#include "contract/language.h"
#include "spec/math/approximate.h"
#include "spec/math/vector.h"
#include "spec/shader/shader.h"

static inline flt absolute(struct env *e, flt value)
{
    itg bits = bits_i(E, value);
    itg cleared = and_i(E, bits, lit_i(E, 0x7fffffff));
    return bits_f(E, cleared);
}

static inline flt multiply(struct env *e, const struct step *s, flt a, flt b)
{
    flt product = mul_f(E, a, b);
    if (!s->legacy)
        return product;
    msk first = eq_f(E, a, lit_f(E, 0.0f));
    msk second = eq_f(E, b, lit_f(E, 0.0f));
    msk either = or_m(E, first, second);
    return select_f(E, either, lit_f(E, 0.0f), product);
}

static inline flt multiply_add(struct env *e, const struct step *s, flt a, flt b, flt c)
{
    if (!s->legacy)
        return mad_f(E, a, b, c);
    flt product = multiply(E, s, a, b);
    return add_f(E, product, c);
}

/* The dot product of the first `count` components. */
static inline flt dot(struct env *e, const struct step *s, int count, const struct vector4 *a,
                      const struct vector4 *b)
{
    flt sum = multiply(E, s, a->v[0], b->v[0]);
    for (int c = 1; c < count; c++)
        sum = multiply_add(E, s, a->v[c], b->v[c], sum);
    return sum;
}

/* FLT_MAX where the divisor was a zero, the quotient elsewhere. */
static inline flt limit_quotient(struct env *e, flt divisor, flt quotient)
{
    msk zero = eq_f(E, divisor, lit_f(E, 0.0f));
    return select_f(E, zero, lit_f(E, FLT_MAX), quotient);
}

/* The precision of a shader's functions; those of vertices are exact. */
static inline int step_precision(const struct step *s)
{
    return s->machine->pixel ? s->machine->pixel->precision : PRECISION_EXACT;
}

static inline flt reciprocal(struct env *e, const struct step *s, flt value)
{
    flt quotient = reciprocal_of(E, step_precision(s), value);
    return limit_quotient(E, value, quotient);
}

/* 1 / sqrt(value); the sign is ignored. */
static inline flt reciprocal_root(struct env *e, const struct step *s, flt value)
{
    flt quotient = reciprocal_root_of(E, step_precision(s), value);
    return limit_quotient(E, value, quotient);
}

/* exponential2, but NaN for NaN. */
static inline flt exponential(struct env *e, const struct step *s, flt value)
{
    flt raised = max_f(E, lit_f(E, -127.0f), value);
    flt limited = min_f(E, lit_f(E, 128.0f), raised);
    return exponential2_of(E, step_precision(s), limited);
}

/* log2|value|: -FLT_MAX of zeros, infinite of infinities, NaN of NaN. */
static inline flt logarithm(struct env *e, const struct step *s, flt value)
{
    flt magnitude = absolute(E, value);
    flt found = logarithm2_of(E, step_precision(s), value);
    msk finite = le_f(E, magnitude, lit_f(E, FLT_MAX));
    flt proper = select_f(E, finite, found, magnitude);
    msk zero = eq_f(E, value, lit_f(E, 0.0f));
    return select_f(E, zero, lit_f(E, -FLT_MAX), proper);
}

/* |base| to the power; 1 if the power is a zero. */
static inline flt power_of(struct env *e, const struct step *s, flt base, flt to)
{
    flt log = logarithm(E, s, base);
    flt exponent = multiply(E, s, log, to);
    flt power = exponential(E, s, exponent);
    msk zero = eq_f(E, to, lit_f(E, 0.0f));
    return select_f(E, zero, lit_f(E, 1.0f), power);
}

/* A magnitude with the sign of the value. */
static inline flt signed_as(struct env *e, flt magnitude, flt value)
{
    itg bits = bits_i(E, value);
    itg sign = and_i(E, bits, lit_i(E, INT32_MIN));
    itg unsigned_bits = bits_i(E, magnitude);
    itg both = or_i(E, unsigned_bits, sign);
    return bits_f(E, both);
}

static inline flt truncated(struct env *e, flt value)
{
    flt magnitude = absolute(E, value);
    flt whole = floor_f(E, magnitude);
    return signed_as(E, whole, value);
}

/* Numbers from 2^23 on are integers. */
static inline flt nearest(struct env *e, flt value)
{
    flt magnitude = absolute(E, value);
    itg number = round_i(E, magnitude);
    flt whole = float_f(E, number);
    msk small = lt_f(E, magnitude, lit_f(E, 0x1p23f));
    flt chosen = select_f(E, small, whole, magnitude);
    return signed_as(E, chosen, value);
}

static inline flt fraction(struct env *e, flt value)
{
    flt whole = floor_f(E, value);
    return sub_f(E, value, whole);
}

/* The exponent of a number's magnitude; -FLT_MAX of zeros. */
static inline flt exponent_of(struct env *e, flt value)
{
    itg bits = bits_i(E, value);
    itg up = shl_i(E, bits, 1);
    itg biased = ushr_i(E, up, 24);
    itg number = sub_i(E, biased, lit_i(E, 127));
    flt exponent = float_f(E, number);
    msk zero = eq_f(E, value, lit_f(E, 0.0f));
    return select_f(E, zero, lit_f(E, -FLT_MAX), exponent);
}

/* A number's magnitude with the exponent 0: from 1 to below 2; 1 of zeros. */
static inline flt mantissa_of(struct env *e, flt value)
{
    itg bits = bits_i(E, value);
    itg rest = and_i(E, bits, lit_i(E, 0x007fffff));
    itg placed = or_i(E, rest, lit_i(E, 0x3f800000));
    flt mantissa = bits_f(E, placed);
    msk zero = eq_f(E, value, lit_f(E, 0.0f));
    return select_f(E, zero, lit_f(E, 1.0f), mantissa);
}

/* The power of lit, limited to the range of 8.8 fixed-point numbers. */
static inline flt limit_power(struct env *e, flt power)
{
    flt raised = max_f(E, lit_f(E, -127.9961f), power);
    return min_f(E, lit_f(E, 127.9961f), raised);
}

/* a >= b ? a : b. max_f differs from it if both are zeros. */
static inline flt greater(struct env *e, flt a, flt b)
{
    msk first = le_f(E, b, a);
    return select_f(E, first, a, b);
}

/* -1, 0 or 1; 1 for NaN. */
static inline flt sign_of(struct env *e, flt value)
{
    msk below = lt_f(E, value, lit_f(E, 0.0f));
    flt sign = select_f(E, below, lit_f(E, -1.0f), lit_f(E, 1.0f));
    msk zero = eq_f(E, value, lit_f(E, 0.0f));
    return select_f(E, zero, lit_f(E, 0.0f), sign);
}

static inline flt one_if(struct env *e, msk holds)
{
    return select_f(E, holds, lit_f(E, 1.0f), lit_f(E, 0.0f));
}

static inline flt is_less(struct env *e, flt a, flt b)
{
    msk less = lt_f(E, a, b);
    return one_if(E, less);
}

static inline flt is_equal(struct env *e, flt a, flt b)
{
    msk holds = eq_f(E, a, b);
    return one_if(E, holds);
}

static inline flt is_not_equal(struct env *e, flt a, flt b)
{
    msk holds = ne_f(E, a, b);
    return one_if(E, holds);
}

static inline flt is_not_less(struct env *e, flt a, flt b)
{
    msk holds = le_f(E, b, a);
    return one_if(E, holds);
}

#endif
