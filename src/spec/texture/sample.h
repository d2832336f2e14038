/* Texture sampling: from coordinates to a colour. Its parts are addressing (address.h), levels of detail
 * (detail.h) and the faces of cubes (cube.h). This file has the filters of textures of bytes, in integers;
 * sample_float.h has those of all others.
 *
 * A linear filter blends the two texels of each axis by the position's fraction of 256, along u first, then
 * v, then w, then between two levels. Each step is round((a * (256 - f) + b * f) / 256) of each channel. The
 * mean of N anisotropic taps is floor((2 * sum + N) / 2N), halves rounded up. The taps are taken in a loop
 * that ends when no lane has another one.
 *
 * Compact texels (compact.h) have the same filters. They have at most two channels, one pair, and are
 * filtered as that pair. Texels with a border are words before they are filtered, because a border has four
 * channels. */
#ifndef SPEC_TEXTURE_SAMPLE_H
#define SPEC_TEXTURE_SAMPLE_H

#include "contract/language.h"
#include "spec/math/color.h"
#include "spec/texture/address.h"
#include "spec/texture/compact.h"
#include "spec/texture/cube.h"
#include "spec/texture/detail.h"

/* The inputs of sampling. */
struct sampler {
    const struct sampler_key *k;
    int axes; /* of its images: 2 or 3 */
    struct tap tap;
    struct detail detail;
    itg face; /* cube: its number */
    flt coordinate[3];
    flt reference; /* compared with texels of depth */
};

static inline bool has_border(const struct sampler *s, int axis)
{
    return s->k->address[axis] == ADDRESS_BORDER;
}

/* Returns true if the filter has one pair, both pairs of its colours. */
static inline bool has_one_pair(const struct sampler *s)
{
    bool border = has_border(s, 0) || has_border(s, 1) || (s->axes == 3 && has_border(s, 2));
    return s->k->compact && !border;
}

/* The texels before row y of a slice. In tiles (render/texture/order.h) (y & ~3) * pitch of them are in the
 * rows of tiles above, and (y & 3) * 4 in the same tile. */
static inline itg row_start(struct env *e, const struct sampler *s, itg y, itg pitch)
{
    if (!s->k->tiled)
        return dot_i(E, y, pitch);
    itg above = and_i(E, y, lit_i(E, ~3));
    itg within = and_i(E, y, lit_i(E, 3));
    itg start = dot_i(E, above, pitch);
    itg rows = shl_i(E, within, 2);
    return add_i(E, start, rows);
}

/* The texels between the first of a row and column x. In tiles (x & ~3) * 4 of them are in the tiles before,
 * and x & 3 in the same row of the tile. */
static inline itg column_start(struct env *e, const struct sampler *s, itg x)
{
    if (!s->k->tiled)
        return x;
    itg before = and_i(E, x, lit_i(E, ~3));
    itg within = and_i(E, x, lit_i(E, 3));
    itg start = shl_i(E, before, 2);
    return add_i(E, start, within);
}

/* The number of the first texel of a row, by taps down and through the slices. */
static inline itg texel_row(struct env *e, const struct sampler *s, const struct level *l,
                            const struct axis *axis, int j, int k, itg pitch)
{
    itg row = row_start(E, s, axis[1].index[j], pitch);
    if (s->axes == 3) {
        itg slice_texels =
            l->each ? l->slice_texels : uniform_i(E, BASE_JOB, TEXTURE_FIELD(l->number, slice_texels));
        itg slice = mul_i(E, axis[2].index[k], slice_texels);
        row = add_i(E, row, slice);
    }
    return l->placed ? add_i(E, row, l->offset) : row;
}

/* --- Bytes --------------------------------------------------------------------------------------------- */

/* The word at a texel, with bytes of those that follow where it is compact. */
static inline itg texel_load(struct env *e, const struct sampler *s, itg index)
{
    int bytes = s->k->compact ? storage_compact[s->k->compact].bytes : 4;
    return gather_i(E, BASE_JOB, TEXTURE_FIELD(s->k->number, texels), index, bytes, 0);
}

/* The four channels of a texel. */
static inline itg texel_word(struct env *e, const struct sampler *s, itg index)
{
    itg word = texel_load(E, s, index);
    if (!s->k->compact)
        return word;
    fix pair = compact_pair(E, s->k->compact, word);
    struct color color = compact_color(E, s->k->compact, pair);
    return color_pack(E, color);
}

