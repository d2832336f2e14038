/* The arithmetic of shaders: a function for each row of def/shader/shader.def that computes with values.
 *
 * The sources of the step are read before. The function returns the result before masks, shifts and
 * saturation. It computes only the components of the step's mask; the others are undefined. Scalar results
 * are computed once. docs/shader-semantics.md has the definitions and their reasons:
 *
 *   products    binary32; `mad` and dot products are fused, in the order of the components. Legacy
 *               multiplication makes a product +0 if a factor is a zero, and adds products unfused
 *   functions   made of the operations of transcendental.h, with its bounds
 *   NaN         comparisons are false, so the value after "else" is taken
 *
 * Sources: Microsoft's reference of the shader assembly and, where it has no rule, the behaviour of devices.
 */
#ifndef SPEC_SHADER_SHADER_ARITHMETIC_H
#define SPEC_SHADER_SHADER_ARITHMETIC_H

#include "contract/language.h"
#include "spec/math/transcendental.h"
#include "spec/math/vector.h"
#include "spec/shader/shader.h"
#include "spec/shader/shader_function.h"

static inline bool wants(const struct step *s, int c)
{
    return s->mask >> c & 1;
}

static inline struct vector4 vector_replicate(flt value)
{
    struct vector4 r = {{value, value, value, value}};
    return r;
}

/* --- Component by component ---------------------------------------------------------------------------- */

typedef flt function_of_one(struct env *, flt);
typedef flt function_of_two(struct env *, flt, flt);

static inline struct vector4 map_one(struct env *e, const struct step *s, function_of_one *function)
{
    struct vector4 r = s->source[0];
    for (int c = 0; c < 4; c++)
        if (wants(s, c))
            r.v[c] = function(E, s->source[0].v[c]);
    return r;
}

static inline struct vector4 map_two(struct env *e, const struct step *s, function_of_two *function)
{
    struct vector4 r = s->source[0];
    for (int c = 0; c < 4; c++)
        if (wants(s, c))
            r.v[c] = function(E, s->source[0].v[c], s->source[1].v[c]);
    return r;
}

static inline struct vector4 execute_add(struct env *e, const struct step *s)
{
    return map_two(E, s, add_f);
}

static inline struct vector4 execute_sub(struct env *e, const struct step *s)
{
    return map_two(E, s, sub_f);
}

static inline struct vector4 execute_mul(struct env *e, const struct step *s)
{
    struct vector4 r = s->source[0];
    for (int c = 0; c < 4; c++)
        if (wants(s, c))
            r.v[c] = multiply(E, s, s->source[0].v[c], s->source[1].v[c]);
    return r;
}

static inline struct vector4 execute_mad(struct env *e, const struct step *s)
{
    struct vector4 r = s->source[0];
    for (int c = 0; c < 4; c++)
        if (wants(s, c))
            r.v[c] = multiply_add(E, s, s->source[0].v[c], s->source[1].v[c], s->source[2].v[c]);
    return r;
}

/* a * (b - c) + c */
static inline struct vector4 execute_lrp(struct env *e, const struct step *s)
{
    struct vector4 r = s->source[0];
    for (int c = 0; c < 4; c++) {
        if (!wants(s, c))
            continue;
        flt difference = sub_f(E, s->source[1].v[c], s->source[2].v[c]);
        r.v[c] = multiply_add(E, s, s->source[0].v[c], difference, s->source[2].v[c]);
    }
    return r;
}

static inline struct vector4 execute_frc(struct env *e, const struct step *s)
{
    return map_one(E, s, fraction);
}

/* Of numbers of OpenGL, a zero in the divisor gives an infinity or NaN. */
static inline struct vector4 execute_div(struct env *e, const struct step *s)
{
    return map_two(E, s, div_f);
}

static inline struct vector4 execute_sqrt(struct env *e, const struct step *s)
{
    return map_one(E, s, sqrt_f);
}

static inline struct vector4 execute_floor(struct env *e, const struct step *s)
{
    return map_one(E, s, floor_f);
}

static inline struct vector4 execute_trunc(struct env *e, const struct step *s)
{
    return map_one(E, s, truncated);
}

static inline struct vector4 execute_round(struct env *e, const struct step *s)
{
    return map_one(E, s, nearest);
}

static inline struct vector4 execute_abs(struct env *e, const struct step *s)
{
    return map_one(E, s, absolute);
}

/* --- Comparisons --------------------------------------------------------------------------------------- */

static inline struct vector4 execute_min(struct env *e, const struct step *s)
{
    return map_two(E, s, min_f);
}

static inline struct vector4 execute_max(struct env *e, const struct step *s)
{
    return map_two(E, s, greater);
}

