/* The stitcher: joins prebuilt, hand-written machine-code fragments and fills their holes. */
#ifndef STITCH_STITCH_H
#define STITCH_STITCH_H

#include "draw/engine.h"

#include <stdio.h>

extern const struct engine engine_stitch;           /* stage fragments, W = 8 */
extern const struct engine engine_stitch_operation; /* operation fragments, W = 8 */

/* Writes the list of fragments that a key's routine is joined from, with holes' values, and its disassembly.
 * Returns 0, or -1 with the reason. */
int stitch_dump(struct code_arena *arena, const struct engine *engine, enum unit unit, const union key *key,
                FILE *out, struct error *error);

#endif
