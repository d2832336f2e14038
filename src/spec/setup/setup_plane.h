/* The common part of triangles, lines and points in setup: projected and snapped corners, planes, and the
 * properties that an edge or a corner has from its triangle. The definitions are in spec/setup/setup.h. */
#ifndef SPEC_SETUP_SETUP_PLANE_H
#define SPEC_SETUP_SETUP_PLANE_H

#include "contract/language.h"

struct corner {
    itg lane; /* byte offset of the vertex's lane in the batch */
    flt reciprocal_w;
    itg window_x, window_y; /* 1/256 pixel */
    flt x, y;               /* the same in pixels, exact */
    flt depth;
};

struct gradients {
    flt u1, u2, v1, v2; /* a line's are u1 and v1 */
};

struct plane_values {
    flt value, dx, dy;
};

static inline flt corner_slot(struct env *e, const struct corner *corner, int slot)
{
    return gather_f(E, BASE_VERTICES, GATHER_DIRECT, corner->lane, 1, slot * VERTEX_SLOT_BYTES);
}

static inline itg window_position(struct env *e, flt ndc, int scale, int offset)
{
    flt s = uniform_f(E, BASE_JOB, scale);
    flt o = uniform_f(E, BASE_JOB, offset);
    flt window = mad_f(E, ndc, s, o);
    flt low = max_f(E, window, lit_f(E, -WINDOW_LIMIT));
    flt limited = min_f(E, low, lit_f(E, WINDOW_LIMIT));
    return round_i(E, limited);
}

static inline flt window_pixels(struct env *e, itg position)
{
    flt subpixels = float_f(E, position);
    return mul_f(E, subpixels, lit_f(E, 1.0f / (1 << SUBPIXEL_BITS)));
}

static inline struct corner project(struct env *e, const struct setup_key *k, int vertex)
{
    struct corner r;
    r.lane = load_i(E, BASE_INPUT, vertex * SETUP_INDEX_BYTES);
    flt w = corner_slot(E, &r, SLOT_W);
    r.reciprocal_w = k->window ? w : div_f(E, lit_f(E, 1.0f), w);
    flt clip_x = corner_slot(E, &r, SLOT_X);
    flt clip_y = corner_slot(E, &r, SLOT_Y);
    flt x = k->window ? clip_x : mul_f(E, clip_x, r.reciprocal_w);
    flt y = k->window ? clip_y : mul_f(E, clip_y, r.reciprocal_w);
    r.window_x =
        window_position(E, x, (int)offsetof(struct job, scale_x), (int)offsetof(struct job, offset_x));
    r.window_y =
        window_position(E, y, (int)offsetof(struct job, scale_y), (int)offsetof(struct job, offset_y));
    r.x = window_pixels(E, r.window_x);
    r.y = window_pixels(E, r.window_y);
    r.depth = lit_f(E, 0.0f);
    if (k->depth) {
        flt clip_z = corner_slot(E, &r, SLOT_Z);
        flt z = k->window ? clip_z : mul_f(E, clip_z, r.reciprocal_w);
        flt s = uniform_f(E, BASE_JOB, (int)offsetof(struct job, depth_scale));
        flt o = uniform_f(E, BASE_JOB, (int)offsetof(struct job, depth_offset));
        r.depth = mad_f(E, z, s, o);
    }
    return r;
}

static inline void record_f(struct env *e, const struct triangle_layout *layout, size_t offset, flt value)
{
    scatter_f(E, BASE_OUTPUT, (int)offset, layout->stride, value);
}

static inline void record_i(struct env *e, const struct triangle_layout *layout, size_t offset, itg value)
{
    scatter_i(E, BASE_OUTPUT, (int)offset, layout->stride, value);
}

