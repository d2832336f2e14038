/* The setup routine: projection, snapping, area and culling, plane equations; one lane a triangle, line or
 * point (draw/call.h, struct setup_call).
 *
 * Bases: JOB; INPUT is the lanes' vertex offsets, SETUP_INDEX_ROWS rows; VERTICES the vertex batch; OUTPUT
 * the lanes' records. Window positions are snapped to 1/256 pixel first, and everything after uses the
 * snapped ones, so coverage and interpolation agree about where the triangle is.
 *
 * Twice the area is a difference of two products that may nearly cancel. With p = dx2 * dy1 rounded and its
 * error e = fma(dx2, dy1, -p), the value fma(dx1, dy2, -p) - e is within 1.5 ulp of the exact one (Kahan;
 * Jeannerod, Louvet, Muller 2013), so its sign is exact and it is 0 only for triangles without area.
 *
 * A plane through (0, a0), (p1, a1), (p2, a2) relative to vertex 0 has the gradients
 *   dx = (a1 - a0) * u1 + (a2 - a0) * u2,  dy = (a1 - a0) * v1 + (a2 - a0) * v2
 * with u1 = dy2 / area, u2 = -dy1 / area, v1 = -dx2 / area, v2 = dx1 / area (Olano and Greer 1997).
 *
 * Depth bias: value += m * slope + bias (one fused multiply-add, then the sum), where m = max(|dx|, |dy|) of
 * the triangle's depth plane. Edges and corners, which are parts of triangles, take it from the whole
 * triangle.
 *
 * A line from (0, a0) to ((dx, dy), a1) has the gradients (a1 - a0) * dx / l, (a1 - a0) * dy / l with l =
 * dx^2
 * + dy^2: constant across the line. On a line without length l counts as 2^-16, the least that a length has.
 *
 * A point of size s is the square of the pixels within s / 2 of its centre, s / 2 rounded to 1/256 pixel
 * (draw/raster_point.c). Nothing varies over it but the texture coordinates of a point sprite, which are what
 * the key calls smooth: u from 0 at the left to 1 at the right, v from 0 at the top to 1 at the bottom, third
 * coordinates 0, divisors 1. 1/w counts as 1 unless the pixel routine asks for w itself. */

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

/* The plane of a value at the corners: a triangle's, or with `line` that of the line between the first two.
 */
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

/* m * slope + bias, given the triangle's depth plane. */
static inline flt depth_offset(struct env *e, const struct setup_key *k, const struct plane_values *plane)
{
    flt bias = uniform_f(E, BASE_JOB, (int)offsetof(struct job, depth_bias));
    if (k->depth_bias == DEPTH_BIAS_CONSTANT)
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
    switch (k->cull) {
    case CULL_CLOCKWISE: return lt_f(E, area, lit_f(E, 0.0f));
    case CULL_COUNTERCLOCKWISE: return lt_f(E, lit_f(E, 0.0f), area);
    default: return ne_f(E, area, lit_f(E, 0.0f));
    }
}

/* What the head says of visibility and, with `facing`, of the winding. */
static inline itg visible_flag(struct env *e, const struct setup_key *k, msk visible, flt area)
{
    itg flag = mask_i(E, visible);
    if (!k->facing)
        return flag;
    msk turned = lt_f(E, area, lit_f(E, 0.0f));
    itg winding = select_i(E, turned, lit_i(E, 1), lit_i(E, -1));
    return and_i(E, flag, winding);
}

/* The head; vertices 1 and 2 change places where the area is negative. */
static inline void record_head(struct env *e, const struct setup_key *k, const struct triangle_layout *layout,
                               const struct corner p[3], msk visible, flt area)
{
    msk turned = lt_f(E, area, lit_f(E, 0.0f));
    itg x1 = select_i(E, turned, p[2].window_x, p[1].window_x);
    itg x2 = select_i(E, turned, p[1].window_x, p[2].window_x);
    itg y1 = select_i(E, turned, p[2].window_y, p[1].window_y);
    itg y2 = select_i(E, turned, p[1].window_y, p[2].window_y);
    itg flag = visible_flag(E, k, visible, area);
    record_i(E, layout, offsetof(struct triangle_head, visible), flag);
    record_i(E, layout, offsetof(struct triangle_head, x[0]), p[0].window_x);
    record_i(E, layout, offsetof(struct triangle_head, x[1]), x1);
    record_i(E, layout, offsetof(struct triangle_head, x[2]), x2);
    record_i(E, layout, offsetof(struct triangle_head, y[0]), p[0].window_y);
    record_i(E, layout, offsetof(struct triangle_head, y[1]), y1);
    record_i(E, layout, offsetof(struct triangle_head, y[2]), y2);
    record_f(E, layout, offsetof(struct triangle_head, origin_x), p[0].x);
    record_f(E, layout, offsetof(struct triangle_head, origin_y), p[0].y);
}

