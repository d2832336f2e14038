/* Level of detail: the levels of a texture that a pixel samples, and the number of taps.
 *
 * The change of the coordinates to the next pixel, across and down, is the difference within the quad of 2x2
 * pixels: right minus left in each row, lower minus upper in each column. In texels of the first level (of
 * the one that maxmiplevel allows, if there are no others) the longer of the two changes is
 *
 *   rho = max(|across|, |down|),   lambda = round(256 * (log2(rho) + mipmaplodbias)) / 256
 *
 * computed from rho^2 by logarithm2 (transcendental.h), which is exact to about one in a million. lambda <= 0
 * is magnification, filtered by magfilter; everything else, NaN included, is minification, filtered by
 * minfilter. With MINIFY_LATER the limit is 1/2, and magnification samples only the first level (OpenGL ES
 * 2.0, 3.7.8).
 *
 *   mipfilter point    level floor(lambda + 1/2)
 *   mipfilter linear   levels floor(lambda) and the next, blended by the fraction of 256
 *
 * both after lambda was clamped to maxmiplevel and the last level.
 *
 * Anisotropic minification takes N taps along the longer change (EXT_texture_filter_anisotropic), each
 * filtered linearly, and returns their mean:
 *
 *   N = ceil(rho / min(|across|, |down|)), less 1/256, from 1 to maxanisotropy
 *   tap i of 1 to N lies at the coordinate + (i / (N + 1) - 1/2) * change
 *
 * with the levels of lambda for rho / N. Magnification takes one tap.
 *
 * A shader can add a bias to lambda, supply the changes, or supply lambda without mipmaplodbias, which is
 * then added. With a bias or a given lambda, nothing is anisotropic. NaN is minification there too. */
#ifndef SPEC_TEXTURE_DETAIL_H
#define SPEC_TEXTURE_DETAIL_H

#include "contract/language.h"
#include "spec/math/transcendental.h"
#include "spec/texture/address.h"

/* The origin of the level of detail. */
enum { DETAIL_QUAD, DETAIL_BIASED, DETAIL_CHANGES, DETAIL_GIVEN };

/* Changes of the coordinates, across and down, and the squares of their lengths in 1/256 texels. */
struct changes {
    flt across[3], down[3];
    flt across_square, down_square;
};

/* The parameters of a lookup. */
struct lookup {
    int from;               /* DETAIL_* */
    flt amount;             /* BIASED: the bias; GIVEN: the level */
    struct changes changes; /* CHANGES: of each coordinate, across and down */
};

struct detail {
    int images;   /* levels that are blended: 1 or 2 */
    itg level[2]; /* used if each lane has its own */
    itg fraction; /* of the second, 0 to 255 */
    msk beyond;   /* lanes that do not sample just the first level of the texture */
    msk minified; /* used if the filters differ */
    flt taps;     /* 1 to maxanisotropy, whole; anisotropic only */
    flt step[3];  /* the longer change */
};

static inline void quad_changes(struct env *e, const flt v[3], int axes, struct changes *r)
{
    for (int i = 0; i < axes; i++) {
        flt right = permute_f(E, v[i], QUAD_RIGHT);
        flt left = permute_f(E, v[i], QUAD_LEFT);
        r->across[i] = sub_f(E, right, left);
        flt lower = permute_f(E, v[i], QUAD_LOWER);
        flt upper = permute_f(E, v[i], QUAD_UPPER);
        r->down[i] = sub_f(E, lower, upper);
    }
}

static inline flt square_length(struct env *e, int number, const flt change[3], int axes)
{
    flt sum = lit_f(E, 0.0f);
    for (int i = 0; i < axes; i++) {
        flt size = job_size_256(E, number, i);
        flt texels = mul_f(E, change[i], size);
        sum = mad_f(E, texels, texels, sum);
    }
    return sum;
}

static inline void measure_changes(struct env *e, int number, int axes, struct changes *r)
{
    r->across_square = square_length(E, number, r->across, axes);
    r->down_square = square_length(E, number, r->down, axes);
}

/* lambda in 1/256 from the square of rho in 1/256 texels. */
static inline itg lambda_256(struct env *e, int number, const struct lookup *how, flt square)
{
    flt doubled = logarithm2(E, square);
    flt offset = uniform_f(E, BASE_JOB, TEXTURE_FIELD(number, lod_offset));
    if (how->from == DETAIL_BIASED)
        offset = mad_f(E, how->amount, lit_f(E, 256.0f), offset);
    flt lambda = mad_f(E, doubled, lit_f(E, 128.0f), offset);
    return round_i(E, lambda);
}