/* The texel; or the border colour if an axis has a border and addressing changed its index. */
static inline itg border_texel(struct env *e, int number, const struct axis *axis, int tap, itg texel)
{
    msk inside = eq_i(E, axis->wanted[tap], axis->index[tap]);
    itg border = uniform_i(E, BASE_JOB, TEXTURE_FIELD(number, border));
    return select_i(E, inside, texel, border);
}

/* The texel of column tap `i`, row tap `j` and slice tap `k`, whose row starts at texel number `row`. */
static inline itg texel(struct env *e, const struct sampler *s, const struct axis *axis, int i, int j, int k,
                        itg row)
{
    const int tap[3] = {i, j, k};
    itg column = column_start(E, s, axis[0].index[i]);
    itg index = add_i(E, row, column);
    itg word = has_one_pair(s) ? texel_load(E, s, index) : texel_word(E, s, index);
    for (int a = 0; a < s->axes; a++)
        if (has_border(s, a))
            word = border_texel(E, s->k->number, &axis[a], tap[a], word);
    return word;
}

/* The neighbours of two compact texels are in the same words. */
static inline void compact_square(struct env *e, const struct sampler *s, const itg index[2],
                                  itg texels[2][2])
{
    for (int j = 0; j < 2; j++) {
        texels[j][0] = texel_load(E, s, index[j]);
        texels[j][1] = ushr_i(E, texels[j][0], 8 * storage_compact[s->k->compact].bytes);
    }
}

/* The texels of two rows that are blended along u and v. All are gathered together, since they are
 * neighbours. */
static inline void texel_square(struct env *e, const struct sampler *s, const struct axis *axis, int k,
                                const itg row[2], itg texels[2][2])
{
    int field = TEXTURE_FIELD(s->k->number, texels);
    if (!axis[0].adjoining) {
        for (int j = 0; j < 2; j++)
            for (int i = 0; i < 2; i++)
                texels[j][i] = texel(E, s, axis, i, j, k, row[j]);
        return;
    }
    itg index[2];
    for (int j = 0; j < 2; j++)
        index[j] = add_i(E, row[j], axis[0].index[0]);
    if (s->k->compact) {
        compact_square(E, s, index, texels);
        return;
    }
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++)
            texels[j][i] = gather_i(E, BASE_JOB, field, index[j], 4, 4 * i);
}

/* The channels that are filtered: two pairs, or twice the same one. */
static inline struct color texel_color(struct env *e, const struct sampler *s, itg word)
{
    if (!has_one_pair(s))
        return color_unpack(E, word);
    struct color r;
    r.rb = r.ga = compact_pair(E, s->k->compact, word);
    return r;
}

/* round((a * (256 - weight) + b * weight) / 256) = a + round((b - a) * weight / 256). `fine` is the weight
 * times 128: at most 255 * 128, so it is not negative as a signed half. */
static inline fix lerp_256(struct env *e, fix a, fix b, fix fine)
{
    fix difference = sub_x(E, b, a);
    fix change = scale_x(E, difference, fine);
    return add_x(E, a, change);
}

static inline fix fine_weight(struct env *e, fix weight)
{
    return shl_x(E, weight, 7);
}

static inline struct color lerp_colors(struct env *e, const struct sampler *s, struct color a, struct color b,
                                       fix fine)
{
    struct color r;
    r.rb = lerp_256(E, a.rb, b.rb, fine);
    r.ga = has_one_pair(s) ? r.rb : lerp_256(E, a.ga, b.ga, fine);
    return r;
}

static inline struct color lerp_texels(struct env *e, const struct sampler *s, itg a, itg b, fix fine)
{
    struct color left = texel_color(E, s, a);
    struct color right = texel_color(E, s, b);
    return lerp_colors(E, s, left, right, fine);
}

/* Four texels of the slice of tap `k`. */
static inline struct color sample_slice(struct env *e, const struct sampler *s, const struct level *l,
                                        const struct axis *axis, int k, itg pitch)
{
    itg row[2], texels[2][2];
    row[0] = texel_row(E, s, l, axis, 0, k, pitch);
    row[1] = texel_row(E, s, l, axis, 1, k, pitch);
    texel_square(E, s, axis, k, row, texels);
    fix u = fine_weight(E, axis[0].weight);
    fix v = fine_weight(E, axis[1].weight);
    struct color upper = lerp_texels(E, s, texels[0][0], texels[0][1], u);
    struct color lower = lerp_texels(E, s, texels[1][0], texels[1][1], u);
    return lerp_colors(E, s, upper, lower, v);
}

