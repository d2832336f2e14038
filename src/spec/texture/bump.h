/* Bump mapping: the texture of one stage displaces the coordinates of the next stage (Direct3D 9, "Bump
 * Mapping Formulas"). Its red and green are du and dv, its blue is luminance:
 *
 *   u' = u + m00 * du + m10 * dv
 *   v' = v + m01 * du + m11 * dv        fused, in this order
 *
 * With luminance, all channels of the texel sampled there are multiplied by blue * scale + offset, clamped to
 * 0..1. */
#ifndef SPEC_TEXTURE_BUMP_H
#define SPEC_TEXTURE_BUMP_H

#include "contract/language.h"
#include "spec/math/float_color.h"

static inline flt bump_value(struct env *e, int stage, size_t field)
{
    size_t bump = offsetof(struct job, bump) + (size_t)stage * sizeof(struct bump_job);
    return uniform_f(E, BASE_JOB, (int)(bump + field));
}

static inline void bump_displace(struct env *e, int stage, const struct float_color *bump, flt coordinate[3])
{
    for (int axis = 0; axis < 2; axis++) {
        flt by_u = bump_value(E, stage, offsetof(struct bump_job, matrix) + sizeof(float) * (size_t)axis);
        flt by_v =
            bump_value(E, stage, offsetof(struct bump_job, matrix) + sizeof(float) * (size_t)(2 + axis));
        flt partly = mad_f(E, bump->channel[0], by_u, coordinate[axis]);
        coordinate[axis] = mad_f(E, bump->channel[1], by_v, partly);
    }
}

static inline struct float_color bump_luminance(struct env *e, int stage, const struct float_color *bump,
                                                struct float_color color)
{
    flt scale = bump_value(E, stage, offsetof(struct bump_job, luminance_scale));
    flt offset = bump_value(E, stage, offsetof(struct bump_job, luminance_offset));
    flt sum = mad_f(E, bump->channel[2], scale, offset);
    flt luminance = saturate(E, sum);
    for (int c = 0; c < 4; c++)
        color.channel[c] = mul_f(E, color.channel[c], luminance);
    return color;
}

#endif
