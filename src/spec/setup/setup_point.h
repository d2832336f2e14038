/* Points, sprites and corners of triangles (spec/setup/setup.h). */
#ifndef SPEC_SETUP_SETUP_POINT_H
#define SPEC_SETUP_SETUP_POINT_H

#include "contract/language.h"
#include "spec/setup/setup_plane.h"
#include "spec/setup/setup_smooth.h"

static inline void record_constant(struct env *e, const struct triangle_layout *layout, size_t offset,
                                   flt value)
{
    struct plane_values plane;
    plane.value = value;
    plane.dx = plane.dy = lit_f(E, 0.0f);
    record_plane(E, layout, offset, &plane);
}

/* The position of one side of the square. */
static inline itg point_side(struct env *e, itg side)
{
    itg low = max_i(E, side, lit_i(E, -(int32_t)WINDOW_LIMIT));
    return min_i(E, low, lit_i(E, (int32_t)WINDOW_LIMIT));
}

/* Half the size in 1/256 pixel: the vertex's size if vertices have any, else the job's. */
static inline itg point_reach(struct env *e, const struct setup_key *k, const struct corner *p)
{
    flt size = k->point_size ? corner_slot(E, p, SLOT_POINT_SIZE)
                             : uniform_f(E, BASE_JOB, (int)offsetof(struct job, point_size));
    flt reach = mul_f(E, size, lit_f(E, 1 << (SUBPIXEL_BITS - 1)));
    return round_i(E, reach);
}

static inline void record_square(struct env *e, const struct triangle_layout *layout, const struct corner *p,
                                 itg visible, itg reach)
{
    itg left = sub_i(E, p->window_x, reach);
    itg right = add_i(E, p->window_x, reach);
    itg top = sub_i(E, p->window_y, reach);
    itg bottom = add_i(E, p->window_y, reach);
    itg x0 = point_side(E, left);
    itg x1 = point_side(E, right);
    itg y0 = point_side(E, top);
    itg y1 = point_side(E, bottom);
    record_i(E, layout, offsetof(struct triangle_head, visible), visible);
    record_i(E, layout, offsetof(struct triangle_head, x[0]), x0);
    record_i(E, layout, offsetof(struct triangle_head, x[1]), x1);
    record_i(E, layout, offsetof(struct triangle_head, y[0]), y0);
    record_i(E, layout, offsetof(struct triangle_head, y[1]), y1);
    record_f(E, layout, offsetof(struct triangle_head, origin_x), p->x);
    record_f(E, layout, offsetof(struct triangle_head, origin_y), p->y);
}

/* The inputs of a sprite's planes: 1/w, and the change of a coordinate over 1/w from pixel to pixel. */
struct sprite {
    flt reciprocal_w, slope;
};

static inline struct sprite make_sprite(struct env *e, const struct setup_key *k, const struct corner *p,
                                        itg reach)
{
    struct sprite r;
    itg size = add_i(E, reach, reach);
    flt pixels = window_pixels(E, size);
    r.reciprocal_w = k->w ? p->reciprocal_w : lit_f(E, 1.0f);
    r.slope = div_f(E, r.reciprocal_w, pixels);
    return r;
}

/* Component c of a varying that is smooth on a point. */
static inline struct plane_values sprite_plane(struct env *e, const struct setup_key *k,
                                               const struct sprite *s, int varying, int c)
{
    struct plane_values r;
    int axis = varying_is_texcoord(varying) ? c : -1;
    r.value = r.dx = r.dy = lit_f(E, 0.0f);
    if (axis >= 0)
        r.value = mul_f(E, s->reciprocal_w, lit_f(E, 0.5f));
    else if (varying_is_divisor(varying))
        r.value = s->reciprocal_w;
    if (axis == 0)
        r.dx = s->slope;
    if (axis == 1)
        r.dy = k->sprite_turned ? neg_f(E, s->slope) : s->slope;
    return r;
}

static inline void setup_point(struct env *e, const struct setup_key *k, const struct triangle_layout *layout)
{
    struct corner p[3];
    for (int i = 0; i < (primitive_has_area(k->primitive) ? 3 : 1); i++)
        p[i] = project(E, k, i);
    struct owner owner = owner_of(E, k, p);
    itg reach = point_reach(E, k, &p[0]);
    record_square(E, layout, &p[0], owner.visible, reach);
    if (layout->coverage)
        record_smooth_point(E, layout, reach);
    if (k->depth) {
        flt depth = p[0].depth;
        if (k->depth_bias)
            depth = add_f(E, depth, owner.depth_offset);
        record_constant(E, layout, layout->depth, depth);
    }
    struct sprite sprite = make_sprite(E, k, &p[0], reach);
    if (layout->smooth)
        record_constant(E, layout, layout->reciprocal_w, sprite.reciprocal_w);
    for (int v = 0; v < VARYING_COUNT; v++) {
        if (k->varying[v] == INTERPOLATION_FLAT)
            record_varying(E, k, layout, NULL, p, v);
        for (int c = 0; k->varying[v] == INTERPOLATION_SMOOTH && c < varying_components[v]; c++) {
            struct plane_values plane = sprite_plane(E, k, &sprite, v, c);
            record_plane(E, layout, layout->varying[v] + sizeof(struct plane) * (size_t)c, &plane);
        }
    }
}

#endif
