/* The table of all engines. */
#ifndef ENGINES_LIST_H
#define ENGINES_LIST_H

#include "contract/engine.h"

/* The i-th engine; null past the last. The order is that of reports: from the naive to the fast. */
const struct engine *engine_at(unsigned i);

/* The engine of that name; null when there is none. */
const struct engine *engine_find(const char *name);

#endif
