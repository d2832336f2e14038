/* The pixel routine: stencil, depth, interpolation, textures and stages or a shader (pixel_shader.h),
 * specular, fog, alpha test, blending, write. A lane is a pixel of a 4x4 block (contract/arguments.h, struct
 * pixel_arguments).
 *
 * Bases: JOB; ENTRY the block's entry; TRIANGLE its record; LANES the per-lane constants of this chunk of the
 * block; COLOR and DEPTH the chunk's pixels in the tile. By definition, the alpha test precedes stencil and
 * depth. Where the result is the same, stencil and depth are tested first, and shading is skipped if no lane
 * remains. Stencil and depth are written after the alpha test, and after a shader that discards pixels or
 * outputs depth. A query counts the lanes that pass all tests. */
#ifndef SPEC_PIXEL_PIXEL_H
#define SPEC_PIXEL_PIXEL_H

#include "contract/language.h"
#include "spec/pixel/float_pixel.h"
#include "spec/pixel/interpolate.h"
#include "spec/pixel/multisample.h"
#include "spec/pixel/packed_pixel.h"
#include "spec/pixel/pixel_shader.h"
#include "spec/pixel/stencil.h"

static inline struct pixel_source pixel_source(struct env *e, const struct pixel_key *k,
                                               const struct triangle_layout *layout,
                                               const struct pixel_position *at, struct samples *samples)
{
    struct pixel_source r = {.k = k, .layout = layout, .at = at, .samples = samples};
    r.w = lit_f(E, 1.0f);
    if (layout->smooth)
        r.w = pixel_w(E, k, at, layout, k->precision);
    r.color_at = centroid(E, k, at, samples);
    r.color_w = r.w;
    if (k->samples && layout->smooth)
        r.color_w = pixel_w(E, k, &r.color_at, layout, k->precision);
    return r;
}

/* `layout` must be the result of layout_of_pixel. */
static inline void spec_pixel(struct env *e, const struct pixel_key *k, const struct triangle_layout *layout)
{
    struct pixel_position at = pixel_position(E);
    struct samples samples;
    pixel_samples(E, k, &at, &samples);
    for (int i = 0; i < samples.count; i++) {
        OBSERVE(E, covered, i, samples.covered[i]);
        samples.live[i] = early_tests(E, k, &samples.at[i], layout, samples.covered[i]);
    }
    if (!pixel_waits(k))
        count_passed(E, k, &samples);
    if (!pixel_shades(k))
        return;
    msk live = any_sample(E, &samples);
    OBSERVE(E, shaded, 0, live);
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

#endif
