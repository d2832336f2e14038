/* Colour write: the new word in live lanes and enabled channels, the stored word elsewhere. */
#ifndef SPEC_PIXEL_WRITE_H
#define SPEC_PIXEL_WRITE_H

#include "contract/language.h"

static inline int32_t write_mask_word(int write_mask)
{
    uint32_t word = 0;
    for (int channel = 0; channel < 4; channel++)
        if (write_mask >> channel & 1)
            word |= 255u << 8 * channel;
    return (int32_t)word;
}

static inline void write_word(struct env *e, int write_mask, int offset, msk live, itg word, itg stored)
{
    if (write_mask != 15) {
        itg new = and_i(E, word, lit_i(E, write_mask_word(write_mask)));
        itg old = and_i(E, stored, lit_i(E, ~write_mask_word(write_mask)));
        word = or_i(E, new, old);
    }
    itg merged = select_i(E, live, word, stored);
    store_i(E, BASE_COLOR, offset, merged);
}

#endif
