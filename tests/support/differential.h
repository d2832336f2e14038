/* Two engines, one unit and key, the same random inputs: are the outputs the same bytes?
 *
 * Inputs mix ordinary values with zeros of both signs, denormals, infinities and NaN, huge and degenerate
 * triangles, and textures of every shape. Compared are whole output buffers: vertex batches, triangle records
 * (planes of culled triangles have no meaning), tiles of colour and depth. Two NaN in a float slot count as
 * equal whatever their payload. */
#ifndef TESTS_DIFFERENTIAL_H
#define TESTS_DIFFERENTIAL_H

#include "draw/engine.h"

struct differential;

struct differential *differential_create(struct code_arena *arena);
void differential_destroy(struct differential *differential);

/* Returns null when a's and b's routines agree on the inputs that `seed` makes, else a message (until the
 * next call) with the key, the place and both values. */
const char *differential_compare(struct differential *differential, const struct engine *a,
                                 const struct engine *b, enum unit unit, const union key *key, uint64_t seed);

#endif
