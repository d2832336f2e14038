/* Two engines, one unit and key, the same random inputs: are the outputs the same bytes?
 *
 * Inputs come in two moods: plausible, and wild, where any float may be a zero of either sign, a denormal, an
 * infinity, a NaN, huge, or any bits at all. Both have degenerate triangles, zero vectors, lights at exactly
 * their range, planes that meet the stored depth, textures of every shape, streams that start at any byte.
 * Counts vary. Indices and lane tables are aligned to words only. Vertex data and textures end where
 * unreadable memory begins.
 *
 * Compared are all bytes that a routine could write to, those behind and between its outputs included, except
 * what the specification leaves open: which NaN a float of a vertex or plane is, and the planes of triangles
 * that setup found invisible. Generated routines are called through the trampoline (trampoline.h), with a foreign
 * MXCSR and canaries wherever the calling convention says that something is kept, and their inputs are hashed before
 * and after. */
#ifndef TESTS_DIFFERENTIAL_H
#define TESTS_DIFFERENTIAL_H

#include "draw/engine.h"

struct differential;

/* Null when memory is refused. */
struct differential *differential_create(struct code_arena *arena);
void differential_destroy(struct differential *differential);

/* Returns null when a's and b's routines agree on the inputs that `seed` makes, else a message (until the
 * next call) with the key, the place and both values. */
const char *differential_compare(struct differential *differential, const struct engine *a,
                                 const struct engine *b, enum unit unit, const union key *key, uint64_t seed);

/* The same of any number of engines without comparing them to one that is known to be right: each keeps the convention,
 * writes to nothing but what the call says is its output, and agrees with the first. */
const char *differential_run(struct differential *differential, const struct engine *const *engines,
                             unsigned count, enum unit unit, const union key *key, uint64_t seed);

/* A random key, normalised or not: any, but more often what draws are like. Advances the seed. */
void differential_key(enum unit unit, uint64_t *seed, union key *key);

/* Changes a random key into one of those that are wanted. */
typedef void differential_shape(enum unit unit, union key *key);

/* The same for `rounds` random keys, normalised or not, and inputs: the first disagreement, or null. `shape`
 * may be null. */
const char *differential_rounds(struct differential *differential, const struct engine *a,
                                const struct engine *b, enum unit unit, differential_shape *shape,
                                uint64_t seed, int rounds);

#endif
