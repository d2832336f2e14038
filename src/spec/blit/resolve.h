/* The average of a pixel's samples: of bytes channel by channel to nearest and halves up, of numbers in
 * binary32, summed in order from zero; NaN is always the same one. Depth and stencil are not averaged.
 *
 * The element's index is the first sample's word of the pixel. The words of the next samples are at constant
 * distances. */
#ifndef SPEC_BLIT_RESOLVE_H
#define SPEC_BLIT_RESOLVE_H

#include "contract/arguments.h"
#include "contract/language.h"
#include "spec/blit/mean.h"
#include "spec/math/nan.h"

static inline void resolve_bytes(struct env *e, const struct blit_key *k)
{
    struct byte_sums sums = mean_begin(E, k->samples);
    for (int sample = 0; sample < 1 << k->samples; sample++) {
        itg word = load_i(E, BASE_INPUT, blit_sample_offset(k, sample));
        mean_add(E, &sums, word);
    }
    itg mean = mean_end(E, &sums, k->samples);
    store_i(E, BASE_OUTPUT, 0, mean);
}

static inline void resolve_numbers(struct env *e, const struct blit_key *k)
{
    int samples = 1 << k->samples;
    flt sum = lit_f(E, 0);
    for (int sample = 0; sample < samples; sample++) {
        flt value = load_f(E, BASE_INPUT, blit_sample_offset(k, sample));
        sum = add_f(E, sum, value);
    }
    flt mean = div_f(E, sum, lit_f(E, (float)samples));
    flt stored = one_nan(E, mean);
    store_f(E, BASE_OUTPUT, 0, stored);
}

static inline void blit_resolve(struct env *e, const struct blit_key *k)
{
    if (k->numbers)
        resolve_numbers(E, k);
    else
        resolve_bytes(E, k);
}

#endif
