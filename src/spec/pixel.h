/* The pixel routine: depth, interpolation, texture, stage, alpha test, blending, write; one lane a pixel of a
 * 4x4 block (draw/call.h, struct pixel_call).
 *
 * Bases: JOB; ENTRY the block's entry; TRIANGLE its record; LANES the per-lane constants of this chunk of the
 * block; COLOR and DEPTH the chunk's pixels in the tile. Depth is always tested first, and shading is skipped
 * when no lane is left; what is written waits for the alpha test. */

/* Lanes of this chunk that the triangle covers. */
static inline msk coverage(struct env *e)
{
    itg bits = uniform_i(E, BASE_ENTRY, (int)offsetof(struct entry, coverage));
    itg bit = load_i(E, BASE_LANES, (int)offsetof(struct lane_table, bit));
    itg hit = and_i(E, bits, bit);
    return eq_i(E, hit, bit);
}

static inline struct color shade(struct env *e, const struct pixel_key *k,
                                 const struct triangle_layout *layout, const struct pixel_position *at)
{
    struct color diffuse, texture;
    flt w = lit_f(E, 1.0f);
    if (layout->smooth)
        w = pixel_w(E, at, layout);
    diffuse.rb = diffuse.ga = texture.rb = texture.ga = lit_x(E, 255);
    if (k->varying[VARYING_diffuse]) {
        flt channel[4];
        for (int c = 0; c < 4; c++)
            channel[c] = interpolate(E, k, layout, at, w, VARYING_diffuse, c);
        diffuse = color_quantize(E, channel);
    }
    if (k->texture) {
        flt u = interpolate(E, k, layout, at, w, VARYING_texcoord, 0);
        flt v = interpolate(E, k, layout, at, w, VARYING_texcoord, 1);
        texture = sample(E, k, u, v);
    }
    return stage(E, k, diffuse, texture);
}

static void spec_pixel(struct env *e, const struct pixel_key *k)
{
    int reads_depth = k->depth_function != COMPARE_ALWAYS || k->depth_write;
    struct triangle_layout layout = triangle_layout(reads_depth, k->varying);
    struct pixel_position at = pixel_position(E);
    msk covered = coverage(E);
    msk live = depth_test(E, k, &at, &layout, covered);
    if (!pixel_shades(k))
        return;
    WHEN (E, live) {
        struct color color = shade(E, k, &layout, &at);
        msk kept = live;
        if (k->alpha_discard)
            kept = alpha_test(E, k->alpha_discard, color, live);
        depth_write_late(E, k, &at, &layout, kept);
        if (k->write_mask) {
            itg stored = load_i(E, BASE_COLOR, 0);
            color = blend(E, k, color, stored);
            write_color(E, k, kept, color, stored);
        }
    }
}
