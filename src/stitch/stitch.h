/* The stitcher: joins prebuilt, hand-written machine-code fragments and fills their holes. */
#ifndef STITCH_STITCH_H
#define STITCH_STITCH_H

#include "draw/engine.h"

#include <stdio.h>

extern const struct engine engine_stitch;           /* stage fragments where they cover the key, W = 8 */
extern const struct engine engine_stitch_operation; /* operation fragments, W = 8 */

/* Decides a routine's granularity: null for stage fragments, else why operation fragments (an empty string
 * when there is no more to say). The engines' own: stages_lack (stitch/cover.h), and always operations. */
typedef const char *stitch_coverage(enum unit unit, const union key *key);

/* An engine's build() with the decision left to the caller. */
struct routine *stitch_build(const struct engine *engine, stitch_coverage *lack, struct code_arena *arena,
                             enum unit unit, const union key *key, struct error *error);

/* Writes the list of fragments that a key's routine is joined from, with holes' values, and its disassembly;
 * before it, its granularity and why. Returns 0, or -1 with the reason. */
int stitch_dump(struct code_arena *arena, const struct engine *engine, enum unit unit, const union key *key,
                FILE *out, struct error *error);

/* The same with the decision left to the caller. */
int stitch_list(const struct engine *engine, stitch_coverage *lack, struct code_arena *arena, enum unit unit,
                const union key *key, FILE *out, struct error *error);

#endif
