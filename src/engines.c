#include "engines.h"

#include "emu/batch.h"
#include "emu/emulate.h"
#include "external/external.h"
#include "jit/jit.h"
#include "stitch/stitch.h"
#include "tiered/tiered.h"

#include <string.h>

static const struct engine *const engines[] = {
    &engine_emulate,  &engine_batch,
#define BATCH(lanes) &engine_batch_##lanes,
#include "def/batch.def"
#undef BATCH
    &engine_stitch,   &engine_stitch_operation,
#define SPECIALIZE(id, ...) &engine_##id,
#include "def/specialize.def"
#undef SPECIALIZE
    &engine_tiered,   &engine_tiered_swap,
    &engine_external,
};

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