static inline struct vector4 execute_slt(struct env *e, const struct step *s)
{
    return map_two(E, s, is_less);
}

static inline struct vector4 execute_sge(struct env *e, const struct step *s)
{
    return map_two(E, s, is_not_less);
}

static inline struct vector4 execute_seq(struct env *e, const struct step *s)
{
    return map_two(E, s, is_equal);
}

static inline struct vector4 execute_sne(struct env *e, const struct step *s)
{
    return map_two(E, s, is_not_equal);
}

static inline struct vector4 execute_sgn(struct env *e, const struct step *s)
{
    return map_one(E, s, sign_of);
}

/* The second source where the limit is below the first (or equal to it, if `equal`), the third elsewhere. */
static inline struct vector4 choose(struct env *e, const struct step *s, float limit, bool equal)
{
    struct vector4 r = s->source[0];
    bool all = swizzle_replicates(s->instruction->source[0].swizzle), compared = false;
    msk holds;
    for (int c = 0; c < 4; c++) {
        if (!wants(s, c))
            continue;
        if (!all || !compared)
            holds = equal ? le_f(E, lit_f(E, limit), s->source[0].v[c])
                          : lt_f(E, lit_f(E, limit), s->source[0].v[c]);
        compared = true;
        r.v[c] = select_f(E, holds, s->source[1].v[c], s->source[2].v[c]);
    }
    return r;
}

static inline struct vector4 execute_cmp(struct env *e, const struct step *s)
{
    return choose(E, s, 0.0f, true);
}

static inline struct vector4 execute_cnd(struct env *e, const struct step *s)
{
    return choose(E, s, 0.5f, false);
}

/* The second source where the first is not a zero, else the third. NaN is not a zero. */
static inline struct vector4 execute_select(struct env *e, const struct step *s)
{
    struct vector4 r = s->source[0];
    for (int c = 0; c < 4; c++) {
        if (!wants(s, c))
            continue;
        msk holds = ne_f(E, s->source[0].v[c], lit_f(E, 0.0f));
        r.v[c] = select_f(E, holds, s->source[1].v[c], s->source[2].v[c]);
    }
    return r;
}

/* --- Products of vectors ------------------------------------------------------------------------------- */

static inline struct vector4 execute_dp3(struct env *e, const struct step *s)
{
    flt sum = dot(E, s, 3, &s->source[0], &s->source[1]);
    return vector_replicate(sum);
}

static inline struct vector4 execute_dp4(struct env *e, const struct step *s)
{
    flt sum = dot(E, s, 4, &s->source[0], &s->source[1]);
    return vector_replicate(sum);
}

/* The addend is first in the sum, so two fused operations are enough. */
static inline struct vector4 execute_dp2add(struct env *e, const struct step *s)
{
    flt sum = multiply_add(E, s, s->source[0].v[0], s->source[1].v[0], s->source[2].v[0]);
    sum = multiply_add(E, s, s->source[0].v[1], s->source[1].v[1], sum);
    return vector_replicate(sum);
}

/* Component c is the dot product of `count` components of the source and row c. */
static inline struct vector4 transform_rows(struct env *e, const struct step *s, int count, int rows)
{
    struct vector4 r = s->source[0];
    for (int c = 0; c < rows; c++)
        if (wants(s, c))
            r.v[c] = dot(E, s, count, &s->source[0], &s->row[c]);
    return r;
}

static inline struct vector4 execute_m4x4(struct env *e, const struct step *s)
{
    return transform_rows(E, s, 4, 4);
}

static inline struct vector4 execute_m4x3(struct env *e, const struct step *s)
{
    return transform_rows(E, s, 4, 3);
}

static inline struct vector4 execute_m3x4(struct env *e, const struct step *s)
{
    return transform_rows(E, s, 3, 4);
}

static inline struct vector4 execute_m3x3(struct env *e, const struct step *s)
{
    return transform_rows(E, s, 3, 3);
}

static inline struct vector4 execute_m3x2(struct env *e, const struct step *s)
{
    return transform_rows(E, s, 3, 2);
}

/* Both products are rounded, so that the product of a vector with itself is 0. */
static inline struct vector4 execute_crs(struct env *e, const struct step *s)
{
    struct vector4 r = s->source[0];
    const flt *a = s->source[0].v, *b = s->source[1].v;
    for (int c = 0; c < 3; c++) {
        if (!wants(s, c))
            continue;
        int next = (c + 1) % 3, last = (c + 2) % 3;
        flt plus = multiply(E, s, a[next], b[last]);
        flt minus = multiply(E, s, a[last], b[next]);
        r.v[c] = sub_f(E, plus, minus);
    }
    return r;
}

