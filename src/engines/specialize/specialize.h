/* The specializer: records the specification for one key, optimises the recording, allocates registers and
 * encodes x86-64. */
#ifndef ENGINES_SPECIALIZE_SPECIALIZE_H
#define ENGINES_SPECIALIZE_SPECIALIZE_H

#include "contract/engine.h"

#include <stdio.h>

#define SPECIALIZE(id, ...) extern const struct engine engine_##id;
#include "def/engine/specialize.def"
#undef SPECIALIZE

/* Returns true if an engine is one of these. */
bool specialize_is_engine(const struct engine *engine);

/* The options of variants (engines/variant.h). Returns a copy of an engine's options, which is freed with
 * free(), or null if memory is refused. */
void *specialize_copy_options(const struct engine *engine);

/* Each changes such a copy. `value` is null for an option without value. Returns 0, or -1 with the reason. */
#define VARIANT(name, engines, ...)                                                                          \
    int engines##_set_##name(void *options, const char *value, struct error *error);
#include "def/engine/variant.def"
#undef VARIANT

/* The words of specialize_dump: the word of that index, null after the last. */
const char *specialize_phase_name(unsigned index);

/* Builds a routine with one of these engines and prints the phases that `show` lists, separated by commas:
 * key, record, a pass's name (pass_name), intervals, asm; or all of these; and text, parts. Returns 0, or -1
 * with the reason. */
int specialize_dump(const struct engine *engine, enum unit unit, const union key *key, const char *show,
                    FILE *out, struct error *error);

#endif
