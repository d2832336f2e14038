/* The mean of 2^n words of bytes, channel by channel, to nearest and halves up: sums of 16 bits, of the even
 * and of the odd bytes. Those of eight words are at most 2040. */
#ifndef SPEC_BLIT_MEAN_H
#define SPEC_BLIT_MEAN_H

#include "contract/language.h"

struct byte_sums {
    fix even, odd;
};

static inline struct byte_sums mean_begin(struct env *e, int exponent)
{
    fix half = lit_x(E, (uint16_t)((1 << exponent) / 2));
    return (struct byte_sums){half, half};
}

static inline void mean_add(struct env *e, struct byte_sums *sums, itg word)
{
    itg low = and_i(E, word, lit_i(E, 0x00ff00ff));
    fix low_bytes = fix_of(E, low);
    fix both = fix_of(E, word);
    fix high_bytes = ushr_x(E, both, 8);
    sums->even = add_x(E, sums->even, low_bytes);
    sums->odd = add_x(E, sums->odd, high_bytes);
}

static inline itg mean_end(struct env *e, const struct byte_sums *sums, int exponent)
{
    fix even = ushr_x(E, sums->even, exponent);
    fix odd = ushr_x(E, sums->odd, exponent);
    odd = shl_x(E, odd, 8);
    fix joined = add_x(E, even, odd);
    return int_of(E, joined);
}

#endif