static inline struct color sample_image(struct env *e, const struct sampler *s, const struct level *l)
{
    struct axis axis[3];
    struct tap tap = s->tap;
    tap.pairs = !s->k->tiled && !has_border(s, 1) && (s->axes == 2 || !has_border(s, 2));
    for (int a = 0; a < s->axes; a++)
        address_axis(E, l, &tap, s->k->address[a], a, s->coordinate[a], &axis[a]);
    itg pitch = level_pitch(E, l);
    if (!s->tap.linear) {
        itg row = texel_row(E, s, l, axis, 0, 0, pitch);
        itg word = texel(E, s, axis, 0, 0, 0, row);
        return texel_color(E, s, word);
    }
    struct color near = sample_slice(E, s, l, axis, 0, pitch);
    if (s->axes == 2)
        return near;
    struct color far = sample_slice(E, s, l, axis, 1, pitch);
    fix w = fine_weight(E, axis[2].weight);
    return lerp_colors(E, s, near, far, w);
}

/* --- Levels -------------------------------------------------------------------------------------------- */

/* Moves the image of a cube to its face. */
static inline void move_to_face(struct env *e, const struct sampler *s, struct level *r)
{
    if (s->k->kind != TEXTURE_CUBE)
        return;
    itg face_texels = uniform_i(E, BASE_JOB, TEXTURE_FIELD(s->k->number, face_texels));
    itg face = mul_i(E, s->face, face_texels);
    r->offset = r->placed ? add_i(E, r->offset, face) : face;
    r->placed = true;
}

/* The image that the job describes. */
static inline void job_level(struct env *e, const struct sampler *s, struct level *r)
{
    r->number = s->k->number;
    r->each = r->placed = false;
    move_to_face(E, s, r);
}

/* Image number `i` of those that are blended: from the job, or each lane's own. */
static inline void sampler_level(struct env *e, const struct sampler *s, int i, struct level *r)
{
    if (!s->k->mip) {
        job_level(E, s, r);
        return;
    }
    r->number = s->k->number;
    gather_level(E, s->k->number, s->detail.level[i], s->axes, r);
    move_to_face(E, s, r);
}

static inline struct color sample_levels(struct env *e, const struct sampler *s)
{
    struct level level;
    sampler_level(E, s, 0, &level);
    struct color color = sample_image(E, s, &level);
    if (!s->k->mip || s->detail.images == 1)
        return color;
    sampler_level(E, s, 1, &level);
    struct color further = sample_image(E, s, &level);
    fix weight = both_halves(E, s->detail.fraction);
    fix fine = fine_weight(E, weight);
    return lerp_colors(E, s, color, further, fine);
}

/* --- Coordinates --------------------------------------------------------------------------------------- */

/* The lanes with a linear filter: by magfilter, or by the other filter where texels are smaller than pixels.
 */
static inline void choose_filter(struct env *e, struct sampler *s)
{
    int minify = s->k->minify;
    bool mag = s->k->filter == FILTER_LINEAR;
    bool min = minify == MINIFY_SAME ? mag : minify == MINIFY_ANISOTROPIC || !mag;
    s->tap.linear = mag || min;
    s->tap.mixed = mag != min;
    if (s->tap.mixed && min)
        s->tap.smooth = s->detail.minified;
    else if (s->tap.mixed)
        s->tap.smooth = andn_m(E, lit_m(E, -1), s->detail.minified);
}

static inline void project_cube(struct env *e, struct sampler *s, const flt v[3], struct changes *changes)
{
    struct cube_face face = cube_face(E, v);
    struct cube_vector at = cube_turn(E, &face, v);
    flt s_ratio = div_f(E, at.s, at.m);
    flt t_ratio = div_f(E, at.t, at.m);
    s->face = face.number;
    s->coordinate[0] = cube_coordinate(E, s_ratio);
    s->coordinate[1] = cube_coordinate(E, t_ratio);
    if (!changes)
        return;
    flt *const change[2] = {changes->across, changes->down};
    for (int i = 0; i < 2; i++) {
        struct cube_vector d = cube_turn(E, &face, change[i]);
        change[i][0] = cube_difference(E, s_ratio, d.s, d.m, at.m);
        change[i][1] = cube_difference(E, t_ratio, d.t, d.m, at.m);
    }
}

