/* The setup routine: projection, snapping, area and culling, plane equations. A lane is a triangle, line or
 * point (contract/arguments.h, struct setup_arguments).
 *
 * Bases: JOB; INPUT is SETUP_INDEX_ROWS rows of the lanes' vertex offsets; VERTICES the vertex batch; OUTPUT
 * the lanes' records. Window positions are snapped to 1/256 pixel first. All later steps use the snapped
 * positions, so coverage and interpolation agree on the triangle's position.
 *
 * Twice the area is a difference of two products that may nearly cancel. With p = dx2 * dy1 rounded and its
 * error e = fma(dx2, dy1, -p), the value fma(dx1, dy2, -p) - e is within 1.5 ulp of the exact one (Kahan;
 * Jeannerod, Louvet, Muller 2013). So its sign is exact, and it is 0 only for triangles without area.
 *
 * A plane through (0, a0), (p1, a1), (p2, a2) relative to vertex 0 has the gradients
 *
 *   dx = (a1 - a0) * u1 + (a2 - a0) * u2,  dy = (a1 - a0) * v1 + (a2 - a0) * v2
 *
 * with u1 = dy2 / area, u2 = -dy1 / area, v1 = -dx2 / area, v2 = dx1 / area (Olano and Greer 1997).
 *
 * Depth bias: value += m * slope + bias (one fused multiply-add, then the sum), where m = max(|dx|, |dy|) of
 * the triangle's depth plane. In steps of floating point, bias is the job's times
 * the greatest power of two that is not above the greatest depth of a corner, or if that is not normal, the
 * least normal number. An edge or a corner uses the m of its triangle. A w-buffer has no depth bias.
 *
 * A line from (0, a0) to ((dx, dy), a1) has the gradients (a1 - a0) * dx / l and (a1 - a0) * dy / l with l =
 * dx dx + dy dy: values are constant across the line. If the length is 0, l is 2^-16, the square of the
 * shortest length.
 *
 * A point of size s is the square of the pixels within s / 2 of its centre, s / 2 rounded to 1/256 pixel
 * (render/raster/raster_point.c). Only the texture coordinates of a point sprite vary over it; these are the
 * varyings that the key has as smooth. u runs from 0 at the left to 1 at the right, v from 0 at the top to 1
 * at the bottom of the picture, which is the side of the last row, or if sprites are turned that of the first
 * row; third coordinates are 0, divisors 1. 1/w is 1 unless the pixel routine reads w itself. */
#ifndef SPEC_SETUP_SETUP_H
#define SPEC_SETUP_SETUP_H

#include "contract/language.h"
#include "spec/setup/setup_line.h"
#include "spec/setup/setup_plane.h"
#include "spec/setup/setup_point.h"
#include "spec/setup/setup_smooth.h"

/* The head of a visible triangle. Vertices 1 and 2 are exchanged where the area is negative. */
static inline void record_head(struct env *e, const struct triangle_layout *layout, const struct corner p[3],
                               flt area)
{
    msk turned = lt_f(E, area, lit_f(E, 0.0f));
    itg x1 = select_i(E, turned, p[2].window_x, p[1].window_x);
    itg x2 = select_i(E, turned, p[1].window_x, p[2].window_x);
    itg y1 = select_i(E, turned, p[2].window_y, p[1].window_y);
    itg y2 = select_i(E, turned, p[1].window_y, p[2].window_y);
    record_i(E, layout, offsetof(struct triangle_head, x[0]), p[0].window_x);
    record_i(E, layout, offsetof(struct triangle_head, x[1]), x1);
    record_i(E, layout, offsetof(struct triangle_head, x[2]), x2);
    record_i(E, layout, offsetof(struct triangle_head, y[0]), p[0].window_y);
    record_i(E, layout, offsetof(struct triangle_head, y[1]), y1);
    record_i(E, layout, offsetof(struct triangle_head, y[2]), y2);
    record_f(E, layout, offsetof(struct triangle_head, origin_x), p[0].x);
    record_f(E, layout, offsetof(struct triangle_head, origin_y), p[0].y);
}

static inline void setup_triangle(struct env *e, const struct setup_key *k,
                                  const struct triangle_layout *layout)
{
    struct corner p[3];
    for (int i = 0; i < 3; i++)
        p[i] = project(E, k, i);
    struct face face = face_of(E, p);
    msk visible = visible_winding(E, k, face.area);
    itg flag = visible_flag(E, k, visible, face.area);
    record_i(E, layout, offsetof(struct triangle_head, visible), flag);
    WHEN (E, visible) {
        record_head(E, layout, p, face.area);
        if (layout->coverage)
            record_smooth_triangle(E, layout, p, face.area);
        struct gradients g = face_gradients(E, &face);
        if (k->depth) {
            flt depth[3] = {p[0].depth, p[1].depth, p[2].depth};
            struct plane_values plane = plane_of(E, 0, &g, depth);
            if (k->depth_bias) {
                flt offset = depth_offset(E, k, &plane, depth);
                plane.value = add_f(E, plane.value, offset);
            }
            record_plane(E, layout, layout->depth, &plane);
        }
        if (layout->smooth) {
            flt w[3] = {p[0].reciprocal_w, p[1].reciprocal_w, p[2].reciprocal_w};
            struct plane_values plane = plane_of(E, 0, &g, w);
            record_plane(E, layout, layout->reciprocal_w, &plane);
        }
        for (int v = 0; v < VARYING_COUNT; v++)
            if (k->varying[v] != INTERPOLATION_NONE)
                record_varying(E, k, layout, &g, p, v);
    }
}

/* `layout` must be the result of layout_of_setup. */
static inline void spec_setup(struct env *e, const struct setup_key *k, const struct triangle_layout *layout)
{
    switch ((enum primitive)k->primitive) {
    case PRIMITIVE_TRIANGLE: setup_triangle(E, k, layout); break;
    case PRIMITIVE_LINE:
    case PRIMITIVE_EDGE: setup_line(E, k, layout); break;
    case PRIMITIVE_POINT:
    case PRIMITIVE_CORNER: setup_point(E, k, layout); break;
    case PRIMITIVE_COUNT: break;
    }
}

#endif