/* The plane of a value at the corners: of a triangle, or with `line` of the line between the first two. */
static inline struct plane_values plane_of(struct env *e, int line, const struct gradients *g, const flt a[3])
{
    struct plane_values r;
    r.value = a[0];
    flt d1 = sub_f(E, a[1], a[0]);
    if (line) {
        r.dx = mul_f(E, d1, g->u1);
        r.dy = mul_f(E, d1, g->v1);
        return r;
    }
    flt d2 = sub_f(E, a[2], a[0]);
    flt x2 = mul_f(E, d2, g->u2);
    r.dx = mad_f(E, d1, g->u1, x2);
    flt y2 = mul_f(E, d2, g->v2);
    r.dy = mad_f(E, d1, g->v1, y2);
    return r;
}

static inline void record_plane(struct env *e, const struct triangle_layout *layout, size_t offset,
                                const struct plane_values *plane)
{
    record_f(E, layout, offset + offsetof(struct plane, value), plane->value);
    record_f(E, layout, offset + offsetof(struct plane, dx), plane->dx);
    record_f(E, layout, offset + offsetof(struct plane, dy), plane->dy);
}

/* The constant part of the bias: the job's, or times the power of two at or below the greatest depth of the
 * corners. The job's is then a number of steps between 1 and 2. */
static inline flt depth_bias_constant(struct env *e, const struct setup_key *k, const flt depth[3])
{
    flt bias = uniform_f(E, BASE_JOB, (int)offsetof(struct job, depth_bias));
    if (k->depth_bias <= DEPTH_BIAS_SLOPE)
        return bias;
    bool short_format = k->depth_bias >= DEPTH_BIAS_FLOAT24;
    flt two = max_f(E, depth[0], depth[1]);
    flt most = max_f(E, two, depth[2]);
    flt normal = max_f(E, most, lit_f(E, short_format ? DEPTH_FLOAT24_NORMAL : 0x1p-126f));
    itg bits = bits_i(E, normal);
    itg exponent = and_i(E, bits, lit_i(E, 0x7f800000));
    flt power = bits_f(E, exponent);
    return mul_f(E, bias, power);
}

/* m * slope + bias, given the triangle's depth plane and the depths of its corners. */
static inline flt depth_offset(struct env *e, const struct setup_key *k, const struct plane_values *plane,
                               const flt depth[3])
{
    flt bias = depth_bias_constant(E, k, depth);
    if (!depth_bias_has_slope(k->depth_bias))
        return bias;
    flt slope = uniform_f(E, BASE_JOB, (int)offsetof(struct job, depth_bias_slope));
    flt minus_x = neg_f(E, plane->dx);
    flt minus_y = neg_f(E, plane->dy);
    flt x = max_f(E, plane->dx, minus_x);
    flt y = max_f(E, plane->dy, minus_y);
    flt most = max_f(E, x, y);
    return mad_f(E, most, slope, bias);
}

static inline msk visible_winding(struct env *e, const struct setup_key *k, flt area)
{
    switch ((enum cull)k->cull) {
    case CULL_CLOCKWISE: return lt_f(E, area, lit_f(E, 0.0f));
    case CULL_COUNTERCLOCKWISE: return lt_f(E, lit_f(E, 0.0f), area);
    case CULL_NONE:
    case CULL_COUNT: break;
    }
    return ne_f(E, area, lit_f(E, 0.0f));
}

/* The head's `visible`: visibility and, with `facing`, the winding. */
static inline itg visible_flag(struct env *e, const struct setup_key *k, msk visible, flt area)
{
    itg flag = mask_i(E, visible);
    if (!k->facing)
        return flag;
    msk turned = lt_f(E, area, lit_f(E, 0.0f));
    itg winding = select_i(E, turned, lit_i(E, 1), lit_i(E, -1));
    return and_i(E, flag, winding);
}
/* A flat colour is that of the provoking vertex, and so is the blending of the primitive. Other flat
 * varyings, which only points have, are the vertex's own. */
