/* Multisampling: 2, 4 or 8 samples of depth, stencil and colour per pixel. Their positions are layout_samples
 * (contract/layout.h), in 1/16 pixel from the pixel's centre.
 *
 * Each sample has coverage, stencil test and depth test of its own, at its position; without the state
 * multisampleantialias all samples are at the centre. Colour is computed once, at the centre, for pixels with
 * a live sample, and tested for alpha once. The diffuse and the specular colour are interpolated at the
 * centroid: the centre if all samples are covered, else the first covered sample. So no colour is
 * extrapolated beyond the triangle's edges. Blending and writing are done for each sample. A pixel without
 * multisampling has one sample, at the centre.
 *
 * With alpha to coverage, only the first samples of a pixel remain: of n samples alpha * n, rounded. */
#ifndef SPEC_PIXEL_MULTISAMPLE_H
#define SPEC_PIXEL_MULTISAMPLE_H

#include "contract/language.h"
#include "spec/pixel/interpolate.h"

struct samples {
    int count;
    struct pixel_position at[SAMPLES_MAXIMUM];
    msk covered[SAMPLES_MAXIMUM];
    msk live[SAMPLES_MAXIMUM];
};

/* Lanes of this chunk whose sample i the triangle covers. The span reading has whole blocks only. */
static inline msk sample_coverage(struct env *e, const struct pixel_key *k, int i)
{
    if (k->span)
        return lit_m(E, -1);
    int place = k->samples ? SAMPLE_COVERAGE + 2 * i : (int)offsetof(struct entry, coverage);
    itg bits = uniform_i(E, BASE_ENTRY, place);
    itg bit = load_i(E, BASE_LANES, (int)offsetof(struct lane_table, bit));
    itg hit = and_i(E, bits, bit);
    return eq_i(E, hit, bit);
}

static inline float sample_distance(int sixteenths)
{
    return (float)sixteenths / 16;
}

static inline void pixel_samples(struct env *e, const struct pixel_key *k, const struct pixel_position *at,
                                 struct samples *samples)
{
    samples->count = 1 << k->samples;
    for (int i = 0; i < samples->count; i++) {
        struct pixel_position *place = &samples->at[i];
        *place = *at;
        place->sample = i;
        if (k->samples && !k->sample_centers) {
            const struct sample_position *from_centre = &layout_samples[k->samples][i];
            place->x = add_f(E, at->x, lit_f(E, sample_distance(from_centre->x)));
            place->y = add_f(E, at->y, lit_f(E, sample_distance(from_centre->y)));
        }
        samples->covered[i] = sample_coverage(E, k, i);
    }
}

/* The position at which the triangle's own colours are interpolated. */
static inline struct pixel_position centroid(struct env *e, const struct pixel_key *k,
                                             const struct pixel_position *at, const struct samples *samples)
{
    struct pixel_position r = *at;
    if (!k->samples || k->sample_centers)
        return r;
    int last = samples->count - 1;
    msk all = samples->covered[last];
    r = samples->at[last];
    for (int i = last - 1; i >= 0; i--) {
        all = and_m(E, all, samples->covered[i]);
        r.x = select_f(E, samples->covered[i], samples->at[i].x, r.x);
        r.y = select_f(E, samples->covered[i], samples->at[i].y, r.y);
    }
    r.x = select_f(E, all, at->x, r.x);
    r.y = select_f(E, all, at->y, r.y);
    return r;
}

/* Alpha to coverage: sample i of n remains if alpha, 0 to 255, is at least (2 i + 1) / 2 n of 255. */
static inline void cover_by_alpha(struct env *e, struct samples *samples, itg alpha)
{
    int parts = 2 * samples->count;
    for (int i = 0; i < samples->count; i++) {
        itg least = lit_i(E, (255 * (2 * i + 1) + parts - 1) / parts);
        msk less = gt_i(E, least, alpha);
        samples->live[i] = andn_m(E, samples->live[i], less);
        OBSERVE(E, remaining, i, samples->live[i]);
    }
}

/* Lanes with any live sample. */
static inline msk any_sample(struct env *e, const struct samples *samples)
{
    msk any = samples->live[0];
    for (int i = 1; i < samples->count; i++)
        any = or_m(E, any, samples->live[i]);
    return any;
}

/* Counts the live samples for an occlusion query. */
static inline void count_passed(struct env *e, const struct pixel_key *k, const struct samples *samples)
{
    if (!k->count)
        return;
    itg sum = load_i(E, BASE_LANES, (int)offsetof(struct lane_table, passed));
    for (int i = 0; i < samples->count; i++) {
        itg lanes = mask_i(E, samples->live[i]);
        sum = sub_i(E, sum, lanes);
    }
    store_i(E, BASE_LANES, (int)offsetof(struct lane_table, passed), sum);
}

#endif
