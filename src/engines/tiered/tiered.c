/* The two tiered engines.
 *
 * A routine's `run` is a function of this file. It runs the routine of the tier whose number is `current`.
 * Without the option keep all tiers that have been built remain until the tiered routine is freed, when no
 * thread runs it. So a change of the tier does not wait for running threads, and a thread inside the old code
 * finishes there. With keep, threads count themselves in and out of a tier, and heat.c frees code that no
 * thread runs.
 *
 * Builds in the background use at most half of an arena; the rest is reserved for builds that draws wait
 * for. A routine holds its shader's program until no further tier is built, because the application may
 * release the shader earlier. */
#include "base/clock.h"
#include "engines/specialize/specialize.h"
#include "engines/stitch/stitch.h"
#include "engines/tiered/tier.h"
#include "machine/code.h"
#include "shader/program/program.h"

#include <stddef.h>
#include <stdlib.h>

static unsigned current(struct tiered *tiered)
{
    return atomic_load_explicit(&tiered->current, memory_order_acquire);
}

static const char *unavailable(const struct engine *self)
{
    for (unsigned i = 0; tiered_engine(self, i); i++) {
        const char *reason = engine_unavailable(tiered_engine(self, i));
        if (reason)
            return reason;
    }
    return NULL;
}

/* --- Running -------------------------------------------------------------------------------------------- */

/* Requests the build of the next tier, if there is one: again if it was not accepted before. */
static void request_next(struct tiered *tiered)
{
    if (atomic_load(&tiered->current) >= atomic_load(&tiered->highest))
        return;
    if (atomic_load_explicit(&tiered->job.state, memory_order_relaxed) != JOB_QUEUED && background_accepts())
        background_request(&tiered->job);
}

/* Requests the next tiers that the routine has earned. Returns the tier to run. */
static unsigned climb(struct tiered *tiered)
{
    unsigned tier = current(tiered);
    while (tiered_has_earned(tiered, tier)) {
        request_next(tiered);
        if (!tiered_options_of(tiered)->waits)
            break;
        background_wait(&tiered->job);
        if (current(tiered) == tier)
            break;
        tier = current(tiered);
    }
    return tier;
}

static void run(const void *arguments, const struct routine *routine)
{
    struct tiered *tiered = tiered_of(routine);
    unsigned tier = climb(tiered);
    tiered_count(tiered, tier, arguments);
    tiered->tier[tier]->run(arguments, tiered->tier[tier]);
}

/* Counts the thread in. The second reading finds a tier that is not dropped (heat.c). */
static unsigned enter(struct tiered *tiered)
{
    for (;;) {
        unsigned tier = atomic_load(&tiered->current);
        atomic_fetch_add(&tiered->inside[tier], 1);
        if (atomic_load(&tiered->current) == tier)
            return tier;
        atomic_fetch_sub(&tiered->inside[tier], 1);
    }
}

static void run_kept(const void *arguments, const struct routine *routine)
{
    struct tiered *tiered = tiered_of(routine);
    climb(tiered);
    unsigned tier = enter(tiered);
    tiered_count(tiered, tier, arguments);
    tiered->tier[tier]->run(arguments, tiered->tier[tier]);
    atomic_fetch_sub(&tiered->inside[tier], 1);
}

void tiered_wait(const struct routine *routine)
{
    request_next(tiered_of(routine));
    background_wait(&tiered_of(routine)->job);
}

bool tiered_is_specialized(const struct routine *routine)
{
    return current(tiered_of(routine)) + 1 == tiered_options_of(tiered_of(routine))->count;
}

/* --- Building ------------------------------------------------------------------------------------------- */

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

/* Builds a tier; null if that is not possible. */
static struct routine *build_tier(struct tiered *tiered, unsigned tier, struct error *error)
{
    uint64_t start = clock_ns();
    struct routine *built = engine_build(tiered_options_of(tiered)->tier[tier], tiered->arena,
                                         tiered->routine.unit, &tiered->routine.key, error);
    struct routine_tier *counts = tiered->tiers.tier + tier;
    __atomic_fetch_add(&counts->build_ns, clock_ns() - start, __ATOMIC_RELAXED);
    __atomic_fetch_add(&counts->builds, built != NULL, __ATOMIC_RELAXED);
    __atomic_store_n(&counts->code_bytes, built ? built->code_bytes : 0, __ATOMIC_RELAXED);
    return built;
}

