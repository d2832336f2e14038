/* The instructions that the pass near of the specializer makes: the fields of a hint, and what a column's
 * entry has in addition. The pass and its code (engines/specialize/emit/gather_near.c) share them. */
#ifndef IR_NEAR_H
#define IR_NEAR_H

#include <stdbool.h>
#include <stdint.h>

/* The field k of a hint: a column of texels, the rows of the first index and of the other one, and the number
 * of gathers, which are the last instructions of the hint: each is below 128. With `pairs`, the words have
 * the right neighbours of their compact texels too. With `bare`, the texels have no margin. */
static inline int32_t ir_near_pack(unsigned column, unsigned upper, unsigned lower, unsigned gathers,
                                   bool pairs, bool bare)
{
    return (int32_t)(column | upper << 8 | lower << 16 | gathers << 24 | (unsigned)pairs << 31 |
                     (unsigned)bare << 7);
}

static inline bool ir_near_pairs(int32_t k)
{
    return k < 0;
}

static inline bool ir_near_bare(int32_t k)
{
    return (unsigned)k >> 7 & 1;
}

static inline unsigned ir_near_column(int32_t k)
{
    return (unsigned)k & 0x7f;
}

static inline unsigned ir_near_row(int32_t k, unsigned other)
{
    return (unsigned)k >> (8 + 8 * other) & 0xff;
}

static inline unsigned ir_near_gathers(int32_t k)
{
    return (unsigned)k >> 24 & 0x7f;
}

/* The values that columns of texels add to a column's entry: each the places of its lanes, and together their
 * first texels, a word each. */
static inline uint32_t ir_near_words(uint32_t columns, uint32_t lanes)
{
    return columns + (columns + lanes - 1) / lanes;
}

#endif
