#include "engines/mixed.h"

#include "emu/emulate/emulate.h"
#include "engines/list.h"
#include "engines/specialize/specialize.h"
#include "engines/stitch/stitch.h"
#include "engines/variant.h"

#include <stdlib.h>
#include <string.h>

struct mixed_options {
    const struct engine *of[UNIT_COUNT];
};

static const char *unavailable(const struct engine *self)
{
    for (int unit = 0; unit < UNIT_COUNT; unit++) {
        const char *reason = engine_unavailable(mixed_engine(self, unit));
        if (reason)
            return reason;
    }
    return NULL;
}

static struct routine *build(const struct engine *self, struct code_arena *arena, enum unit unit,
                             const union key *key, struct error *error)
{
    return engine_build(mixed_engine(self, unit == UNIT_BLIT ? UNIT_PIXEL : unit), arena, unit, key, error);
}

static void free_routine(struct code_arena *arena, struct routine *routine)
{
    if (routine)
        routine->engine->free(arena, routine);
}

const struct engine engine_mixed = {
    .name = "mixed",
    .description = "an engine for each unit, chosen by options; without them vertices by emulate, setup by "
                   "stitch, pixels by specialize",
    .options = &(const struct mixed_options){{[UNIT_VERTEX] = &engine_emulate,
                                              [UNIT_SETUP] = &engine_stitch,
                                              [UNIT_PIXEL] = &engine_specialize}},
    .unavailable = unavailable,
    .build = build,
    .free = free_routine,
};

bool mixed_is_engine(const struct engine *engine)
{
    return engine->build == build;
}

const struct engine *mixed_engine(const struct engine *engine, enum unit unit)
{
    return mixed_is_engine(engine) ? ((const struct mixed_options *)engine->options)->of[unit] : NULL;
}

/* --- Options -------------------------------------------------------------------------------------------- */

void *mixed_copy_options(const struct engine *engine)
{
    struct mixed_options *copy = malloc(sizeof *copy);
    if (copy)
        *copy = *(const struct mixed_options *)engine->options;
    return copy;
}

void mixed_use(void *options, enum unit unit, const struct engine *engine)
{
    ((struct mixed_options *)options)->of[unit] = engine;
}

static int set_engine(void *options, enum unit unit, const char *value, struct error *error)
{
    char name[ENGINE_NAME_CAPACITY];
    size_t length = strlen(value);
    if (length >= sizeof name)
        return error_set(error, "%s has %zu bytes, expected at most %zu", unit_name[unit], length,
                         sizeof name - 1);
    memcpy(name, value, length + 1);
    for (char *plus = name; (plus = strchr(plus, '+'));)
        *plus = ':';
    const struct engine *engine = engine_named(name, error);
    if (!engine)
        return -1;
    if (mixed_is_engine(engine))
        return error_set(error, "%s is \"%.80s\", expected an engine that is not mixed", unit_name[unit],
                         value);
    mixed_use(options, unit, engine);
    return 0;
}

int mixed_set_vertex(void *options, const char *value, struct error *error)
{
    return set_engine(options, UNIT_VERTEX, value, error);
}

int mixed_set_setup(void *options, const char *value, struct error *error)
{
    return set_engine(options, UNIT_SETUP, value, error);
}

int mixed_set_pixel(void *options, const char *value, struct error *error)
{
    return set_engine(options, UNIT_PIXEL, value, error);
}
