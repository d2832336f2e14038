/* The average of a pixel's samples: of bytes channel by channel to nearest and halves up, of numbers in
 * binary32, summed in order from zero; NaN is always the same one. Depth and stencil are not averaged.
 *
 * The element's index is the first sample's word of the pixel. The words of the next samples are at constant
 * distances. */
#ifndef SPEC_BLIT_RESOLVE_H
#define SPEC_BLIT_RESOLVE_H

#include "contract/arguments.h"
#include "contract/language.h"
#include "spec/math/nan.h"

/* Sums of bytes have 16 bits each: eight samples are at most 2040. */
static inline void resolve_bytes(struct env *e, const struct blit_key *k)
{
    int samples = 1 << k->samples;
    fix even = lit_x(E, (uint16_t)(samples / 2)), odd = even;
    for (int sample = 0; sample < samples; sample++) {
        itg word = load_i(E, BASE_INPUT, blit_sample_offset(k, sample));
        itg low = and_i(E, word, lit_i(E, 0x00ff00ff));
        fix low_bytes = fix_of(E, low);
        fix both = fix_of(E, word);
        fix high_bytes = ushr_x(E, both, 8);
        even = add_x(E, even, low_bytes);
        odd = add_x(E, odd, high_bytes);
    }
    even = ushr_x(E, even, k->samples);
    odd = ushr_x(E, odd, k->samples);
    odd = shl_x(E, odd, 8);
    fix joined = add_x(E, even, odd);
    itg word = int_of(E, joined);
    store_i(E, BASE_OUTPUT, 0, word);
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