/* The square of rho for one tap of N. */
static inline flt detail_taps(struct env *e, int taps, int axes, const struct changes *c, flt square,
                              struct detail *d)
{
    msk across = le_f(E, c->down_square, c->across_square);
    for (int i = 0; i < axes; i++)
        d->step[i] = select_f(E, across, c->across[i], c->down[i]);
    flt shorter = min_f(E, c->across_square, c->down_square);
    flt ratio_square = div_f(E, square, shorter);
    flt ratio = sqrt_f(E, ratio_square);
    flt raised = add_f(E, ratio, lit_f(E, 255.0f / 256.0f));
    flt whole = floor_f(E, raised);
    flt limited = min_f(E, whole, lit_f(E, (float)taps));
    flt counted = max_f(E, limited, lit_f(E, 1.0f));
    d->taps = select_f(E, d->minified, counted, lit_f(E, 1.0f));
    flt taps_square = mul_f(E, d->taps, d->taps);
    return div_f(E, square, taps_square);
}

static inline void detail_levels(struct env *e, int number, int mip, itg lambda, struct detail *d)
{
    itg first = uniform_i(E, BASE_JOB, TEXTURE_FIELD(number, first_level_256));
    itg last = uniform_i(E, BASE_JOB, TEXTURE_FIELD(number, last_level_256));
    itg low = max_i(E, lambda, first);
    itg clamped = min_i(E, low, last);
    if (mip == MIP_POINT) {
        itg nearest = add_i(E, clamped, lit_i(E, 128));
        d->level[0] = shr_i(E, nearest, 8);
        d->beyond = gt_i(E, d->level[0], lit_i(E, 0));
        return;
    }
    d->images = 2;
    d->beyond = gt_i(E, clamped, lit_i(E, 0));
    d->level[0] = shr_i(E, clamped, 8);
    d->fraction = and_i(E, clamped, lit_i(E, 255));
    itg last_level = shr_i(E, last, 8);
    itg next = add_i(E, d->level[0], lit_i(E, 1));
    d->level[1] = min_i(E, next, last_level);
}

/* Decides between the filters; returns lambda for the choice of levels. */
static inline itg decide_filter(struct env *e, const struct sampler_key *k, itg lambda, struct detail *d)
{
    bool later = k->minify == MINIFY_LATER;
    d->minified = gt_i(E, lambda, lit_i(E, later ? 128 : 0));
    return later ? select_i(E, d->minified, lambda, lit_i(E, 0)) : lambda;
}

static inline bool needs_detail(const struct sampler_key *k)
{
    return k->mip || k->minify;
}

static inline void detail(struct env *e, const struct sampler_key *k, int axes, const struct lookup *how,
                          const struct changes *changes, struct detail *r)
{
    r->images = 1;
    flt longer = max_f(E, changes->across_square, changes->down_square);
    flt square = min_f(E, longer, lit_f(E, 0x1p100f)); /* NaN too */
    itg lambda = lambda_256(E, k->number, how, square);
    lambda = decide_filter(E, k, lambda, r);
    if (k->minify == MINIFY_ANISOTROPIC) {
        flt share = detail_taps(E, k->anisotropy, axes, changes, square, r);
        lambda = lambda_256(E, k->number, how, share);
    }
    if (k->mip)
        detail_levels(E, k->number, k->mip, lambda, r);
}

/* A level beyond the last one of any texture is the same as the last. */
static inline void given_detail(struct env *e, const struct sampler_key *k, flt level, struct detail *r)
{
    flt bias = uniform_f(E, BASE_JOB, TEXTURE_FIELD(k->number, lod_bias_256));
    flt low = min_f(E, level, lit_f(E, 1024.0f)); /* NaN too */
    flt limited = max_f(E, low, lit_f(E, -1024.0f));
    flt sum = mad_f(E, limited, lit_f(E, 256.0f), bias);
    itg lambda = round_i(E, sum);
    r->images = 1;
    lambda = decide_filter(E, k, lambda, r);
    if (k->mip)
        detail_levels(E, k->number, k->mip, lambda, r);
}

/* The image of each lane's level. Its words are adjacent in memory and are read in order here, so engines can
 * load them together. */
static inline void gather_level(struct env *e, int number, itg level, int axes, struct level *r)
{
    static const size_t size[3] = {offsetof(struct texture_level, width),
                                   offsetof(struct texture_level, height),
                                   offsetof(struct texture_level, depth)};
    int levels = TEXTURE_FIELD(number, levels);
    itg row = shl_i(E, level, 3); /* of 8 words */
    r->each = r->placed = true;
    r->offset = gather_i(E, BASE_JOB, levels, row, 4, (int)offsetof(struct texture_level, offset));
    r->pitch = gather_i(E, BASE_JOB, levels, row, 4, (int)offsetof(struct texture_level, pitch));
    for (int i = 0; i < axes; i++)
        r->size[i] = gather_i(E, BASE_JOB, levels, row, 4, (int)size[i]);
    if (axes == 3)
        r->slice_texels =
            gather_i(E, BASE_JOB, levels, row, 4, (int)offsetof(struct texture_level, slice_texels));
    for (int i = 0; i < axes; i++) {
        itg positions = shl_i(E, r->size[i], 8);
        r->size_256[i] = float_f(E, positions);
        r->last[i] = sub_i(E, r->size[i], lit_i(E, 1));
    }
}

#endif
