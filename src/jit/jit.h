/* The specializer: records the spec for one key, optimises, allocates registers and encodes x86-64. */
#ifndef JIT_JIT_H
#define JIT_JIT_H

#include "draw/engine.h"

#include <stdio.h>

#define SPECIALIZE(id, ...) extern const struct engine engine_##id;
#include "def/specialize.def"
#undef SPECIALIZE

/* Whether an engine is one of these. */
int jit_is_engine(const struct engine *engine);

/* Writes the stages of building a routine with one of the engines above that `show` names, a comma-separated
 * list of: key, record, a pass's name (jit_pass_name), intervals, asm; or all. Returns 0, or -1 with the
 * reason. */
int jit_dump(const struct engine *engine, enum unit unit, const union key *key, const char *show, FILE *out,
             struct error *error);

/* The i-th pass's name and one line about it; null past the last. */
const char *jit_pass_name(unsigned i);
const char *jit_pass_description(unsigned i);

#endif
