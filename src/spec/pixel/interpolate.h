/* Interpolation: plane equations are evaluated at the pixel's centre, never accumulated along a span.
 *
 * value + (dy * (y - origin_y) then dx * (x - origin_x)) by fused multiply-adds in that order. The distances
 * are exact: multiples of 1/256 below 2^15. The plane of a smooth varying has a/w; it is multiplied by w = 1
 * / (plane of 1/w).
 *
 * The span reading (docs/spans.md) leaves out the multiply-adds of steps that are zero in its triangles. This
 * changes no bit: y * 0 + v = v unless v is -0 or a denormal, and such planes are not in the class
 * (render/geometry/span.h). Numbers that are 1 in all triangles of a class are literals. So is 1/w of joined
 * rectangles, whose flat diffuse colours are from 0 to 1 (render/geometry/bin_pair.h). */
#ifndef SPEC_PIXEL_INTERPOLATE_H
#define SPEC_PIXEL_INTERPOLATE_H

#include "contract/language.h"
#include "spec/math/approximate.h"

struct pixel_position {
    flt x, y;         /* distance from the triangle's origin in pixels */
    int sample;       /* of this position; 0 at the centre */
    const flt *depth; /* output by a shader, 0 to 1; null before the shader has run, or if it outputs none */
};

static inline struct pixel_position pixel_position(struct env *e)
{
    struct pixel_position at;
    at.sample = 0;
    at.depth = NULL;
    flt block_x = uniform_f(E, BASE_ENTRY, (int)offsetof(struct entry, x));
    flt lane_x = load_f(E, BASE_LANES, (int)offsetof(struct lane_table, x));
    flt origin_x = uniform_f(E, BASE_TRIANGLE, (int)offsetof(struct triangle_head, origin_x));
    flt corner_x = sub_f(E, block_x, origin_x);
    at.x = add_f(E, corner_x, lane_x);
    flt block_y = uniform_f(E, BASE_ENTRY, (int)offsetof(struct entry, y));
    flt lane_y = load_f(E, BASE_LANES, (int)offsetof(struct lane_table, y));
    flt origin_y = uniform_f(E, BASE_TRIANGLE, (int)offsetof(struct triangle_head, origin_y));
    flt corner_y = sub_f(E, block_y, origin_y);
    at.y = add_f(E, corner_y, lane_y);
    return at;
}

/* A plane that varies along these axes only. */
static inline flt evaluate_along(struct env *e, const struct pixel_position *at, int plane, enum axes axes)
{
    flt value = uniform_f(E, BASE_TRIANGLE, plane + (int)offsetof(struct plane, value));
    if (axes & AXES_Y) {
        flt dy = uniform_f(E, BASE_TRIANGLE, plane + (int)offsetof(struct plane, dy));
        value = mad_f(E, at->y, dy, value);
    }
    if (axes & AXES_X) {
        flt dx = uniform_f(E, BASE_TRIANGLE, plane + (int)offsetof(struct plane, dx));
        value = mad_f(E, at->x, dx, value);
    }
    return value;
}

static inline flt evaluate_plane(struct env *e, const struct pixel_position *at, int plane)
{
    return evaluate_along(E, at, plane, AXES_BOTH);
}

/* 1/w at the pixel. */
static inline flt pixel_reciprocal_w(struct env *e, const struct pixel_key *k,
                                     const struct pixel_position *at, const struct triangle_layout *layout)
{
    if (k->joined || span_has_unit_w(k->span))
        return lit_f(E, 1.0f);
    return evaluate_along(E, at, layout->reciprocal_w, k->span ? AXES_NONE : AXES_BOTH);
}

/* w of depth is exact; w of colours and coordinates has the key's precision. */
static inline flt pixel_w(struct env *e, const struct pixel_key *k, const struct pixel_position *at,
                          const struct triangle_layout *layout, int precision)
{
    flt reciprocal = pixel_reciprocal_w(E, k, at, layout);
    return reciprocal_of(E, precision, reciprocal);
}

/* Component c of a varying as the record has it: divided by w if it is smooth. */
static inline flt interpolate_over_w(struct env *e, const struct pixel_key *k,
                                     const struct triangle_layout *layout, const struct pixel_position *at,
                                     int varying, int c)
{
    int first = layout->varying[varying];
    if (span_has_ones(k->span, varying))
        return lit_f(E, 1.0f);
    if (k->varying[varying] == INTERPOLATION_FLAT) {
        const int word = first + (int)sizeof(float) * c;
        return k->joined && varying == VARYING_diffuse ? uniform_unit_f(E, BASE_TRIANGLE, word)
                                                       : uniform_f(E, BASE_TRIANGLE, word);
    }
    enum axes axes = k->span ? varying_span_axes(k->span, varying, c) : AXES_BOTH;
    return evaluate_along(E, at, first + (int)sizeof(struct plane) * c, axes);
}

/* Component c of a varying at the pixel. Only smooth varyings use w. */
static inline flt interpolate(struct env *e, const struct pixel_key *k, const struct triangle_layout *layout,
                              const struct pixel_position *at, flt w, int varying, int c)
{
    flt value = interpolate_over_w(E, k, layout, at, varying, c);
    return k->varying[varying] == INTERPOLATION_FLAT ? value : mul_f(E, value, w);
}

#endif
