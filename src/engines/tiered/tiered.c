/* The two tiered engines.
 *
 * A routine's `run` is a function of this file. It runs the routine of the tier that `current` points to.
 * The pointer changes once, from the stitched routine to the specialized one. Both routines remain until
 * the tiered routine is freed, when no thread runs it. So the change does not wait for running threads,
 * and a thread inside the old code finishes there.
 *
 * Builds in the background use at most half of an arena; the rest is reserved for builds that draws wait
 * for. A routine holds its shader's program until it has been specialized, because the application may
 * release the shader earlier. */
#include "engines/tiered/tiered.h"

#include "machine/code.h"
#include "engines/specialize/specialize.h"
#include "shader/program/program.h"
#include "engines/stitch/stitch.h"
#include "engines/tiered/background.h"

#include <stdlib.h>

enum { TIERS = 2 };

struct tiered_options {
    const struct engine *tier[TIERS];
    routine_function *run;
};

struct tiered {
    struct routine routine; /* first: the engine interface's pointer is this structure's */
    struct background_job job;
    struct code_arena *arena;
    struct routine *tier[TIERS]; /* the background thread sets the second one before it changes `current` */
    _Atomic(struct routine *) current;
    atomic_bool called;
    const struct program *program; /* held; or null */
};

static struct tiered *tiered_of(const struct routine *routine)
{
    return (struct tiered *)(uintptr_t)routine;
}

static const struct tiered_options *options_of(const struct engine *engine)
{
    return engine->options;
}

static const struct routine *current(struct tiered *tiered)
{
    return atomic_load_explicit(&tiered->current, memory_order_acquire);
}

static const char *unavailable(const struct engine *self)
{
    for (int i = 0; i < TIERS; i++) {
        const char *reason = engine_unavailable(options_of(self)->tier[i]);
        if (reason)
            return reason;
    }
    return NULL;
}

/* --- Running
 * ------------------------------------------------------------------------------------------------------ */

/* Requests the job again if it was not accepted. */
static void request_again(struct tiered *tiered)
{
    if (atomic_load_explicit(&tiered->job.state, memory_order_relaxed) == JOB_IDLE && background_accepts())
        background_request(&tiered->job);
}

static void run(const void *call, const struct routine *routine)
{
    struct tiered *tiered = tiered_of(routine);
    const struct routine *tier = current(tiered);
    if (tier == tiered->tier[0])
        request_again(tiered);
    tier->run(call, tier);
}

static void run_swapping(const void *call, const struct routine *routine)
{
    struct tiered *tiered = tiered_of(routine);
    if (atomic_exchange(&tiered->called, true))
        tiered_wait(routine);
    const struct routine *tier = current(tiered);
    tier->run(call, tier);
}

void tiered_wait(const struct routine *routine)
{
    request_again(tiered_of(routine));
    background_wait(&tiered_of(routine)->job);
}

bool tiered_is_specialized(const struct routine *routine)
{
    return current(tiered_of(routine)) != tiered_of(routine)->tier[0];
}

/* --- Building
 * ----------------------------------------------------------------------------------------------------- */

static bool has_room(struct code_arena *arena)
{
    struct code_statistics statistics = code_statistics(arena);
    return statistics.used <= statistics.capacity / 2;
}

static void release_program(struct tiered *tiered)
{
    if (tiered->program)
        program_release(tiered->program);
    tiered->program = NULL;
}

/* Builds the second tier; null if that is not possible. */
static struct routine *build_second(const struct tiered *tiered)
{
    const struct engine *engine = options_of(tiered->routine.engine)->tier[1];
    struct error error = {{0}};
    struct routine *second = NULL;
    if (has_room(tiered->arena))
        second = engine_build(engine, tiered->arena, tiered->routine.unit, &tiered->routine.key, &error);
    if (second && !has_room(tiered->arena)) {
        engine->free(tiered->arena, second);
        second = NULL;
    }
    return second;
}

static void specialize(struct background_job *job)
{
    struct tiered *tiered = (struct tiered *)(void *)((char *)job - offsetof(struct tiered, job));
    tiered->tier[1] = build_second(tiered);
    if (tiered->tier[1])
        atomic_store_explicit(&tiered->current, tiered->tier[1], memory_order_release);
    release_program(tiered);
}

/* The fields describe the first tier. data_bytes includes an estimate for the second tier: the size of the
 * first. */
static void fill_in(struct tiered *tiered, const struct engine *engine)
{
    const struct routine *first = tiered->tier[0];
    const struct program *program = key_shader(first->unit, &first->key);
    tiered->routine = *first;
    tiered->routine.engine = engine;
    tiered->routine.run = options_of(engine)->run;
    tiered->routine.data_bytes += first->code_bytes;
    tiered->program = program ? program_hold(program->number) : NULL;
    tiered->job.work = specialize;
    atomic_init(&tiered->job.state, JOB_IDLE);
    atomic_init(&tiered->current, tiered->tier[0]);
    atomic_init(&tiered->called, false);
}

static struct routine *build(const struct engine *self, struct code_arena *arena, enum unit unit,
                             const union key *key, struct error *error)
{
    struct tiered *tiered = calloc(1, sizeof *tiered);
    if (!tiered) {
        error_set(error, "out of memory for a routine");
        return NULL;
    }
    tiered->arena = arena;
    tiered->tier[0] = engine_build(options_of(self)->tier[0], arena, unit, key, error);
    if (!tiered->tier[0]) {
        free(tiered);
        return NULL;
    }
    fill_in(tiered, self);
    background_begin();
    background_request(&tiered->job);
    return &tiered->routine;
}

static void free_routine(struct code_arena *arena, struct routine *routine)
{
    struct tiered *tiered = tiered_of(routine);
    if (!tiered)
        return;
    background_cancel(&tiered->job);
    background_end();
    release_program(tiered);
    for (int i = 0; i < TIERS; i++)
        if (tiered->tier[i])
            tiered->tier[i]->engine->free(arena, tiered->tier[i]);
    free(tiered);
}

/* Describes the first tier, which exists when listeners are called. */
static int describe(const struct routine *routine, struct debug_code *code, struct error *error)
{
    const struct routine *first = tiered_of(routine)->tier[0];
    return first->engine->describe(first, code, error);
}

const struct engine engine_tiered = {
    .name = "tiered",
    .description =
        "stitched first, specialized in the background; runs use the specialized routine when it is complete",
    .options = &(const struct tiered_options){{&engine_stitch, &engine_specialize}, run},
    .unavailable = unavailable,
    .build = build,
    .free = free_routine,
    .describe = describe,
};

const struct engine engine_tiered_swap = {
    .name = "tiered-swap",
    .description = "tiered without dependence on time: the first run is stitched, the second waits for the "
                   "specialized routine",
    .options = &(const struct tiered_options){{&engine_stitch, &engine_specialize}, run_swapping},
    .unavailable = unavailable,
    .build = build,
    .free = free_routine,
    .describe = describe,
};

const struct engine *tiered_engine(const struct engine *engine, unsigned tier)
{
    return engine->build == build && tier < TIERS ? options_of(engine)->tier[tier] : NULL;
}
