/* Depth: clamped to 0..1 (NaN gives 0), compared with the stored value, written where the test passes.
 *
 * The comparison comes first of all. The write follows at once, or behind the alpha test when that is on. */

static inline msk depth_compare(struct env *e, int function, flt new, flt stored)
{
    switch (function) {
    case COMPARE_NEVER: return lit_m(E, 0);
    case COMPARE_LESS: return lt_f(E, new, stored);
    case COMPARE_EQUAL: return eq_f(E, new, stored);
    case COMPARE_LESS_EQUAL: return le_f(E, new, stored);
    case COMPARE_GREATER: return lt_f(E, stored, new);
    case COMPARE_NOT_EQUAL: return ne_f(E, new, stored);
    case COMPARE_GREATER_EQUAL: return le_f(E, stored, new);
    default: return lit_m(E, -1);
    }
}

struct depth {
    flt new, stored;
};

/* The pixel's own depth. */
static inline flt pixel_depth(struct env *e, const struct pixel_position *at,
                              const struct triangle_layout *layout)
{
    flt plane = evaluate_plane(E, at, layout->depth);
    flt low = max_f(E, plane, lit_f(E, 0.0f));
    return min_f(E, low, lit_f(E, 1.0f));
}

/* The pixel's depth and the tile's. */
static inline struct depth depth_pair(struct env *e, const struct pixel_position *at,
                                      const struct triangle_layout *layout)
{
    struct depth r;
    r.new = pixel_depth(E, at, layout);
    r.stored = load_f(E, BASE_DEPTH, 0);
    return r;
}

static inline void depth_write(struct env *e, struct depth depth, msk live)
{
    flt merged = select_f(E, live, depth.new, depth.stored);
    store_f(E, BASE_DEPTH, 0, merged);
}

/* Tests depth, and writes it unless the alpha test has a say in that; returns the lanes that are still live.
 */
static inline msk depth_test(struct env *e, const struct pixel_key *k, const struct pixel_position *at,
                             const struct triangle_layout *layout, msk live)
{
    int writes = k->depth_write && !k->alpha_discard;
    if (k->depth_function == COMPARE_ALWAYS && !writes)
        return live;
    struct depth depth = depth_pair(E, at, layout);
    if (k->depth_function != COMPARE_ALWAYS) {
        msk passed = depth_compare(E, k->depth_function, depth.new, depth.stored);
        live = and_m(E, live, passed);
    }
    if (writes)
        depth_write(E, depth, live);
    return live;
}

/* Behind the alpha test: the same depth again, which costs less than keeping it through shading. */
static inline void depth_write_late(struct env *e, const struct pixel_key *k, const struct pixel_position *at,
                                    const struct triangle_layout *layout, msk live)
{
    if (!k->depth_write || !k->alpha_discard)
        return;
    struct depth depth = depth_pair(E, at, layout);
    depth_write(E, depth, live);
}
