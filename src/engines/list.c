#include "engines/list.h"

#include "emu/batch/batch.h"
#include "emu/emulate/emulate.h"
#include "engines/external/external.h"
#include "engines/specialize/specialize.h"
#include "engines/stitch/stitch.h"
#include "engines/tiered/tiered.h"

#include <string.h>

/* In the order of reports, from the slowest to the fastest. */
/* clang-format off */
static const struct engine *const engines[] = {
    &engine_emulate,
    &engine_batch,
#define BATCH(lanes) &engine_batch_##lanes,
#include "def/engine/batch.def"
#undef BATCH
    &engine_stitch,
    &engine_stitch_operation,
#define SPECIALIZE(id, ...) &engine_##id,
#include "def/engine/specialize.def"
#undef SPECIALIZE
    &engine_tiered,
    &engine_tiered_swap,
    &engine_external,
};
/* clang-format on */

const struct engine *engine_at(unsigned i)
{
    return i < sizeof engines / sizeof *engines ? engines[i] : NULL;
}

const struct engine *engine_find(const char *name)
{
    for (unsigned i = 0; engine_at(i); i++)
        if (!strcmp(engine_at(i)->name, name))
            return engine_at(i);
    return NULL;
}
