/* The table of all engines. */
#ifndef ENGINES_LIST_H
#define ENGINES_LIST_H

#include "contract/engine.h"

/* The i-th engine; null past the last. The order is that of reports: from the naive to the fast. From
 * ENGINE_VARIANT on (variant.h), the variants that have been used, so that a walk from 0 does not meet them.
 */
const struct engine *engine_at(unsigned i);

/* The engine of that name, or its variant if options follow the name; null when there is none. */
const struct engine *engine_find(const char *name);

/* Does the same, with the reason. errno is ENOMEM if memory is refused. */
const struct engine *engine_named(const char *name, struct error *error);

/* The number of an engine in engine_at. */
unsigned engine_number(const struct engine *engine);

#endif
