/* Clears: a word of a tile gets the bits of a new word, all of them or those of a mask. Its bytes are the
 * channels of a colour, or depth above stencil (render/target/depth.h). With several planes each has one
 * channel, which is cleared as a whole.
 *
 * The element's index is the pixel's place, x and y in 16 bits each, if only a part is cleared; then pixels
 * outside of it keep their words. */
#ifndef SPEC_BLIT_CLEAR_H
#define SPEC_BLIT_CLEAR_H

#include "contract/language.h"

static inline itg clear_mask(struct env *e, int write_mask)
{
    uint32_t bits = 0;
    if (write_mask == BLIT_MASK_JOB)
        return uniform_i(E, BASE_JOB, (int)offsetof(struct blit_job, mask));
    for (int byte = 0; byte < 4; byte++)
        if (write_mask >> byte & 1)
            bits |= 0xffu << 8 * byte;
    return lit_i(E, (int32_t)bits);
}

/* Lanes with low < value < high. */
static inline msk clear_between(struct env *e, itg value, int low, int high)
{
    itg least = uniform_i(E, BASE_JOB, low);
    itg most = uniform_i(E, BASE_JOB, high);
    msk above = gt_i(E, value, least);
    msk below = gt_i(E, most, value);
    return and_m(E, above, below);
}

/* The pixels of the job's rectangle. */
static inline msk clear_inside(struct env *e)
{
    itg place = load_i(E, BASE_INPUT, 0);
    itg x = and_i(E, place, lit_i(E, 0xffff));
    itg y = ushr_i(E, place, 16);
    msk column =
        clear_between(E, x, (int)offsetof(struct blit_job, left), (int)offsetof(struct blit_job, right));
    msk row =
        clear_between(E, y, (int)offsetof(struct blit_job, top), (int)offsetof(struct blit_job, bottom));
    return and_m(E, column, row);
}

static inline void blit_clear(struct env *e, const struct blit_key *k)
{
    itg word = uniform_i(E, BASE_JOB, (int)offsetof(struct blit_job, word));
    itg old = load_i(E, BASE_OUTPUT, 0);
    if (k->write_mask != BLIT_MASK_ALL) {
        itg mask = clear_mask(E, k->write_mask);
        itg changed = xor_i(E, old, word);
        itg differs = and_i(E, changed, mask);
        word = xor_i(E, old, differs);
    }
    if (k->part) {
        msk inside = clear_inside(E);
        word = select_i(E, inside, word, old);
    }
    store_i(E, BASE_OUTPUT, 0, word);
}

#endif
