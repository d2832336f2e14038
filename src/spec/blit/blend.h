/* A row of a scaled copy with the linear filter: a pixel blends the four source pixels around its place, in
 * binary32, horizontally and then vertically: a (1 - w) + b w, or a if w is 0.
 *
 * An element's words are in three arrays of BLIT_BLEND_PIXELS, one after the other: its left source pixel,
 * its right one, and the right one's weight. The job has the upper and the lower row, and the lower one's
 * weight. A byte b is the number b / 255. Results are words of bytes, clamped and rounded as a draw writes
 * them, or four planes of BLIT_BLEND_PIXELS numbers, where NaN is always the same one. */
#ifndef SPEC_BLIT_BLEND_H
#define SPEC_BLIT_BLEND_H

#include "contract/language.h"
#include "spec/math/nan.h"

static inline flt blend_pair(struct env *e, flt a, flt b, flt weight, flt rest, msk both)
{
    flt first = mul_f(E, a, rest);
    flt second = mul_f(E, b, weight);
    flt sum = add_f(E, first, second);
    return select_f(E, both, sum, a);
}

/* The weight of b, that of a, and whether there are both. */
struct blend_weight {
    flt weight, rest;
    msk both;
};

static inline struct blend_weight blend_weight(struct env *e, flt weight)
{
    struct blend_weight r = {.weight = weight};
    r.rest = sub_f(E, lit_f(E, 1), weight);
    r.both = lt_f(E, lit_f(E, 0), weight);
    return r;
}

/* The channels of a pixel of the upper or the lower row. */
static inline void blend_read(struct env *e, const struct blit_key *k, int row, itg pixel, flt channel[4])
{
    int field = (int)offsetof(struct blit_job, row) + row * (int)sizeof(void *);
    if (k->numbers) {
        itg pair = shl_i(E, pixel, 1);
        for (int c = 0; c < 4; c++)
            channel[c] = gather_f(E, BASE_JOB, field, pair, 8, 4 * c);
        return;
    }
    itg word = gather_i(E, BASE_JOB, field, pixel, 4, 0);
    for (int c = 0; c < 4; c++) {
        itg shifted = ushr_i(E, word, 8 * c);
        itg byte = and_i(E, shifted, lit_i(E, 255));
        flt number = float_f(E, byte);
        channel[c] = div_f(E, number, lit_f(E, 255));
    }
}

static inline void blend_row(struct env *e, const struct blit_key *k, int row, const itg pixel[2],
                             const struct blend_weight *w, flt result[4])
{
    flt left[4], right[4];
    blend_read(E, k, row, pixel[0], left);
    blend_read(E, k, row, pixel[1], right);
    for (int c = 0; c < 4; c++)
        result[c] = blend_pair(E, left[c], right[c], w->weight, w->rest, w->both);
}

/* NaN gives 0. */
static inline itg blend_byte(struct env *e, flt value)
{
    flt low = max_f(E, value, lit_f(E, 0));
    flt inside = min_f(E, low, lit_f(E, 1));
    flt scaled = mul_f(E, inside, lit_f(E, 255));
    return round_i(E, scaled);
}

static inline void blend_store_bytes(struct env *e, const flt result[4])
{
    itg word = uniform_i(E, BASE_JOB, (int)offsetof(struct blit_job, missing));
    for (int c = 0; c < 4; c++) {
        itg byte = blend_byte(E, result[c]);
        itg placed = shl_i(E, byte, 8 * c);
        word = or_i(E, word, placed);
    }
    store_i(E, BASE_OUTPUT, 0, word);
}

static inline void blend_store_numbers(struct env *e, const flt result[4])
{
    for (int c = 0; c < 4; c++) {
        flt stored = one_nan(E, result[c]);
        store_f(E, BASE_OUTPUT, 4 * BLIT_BLEND_PIXELS * c, stored);
    }
}

static inline void blit_blend(struct env *e, const struct blit_key *k)
{
    flt upper[4], lower[4], result[4];
    itg pixel[2];
    for (int n = 0; n < 2; n++)
        pixel[n] = load_i(E, BASE_INPUT, 4 * BLIT_BLEND_PIXELS * n);
    flt across = load_f(E, BASE_INPUT, 4 * BLIT_BLEND_PIXELS * 2);
    flt down = uniform_f(E, BASE_JOB, (int)offsetof(struct blit_job, weight));
    struct blend_weight horizontal = blend_weight(E, across);
    struct blend_weight vertical = blend_weight(E, down);
    blend_row(E, k, 0, pixel, &horizontal, upper);
    blend_row(E, k, 1, pixel, &horizontal, lower);
    for (int c = 0; c < 4; c++)
        result[c] = blend_pair(E, upper[c], lower[c], vertical.weight, vertical.rest, vertical.both);
    if (k->number_results)
        blend_store_numbers(E, result);
    else
        blend_store_bytes(E, result);
}

#endif
