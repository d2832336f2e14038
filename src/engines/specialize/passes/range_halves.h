/* Bounds of the halves of packed values (range_halves.c). */
#ifndef ENGINES_SPECIALIZE_PASSES_RANGE_HALVES_H
#define ENGINES_SPECIALIZE_PASSES_RANGE_HALVES_H

#include "ir/ir.h"

/* The most that each half of a word can be, as an unsigned integer. */
struct halves {
    uint32_t low, high;
};

/* The bounds of a value. 0xffff: nothing is known of the half. */
struct halves range_halves(const struct ir *ir, unsigned value);

#endif
