/* Sampling of textures that are not bytes: binary32, sRGB, and depth to compare with. As sample.h, with
 * filters in binary32:
 *
 *   weights    w = f / 256 of the position's fraction f; a and b are blended to a * (1 - w), rounded, then
 *              b * w added in one rounding; where w is 0 it is a, whatever b
 *   sRGB       each texel's colour is decoded (srgb.h) before it is blended; alpha and the border colour are
 *              byte / 255
 *   depth      each texel is 1 where the third coordinate, clamped to 0..1, is at most the texel, else 0;
 *              these are blended (percentage-closer filtering), and the result is in all four channels
 *   N taps     summed in order, then divided by N */
#ifndef SPEC_TEXTURE_SAMPLE_FLOAT_H
#define SPEC_TEXTURE_SAMPLE_FLOAT_H

#include "contract/language.h"
#include "spec/math/color.h"
#include "spec/math/float_color.h"
#include "spec/math/srgb.h"
#include "spec/texture/address.h"
#include "spec/texture/detail.h"
#include "spec/texture/sample.h"

static inline int texel_channels(const struct sampler *s)
{
    return s->k->texel == TEXEL_COMPARE ? 1 : 4;
}

static inline struct float_color fetch_srgb(struct env *e, const struct sampler *s, itg index)
{
    itg word = texel_word(E, s, index);
    struct float_color r;
    for (int c = 0; c < 3; c++) {
        itg code = word_byte(E, word, c);
        r.channel[c] = srgb_decode(E, code);
    }
    itg alpha = word_byte(E, word, 3);
    flt byte = float_f(E, alpha);
    r.channel[3] = div_f(E, byte, lit_f(E, 255.0f));
    return r;
}

static inline struct float_color fetch_floats(struct env *e, const struct sampler *s, itg index)
{
    struct float_color r = {0};
    itg word = shl_i(E, index, 2);
    for (int c = 0; c < texel_channels(s); c++)
        r.channel[c] = gather_f(E, BASE_JOB, TEXTURE_FIELD(s->k->number, texels), word, 4, 4 * c);
    return r;
}

/* The lanes whose tap is inside on all axes that have a border. */
static inline msk tap_inside(struct env *e, const struct sampler *s, const struct axis *axis,
                             const int tap[3])
{
    msk r = lit_m(E, -1);
    for (int a = 0; a < s->axes; a++)
        if (has_border(s, a)) {
            msk here = eq_i(E, axis[a].wanted[tap[a]], axis[a].index[tap[a]]);
            r = and_m(E, r, here);
        }
    return r;
}

static inline struct float_color float_texel(struct env *e, const struct sampler *s, const struct axis *axis,
                                             int i, int j, int k, itg row)
{
    const int tap[3] = {i, j, k};
    itg column = column_start(E, s, axis[0].index[i]);
    itg index = add_i(E, row, column);
    struct float_color r = s->k->texel == TEXEL_SRGB ? fetch_srgb(E, s, index) : fetch_floats(E, s, index);
    if (has_border(s, 0) || has_border(s, 1) || (s->axes == 3 && has_border(s, 2))) {
        msk inside = tap_inside(E, s, axis, tap);
        struct float_color border = float_packed(E, (size_t)TEXTURE_FIELD(s->k->number, border));
        for (int c = 0; c < texel_channels(s); c++)
            r.channel[c] = select_f(E, inside, r.channel[c], border.channel[c]);
    }
    if (s->k->texel == TEXEL_COMPARE) {
        msk lit = le_f(E, s->reference, r.channel[0]);
        r.channel[0] = select_f(E, lit, lit_f(E, 1.0f), lit_f(E, 0.0f));
    }
    return r;
}

/* A weight, and 1 minus it. */
struct float_weight {
    flt weight, inverse;
    msk none;
};

static inline struct float_weight float_weight(struct env *e, itg fraction)
{
    struct float_weight r;
    flt number = float_f(E, fraction);
    r.weight = mul_f(E, number, lit_f(E, 1.0f / 256.0f));
    r.inverse = sub_f(E, lit_f(E, 1.0f), r.weight);
    r.none = eq_f(E, r.weight, lit_f(E, 0.0f));
    return r;
}

static inline struct float_color float_blend_texels(struct env *e, const struct sampler *s,
                                                    const struct float_color *a, const struct float_color *b,
                                                    const struct float_weight *w)
{
    struct float_color r = *a;
    for (int c = 0; c < texel_channels(s); c++) {
        flt first = mul_f(E, a->channel[c], w->inverse);
        flt both = mad_f(E, b->channel[c], w->weight, first);
        r.channel[c] = select_f(E, w->none, a->channel[c], both);
    }
    return r;
}

