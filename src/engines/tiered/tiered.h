/* Tiered: a routine begins in its first tier, which is built when a draw needs it. A background thread builds
 * the next tiers, from the slowest engine to the fastest. When one is complete, runs use it. By default the
 * tiers are stitch and specialize, and the second one is built immediately; options (def/engine/tiered.def)
 * choose other tiers, and the use that a routine needs before its next tier.
 *
 * Results do not depend on the moment of a change: all tiers read and write the same layouts and compute the
 * same bytes, so each run may use any. A tier that cannot be built (no thread, no memory, no room for code)
 * leaves the routine in the tier before it. */
#ifndef ENGINES_TIERED_TIERED_H
#define ENGINES_TIERED_TIERED_H

#include "contract/engine.h"

extern const struct engine engine_tiered;

/* The same without dependence on time, for tests: the first run of a routine is stitched, and the second
 * waits until the routine has been specialized. A stream that draws twice with a routine runs both tiers
 * and the change between them. It is tiered:runs=1:wait. */
extern const struct engine engine_tiered_swap;

/* Returns true for these and their variants. */
bool tiered_is_engine(const struct engine *engine);

/* The engine of a tier, from 0; null past the last, and for an engine that is not tiered. */
const struct engine *tiered_engine(const struct engine *engine, unsigned tier);

/* The options of variants (engines/variant.h), as those of specialize.h. */
void *tiered_copy_options(const struct engine *engine);
#define VARIANT(name, ...) int tiered_set_##name(void *options, const char *value, struct error *error);
#include "def/engine/tiered.def"
#undef VARIANT

/* Returns true if the routine's runs use its last tier. The routine must be the one that was built, not the
 * cache's copy. For tests: which tier runs. */
bool tiered_is_specialized(const struct routine *routine);

/* Waits until the routine's next tier has been built, or until that is not possible before its next run. For
 * tests: the end of the builds in the background. */
void tiered_wait(const struct routine *routine);

#endif
