/* The second code of a pixel routine (option `sixteen`): with two registers for each value, it computes
 * the 16 pixels of a block in one pass, as specialize-8x2 does.
 *
 * A routine with one register of 8 lanes for each value runs once for each half of a block that has a
 * covered pixel. In the second code, one half is work for the time in which the other waits, but it always
 * computes both. So it is faster where blocks are covered in both halves, and slower at the edges of
 * triangles: the coverage decides, and no key has it. Each call therefore counts its blocks that are covered
 * in both halves, and runs the code that is faster for it by the estimates of the pass shape. A call of fewer
 * than four blocks runs the first code, since the count would cost more than it gains. Until the second code
 * exists, the counted blocks are added up. When there were `sixteen` of them, the thread that records
 * draws builds it, unless the estimates show that it would not be faster.
 *
 * A long chain of operations keeps even two halves waiting. If the estimates show it, and most blocks that
 * were counted have a neighbour in the list with the same record, the second code has four registers for each
 * value and computes two blocks in a pass.
 *
 * The first code of a span reading is separated (passes/span/separate.c), the second is not. So the first is
 * estimated when it is built. */
#ifndef ENGINES_SPECIALIZE_SIXTEEN_H
#define ENGINES_SPECIALIZE_SIXTEEN_H

#include "engines/specialize/build.h"

/* Returns true if a routine with these options may get a second code. */
bool specialize_may_sixteen(const struct build_options *options, enum unit unit);

/* Gives a routine that was just built the state for it, with the estimates that are known. Returns 0, or -1
 * with the reason. */
int specialize_sixteen(struct code_arena *arena, struct routine *routine, const struct pass_shapes *shapes,
                       struct error *error);

/* Builds the second code if enough blocks have been counted. Only the thread that records draws calls it. */
void specialize_build_sixteen(const struct routine *routine);

/* Frees the second code, if there is one. No thread runs it. */
void specialize_sixteen_free(struct routine *routine);

/* The blocks of a call that are covered in both halves; from 128 blocks on an estimate by a sample. For
 * tests: coverages of all kinds. */
uint32_t specialize_count_both(const struct entry *entries, uint32_t count);

/* The pairs of neighbours with the same record, each entry in one of them at most; of more than 128 entries
 * an estimate. For tests: lists of all kinds. */
uint32_t specialize_count_pairs(const struct entry *entries, uint32_t count);

/* Returns true if the second code can be faster at all, with room for the error of estimates. */
bool specialize_is_worth(const struct pass_shapes *shapes);

/* Returns true if the second code is faster for `count` blocks. `both` of them are covered in both halves. */
bool specialize_prefers_sixteen(const struct pass_shapes *shapes, uint32_t count, uint32_t both);

/* The same, if it computes two blocks in a pass and there are `pairs` of them. For tests: what decides. */
bool specialize_prefers_pairs(const struct pass_shapes *shapes, uint32_t count, uint32_t both,
                              uint32_t pairs);

#endif
