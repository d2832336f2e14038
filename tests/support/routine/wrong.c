#include "tests/support/routine/wrong.h"

#include "contract/arguments.h"
#include "contract/key.h"
#include "emu/emulate/emulate.h"

#include <stdlib.h>
#include <unistd.h>

static enum wrong fault;
static void (*run_pixels)(const void *call, const struct routine *routine);

static void run_wrong(const void *argument, const struct routine *routine)
{
    const struct pixel_arguments *call = argument;
    run_pixels(argument, routine);
    if (routine->key.pixel.alpha_discard == COMPARE_NEVER)
        return;
    switch (fault) {
    case WRONG_COLOR: call->color[16 * call->entries[0].block] ^= 1; break;
    case WRONG_DEPTH: call->depth[16 * call->entries[0].block] ^= 1; break;
    case WRONG_CRASH: abort();
    default:
        for (;;)
            sleep(1);
    }
}

static struct routine *build(const struct engine *self, struct code_arena *arena, enum unit unit,
                             const union key *key, struct error *error)
{
    (void)self;
    struct routine *routine = engine_build(&engine_emulate, arena, unit, key, error);
    if (routine && unit == UNIT_PIXEL) {
        run_pixels = routine->run;
        routine->run = run_wrong;
    }
    return routine;
}

const struct engine *wrong_engine(enum wrong wrong)
{
    static struct engine engine;
    fault = wrong;
    engine = engine_emulate;
    engine.name = "wrong";
    engine.build = build;
    return &engine;
}