/* The fourth component is scaled too. */
static inline struct vector4 execute_nrm(struct env *e, const struct step *s)
{
    struct vector4 r = s->source[0];
    flt square = dot(E, s, 3, &s->source[0], &s->source[0]);
    flt scale = reciprocal_root(E, s, square);
    for (int c = 0; c < 4; c++)
        if (wants(s, c))
            r.v[c] = multiply(E, s, s->source[0].v[c], scale);
    return r;
}

/* --- Functions ----------------------------------------------------------------------------------------- */

static inline struct vector4 execute_rcp(struct env *e, const struct step *s)
{
    flt value = reciprocal(E, s, s->source[0].v[0]);
    return vector_replicate(value);
}

static inline struct vector4 execute_rsq(struct env *e, const struct step *s)
{
    flt magnitude = absolute(E, s->source[0].v[0]);
    flt value = reciprocal_root(E, s, magnitude);
    return vector_replicate(value);
}

static inline struct vector4 execute_exp(struct env *e, const struct step *s)
{
    flt value = exponential(E, s, s->source[0].v[0]);
    return vector_replicate(value);
}

static inline struct vector4 execute_log(struct env *e, const struct step *s)
{
    flt value = logarithm(E, s, s->source[0].v[0]);
    return vector_replicate(value);
}

static inline struct vector4 execute_pow(struct env *e, const struct step *s)
{
    flt value = power_of(E, s, s->source[0].v[0], s->source[1].v[0]);
    return vector_replicate(value);
}

/* vs_1_1 has the parts as well: 2 to the next lower integer, the fraction, the power, and 1. */
static inline struct vector4 execute_expp(struct env *e, const struct step *s)
{
    flt value = s->source[0].v[0];
    if (shader_major(s->machine->program->model) > 1)
        return execute_exp(E, s);
    struct vector4 r = s->source[0];
    if (wants(s, 0)) {
        flt whole = floor_f(E, value);
        r.v[0] = exponential(E, s, whole);
    }
    if (wants(s, 1))
        r.v[1] = fraction(E, value);
    if (wants(s, 2))
        r.v[2] = exponential(E, s, value);
    if (wants(s, 3))
        r.v[3] = lit_f(E, 1.0f);
    return r;
}

/* vs_1_1 has the parts as well: exponent, mantissa, the logarithm, and 1. */
static inline struct vector4 execute_logp(struct env *e, const struct step *s)
{
    flt value = s->source[0].v[0];
    if (shader_major(s->machine->program->model) > 1)
        return execute_log(E, s);
    struct vector4 r = s->source[0];
    if (wants(s, 0))
        r.v[0] = exponent_of(E, value);
    if (wants(s, 1))
        r.v[1] = mantissa_of(E, value);
    if (wants(s, 2))
        r.v[2] = logarithm(E, s, value);
    if (wants(s, 3))
        r.v[3] = lit_f(E, 1.0f);
    return r;
}

/* In models 2 the instruction also has the constants of a series, which the polynomials do not need. */
static inline struct vector4 execute_sincos(struct env *e, const struct step *s)
{
    struct vector4 r = s->source[0];
    sine_cosine(E, s->source[0].v[0], wants(s, 1) ? &r.v[1] : NULL, wants(s, 0) ? &r.v[0] : NULL);
    return r;
}

/* (1, diffuse, specular, 1). x is the cosine to the light, y to the half vector, w the power. */
static inline struct vector4 execute_lit(struct env *e, const struct step *s)
{
    flt one = lit_f(E, 1.0f);
    struct vector4 r = vector_replicate(one);
    if (wants(s, 1))
        r.v[1] = max_f(E, s->source[0].v[0], lit_f(E, 0.0f));
    if (!wants(s, 2))
        return r;
    flt power = limit_power(E, s->source[0].v[3]);
    flt specular = power_of(E, s, s->source[0].v[1], power);
    msk lit = lt_f(E, lit_f(E, 0.0f), s->source[0].v[0]);
    msk seen = lt_f(E, lit_f(E, 0.0f), s->source[0].v[1]);
    msk both = and_m(E, lit, seen);
    r.v[2] = select_f(E, both, specular, lit_f(E, 0.0f));
    return r;
}

/* (1, d, d^2, 1 / d) of (., d^2, d^2, .) and (., 1 / d, ., 1 / d). */
static inline struct vector4 execute_dst(struct env *e, const struct step *s)
{
    struct vector4 r = s->source[0];
    if (wants(s, 0))
        r.v[0] = lit_f(E, 1.0f);
    if (wants(s, 1))
        r.v[1] = multiply(E, s, s->source[0].v[1], s->source[1].v[1]);
    r.v[3] = s->source[1].v[3];
    return r;
}

#endif
