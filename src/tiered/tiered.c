/* The two tiered engines.
 *
 * A routine's `run` is a function here that calls the routine of the tier that `current` points at. The pointer changes
 * once, from the stitched routine to the specialized one, and both stay until the routine is freed, when nobody runs it:
 * so no call has to be waited for, no frame has to end, and who is in the middle of the old code stays there.
 *
 * Builds in the background leave half of an arena to what draws wait for. A
 * shader's program is held until its routine has been specialized, for the application may let go of it meanwhile. */
#include "tiered/tiered.h"

#include "base/code.h"
#include "jit/jit.h"
#include "shader/program.h"
#include "stitch/stitch.h"
#include "tiered/background.h"

#include <stdlib.h>

enum { TIERS = 2 };

static const struct engine *const tiers[TIERS] = {&engine_stitch, &engine_specialize};

struct tiered {
    struct routine routine; /* first: the engine interface's pointer is this structure's */
    struct background_job job;
    struct code_arena *arena;
    struct routine
        *tier[TIERS]; /* the second one, if there is one, by the thread in the background until `current` */
    _Atomic(struct routine *) current;
    atomic_bool called;
    const struct program *program; /* held; or null */
};

static struct tiered *tiered_of(const struct routine *routine)
{
    return (struct tiered *)(uintptr_t)routine;
}

static const struct routine *current(struct tiered *tiered)
{
    return atomic_load_explicit(&tiered->current, memory_order_acquire);
}

static const char *unavailable(void)
{
    for (int i = 0; i < TIERS; i++) {
        const char *reason = tiers[i]->unavailable();
        if (reason)
            return reason;
    }
    return NULL;
}

/* --- Running ------------------------------------------------------------------------------------------------------ */

/* Asks once more if the job was not accepted. */
static void ask_again(struct tiered *tiered)
{
    if (atomic_load_explicit(&tiered->job.state, memory_order_relaxed) == JOB_IDLE && background_accepts())
        background_ask(&tiered->job);
}

static void run(const void *call, const struct routine *routine)
{
    struct tiered *tiered = tiered_of(routine);
    const struct routine *tier = current(tiered);
    if (tier == tiered->tier[0])
        ask_again(tiered);
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
    ask_again(tiered_of(routine));
    background_wait(&tiered_of(routine)->job);
}

int tiered_is_specialized(const struct routine *routine)
{
    return current(tiered_of(routine)) != tiered_of(routine)->tier[0];
}

/* --- Building ----------------------------------------------------------------------------------------------------- */

static bool has_room(struct code_arena *arena)
{
    struct code_statistics statistics = code_statistics(arena);
    return statistics.used <= statistics.capacity / 2;
}

static void let_go_of_program(struct tiered *tiered)
{
    if (tiered->program)
        program_release(tiered->program);
    tiered->program = NULL;
}

/* Null if there is none to be had. */
static struct routine *build_second(const struct tiered *tiered)
{
    struct error error = {{0}};
    struct routine *second = NULL;
    if (has_room(tiered->arena))
        second = tiers[1]->build(tiered->arena, tiered->routine.unit, &tiered->routine.key, &error);
    if (second && !has_room(tiered->arena)) {
        tiers[1]->free(tiered->arena, second);
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
    let_go_of_program(tiered);
}

/* What is known of the routine is known of its first tier; its price includes as much again for the second. */
static void fill_in(struct tiered *tiered, const struct engine *engine, routine_function *run_tier)
{
    const struct routine *first = tiered->tier[0];
    const struct program *program = key_shader(first->unit, &first->key);
    tiered->routine = *first;
    tiered->routine.engine = engine;
    tiered->routine.run = run_tier;
    tiered->routine.data_bytes += first->code_bytes;
    tiered->program = program ? program_hold(program->number) : NULL;
    tiered->job.work = specialize;
    atomic_init(&tiered->job.state, JOB_IDLE);
    atomic_init(&tiered->current, tiered->tier[0]);
    atomic_init(&tiered->called, false);
}

static struct routine *build_with(const struct engine *engine, routine_function *run_tier,
                                  struct code_arena *arena, enum unit unit, const union key *key,
                                  struct error *error)
{
    struct tiered *tiered = calloc(1, sizeof *tiered);
    if (!tiered) {
        error_set(error, "out of memory for a routine");
        return NULL;
    }
    tiered->arena = arena;
    tiered->tier[0] = tiers[0]->build(arena, unit, key, error);
    if (!tiered->tier[0]) {
        free(tiered);
        return NULL;
    }
    fill_in(tiered, engine, run_tier);
    background_begin();
    background_ask(&tiered->job);
    return &tiered->routine;
}

static struct routine *build(struct code_arena *arena, enum unit unit, const union key *key,
                             struct error *error)
{
    return build_with(&engine_tiered, run, arena, unit, key, error);
}

static struct routine *build_swapping(struct code_arena *arena, enum unit unit, const union key *key,
                                      struct error *error)
{
    return build_with(&engine_tiered_swap, run_swapping, arena, unit, key, error);
}

static void free_routine(struct code_arena *arena, struct routine *routine)
{
    struct tiered *tiered = tiered_of(routine);
    if (!tiered)
        return;
    background_cancel(&tiered->job);
    background_end();
    let_go_of_program(tiered);
    for (int i = 0; i < TIERS; i++)
        if (tiered->tier[i])
            tiers[i]->free(arena, tiered->tier[i]);
    free(tiered);
}

/* Of the first tier, which is there when somebody is told. */
static int describe(const struct routine *routine, struct debug_code *code, struct error *error)
{
    return tiers[0]->describe(tiered_of(routine)->tier[0], code, error);
}

const struct engine engine_tiered = {
    .name = "tiered",
    .description = "stitched at once, specialized in the background, calls go there when that is ready",
    .width = 0,
    .unavailable = unavailable,
    .build = build,
    .free = free_routine,
    .describe = describe,
};

const struct engine engine_tiered_swap = {
    .name = "tiered-swap",
    .description =
        "tiered, not left to the clock: first calls are stitched, second ones wait for the specialized",
    .width = 0,
    .unavailable = unavailable,
    .build = build_swapping,
    .free = free_routine,
    .describe = describe,
};

const struct engine *tiered_engine(const struct engine *engine, unsigned tier)
{
    return (engine == &engine_tiered || engine == &engine_tiered_swap) && tier < TIERS ? tiers[tier] : NULL;
}
