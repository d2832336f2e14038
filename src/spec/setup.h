/* The setup routine: projection, snapping, area and culling, plane equations; one lane a triangle
 * (draw/call.h, struct setup_call).
 *
 * Bases: JOB; INPUT is the lanes' vertex offsets, three rows; VERTICES the vertex batch; OUTPUT the lanes'
 * triangle records. Window positions are snapped to 1/256 pixel first, and everything after uses the snapped
 * ones, so coverage and interpolation agree about where the triangle is.
 *
 * Twice the area is a difference of two products that may nearly cancel. With p = dx2 * dy1 rounded and its
 * error e = fma(dx2, dy1, -p), the value fma(dx1, dy2, -p) - e is within 1.5 ulp of the exact one (Kahan;
 * Jeannerod, Louvet, Muller 2013), so its sign is exact and it is 0 only for triangles without area.
 *
 * A plane through (0, a0), (p1, a1), (p2, a2) relative to vertex 0 has the gradients
 *   dx = (a1 - a0) * u1 + (a2 - a0) * u2,  dy = (a1 - a0) * v1 + (a2 - a0) * v2
 * with u1 = dy2 / area, u2 = -dy1 / area, v1 = -dx2 / area, v2 = dx1 / area (Olano and Greer 1997). */

struct corner {
    itg lane; /* byte offset of the vertex's lane in the batch */
    flt reciprocal_w;
    itg window_x, window_y; /* 1/256 pixel */
    flt x, y;               /* the same in pixels, exact */
    flt depth;
};

struct gradients {
    flt u1, u2, v1, v2;
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

static inline void record_plane(struct env *e, const struct triangle_layout *layout, size_t offset,
                                const struct gradients *g, const flt a[3])
{
    flt d1 = sub_f(E, a[1], a[0]);
    flt d2 = sub_f(E, a[2], a[0]);
    flt x2 = mul_f(E, d2, g->u2);
    flt dx = mad_f(E, d1, g->u1, x2);
    flt y2 = mul_f(E, d2, g->v2);
    flt dy = mad_f(E, d1, g->v1, y2);
    record_f(E, layout, offset + offsetof(struct plane, value), a[0]);
    record_f(E, layout, offset + offsetof(struct plane, dx), dx);
    record_f(E, layout, offset + offsetof(struct plane, dy), dy);
}

static inline msk visible_winding(struct env *e, const struct setup_key *k, flt area)
{
    switch (k->cull) {
    case CULL_CLOCKWISE: return lt_f(E, area, lit_f(E, 0.0f));
    case CULL_COUNTERCLOCKWISE: return lt_f(E, lit_f(E, 0.0f), area);
    default: return ne_f(E, area, lit_f(E, 0.0f));
    }
}

/* The head; vertices 1 and 2 change places where the area is negative. */
static inline void record_head(struct env *e, const struct triangle_layout *layout, const struct corner p[3],
                               msk visible, flt area)
{
    msk turned = lt_f(E, area, lit_f(E, 0.0f));
    itg x1 = select_i(E, turned, p[2].window_x, p[1].window_x);
    itg x2 = select_i(E, turned, p[1].window_x, p[2].window_x);
    itg y1 = select_i(E, turned, p[2].window_y, p[1].window_y);
    itg y2 = select_i(E, turned, p[1].window_y, p[2].window_y);
    itg flag = mask_i(E, visible);
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

static inline void record_varying(struct env *e, const struct setup_key *k,
                                  const struct triangle_layout *layout, const struct gradients *g,
                                  const struct corner p[3], int varying)
{
    for (int c = 0; c < varying_components[varying]; c++) {
        int slot = varying_slot[varying] + c;
        if (k->varying[varying] == INTERPOLATION_FLAT) {
            flt value = corner_slot(E, &p[0], slot);
            record_f(E, layout, layout->varying[varying] + sizeof(float) * (size_t)c, value);
            continue;
        }
        flt a[3];
        for (int i = 0; i < 3; i++) {
            flt value = corner_slot(E, &p[i], slot);
            a[i] = mul_f(E, value, p[i].reciprocal_w);
        }
        record_plane(E, layout, layout->varying[varying] + sizeof(struct plane) * (size_t)c, g, a);
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

static void spec_setup(struct env *e, const struct setup_key *k)
{
    struct triangle_layout layout = setup_layout(k);
    struct corner p[3];
    for (int i = 0; i < 3; i++)
        p[i] = project(E, k, i);
    flt dx1 = sub_f(E, p[1].x, p[0].x);
    flt dy1 = sub_f(E, p[1].y, p[0].y);
    flt dx2 = sub_f(E, p[2].x, p[0].x);
    flt dy2 = sub_f(E, p[2].y, p[0].y);
    flt product = mul_f(E, dx2, dy1);
    flt minus = neg_f(E, product);
    flt error = mad_f(E, dx2, dy1, minus);
    flt difference = mad_f(E, dx1, dy2, minus);
    flt area = sub_f(E, difference, error);
    msk visible = visible_winding(E, k, area);
    record_head(E, &layout, p, visible, area);
    WHEN (E, visible) {
        struct gradients g = plane_gradients(E, area, dx1, dy1, dx2, dy2);
        if (k->depth) {
            flt depth[3] = {p[0].depth, p[1].depth, p[2].depth};
            record_plane(E, &layout, layout.depth, &g, depth);
        }
        if (layout.smooth) {
            flt w[3] = {p[0].reciprocal_w, p[1].reciprocal_w, p[2].reciprocal_w};
            record_plane(E, &layout, layout.reciprocal_w, &g, w);
        }
        for (int v = 0; v < VARYING_COUNT; v++)
            if (k->varying[v] != INTERPOLATION_NONE)
                record_varying(E, k, &layout, &g, p, v);
    }
}
