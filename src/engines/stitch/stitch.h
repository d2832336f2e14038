/* The stitcher: joins prebuilt, hand-written machine-code fragments and fills their holes. */
#ifndef ENGINES_STITCH_STITCH_H
#define ENGINES_STITCH_STITCH_H

#include "contract/engine.h"

#include <stdio.h>

extern const struct engine engine_stitch;           /* stage fragments where they cover the key, W = 8 */
extern const struct engine engine_stitch_operation; /* operation fragments, W = 8 */

/* Decides a routine's granularity. Returns null for stage fragments, else the reason for operation fragments,
 * which may be empty. */
typedef const char *stitch_coverage(enum unit unit, const union key *key);

/* The options of an engine that stitches. engine_stitch has stages_lack (engines/stitch/cover.h). */
struct stitch_options {
    stitch_coverage *lack;
};

/* Plans a routine with the granularity that the engine chooses. Returns null for stage fragments, else the
 * reason for operation fragments, which may be empty. */
struct plan;
const char *stitch_plan(struct plan *plan, const struct engine *engine, enum unit unit, const union key *key);

/* Returns true if an engine is one of these. */
bool stitch_is_engine(const struct engine *engine);

/* Writes a routine's granularity and the reason for it, the fragments it is joined from with the values of
 * their holes, and its disassembly. Returns 0, or -1 with the reason. */
int stitch_dump(const struct engine *engine, struct code_arena *arena, enum unit unit, const union key *key,
                FILE *out, struct error *error);

#endif
