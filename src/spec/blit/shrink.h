/* Mip levels of bytes by a box filter.
 *
 * A texel of the smaller level is the mean of the texels that its area covers in the larger one, each
 * weighted with how much of it is covered. Along an axis of n texels that becomes m = max(1, n / 2):
 *
 *   n even   texels 2i and 2i + 1, weights 1 and 1
 *   n odd    texels 2i, 2i + 1 and 2i + 2, weights m - i, m and i + 1
 *            (Non-Power-of-Two Mipmap Creation, NVIDIA 2005)
 *   n = 1    the texel itself
 *
 * and a texel's weight is the product of the axes'. Stored texels are averaged as they are, whatever curve
 * their values mean. Means are exact and rounded to nearest, halves up.
 *
 * The element's index is i. The job has the rows that the texel covers, slice by slice, and the product of
 * each row's other weights. The sum of all weights is the product of odd sizes and of a power of two, below
 * 2^30. */
#ifndef SPEC_BLIT_SHRINK_H
#define SPEC_BLIT_SHRINK_H

#include "contract/language.h"
#include "spec/blit/mean.h"

static inline int shrink_rows(const struct blit_key *k)
{
    return k->taps[1] * k->taps[2];
}

/* Texel 2i + tap of a row. */
static inline itg shrink_texel(struct env *e, int row, itg first, int tap)
{
    int field = (int)offsetof(struct blit_job, row) + row * (int)sizeof(void *);
    return gather_i(E, BASE_JOB, field, first, 4, 4 * tap);
}

/* All weights are 1, and there are 1, 2, 4 or 8 texels. */
static inline void shrink_evenly(struct env *e, const struct blit_key *k, itg first)
{
    int texels = k->taps[0] * shrink_rows(k), exponent = texels / 4 + (texels > 1);
    struct byte_sums sums = mean_begin(E, exponent);
    for (int row = 0; row < shrink_rows(k); row++)
        for (int tap = 0; tap < k->taps[0]; tap++) {
            itg word = shrink_texel(E, row, first, tap);
            mean_add(E, &sums, word);
        }
    itg mean = mean_end(E, &sums, exponent);
    store_i(E, BASE_OUTPUT, 0, mean);
}

/* The weights along x: 1 and 1, or m - i, m and i + 1. */
static inline void shrink_weights(struct env *e, const struct blit_key *k, itg i,
                                  itg weight[BLIT_TAPS_MAXIMUM])
{
    itg one = lit_i(E, 1);
    weight[0] = weight[1] = one;
    if (k->taps[0] < 3)
        return;
    itg half = uniform_i(E, BASE_JOB, (int)offsetof(struct blit_job, half));
    weight[0] = sub_i(E, half, i);
    weight[1] = half;
    weight[2] = add_i(E, i, one);
}

/* The weighted sum of a channel's bytes in a row: below 2^21. */
static inline itg shrink_row(struct env *e, const struct blit_key *k, const itg texel[BLIT_TAPS_MAXIMUM],
                             const itg weight[BLIT_TAPS_MAXIMUM], int channel)
{
    itg sum = lit_i(E, 0);
    for (int tap = 0; tap < k->taps[0]; tap++) {
        itg shifted = ushr_i(E, texel[tap], 8 * channel);
        itg byte = and_i(E, shifted, lit_i(E, 255));
        itg product = k->taps[0] < 3 ? byte : mul_i(E, byte, weight[tap]);
        sum = add_i(E, sum, product);
    }
    return sum;
}

/* The quotient of a sum and the total, rounded: of the sum modulo 2^32, and of the sum in binary32, which is
 * so close that a quotient of it is at most 1 from the result. The remainder decides. */
static inline itg shrink_quotient(struct env *e, itg sum, flt approximation)
{
    itg total = uniform_i(E, BASE_JOB, (int)offsetof(struct blit_job, total));
    flt divisor = float_f(E, total);
    flt ratio = div_f(E, approximation, divisor);
    itg guess = round_i(E, ratio);
    itg half = ushr_i(E, total, 1);
    itg raised = add_i(E, sum, half);
    itg product = mul_i(E, guess, total);
    itg remainder = sub_i(E, raised, product);
    msk less = gt_i(E, lit_i(E, 0), remainder);
    msk enough = gt_i(E, total, remainder);
    itg down = mask_i(E, less);
    itg up = mask_i(E, enough);
    itg corrected = add_i(E, guess, down);
    itg raised_by_one = add_i(E, corrected, lit_i(E, 1));
    return add_i(E, raised_by_one, up);
}

static inline itg shrink_channel(struct env *e, const struct blit_key *k, itg texel[][BLIT_TAPS_MAXIMUM],
                                 const itg weight[BLIT_TAPS_MAXIMUM], int channel)
{
    itg sum = lit_i(E, 0);
    flt approximation = lit_f(E, 0);
    for (int row = 0; row < shrink_rows(k); row++) {
        itg in_row = shrink_row(E, k, texel[row], weight, channel);
        itg others = uniform_i(E, BASE_JOB, (int)offsetof(struct blit_job, row_weight) + 4 * row);
        itg product = mul_i(E, in_row, others);
        flt factor = float_f(E, in_row);
        flt other_factor = float_f(E, others);
        sum = add_i(E, sum, product);
        approximation = mad_f(E, factor, other_factor, approximation);
    }
    return shrink_quotient(E, sum, approximation);
}

static inline void shrink_by_weights(struct env *e, const struct blit_key *k, itg i, itg first)
{
    itg texel[BLIT_ROWS][BLIT_TAPS_MAXIMUM], weight[BLIT_TAPS_MAXIMUM];
    shrink_weights(E, k, i, weight);
    for (int row = 0; row < shrink_rows(k); row++)
        for (int tap = 0; tap < k->taps[0]; tap++)
            texel[row][tap] = shrink_texel(E, row, first, tap);
    itg word = shrink_channel(E, k, texel, weight, 0);
    for (int channel = 1; channel < 4; channel++) {
        itg byte = shrink_channel(E, k, texel, weight, channel);
        itg placed = shl_i(E, byte, 8 * channel);
        word = or_i(E, word, placed);
    }
    store_i(E, BASE_OUTPUT, 0, word);
}

static inline void blit_shrink(struct env *e, const struct blit_key *k)
{
    itg i = load_i(E, BASE_INPUT, 0);
    itg first = shl_i(E, i, 1);
    if (k->taps[0] < 3 && k->taps[1] < 3 && k->taps[2] < 3)
        shrink_evenly(E, k, first);
    else
        shrink_by_weights(E, k, i, first);
}

#endif
