/* The pixel routine: stencil, depth, interpolation, textures and stages or a shader (shader_pixel.h), specular, fog,
 * alpha test, blending, write; one lane a pixel of a 4x4 block (draw/call.h, struct pixel_call).
 *
 * Bases: JOB; ENTRY the block's entry; TRIANGLE its record; LANES the per-lane constants of this chunk of the
 * block; COLOR and DEPTH the chunk's pixels in the tile. The alpha test comes before stencil and depth by
 * definition. These are tested first all the same where that makes no difference, and shading is skipped when
 * no lane is left; what is written waits for the alpha test, and for a shader that discards pixels or gives depth. A
 * query counts the lanes that pass everything.
 */

/* What all colours of a pixel are interpolated with. */
struct pixel_source {
    const struct pixel_key *k;
    const struct triangle_layout *layout;
    const struct pixel_position *at;
    flt w;
    struct pixel_position color_at; /* of the diffuse and the specular colour */
    flt color_w;
    struct samples *samples;
};

/* An interpolated colour; white where none is. */
static inline struct color interpolated_color(struct env *e, const struct pixel_source *s, int varying)
{
    struct color r;
    flt channel[4];
    r.rb = r.ga = lit_x(E, 255);
    if (!s->k->varying[varying])
        return r;
    for (int c = 0; c < 4; c++)
        channel[c] = interpolate(E, s->k, s->layout, &s->color_at, s->color_w, varying, c);
    return color_quantize(E, channel);
}

/* The texture coordinates of a stage: u, v, and a third where it is read. A divisor takes the place of 1/w:
 * (u/w) / (q/w) is u/q. */
static inline void stage_coordinates(struct env *e, const struct pixel_source *s, int stage, flt v[3])
{
    int channel = s->k->coordinates[stage];
    flt w = s->w;
    if (s->k->varying[varying_divisor(channel)]) {
        flt divisor = interpolate_over_w(E, s->k, s->layout, s->at, varying_divisor(channel), 0);
        w = div_f(E, lit_f(E, 1.0f), divisor);
    }
    v[0] = v[2] = interpolate(E, s->k, s->layout, s->at, w, varying_texcoord(channel), 0);
    v[1] = interpolate(E, s->k, s->layout, s->at, w, varying_texcoord(channel), 1);
    if (s->k->varying[varying_third(channel)])
        v[2] = interpolate(E, s->k, s->layout, s->at, w, varying_third(channel), 0);
}

static inline struct color stage_texture(struct env *e, const struct pixel_source *s, int stage)
{
    flt v[3];
    struct sampler_key k = pixel_sampler(s->k, stage);
    struct lookup how = {.from = DETAIL_QUAD};
    stage_coordinates(E, s, stage, v);
    return sample(E, &k, v, &how);
}

static inline struct color shade_stages(struct env *e, const struct pixel_source *s)
{
    struct stage_values v;
    v.diffuse = interpolated_color(E, s, VARYING_diffuse);
    v.specular = interpolated_color(E, s, VARYING_specular);
    v.current = v.diffuse;
    v.temporary.rb = v.temporary.ga = lit_x(E, 0);
    for (int i = 0; i < s->k->stages; i++) {
        v.texture.rb = v.texture.ga = lit_x(E, 255);
        if (s->k->texture[i])
            v.texture = stage_texture(E, s, i);
        stage(E, s->k, i, &v);
    }
    if (s->k->specular)
        v.current = add_specular(E, v.current, v.specular);
    return v.current;
}

static inline struct color apply_fog(struct env *e, const struct pixel_source *s, struct color color)
{
    if (!s->k->fog)
        return color;
    flt distance = fog_distance(E, s->k, s->layout, s->at, s->w);
    fix factor = fog_factor(E, s->k->fog, distance);
    return fog_blend(E, color, factor);
}

/* Does what waits for shading, in the lanes that it keeps. */
static inline void finish_tests(struct env *e, const struct pixel_source *s, msk kept)
{
    struct samples *samples = s->samples;
    if (!pixel_waits(s->k))
        return;
    for (int i = 0; i < samples->count; i++) {
        if (samples->count > 1)
            samples->live[i] = and_m(E, samples->live[i], kept);
        else
            samples->live[i] = kept;
        samples->live[i] = late_tests(E, s->k, &samples->at[i], s->layout, samples->live[i]);
    }
    count_passed(E, s->k, samples);
}

/* Tests and writes the colours of the targets; all have the first one's where `step` is 0, else each its own. */
static inline void finish_packed(struct env *e, const struct pixel_source *s, const struct color *color,
                                 int step, msk live)
{
    const struct pixel_key *k = s->k;
    if (k->alpha_discard) {
        itg ga = int_of(E, color->ga);
        itg alpha = ushr_i(E, ga, 16);
        live = alpha_test(E, k->alpha_discard, alpha, live);
    }
    finish_tests(E, s, live);
    for (int i = 0; i < s->samples->count; i++)
        for (int t = 0; t < TARGETS; t++)
            if (k->write_mask[t])
                write_target(E, k, t, i, s->samples->live[i], color[step * t]);
}

static inline void shade_packed(struct env *e, const struct pixel_source *s, msk live)
{
    struct color color = shade_stages(E, s);
    color = apply_fog(E, s, color);
    finish_packed(E, s, &color, 0, live);
}

static inline void shade_float(struct env *e, const struct pixel_source *s, msk live); /* float_pixel.h */
static inline void shade_by_shader(struct env *e, const struct pixel_source *s,
                                   msk live); /* shader_pixel.h */

static inline struct pixel_source pixel_source(struct env *e, const struct pixel_key *k,
                                               const struct triangle_layout *layout,
                                               const struct pixel_position *at, struct samples *samples)
{
    struct pixel_source r = {.k = k, .layout = layout, .at = at, .samples = samples};
    r.w = lit_f(E, 1.0f);
    if (layout->smooth)
        r.w = pixel_w(E, at, layout);
    r.color_at = centroid(E, k, at, samples);
    r.color_w = r.w;
    if (k->samples && layout->smooth)
        r.color_w = pixel_w(E, &r.color_at, layout);
    return r;
}

/* `layout` is pixel_layout's. */
static void spec_pixel(struct env *e, const struct pixel_key *k, const struct triangle_layout *layout)
{
    struct pixel_position at = pixel_position(E);
    struct samples samples;
    pixel_samples(E, k, &at, &samples);
    for (int i = 0; i < samples.count; i++)
        samples.live[i] = early_tests(E, k, &samples.at[i], layout, samples.covered[i]);
    if (!pixel_waits(k))
        count_passed(E, k, &samples);
    if (!pixel_shades(k))
        return;
    msk live = any_sample(E, &samples);
    WHEN (E, live) {
        struct pixel_source source = pixel_source(E, k, layout, &at, &samples);
        if (e->program)
            shade_by_shader(E, &source, live);
        else if (k->float_color)
            shade_float(E, &source, live);
        else
            shade_packed(E, &source, live);
    }
}