static inline struct corner flat_corner(struct env *e, const struct setup_key *k, const struct corner p[3],
                                        int varying)
{
    struct corner r = p[0];
    bool provoked = varying == VARYING_diffuse || varying == VARYING_specular || varying == VARYING_blending;
    if (k->primitive != PRIMITIVE_TRIANGLE && provoked)
        r.lane = load_i(E, BASE_INPUT, 3 * SETUP_INDEX_BYTES);
    return r;
}

static inline void record_varying(struct env *e, const struct setup_key *k,
                                  const struct triangle_layout *layout, const struct gradients *g,
                                  const struct corner p[3], int varying)
{
    bool line = k->primitive != PRIMITIVE_TRIANGLE;
    struct corner flat = p[0];
    if (k->varying[varying] == INTERPOLATION_FLAT)
        flat = flat_corner(E, k, p, varying);
    for (int c = 0; c < varying_components[varying]; c++) {
        int slot = varying_slot[varying] + c;
        if (k->varying[varying] == INTERPOLATION_FLAT) {
            flt value = corner_slot(E, &flat, slot);
            record_f(E, layout, layout->varying[varying] + sizeof(float) * (size_t)c, value);
            continue;
        }
        flt a[3];
        for (int i = 0; i < (line ? 2 : 3); i++) {
            flt value = corner_slot(E, &p[i], slot);
            a[i] = mul_f(E, value, p[i].reciprocal_w);
        }
        struct plane_values plane = plane_of(E, line, g, a);
        record_plane(E, layout, layout->varying[varying] + sizeof(struct plane) * (size_t)c, &plane);
    }
}

static inline struct gradients plane_gradients(struct env *e, flt area, flt dx1, flt dy1, flt dx2, flt dy2)
{
    struct gradients g;
    flt inverse = div_f(E, lit_f(E, 1.0f), area);
    flt minus = neg_f(E, inverse);
    g.u1 = mul_f(E, dy2, inverse);
    g.u2 = mul_f(E, dy1, minus);
    g.v1 = mul_f(E, dx2, minus);
    g.v2 = mul_f(E, dx1, inverse);
    return g;
}

/* Twice the area of the triangle, whose sign is exact, and the sides that meet at its first corner. */
struct face {
    flt dx1, dy1, dx2, dy2;
    flt area;
};

static inline struct face face_of(struct env *e, const struct corner p[3])
{
    struct face r;
    r.dx1 = sub_f(E, p[1].x, p[0].x);
    r.dy1 = sub_f(E, p[1].y, p[0].y);
    r.dx2 = sub_f(E, p[2].x, p[0].x);
    r.dy2 = sub_f(E, p[2].y, p[0].y);
    flt product = mul_f(E, r.dx2, r.dy1);
    flt minus = neg_f(E, product);
    flt error = mad_f(E, r.dx2, r.dy1, minus);
    flt difference = mad_f(E, r.dx1, r.dy2, minus);
    r.area = sub_f(E, difference, error);
    return r;
}

static inline struct gradients face_gradients(struct env *e, const struct face *f)
{
    return plane_gradients(E, f->area, f->dx1, f->dy1, f->dx2, f->dy2);
}

/* The properties that an edge or a corner has from its triangle. Lines and points are visible and have no
 * bias. */
struct owner {
    itg visible;      /* as in the head */
    flt depth_offset; /* if the key has a depth bias */
};

static inline struct owner owner_of(struct env *e, const struct setup_key *k, const struct corner p[3])
{
    struct owner r;
    r.depth_offset = lit_f(E, 0.0f);
    if (!primitive_has_area(k->primitive)) {
        r.visible = lit_i(E, -1);
        return r;
    }
    struct face face = face_of(E, p);
    msk visible = visible_winding(E, k, face.area);
    r.visible = visible_flag(E, k, visible, face.area);
    if (k->depth && k->depth_bias) {
        struct gradients g = face_gradients(E, &face);
        flt depth[3] = {p[0].depth, p[1].depth, p[2].depth};
        struct plane_values plane = plane_of(E, 0, &g, depth);
        r.depth_offset = depth_offset(E, k, &plane, depth);
    }
    return r;
}

#endif