/* Coordinates u, v and, if the texture needs it, a third: w, z of a cube's vector, or the reference depth. */
static inline void sampler_begin(struct env *e, struct sampler *s, const struct sampler_key *k,
                                 const flt v[3], const struct lookup *how)
{
    struct changes changes;
    bool cube = k->kind == TEXTURE_CUBE;
    bool measured = needs_detail(k) && how->from != DETAIL_GIVEN;
    s->k = k;
    s->axes = k->kind == TEXTURE_VOLUME ? 3 : 2;
    if (measured && how->from == DETAIL_CHANGES)
        changes = how->changes;
    else if (measured)
        quad_changes(E, v, cube ? 3 : s->axes, &changes);
    if (cube)
        project_cube(E, s, v, measured ? &changes : NULL);
    else
        for (int a = 0; a < s->axes; a++)
            s->coordinate[a] = v[a];
    if (measured) {
        measure_changes(E, k->number, s->axes, &changes);
        detail(E, k, s->axes, how, &changes, &s->detail);
    } else if (needs_detail(k))
        given_detail(E, k, how->amount, &s->detail);
    choose_filter(E, s);
    s->reference = v[2];
}

/* Variables of the taps' loop: the number of the tap, the lanes that take it, and the sums, of two pairs of
 * channels or of up to four. A variable has one type in a whole routine, which may sample textures of both
 * kinds. */
enum { VARIABLE_TAP = 504, VARIABLE_TAPPED, VARIABLE_PAIR_SUM, VARIABLE_SUM = VARIABLE_TAP + 4 };

/* Moves the coordinates of `to` to tap i of 1 to N; `apart` is 1 / (N + 1). */
static inline void move_to_tap(struct env *e, const struct sampler *s, flt i, flt apart, struct sampler *to)
{
    flt along = mad_f(E, i, apart, lit_f(E, -0.5f));
    for (int a = 0; a < s->axes; a++)
        to->coordinate[a] = mad_f(E, s->detail.step[a], along, s->coordinate[a]);
}

static inline flt taps_apart(struct env *e, const struct sampler *s)
{
    flt spaces = add_f(E, s->detail.taps, lit_f(E, 1.0f));
    return div_f(E, lit_f(E, 1.0f), spaces);
}

static inline void begin_taps(struct env *e)
{
    set_f(E, VARIABLE_TAP, lit_f(E, 1.0f));
    set_m(E, VARIABLE_TAPPED, lit_m(E, -1));
}

/* Advances to the next tap, while any lane has one. */
static inline void next_tap(struct env *e, const struct sampler *s)
{
    flt i = get_f(E, VARIABLE_TAP);
    flt next = add_f(E, i, lit_f(E, 1.0f));
    msk more = le_f(E, next, s->detail.taps);
    set_f(E, VARIABLE_TAP, next);
    set_m(E, VARIABLE_TAPPED, more);
}

static inline fix fix_where(struct env *e, msk mask, fix value)
{
    itg kept = mask_i(E, mask);
    itg bits = int_of(E, value);
    itg r = and_i(E, bits, kept);
    return fix_of(E, r);
}

/* floor((2 * sum + N) / 2N) of both halves. The numbers are small, so the quotient cannot round up to a whole
 * number. */
static inline fix divide_taps(struct env *e, fix sum, itg taps)
{
    itg both = int_of(E, sum);
    itg half[2], result[2];
    half[0] = and_i(E, both, lit_i(E, 0xffff));
    half[1] = ushr_i(E, both, 16);
    itg doubled = add_i(E, taps, taps);
    flt divisor = float_f(E, doubled);
    for (int i = 0; i < 2; i++) {
        itg twice = add_i(E, half[i], half[i]);
        itg numerator = add_i(E, twice, taps);
        flt dividend = float_f(E, numerator);
        flt quotient = div_f(E, dividend, divisor);
        result[i] = trunc_i(E, quotient);
    }
    itg high = shl_i(E, result[1], 16);
    itg joined = or_i(E, result[0], high);
    return fix_of(E, joined);
}

static inline void add_tap(struct env *e, int variable, msk counts, fix value)
{
    fix counted = fix_where(E, counts, value);
    itg before = get_i(E, variable);
    fix sum = fix_of(E, before);
    sum = add_x(E, sum, counted);
    itg after = int_of(E, sum);
    set_i(E, variable, after);
}

