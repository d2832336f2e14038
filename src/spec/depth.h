/* Depth: clamped to 0..1 (NaN gives 0), compared with the stored value, written where the test passes. */

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

/* Tests and writes depth; returns the lanes that are still live. */
static inline msk depth_test(struct env *e, const struct pixel_key *k, const struct pixel_position *at,
                             const struct triangle_layout *layout, msk live)
{
    if (k->depth_function == COMPARE_ALWAYS && !k->depth_write)
        return live;
    flt plane = evaluate_plane(E, at, layout->depth);
    flt low = max_f(E, plane, lit_f(E, 0.0f));
    flt depth = min_f(E, low, lit_f(E, 1.0f));
    flt stored = load_f(E, BASE_DEPTH, 0);
    if (k->depth_function != COMPARE_ALWAYS) {
        msk passed = depth_compare(E, k->depth_function, depth, stored);
        live = and_m(E, live, passed);
    }
    if (k->depth_write) {
        flt merged = select_f(E, live, depth, stored);
        store_f(E, BASE_DEPTH, 0, merged);
    }
    return live;
}
