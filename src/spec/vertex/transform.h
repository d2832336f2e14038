/* Fixed-function transformation: row vector times matrix. Rows are summed from the last to the first with
 * fused multiply-adds.
 *
 * The order is part of the contract: x * m0 + (y * m1 + (z * m2 + w * m3)), one rounding for each step.
 * Matrices are the job's, row-major, m[row][column]; `rows` of them are used. A position without w has w = 1.
 */
#ifndef SPEC_VERTEX_TRANSFORM_H
#define SPEC_VERTEX_TRANSFORM_H

#include "contract/language.h"
#include "spec/math/vector.h"

static inline flt matrix_element(struct env *e, int matrix, int row, int column)
{
    return uniform_f(E, BASE_JOB, matrix + 16 * row + 4 * column);
}

/* One component of position * matrix. `w` is the position's fourth component; with `one` it is 1 and not
 * read. */
static inline flt transform_component(struct env *e, const struct vector4 *p, int one, int matrix, int column)
{
    flt m3 = matrix_element(E, matrix, 3, column);
    flt sum = one ? m3 : mul_f(E, p->v[3], m3);
    for (int row = 2; row >= 0; row--) {
        flt m = matrix_element(E, matrix, row, column);
        sum = mad_f(E, p->v[row], m, sum);
    }
    return sum;
}

/* One component of a direction * matrix (no translation). */
static inline flt transform_direction(struct env *e, const flt v[3], int matrix, int column)
{
    flt m2 = matrix_element(E, matrix, 2, column);
    flt sum = mul_f(E, v[2], m2);
    for (int row = 1; row >= 0; row--) {
        flt m = matrix_element(E, matrix, row, column);
        sum = mad_f(E, v[row], m, sum);
    }
    return sum;
}

static inline flt dot3(struct env *e, const flt a[3], const flt b[3])
{
    flt sum = mul_f(E, a[2], b[2]);
    sum = mad_f(E, a[1], b[1], sum);
    return mad_f(E, a[0], b[0], sum);
}

/* 1 / sqrt(x) by two rounded operations; FLT_MAX for 0, so that normalising the zero vector returns it. */
static inline flt reciprocal_length(struct env *e, flt squared)
{
    flt length = sqrt_f(E, squared);
    flt inverse = div_f(E, lit_f(E, 1.0f), length);
    return min_f(E, inverse, lit_f(E, FLT_MAX));
}

#endif
