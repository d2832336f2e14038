/* Shading in binary32: as packed_pixel.h, on channels that are not quantized between the steps. */
#ifndef SPEC_PIXEL_FLOAT_PIXEL_H
#define SPEC_PIXEL_FLOAT_PIXEL_H

#include "contract/language.h"
#include "spec/math/color.h"
#include "spec/math/float_color.h"
#include "spec/pixel/clip_mask.h"
#include "spec/pixel/coverage.h"
#include "spec/pixel/alpha.h"
#include "spec/pixel/float_stage.h"
#include "spec/pixel/float_target.h"
#include "spec/pixel/fog.h"
#include "spec/pixel/interpolate.h"
#include "spec/pixel/source.h"
#include "spec/texture/bump.h"
#include "spec/texture/detail.h"
#include "spec/texture/sample_float.h"

static inline struct float_color float_interpolated(struct env *e, const struct pixel_source *s, int varying)
{
    struct float_color r = float_replicate(lit_f(E, 1.0f));
    if (!s->k->varying[varying])
        return r;
    for (int c = 0; c < 4; c++) {
        flt value = interpolate(E, s->k, s->layout, &s->color_at, s->color_w, varying, c);
        r.channel[c] = saturate(E, value);
    }
    return r;
}

/* The texture of a stage; the texture of the stage before may displace it. */
static inline struct float_color float_texture(struct env *e, const struct pixel_source *s, int stage,
                                               const struct float_color *before)
{
    flt v[3];
    struct lookup how = {.from = DETAIL_QUAD};
    struct sampler_key k = pixel_sampler(s->k, stage);
    stage_coordinates(E, s, stage, v);
    if (s->k->bump[stage])
        bump_displace(E, stage, before, v);
    struct float_color r = sample_as_float(E, &k, v, &how);
    return s->k->bump[stage] == BUMP_LUMINANCE ? bump_luminance(E, stage, before, r) : r;
}

static inline struct float_color float_stages(struct env *e, const struct pixel_source *s)
{
    struct float_values v;
    v.diffuse = float_interpolated(E, s, VARYING_diffuse);
    v.specular = float_interpolated(E, s, VARYING_specular);
    v.current = v.diffuse;
    v.temporary = float_replicate(lit_f(E, 0.0f));
    v.texture = float_replicate(lit_f(E, 1.0f));
    for (int i = 0; i < s->k->stages; i++) {
        struct float_color before = v.texture;
        v.texture = float_replicate(lit_f(E, 1.0f));
        if (s->k->texture[i])
            v.texture = float_texture(E, s, i, &before);
        OBSERVE(E, texel_exact, i, v.texture);
        float_stage(E, s->k, i, &v);
    }
    if (s->k->specular)
        v.current = float_specular(E, v.current, &v.specular);
    return v.current;
}

static inline struct float_color apply_float_fog(struct env *e, const struct pixel_source *s,
                                                 struct float_color color)
{
    if (!s->k->fog)
        return color;
    flt distance = fog_distance(E, s->k, s->layout, s->at, s->w);
    flt share = fog_share(E, s->k, distance);
    flt factor = saturate(E, share);
    struct float_color fog = float_packed(E, offsetof(struct job, fog_color));
    for (int c = 0; c < 3; c++)
        color.channel[c] = float_lerp(E, color.channel[c], fog.channel[c], factor);
    return color;
}

/* Multiplies the targets' colours, and the second colour, by the clip mask. */
static inline void mask_numbers(struct env *e, const struct pixel_key *k, struct float_color color[TARGETS])
{
    if (!k->clip_mask)
        return;
    flt share = clip_mask_share(E, k->clip_mask);
    for (int t = 0; t < TARGETS; t++)
        if (pixel_uses_color(k, t))
            color[t] = clip_mask_numbers(E, share, color[t]);
}

/* As cover_packed. */
static inline const struct float_color *cover_numbers(struct env *e, const struct pixel_source *s,
                                                      const struct float_color *color, int step,
                                                      struct float_color *covered)
{
    flt part = pixel_coverage(E, s->k, s->at);
    for (int t = 0; t < (step ? TARGETS : 1); t++) {
        if (!pixel_has_color(s->k, t) && step)
            continue;
        covered[t] = color[t];
        for (int c = s->k->coverage_color ? 0 : 3; c < 4; c++)
            covered[t].channel[c] = mul_f(E, color[t].channel[c], part);
    }
    return covered;
}

/* As finish_packed. */
static inline void finish_float(struct env *e, const struct pixel_source *s, const struct float_color *color,
                                int step, msk live)
{
    const struct pixel_key *k = s->k;
    bool second = blend_reads_second(k);
    struct float_color covered[TARGETS];
    if (k->coverage)
        color = cover_numbers(E, s, color, step, covered);
    if (pixel_tests_alpha(k)) {
        itg alpha = quantize(E, color->channel[3]);
        live = test_alpha(E, s, alpha, live);
    }
    finish_tests(E, s, live);
    struct float_color masked[TARGETS];
    for (int t = 0; t < TARGETS; t++)
        if (pixel_uses_color(k, t))
            masked[t] = color[step * t];
    mask_numbers(E, k, masked);
    struct primitive_blend own = primitive_blend_begin(E, s);
    for (int i = 0; i < s->samples->count; i++)
        for (int t = 0; t < TARGETS; t++)
            if (k->write_mask[t]) {
                const struct float_color colors[2] = {masked[t], masked[second ? 1 : t]};
                write_float_target(E, k, t, i, s->samples->live[i], colors, &own);
            }
}

static inline void shade_float(struct env *e, const struct pixel_source *s, msk live)
{
    struct float_color color = float_stages(E, s);
    color = apply_float_fog(E, s, color);
    finish_float(E, s, &color, 0, live);
}

#endif
