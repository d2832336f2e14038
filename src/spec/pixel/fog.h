/* Fog: blends towards the fog colour with distance (Direct3D 9, "Fog Formulas"). Alpha is not fogged.
 *
 *   colour' = round((factor * colour + (255 - factor) * fog colour) / 255), factor quantized to 0..255
 *
 * The factor is 1 without fog and 0 in full fog. It is interpolated from the vertex routine's, or computed at
 * the pixel (table fog) from its distance d: w, the distance along the view in units of the scene, or the
 * triangle's depth. Start and end are then in the range of depth, 0 to 1. Depth is not clamped to this range:
 * vertices in the window are not clipped to it, and have fog by the formula outside of it too.
 *
 *   LINEAR   (end - d) / (end - start)          as d * scale + offset
 *   EXP      2 ^ (d * scale)                    scale = -density * log2(e)
 *   EXP2     2 ^ -(d * scale) ^ 2               scale = density * sqrt(log2(e))
 *
 * The quantization clamps it to 0..1. In binary32 it is clamped and not quantized:
 *
 *   colour' = colour * factor + fog colour * (1 - factor) */
#ifndef SPEC_PIXEL_FOG_H
#define SPEC_PIXEL_FOG_H

#include "contract/language.h"
#include "spec/math/approximate.h"
#include "spec/math/color.h"
#include "spec/pixel/depth.h"
#include "spec/pixel/interpolate.h"

static inline flt fog_distance(struct env *e, const struct pixel_key *k, const struct triangle_layout *layout,
                               const struct pixel_position *at, flt w)
{
    if (k->fog == FOG_VARYING)
        return interpolate(E, k, layout, at, w, VARYING_fog, 0);
    if (!fog_reads_depth(k->fog))
        return w;
    return evaluate_plane(E, at, layout->depth);
}

/* The factor before it is clamped. */
static inline flt fog_share(struct env *e, const struct pixel_key *k, flt distance)
{
    int fog = k->fog;
    flt factor = distance;
    if (fog == FOG_LINEAR_Z || fog == FOG_LINEAR_W) {
        flt scale = uniform_f(E, BASE_JOB, (int)offsetof(struct job, fog_scale));
        flt offset = uniform_f(E, BASE_JOB, (int)offsetof(struct job, fog_offset));
        factor = mad_f(E, distance, scale, offset);
    } else if (fog != FOG_VARYING) {
        flt scale = uniform_f(E, BASE_JOB, (int)offsetof(struct job, fog_scale));
        flt power = mul_f(E, distance, scale);
        if (fog == FOG_EXP2_Z || fog == FOG_EXP2_W) {
            flt minus = neg_f(E, power);
            power = mul_f(E, power, minus);
        }
        flt raised = max_f(E, power, lit_f(E, -127.0f));
        flt limited = min_f(E, raised, lit_f(E, 128.0f));
        factor = exponential2_of(E, k->precision, limited);
    }
    return factor;
}

static inline fix fog_factor(struct env *e, const struct pixel_key *k, flt distance)
{
    flt share = fog_share(E, k, distance);
    itg byte = quantize(E, share);
    return both_halves(E, byte);
}

static inline struct color fog_blend(struct env *e, struct color color, fix factor)
{
    struct color fog = packed_color(E, offsetof(struct job, fog_color));
    struct color r;
    r.rb = lerp_255(E, color.rb, fog.rb, factor);
    r.ga = lerp_255(E, color.ga, fog.ga, factor);
    return color_join(E, r, color);
}

#endif
