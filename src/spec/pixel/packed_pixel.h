/* Shading in packed bytes: texture stages, specular colour, fog, alpha test, and the writes to all targets.
 */
#ifndef SPEC_PIXEL_PACKED_PIXEL_H
#define SPEC_PIXEL_PACKED_PIXEL_H

#include "contract/language.h"
#include "spec/math/color.h"
#include "spec/pixel/alpha.h"
#include "spec/pixel/clip_mask.h"
#include "spec/pixel/coverage.h"
#include "spec/pixel/fog.h"
#include "spec/pixel/interpolate.h"
#include "spec/pixel/source.h"
#include "spec/pixel/stage.h"
#include "spec/pixel/target.h"
#include "spec/texture/detail.h"
#include "spec/texture/sample.h"

/* The channels of an interpolated colour that need no limits: those that vary in a span reading. */
static inline unsigned channels_within(const struct pixel_key *k, int varying)
{
    unsigned within = 0;
    for (int c = 0; c < 4 && k->span && k->varying[varying] == INTERPOLATION_SMOOTH; c++)
        within |= (unsigned)(varying_span_axes(k->span, varying, c) == AXES_BOTH) << c;
    return within;
}

/* An interpolated colour; white if the key has none. */
static inline struct color interpolated_color(struct env *e, const struct pixel_source *s, int varying)
{
    struct color r;
    flt channel[4];
    r.rb = r.ga = lit_x(E, 255);
    if (!s->k->varying[varying])
        return r;
    for (int c = 0; c < 4; c++)
        channel[c] = interpolate(E, s->k, s->layout, &s->color_at, s->color_w, varying, c);
    return color_quantize_within(E, channel, channels_within(s->k, varying));
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
        OBSERVE(E, texel, i, v.texture);
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
    fix factor = fog_factor(E, s->k, distance);
    return fog_blend(E, color, factor);
}

/* Multiplies the targets' colours, and the second colour, by the clip mask. */
static inline void mask_packed(struct env *e, const struct pixel_key *k, struct color color[TARGETS])
{
    if (!k->clip_mask)
        return;
    itg byte = clip_mask_byte(E, k->clip_mask);
    fix mask = both_halves(E, byte);
    for (int t = 0; t < TARGETS; t++)
        if (pixel_uses_color(k, t))
            color[t] = clip_mask_color(E, mask, color[t]);
}

/* Applies the coverage to the colours that are used; writes them to `covered`. */
static inline const struct color *cover_packed(struct env *e, const struct pixel_source *s,
                                               const struct color *color, int step, struct color *covered)
{
    flt part = pixel_coverage(E, s->k, s->at);
    fix factor = coverage_factor(E, s->k, part);
    for (int t = 0; t < (step ? TARGETS : 1); t++)
        if (pixel_has_color(s->k, t) || !step)
            covered[t] = cover_color(E, s->k, factor, color[t]);
    return covered;
}

/* Tests and writes the colours of the targets. `step` is 0 if all targets have the first colour, 1 if each
 * has its own. */
static inline void finish_packed(struct env *e, const struct pixel_source *s, const struct color *color,
                                 int step, msk live)
{
    const struct pixel_key *k = s->k;
    bool second = blend_reads_second(k);
    struct color covered[TARGETS];
    if (k->coverage)
        color = cover_packed(E, s, color, step, covered);
    if (pixel_tests_alpha(k)) {
        itg ga = int_of(E, color->ga);
        itg alpha = ushr_i(E, ga, 16);
        live = test_alpha(E, s, alpha, live);
    }
    finish_tests(E, s, live);
    struct color masked[TARGETS];
    for (int t = 0; t < TARGETS; t++)
        if (pixel_uses_color(k, t))
            masked[t] = color[step * t];
    mask_packed(E, k, masked);
    struct primitive_blend own = primitive_blend_begin(E, s);
    for (int i = 0; i < s->samples->count; i++)
        for (int t = 0; t < TARGETS; t++)
            if (k->write_mask[t])
                write_target(E, k, t, i, s->samples->live[i], masked[t], masked[second ? 1 : t], &own);
}

static inline void shade_packed(struct env *e, const struct pixel_source *s, msk live)
{
    struct color color = shade_stages(E, s);
    color = apply_fog(E, s, color);
    finish_packed(E, s, &color, 0, live);
}

#endif
