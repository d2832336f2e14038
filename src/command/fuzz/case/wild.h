/* Numbers of fuzzed cases that arithmetic stumbles over. */
#ifndef COMMAND_FUZZ_CASE_WILD_H
#define COMMAND_FUZZ_CASE_WILD_H

#include "base/random.h"

/* Bits of a binary32: zeros of both signs, denormals, infinities, NaNs, the largest, ones next to powers of
 * two, or any bits at all. */
uint32_t wild_bits(struct random *random);

/* The same, finite. */
float wild_float(struct random *random);

#endif