/* A flat colour is the provoking vertex's; other flat varyings, which only points have, are their own. */
static inline struct corner flat_corner(struct env *e, const struct setup_key *k, const struct corner p[3],
                                        int varying)
{
    struct corner r = p[0];
    if (k->primitive != PRIMITIVE_TRIANGLE && (varying == VARYING_diffuse || varying == VARYING_specular))
        r.lane = load_i(E, BASE_INPUT, 3 * SETUP_INDEX_BYTES);
    return r;
}

static inline void record_varying(struct env *e, const struct setup_key *k,
                                  const struct triangle_layout *layout, const struct gradients *g,
                                  const struct corner p[3], int varying)
{
    int line = k->primitive != PRIMITIVE_TRIANGLE;
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

/* Twice the area of the triangle, whose sign is exact, and the sides that meet in its first corner. */
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

static inline void setup_triangle(struct env *e, const struct setup_key *k,
                                  const struct triangle_layout *layout)
{
    struct corner p[3];
    for (int i = 0; i < 3; i++)
        p[i] = project(E, k, i);
    struct face face = face_of(E, p);
    msk visible = visible_winding(E, k, face.area);
    record_head(E, k, layout, p, visible, face.area);
    WHEN (E, visible) {
        struct gradients g = face_gradients(E, &face);
        if (k->depth) {
            flt depth[3] = {p[0].depth, p[1].depth, p[2].depth};
            struct plane_values plane = plane_of(E, 0, &g, depth);
            if (k->depth_bias) {
                flt offset = depth_offset(E, k, &plane);
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

/* --- Lines and points, edges and corners */

/* What the triangle of an edge or a corner says; all true and nothing for lines and points. */
struct owner {
    itg visible;      /* as the head has it */
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
        r.depth_offset = depth_offset(E, k, &plane);
    }
    return r;
}

static inline void record_constant(struct env *e, const struct triangle_layout *layout, size_t offset,
                                   flt value)
{
    struct plane_values plane;
    plane.value = value;
    plane.dx = plane.dy = lit_f(E, 0.0f);
    record_plane(E, layout, offset, &plane);
}

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

/* Where the square ends on one side. */
static inline itg point_side(struct env *e, itg side)
{
    itg low = max_i(E, side, lit_i(E, -(int32_t)WINDOW_LIMIT));
    return min_i(E, low, lit_i(E, (int32_t)WINDOW_LIMIT));
}

/* Half the size in 1/256 pixel. */
static inline itg point_reach(struct env *e)
{
    flt size = uniform_f(E, BASE_JOB, (int)offsetof(struct job, point_size));
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

/* What a sprite's planes are made of: 1/w, and the change of a coordinate over 1/w from pixel to pixel. */
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
static inline struct plane_values sprite_plane(struct env *e, const struct sprite *s, int varying, int c)
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
        r.dy = s->slope;
    return r;
}

static inline void setup_point(struct env *e, const struct setup_key *k, const struct triangle_layout *layout)
{
    struct corner p[3];
    for (int i = 0; i < (primitive_has_area(k->primitive) ? 3 : 1); i++)
        p[i] = project(E, k, i);
    struct owner owner = owner_of(E, k, p);
    itg reach = point_reach(E);
    record_square(E, layout, &p[0], owner.visible, reach);
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
            struct plane_values plane = sprite_plane(E, &sprite, v, c);
            record_plane(E, layout, layout->varying[v] + sizeof(struct plane) * (size_t)c, &plane);
        }
    }
}

static void spec_setup(struct env *e, const struct setup_key *k)
{
    struct triangle_layout layout = setup_layout(k);
    switch (k->primitive) {
    case PRIMITIVE_TRIANGLE: setup_triangle(E, k, &layout); break;
    case PRIMITIVE_LINE:
    case PRIMITIVE_EDGE: setup_line(E, k, &layout); break;
    default: setup_point(E, k, &layout);
    }
}
