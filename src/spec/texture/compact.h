/* Compact texels: one or two bytes (def/state/compact.def).
 *
 * Their bytes are the pair of a `fix`, the first one in the low half; the second of one byte is 0. So a
 * filter blends one pair where other texels have two, and the channels are made of its result. */
#ifndef SPEC_TEXTURE_COMPACT_H
#define SPEC_TEXTURE_COMPACT_H

#include "contract/language.h"
#include "spec/math/color.h"

enum compact_source { COMPACT_CONSTANT, COMPACT_FIRST, COMPACT_SECOND };

/* The byte that channel c is. */
static inline enum compact_source compact_source(int form, int c)
{
    if (storage_compact[form].first >> 8 * c & 1)
        return COMPACT_FIRST;
    return storage_compact[form].second >> 8 * c & 1 ? COMPACT_SECOND : COMPACT_CONSTANT;
}

/* The pair of the texel in the low bytes of a word. */
static inline fix compact_pair(struct env *e, int form, itg word)
{
    itg first = and_i(E, word, lit_i(E, 0xff));
    if (storage_compact[form].bytes == 1)
        return fix_of(E, first);
    itg second = and_i(E, word, lit_i(E, 0xff00));
    itg high = shl_i(E, second, 8);
    itg both = or_i(E, first, high);
    return fix_of(E, both);
}

/* A byte of the pair in the low half, the other half 0; and in the high half. */
static inline itg compact_low(struct env *e, int form, itg pair, enum compact_source source)
{
    if (source == COMPACT_SECOND)
        return ushr_i(E, pair, 16);
    return storage_compact[form].bytes == 1 ? pair : and_i(E, pair, lit_i(E, 0xffff));
}

static inline itg compact_high(struct env *e, itg pair, enum compact_source source)
{
    return source == COMPACT_FIRST ? shl_i(E, pair, 16) : and_i(E, pair, lit_i(E, -0x10000));
}

/* Channel c in the low half, channel c + 2 in the high one. */
static inline fix compact_channels(struct env *e, int form, fix pair, int c)
{
    enum compact_source low = compact_source(form, c), high = compact_source(form, c + 2);
    if (low == COMPACT_FIRST && high == COMPACT_SECOND)
        return pair;
    uint32_t constant = storage_compact[form].constant >> 8 * c & 0x00ff00ff;
    itg bits = int_of(E, pair), r = lit_i(E, (int32_t)constant);
    if (low != COMPACT_CONSTANT) {
        itg part = compact_low(E, form, bits, low);
        r = constant ? or_i(E, r, part) : part;
    }
    if (high != COMPACT_CONSTANT) {
        itg part = compact_high(E, bits, high);
        r = constant || low != COMPACT_CONSTANT ? or_i(E, r, part) : part;
    }
    return fix_of(E, r);
}

static inline struct color compact_color(struct env *e, int form, fix pair)
{
    struct color r;
    r.rb = compact_channels(E, form, pair, 0);
    r.ga = compact_channels(E, form, pair, 1);
    return r;
}

#endif
