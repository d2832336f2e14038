/* The naive emulator: executes the specification on four lanes, and makes every decision on the state for
 * each group of four. */
#ifndef EMU_EMULATE_EMULATE_H
#define EMU_EMULATE_EMULATE_H

#include "contract/engine.h"

extern const struct engine engine_emulate;

/* Returns true for engine emulate and its variants. */
bool emulate_is_engine(const struct engine *engine);

/* The options of variants (engines/variant.h), as those of specialize.h. */
void *emulate_copy_options(const struct engine *engine);
#define VARIANT(name, ...) int emulate_set_##name(void *options, const char *value, struct error *error);
#include "def/engine/emulate.def"
#undef VARIANT

#endif
