/* Tiered: a routine is stitched first and specialized in the background. When the specialized routine is
 * complete, runs use it.
 *
 * Results do not depend on the moment of the change: both tiers read and write the same layouts and
 * compute the same bytes, so each run may use either. A routine that cannot be specialized (no thread, no
 * memory, no room for code) stays stitched. */
#ifndef ENGINES_TIERED_TIERED_H
#define ENGINES_TIERED_TIERED_H

#include "contract/engine.h"

extern const struct engine engine_tiered;

/* The same without dependence on time, for tests: the first run of a routine is stitched, and the second
 * waits until the routine has been specialized. A stream that draws twice with a routine runs both tiers
 * and the change between them. */
extern const struct engine engine_tiered_swap;

/* The engine of a tier, 0 or 1; null for an engine that is not tiered. */
const struct engine *tiered_engine(const struct engine *engine, unsigned tier);

/* Returns true if the routine's runs use its second tier. The routine must be the one that was built, not
 * the cache's copy. For tests: which tier runs. */
bool tiered_is_specialized(const struct routine *routine);

/* Waits until the routine has been specialized, or until that is not possible before its next run. For tests:
 * the end of the builds in the background. */
void tiered_wait(const struct routine *routine);

#endif