static inline fix mean_of_taps(struct env *e, int variable, itg taps)
{
    itg bits = get_i(E, variable);
    fix sum = fix_of(E, bits);
    return divide_taps(E, sum, taps);
}

static inline struct color sample_anisotropic(struct env *e, const struct sampler *s)
{
    flt apart = taps_apart(E, s);
    struct sampler tap = *s;
    begin_taps(E);
    set_i(E, VARIABLE_PAIR_SUM, lit_i(E, 0));
    set_i(E, VARIABLE_PAIR_SUM + 1, lit_i(E, 0));
    LOOP(E, VARIABLE_TAPPED)
    {
        flt i = get_f(E, VARIABLE_TAP);
        msk counts = get_m(E, VARIABLE_TAPPED);
        move_to_tap(E, s, i, apart, &tap);
        struct color color = sample_levels(E, &tap);
        add_tap(E, VARIABLE_PAIR_SUM, counts, color.rb);
        if (!has_one_pair(s))
            add_tap(E, VARIABLE_PAIR_SUM + 1, counts, color.ga);
        next_tap(E, s);
    }
    itg taps = round_i(E, s->detail.taps);
    struct color r;
    r.rb = mean_of_taps(E, VARIABLE_PAIR_SUM, taps);
    r.ga = has_one_pair(s) ? r.rb : mean_of_taps(E, VARIABLE_PAIR_SUM + 1, taps);
    return r;
}

static inline void keep_color(struct env *e, const struct sampler *s, msk lanes, struct color color)
{
    const fix pair[2] = {color.rb, color.ga};
    for (int i = 0; i < (has_one_pair(s) ? 1 : 2); i++) {
        itg before = get_i(E, VARIABLE_PAIR_SUM + i);
        itg bits = int_of(E, pair[i]);
        itg after = select_i(E, lanes, bits, before);
        set_i(E, VARIABLE_PAIR_SUM + i, after);
    }
}

static inline struct color kept_color(struct env *e, const struct sampler *s)
{
    struct color r;
    itg rb = get_i(E, VARIABLE_PAIR_SUM);
    r.rb = r.ga = fix_of(E, rb);
    if (has_one_pair(s))
        return r;
    itg ga = get_i(E, VARIABLE_PAIR_SUM + 1);
    r.ga = fix_of(E, ga);
    return r;
}

/* A texture that is magnified shows only its first level. Its description is in the job, so these lanes need
 * neither the levels' descriptions nor a second image. Both ways have the same result for them. */
static inline struct color sample_near_or_far(struct env *e, const struct sampler *s)
{
    set_i(E, VARIABLE_PAIR_SUM, lit_i(E, 0));
    set_i(E, VARIABLE_PAIR_SUM + 1, lit_i(E, 0));
    WHEN (E, s->detail.beyond) {
        struct color color = sample_levels(E, s);
        keep_color(E, s, s->detail.beyond, color);
    }
    msk near = andn_m(E, lit_m(E, -1), s->detail.beyond);
    WHEN (E, near) {
        struct level level;
        job_level(E, s, &level);
        struct color color = sample_image(E, s, &level);
        keep_color(E, s, near, color);
    }
    return kept_color(E, s);
}

/* Without changes there is no longer one, so an anisotropic filter takes one tap, filtered linearly. */
static inline struct sampler_key lookup_sampler(const struct sampler_key *k, const struct lookup *how)
{
    struct sampler_key r = *k;
    if (how->from == DETAIL_GIVEN && k->minify == MINIFY_ANISOTROPIC)
        r.minify = k->filter == FILTER_LINEAR ? MINIFY_SAME : MINIFY_OTHER;
    return r;
}

/* Samples a texture of bytes. */
static inline struct color sample(struct env *e, const struct sampler_key *key, const flt v[3],
                                  const struct lookup *how)
{
    struct sampler_key k = lookup_sampler(key, how);
    struct sampler s;
    NOTE_SAMPLING(E, true);
    sampler_begin(E, &s, &k, v, how);
    struct color color = k.minify == MINIFY_ANISOTROPIC ? sample_anisotropic(E, &s)
                         : k.mip                        ? sample_near_or_far(E, &s)
                                                        : sample_levels(E, &s);
    NOTE_SAMPLING(E, false);
    return has_one_pair(&s) ? compact_color(E, k.compact, color.rb) : color;
}

#endif
