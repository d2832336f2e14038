/* The clip code of a vertex: a bit for each half-space of clip space that the vertex is outside of (enum
 * clip_bit, contract/layout.h).
 *
 * Every test computes "inside" and complements the result, so a NaN is outside. Depth runs from 0 to w as in
 * Direct3D. CLIP_INVALID: v - v is +0 exactly when v is finite. An optimiser that rewrites y - y to 0, as the
 * thesis does, would break this test unless it proves that y is finite.
 *
 * User clip planes are in clip space; the renderer transforms them there. */
#ifndef SPEC_VERTEX_CLIP_H
#define SPEC_VERTEX_CLIP_H

#include "contract/language.h"

/* bit where not (a <= b), else 0 */
static inline itg clip_outside(struct env *e, flt a, flt b, int bit)
{
    msk inside = le_f(E, a, b);
    itg lanes = mask_i(E, inside);
    itg outside = xor_i(E, lanes, lit_i(E, -1));
    return and_i(E, outside, lit_i(E, bit));
}

static inline itg clip_pair(struct env *e, flt value, flt limit, int low_bit, int high_bit)
{
    flt minus = neg_f(E, limit);
    itg low = clip_outside(E, minus, value, low_bit);
    itg high = clip_outside(E, value, limit, high_bit);
    return or_i(E, low, high);
}

/* The same for the bounds of the guard band, in the job. `scale` is w, or null in the window, where the
 * factor is 1. */
static inline itg clip_guard(struct env *e, flt value, const flt *scale, int low, int high, int low_bit,
                             int high_bit)
{
    flt least = uniform_f(E, BASE_JOB, low);
    flt most = uniform_f(E, BASE_JOB, high);
    if (scale) {
        least = mul_f(E, least, *scale);
        most = mul_f(E, most, *scale);
    }
    itg below = clip_outside(E, least, value, low_bit);
    itg above = clip_outside(E, value, most, high_bit);
    return or_i(E, below, above);
}

static inline itg clip_guard_x(struct env *e, flt x, const flt *scale)
{
    return clip_guard(E, x, scale, (int)offsetof(struct job, guard_left),
                      (int)offsetof(struct job, guard_right), CLIP_GUARD_LEFT, CLIP_GUARD_RIGHT);
}

static inline itg clip_guard_y(struct env *e, flt y, const flt *scale)
{
    return clip_guard(E, y, scale, (int)offsetof(struct job, guard_bottom),
                      (int)offsetof(struct job, guard_top), CLIP_GUARD_BOTTOM, CLIP_GUARD_TOP);
}

static inline itg clip_invalid(struct env *e, const flt p[4])
{
    flt sum = sub_f(E, p[0], p[0]);
    for (int c = 1; c < 4; c++) {
        flt zero = sub_f(E, p[c], p[c]);
        sum = add_f(E, sum, zero);
    }
    return clip_outside(E, sum, lit_f(E, 0.0f), CLIP_INVALID);
}

/* x a + (y b + (z c + w d)), by fused multiply-adds; not negative inside. */
static inline itg clip_user(struct env *e, const flt p[4], int plane)
{
    int at = (int)offsetof(struct job, clip_plane) + (int)sizeof(float[4]) * plane;
    flt d = uniform_f(E, BASE_JOB, at + 12);
    flt distance = mul_f(E, p[3], d);
    for (int c = 2; c >= 0; c--) {
        flt coefficient = uniform_f(E, BASE_JOB, at + 4 * c);
        distance = mad_f(E, p[c], coefficient, distance);
    }
    return clip_outside(E, lit_f(E, 0.0f), distance, CLIP_USER << plane);
}

static inline itg clip_code(struct env *e, const struct vertex_key *k, const flt p[4])
{
    itg part[7];
    part[0] = clip_pair(E, p[0], p[3], CLIP_LEFT, CLIP_RIGHT);
    part[1] = clip_pair(E, p[1], p[3], CLIP_BOTTOM, CLIP_TOP);
    part[2] = clip_outside(E, lit_f(E, 0.0f), p[2], CLIP_NEAR);
    part[3] = clip_outside(E, p[2], p[3], CLIP_FAR);
    part[4] = clip_outside(E, lit_f(E, CLIP_EYE_W), p[3], CLIP_EYE);
    part[5] = clip_guard_x(E, p[0], &p[3]);
    part[6] = clip_guard_y(E, p[1], &p[3]);
    itg code = clip_invalid(E, p);
    for (int i = 0; i < 7; i++)
        code = or_i(E, code, part[i]);
    for (int i = 0; i < k->clip_planes; i++) {
        itg user = clip_user(E, p, i);
        code = or_i(E, code, user);
    }
    return code;
}

/* The clip code of a vertex in the window (x, y, depth and 1/w), which is clipped at the guard band only. */
static inline itg clip_code_window(struct env *e, const flt p[4])
{
    itg x = clip_guard_x(E, p[0], NULL);
    itg y = clip_guard_y(E, p[1], NULL);
    itg invalid = clip_invalid(E, p);
    itg outside = or_i(E, x, y);
    return or_i(E, invalid, outside);
}

#endif
