/* The parts of shading that do not depend on the form of colours: the inputs of a pixel's colours, texture
 * coordinates, and the tests that wait for shading. */
#ifndef SPEC_PIXEL_SOURCE_H
#define SPEC_PIXEL_SOURCE_H

#include "contract/key_query.h"
#include "contract/language.h"
#include "spec/pixel/alpha.h"
#include "spec/pixel/interpolate.h"
#include "spec/pixel/multisample.h"
#include "spec/pixel/stencil.h"

/* The common inputs of all colours of a pixel. */
struct pixel_source {
    const struct pixel_key *k;
    const struct triangle_layout *layout;
    const struct pixel_position *at;
    flt w;
    struct pixel_position color_at; /* of the diffuse and the specular colour */
    flt color_w;
    struct samples *samples;
};

/* The texture coordinates of a stage: u, v, and a third if it is read. If there is a divisor q, it replaces
 * 1/w: (u/w) / (q/w) is u/q. */
static inline void stage_coordinates(struct env *e, const struct pixel_source *s, int stage, flt v[3])
{
    int channel = s->k->coordinates[stage];
    flt w = s->w;
    if (s->k->varying[varying_divisor(channel)]) {
        flt divisor = interpolate_over_w(E, s->k, s->layout, s->at, varying_divisor(channel), 0);
        w = reciprocal_of(E, s->k->precision, divisor);
    }
    v[0] = v[2] = interpolate(E, s->k, s->layout, s->at, w, varying_texcoord(channel), 0);
    v[1] = interpolate(E, s->k, s->layout, s->at, w, varying_texcoord(channel), 1);
    if (s->k->varying[varying_third(channel)])
        v[2] = interpolate(E, s->k, s->layout, s->at, w, varying_third(channel), 0);
}

/* The alpha test and alpha to coverage. Alpha is 0 to 255. Returns the lanes of `live` that pass the test. */
static inline msk test_alpha(struct env *e, const struct pixel_source *s, itg alpha, msk live)
{
    if (s->k->alpha_coverage)
        cover_by_alpha(E, s->samples, alpha);
    return s->k->alpha_discard ? alpha_test(E, s->k->alpha_discard, alpha, live) : live;
}

/* The tests that wait for shading, in the lanes that shading keeps. */
static inline void finish_tests(struct env *e, const struct pixel_source *s, msk kept)
{
    struct samples *samples = s->samples;
    if (!pixel_waits(s->k))
        return;
    for (int i = 0; i < samples->count; i++) {
        if (samples->count > 1 || s->k->alpha_coverage)
            samples->live[i] = and_m(E, samples->live[i], kept);
        else
            samples->live[i] = kept;
        samples->live[i] = late_tests(E, s->k, &samples->at[i], s->layout, samples->live[i]);
    }
    count_passed(E, s->k, samples);
}

#endif
