/* Tiered: a routine is stitched at once and specialized in the background; as soon as that is ready, calls go there.
 *
 * Nobody can tell but by the clock: both tiers read and write the same layouts and give the same bytes, so any call may be
 * of either. What cannot be specialized (no thread, no memory, no room for code) stays stitched. */
#ifndef TIERED_TIERED_H
#define TIERED_TIERED_H

#include "draw/engine.h"

extern const struct engine engine_tiered;

/* The same, not left to the clock: a routine's first call is stitched, the second one waits until the routine has been
 * specialized. So whatever draws something twice has run both tiers and what lies between. */
extern const struct engine engine_tiered_swap;

/* The engines of an engine's tiers, from the first, 0 or 1; null for those that are not tiered. */
const struct engine *tiered_engine(const struct engine *engine, unsigned tier);

/* Whether a routine's calls go to its second tier by now. For a routine as it was built; not for the cache's copies. */
int tiered_is_specialized(const struct routine *routine);

/* Waits until there is nothing to wait for: the routine has been specialized, or will not be before it is called
 * again. */
void tiered_wait(const struct routine *routine);

#endif
