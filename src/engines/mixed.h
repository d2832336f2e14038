/* Mixed: each unit has an engine of its own, as in "mixed:vertex=emulate:setup=stitch:pixel=specialize-8".
 *
 * A routine is built, run and freed by the engine of its unit, which is its routine->engine. The engines can
 * be combined because all of them have the same layouts (contract/layout.h) and compute the same bytes. A
 * picture that is wrong with one engine becomes correct when the faulty unit gets another engine. */
#ifndef ENGINES_MIXED_H
#define ENGINES_MIXED_H

#include "contract/engine.h"

/* Without options: vertices by emulate, setup by stitch, pixels by specialize. */
extern const struct engine engine_mixed;

/* Returns true for engine mixed and its variants. */
bool mixed_is_engine(const struct engine *engine);

/* The engine of a unit; null for an engine that is not mixed. */
const struct engine *mixed_engine(const struct engine *engine, enum unit unit);

/* The options of variants (engines/variant.h), as those of specialize.h. The value of each is the name of an
 * engine that is not mixed itself. Options in it follow a "+" instead of a colon:
 * "mixed:pixel=specialize-8+registers=6". */
void *mixed_copy_options(const struct engine *engine);
/* Sets the engine of a unit. For tests: the names of options name only engines of the list. */
void mixed_use(void *options, enum unit unit, const struct engine *engine);
#define VARIANT(name, ...) int mixed_set_##name(void *options, const char *value, struct error *error);
#include "def/engine/mixed.def"
#undef VARIANT

#endif
