/* Compares the outputs of two engines for one unit, one key and the same random inputs, byte by byte.
 *
 * Inputs are plausible or wild. In wild inputs, any float may be a zero of either sign, a denormal, an
 * infinity, a NaN, huge, or any bits. Both kinds have degenerate triangles, zero vectors, lights at
 * exactly their range, planes that meet the stored depth, textures of every shape, and streams that begin
 * at any byte. Counts vary. Indices and lane tables are aligned only to words. Vertex data and textures
 * end at unreadable memory.
 *
 * All bytes that a routine could write are compared, including those after and between its outputs. The
 * specification leaves two things open, which are not compared: the payload of a NaN in a vertex or a
 * plane, and the planes of triangles that setup found invisible. Generated routines are called through the
 * trampoline (trampoline.h), with a foreign MXCSR and canaries in every register that the convention
 * preserves. */
#ifndef TESTS_SUPPORT_ROUTINE_DIFFERENTIAL_H
#define TESTS_SUPPORT_ROUTINE_DIFFERENTIAL_H

#include "contract/engine.h"

struct differential;

/* Null when memory is refused. */
struct differential *differential_create(struct code_arena *arena);
void differential_destroy(struct differential *differential);

/* Returns null when the routines of a and b agree on the inputs of `seed`, else a message with the key,
 * the position and both values, valid until the next call. */
const char *differential_compare(struct differential *differential, const struct engine *a,
                                 const struct engine *b, enum unit unit, const union key *key, uint64_t seed);

/* The same for any number of engines, without a reference: each keeps the calling convention, writes only
 * to its outputs, and agrees with the first. */
const char *differential_run(struct differential *differential, const struct engine *const *engines,
                             unsigned count, enum unit unit, const union key *key, uint64_t seed);

/* A random key, normalised or not. Keys like those of draws are more frequent. Advances the seed. */
void differential_key(enum unit unit, uint64_t *seed, union key *key);

/* Changes a random key into one that the test accepts. */
typedef void differential_shape(enum unit unit, union key *key);

/* The same for `rounds` random keys, normalised or not, and inputs. Returns the first disagreement, or
 * null. `shape` may be null. */
const char *differential_rounds(struct differential *differential, const struct engine *a,
                                const struct engine *b, enum unit unit, differential_shape *shape,
                                uint64_t seed, int rounds);

#endif
