/* Lines and edges of triangles (spec/setup/setup.h). */
#ifndef SPEC_SETUP_SETUP_LINE_H
#define SPEC_SETUP_SETUP_LINE_H

#include "contract/language.h"
#include "spec/setup/setup_plane.h"
#include "spec/setup/setup_smooth.h"

static inline void setup_line(struct env *e, const struct setup_key *k, const struct triangle_layout *layout)
{
    struct corner p[3];
    for (int i = 0; i < (primitive_has_area(k->primitive) ? 3 : 2); i++)
        p[i] = project(E, k, i);
    struct owner owner = owner_of(E, k, p);
    itg last = load_i(E, BASE_INPUT, 4 * SETUP_INDEX_BYTES);
    record_i(E, layout, offsetof(struct triangle_head, visible), owner.visible);
    record_i(E, layout, offsetof(struct triangle_head, x[0]), p[0].window_x);
    record_i(E, layout, offsetof(struct triangle_head, x[1]), p[1].window_x);
    record_i(E, layout, offsetof(struct triangle_head, x[2]), last);
    record_i(E, layout, offsetof(struct triangle_head, y[0]), p[0].window_y);
    record_i(E, layout, offsetof(struct triangle_head, y[1]), p[1].window_y);
    record_f(E, layout, offsetof(struct triangle_head, origin_x), p[0].x);
    record_f(E, layout, offsetof(struct triangle_head, origin_y), p[0].y);
    flt dx = sub_f(E, p[1].x, p[0].x);
    flt dy = sub_f(E, p[1].y, p[0].y);
    if (layout->coverage)
        record_smooth_line(E, layout, dx, dy, last);
    flt square = mul_f(E, dy, dy);
    flt length = mad_f(E, dx, dx, square);
    flt least = max_f(E, length, lit_f(E, 0x1p-16f));
    flt inverse = div_f(E, lit_f(E, 1.0f), least);
    struct gradients g;
    g.u1 = mul_f(E, dx, inverse);
    g.v1 = mul_f(E, dy, inverse);
    g.u2 = g.v2 = g.u1;
    if (k->depth) {
        flt depth[3] = {p[0].depth, p[1].depth, p[1].depth};
        struct plane_values plane = plane_of(E, 1, &g, depth);
        if (k->depth_bias)
            plane.value = add_f(E, plane.value, owner.depth_offset);
        record_plane(E, layout, layout->depth, &plane);
    }
    if (layout->smooth) {
        flt w[3] = {p[0].reciprocal_w, p[1].reciprocal_w, p[1].reciprocal_w};
        struct plane_values plane = plane_of(E, 1, &g, w);
        record_plane(E, layout, layout->reciprocal_w, &plane);
    }
    for (int v = 0; v < VARYING_COUNT; v++)
        if (k->varying[v] != INTERPOLATION_NONE)
            record_varying(E, k, layout, &g, p, v);
}

#endif
