#include "engines/list.h"

#include "base/words.h"
#include "emu/batch/batch.h"
#include "emu/emulate/emulate.h"
#include "engines/external/external.h"
#include "engines/mixed.h"
#include "engines/specialize/specialize.h"
#include "engines/stitch/stitch.h"
#include "engines/tiered/tiered.h"
#include "engines/variant.h"

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
    &engine_mixed,
    &engine_external,
};
/* clang-format on */

const struct engine *engine_at(unsigned i)
{
    if (i >= ENGINE_VARIANT)
        return engine_variant_at(i - ENGINE_VARIANT);
    return i < sizeof engines / sizeof *engines ? engines[i] : NULL;
}

static const char *engine_choice(const struct words *words, unsigned i)
{
    (void)words;
    return engine_at(i) ? engine_at(i)->name : NULL;
}

static const struct engine *unknown_engine(const char *name, size_t length, struct error *error)
{
    const struct words names = {.at = engine_choice};
    char choices[ERROR_CAPACITY];
    words_join(names, choices, sizeof choices);
    error_set(error, "engine %.*s: there is none of that name, expected one of: %s",
              (int)(length < 80 ? length : 80), name, choices);
    words_suggest_in(names, name, length, error);
    return NULL;
}

const struct engine *engine_named(const char *name, struct error *error)
{
    const struct words names = {.at = engine_choice};
    size_t length = strcspn(name, ":");
    unsigned i;
    if (!words_find(names, name, length, &i))
        return unknown_engine(name, length, error);
    return name[length] ? engine_vary(engines[i], name, length, error) : engines[i];
}

const struct engine *engine_find(const char *name)
{
    return engine_named(name, NULL);
}

unsigned engine_number(const struct engine *engine)
{
    unsigned i = 0;
    while (engine_at(i) && engine_at(i) != engine)
        i++;
    if (!engine_at(i))
        for (i = ENGINE_VARIANT; engine_at(i) != engine;)
            i++;
    return i;
}