static inline struct float_color float_slice(struct env *e, const struct sampler *s, const struct level *l,
                                             const struct axis *axis, const struct float_weight *w, int k,
                                             itg pitch)
{
    struct float_color row[2];
    for (int j = 0; j < 2; j++) {
        itg first = texel_row(E, s, l, axis, j, k, pitch);
        struct float_color left = float_texel(E, s, axis, 0, j, k, first);
        struct float_color right = float_texel(E, s, axis, 1, j, k, first);
        row[j] = float_blend_texels(E, s, &left, &right, &w[0]);
    }
    return float_blend_texels(E, s, &row[0], &row[1], &w[1]);
}

static inline struct float_color float_image(struct env *e, const struct sampler *s, const struct level *l)
{
    struct axis axis[3];
    struct float_weight weight[3];
    struct tap tap = s->tap;
    tap.pairs = false;
    for (int a = 0; a < s->axes; a++)
        address_axis(E, l, &tap, s->k->address[a], a, s->coordinate[a], &axis[a]);
    itg pitch = level_pitch(E, l);
    if (!s->tap.linear) {
        itg row = texel_row(E, s, l, axis, 0, 0, pitch);
        return float_texel(E, s, axis, 0, 0, 0, row);
    }
    for (int a = 0; a < s->axes; a++)
        weight[a] = float_weight(E, axis[a].fraction);
    struct float_color near = float_slice(E, s, l, axis, weight, 0, pitch);
    if (s->axes == 2)
        return near;
    struct float_color far = float_slice(E, s, l, axis, weight, 1, pitch);
    return float_blend_texels(E, s, &near, &far, &weight[2]);
}

static inline struct float_color float_levels(struct env *e, const struct sampler *s)
{
    struct level level;
    sampler_level(E, s, 0, &level);
    struct float_color color = float_image(E, s, &level);
    if (!s->k->mip || s->detail.images == 1)
        return color;
    sampler_level(E, s, 1, &level);
    struct float_color further = float_image(E, s, &level);
    struct float_weight weight = float_weight(E, s->detail.fraction);
    return float_blend_texels(E, s, &color, &further, &weight);
}

static inline struct float_color float_anisotropic(struct env *e, const struct sampler *s)
{
    flt apart = taps_apart(E, s);
    struct float_color sum = float_replicate(lit_f(E, 0.0f));
    struct sampler tap = *s;
    begin_taps(E);
    for (int c = 0; c < texel_channels(s); c++)
        set_f(E, VARIABLE_SUM + c, lit_f(E, 0.0f));
    LOOP(E, VARIABLE_TAPPED)
    {
        flt i = get_f(E, VARIABLE_TAP);
        msk counts = get_m(E, VARIABLE_TAPPED);
        move_to_tap(E, s, i, apart, &tap);
        struct float_color color = float_levels(E, &tap);
        for (int c = 0; c < texel_channels(s); c++) {
            flt counted = select_f(E, counts, color.channel[c], lit_f(E, 0.0f));
            flt before = get_f(E, VARIABLE_SUM + c);
            flt after = add_f(E, before, counted);
            set_f(E, VARIABLE_SUM + c, after);
        }
        next_tap(E, s);
    }
    for (int c = 0; c < texel_channels(s); c++) {
        flt total = get_f(E, VARIABLE_SUM + c);
        sum.channel[c] = div_f(E, total, s->detail.taps);
    }
    return sum;
}

/* Samples a texture of anything but bytes. */
static inline struct float_color float_sample(struct env *e, const struct sampler_key *key, const flt v[3],
                                              const struct lookup *how)
{
    struct sampler_key k = lookup_sampler(key, how);
    struct sampler s;
    NOTE_SAMPLING(E, true);
    sampler_begin(E, &s, &k, v, how);
    if (k.texel == TEXEL_COMPARE)
        s.reference = saturate(E, s.reference);
    struct float_color color =
        k.minify == MINIFY_ANISOTROPIC ? float_anisotropic(E, &s) : float_levels(E, &s);
    NOTE_SAMPLING(E, false);
    return k.texel == TEXEL_COMPARE ? float_replicate(color.channel[0]) : color;
}

/* Samples any texture, as binary32. One of bytes is filtered in integers. */
static inline struct float_color sample_as_float(struct env *e, const struct sampler_key *k, const flt v[3],
                                                 const struct lookup *how)
{
    if (k->texel != TEXEL_BYTES)
        return float_sample(E, k, v, how);
    struct color packed = sample(E, k, v, how);
    itg word = color_pack(E, packed);
    return float_unpack(E, word);
}

#endif