/* Builds a later tier, if half of the arena is free. */
static struct routine *build_later(struct tiered *tiered, unsigned tier)
{
    struct error error = {{0}};
    struct routine *built = has_room(tiered->arena) ? build_tier(tiered, tier, &error) : NULL;
    if (built && !has_room(tiered->arena)) {
        built->engine->free(tiered->arena, built);
        __atomic_store_n(&tiered->tiers.tier[tier].code_bytes, 0, __ATOMIC_RELAXED);
        built = NULL;
    }
    return built;
}

/* In the background thread. No other thread changes the tiers of a routine. */
static void build_next(struct background_job *job)
{
    struct tiered *tiered = (struct tiered *)(void *)((char *)job - offsetof(struct tiered, job));
    unsigned tier = atomic_load(&tiered->current) + 1;
    /* A thread may have requested this before the job that it did not see raised the tier. */
    if (tier > atomic_load(&tiered->highest))
        return;
    if (!tiered->tier[tier])
        tiered->tier[tier] = build_later(tiered, tier);
    if (tiered->tier[tier]) {
        tiered_raise(tiered, tier);
        tiered_drop_coldest(tiered);
    } else {
        atomic_store(&tiered->highest, tier - 1);
    }
    if (tiered_options_of(tiered)->keep == KEEP_ALL &&
        atomic_load(&tiered->current) >= atomic_load(&tiered->highest))
        release_program(tiered);
}

enum { TYPICAL_BYTES = 4096 };

/* The fields describe the first tier, except that calls are padded for the widest tier. data_bytes includes
 * an estimate for the code of later tiers: the bytes of the first tier, for each. */
static void fill_in(struct tiered *tiered, const struct engine *engine)
{
    const struct routine *first = tiered->tier[0];
    const struct program *program = key_shader(first->unit, &first->key);
    const struct tiered_options *options = engine->options;
    uint32_t typical = first->code_bytes ? first->code_bytes : TYPICAL_BYTES;
    tiered->routine = *first;
    tiered->routine.engine = engine;
    tiered->routine.run = options->keep == KEEP_ALL ? run : run_kept;
    tiered->routine.data_bytes += typical * (options->keep == KEEP_ALL ? options->count - 1 : 1);
    tiered->routine.lanes = 0;
    tiered->routine.tiers = &tiered->tiers;
    tiered->program = program ? program_hold(program->number) : NULL;
    tiered->job.work = build_next;
    tiered->highest = options->count - 1;
}

static void name_tiers(struct tiered *tiered, const struct tiered_options *options)
{
    tiered->tiers.count = options->count;
    for (unsigned i = 0; i < options->count; i++)
        tiered->tiers.tier[i].engine = options->tier[i]->name;
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
    tiered->routine = (struct routine){.engine = self, .unit = unit, .key = *key};
    name_tiers(tiered, self->options);
    tiered->tier[0] = build_tier(tiered, 0, error);
    if (!tiered->tier[0]) {
        free(tiered);
        return NULL;
    }
    fill_in(tiered, self);
    background_begin();
    if (tiered_has_earned(tiered, 0))
        request_next(tiered);
    return &tiered->routine;
}

static void free_routine(struct code_arena *arena, struct routine *routine)
{
    struct tiered *tiered = tiered_of(routine);
    if (!tiered)
        return;
    background_cancel(&tiered->job);
    tiered_forget(tiered);
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

/* --- The engines ---------------------------------------------------------------------------------------- */

const struct engine engine_tiered = {
    .name = "tiered",
    .description =
        "stitched first, specialized in the background; runs use the specialized routine when it is complete",
    .options = &(const struct tiered_options){.count = 2,
                                              .tier = {&engine_stitch, &engine_specialize},
                                              .hysteresis = 2},
    .unavailable = unavailable,
    .build = build,
    .free = free_routine,
    .describe = describe,
};

const struct engine engine_tiered_swap = {
    .name = "tiered-swap",
    .description = "tiered without dependence on time: the first run is stitched, the second waits for the "
                   "specialized routine",
    .options = &(const struct tiered_options){.count = 2,
                                              .tier = {&engine_stitch, &engine_specialize},
                                              .runs = {1, {1}},
                                              .hysteresis = 2,
                                              .waits = true},
    .unavailable = unavailable,
    .build = build,
    .free = free_routine,
    .describe = describe,
};

bool tiered_is_engine(const struct engine *engine)
{
    return engine->build == build;
}

const struct engine *tiered_engine(const struct engine *engine, unsigned tier)
{
    const struct tiered_options *options = engine->options;
    return tiered_is_engine(engine) && tier < options->count ? options->tier[tier] : NULL;
}
