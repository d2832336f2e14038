/* The naive emulator's engine: the specification under the lane binding, and the loops of the three units
 * around it.
 *
 * To build a routine is to store the key. Every run makes every decision on the state again for every four
 * elements. The thesis calls this emulation by switch (section 2.4.1). The compiler cannot specialise the
 * code, because keys are known only at run time. */
#include "emu/emulate/emulate.h"

#include "machine/cpu.h"
#include "machine/mxcsr.h"
#include "emu/emulate/bind.h"
#include "spec/spec.h"

#include <stdlib.h>

/* A routine, with values that depend only on the key. */
struct emulate_routine {
    struct routine routine;
    const struct program *program;
    struct triangle_layout layout;
    bool fuses;
};

static const struct emulate_routine *emulate_routine(const struct routine *routine)
{
    return (const struct emulate_routine *)(const void *)routine;
}

/* Prepares an environment for a run of the routine with this job. */
static void begin(struct env *e, const struct routine *routine, const struct job *job)
{
    e->program = emulate_routine(routine)->program;
    e->fuses = emulate_routine(routine)->fuses;
    e->base[BASE_JOB] = (const uint8_t *)job;
    if (e->program)
        e->base[BASE_CONSTANT] = (const uint8_t *)job->constants[e->program->model->stage];
}

static void emulate_vertex(const void *arguments, const struct routine *routine)
{
    const struct vertex_arguments *call = arguments;
    unsigned saved = mxcsr_enter();
    struct env e;
    begin(&e, routine, call->job);
    for (uint32_t i = 0; i < call->count; i += EMULATE_WIDTH) {
        e.base[BASE_INPUT] = (const uint8_t *)(call->index + i);
        e.base[BASE_OUTPUT] = (const uint8_t *)(call->out + i);
        spec_vertex(&e, &routine->key.vertex);
    }
    mxcsr_leave(saved);
}

static void emulate_setup(const void *arguments, const struct routine *routine)
{
    const struct setup_arguments *call = arguments;
    const struct triangle_layout *layout = &emulate_routine(routine)->layout;
    unsigned saved = mxcsr_enter();
    struct env e;
    begin(&e, routine, call->job);
    e.base[BASE_VERTICES] = (const uint8_t *)call->vertices;
    for (uint32_t i = 0; i < call->count; i += EMULATE_WIDTH) {
        e.base[BASE_INPUT] = (const uint8_t *)(call->index + i);
        e.base[BASE_OUTPUT] = call->out + (size_t)i * layout->stride;
        spec_setup(&e, &routine->key.setup, layout);
    }
    mxcsr_leave(saved);
}

static void emulate_block(struct env *e, const struct pixel_arguments *call, const struct entry *entry,
                          const struct emulate_routine *routine)
{
    e->base[BASE_ENTRY] = (const uint8_t *)entry;
    e->base[BASE_TRIANGLE] = call->triangles + entry->triangle;
    for (uint32_t lane = 0; lane < BLOCK_PIXELS; lane += EMULATE_WIDTH) {
        if (!(entry->coverage >> lane & ((1 << EMULATE_WIDTH) - 1)))
            continue;
        size_t word = (size_t)entry->block * BLOCK_PIXELS + lane;
        e->base[BASE_LANES] = (const uint8_t *)call->lanes + 4 * lane;
        e->base[BASE_COLOR] = (const uint8_t *)(call->color + word);
        e->base[BASE_DEPTH] = (const uint8_t *)(call->depth + word);
        spec_pixel(e, &routine->routine.key.pixel, &routine->layout);
    }
}

static void emulate_pixel(const void *arguments, const struct routine *routine)
{
    const struct pixel_arguments *call = arguments;
    unsigned saved = mxcsr_enter();
    struct env e;
    begin(&e, routine, call->job);
    for (uint32_t i = 0; i < call->count; i++)
        emulate_block(&e, call, call->entries + i, emulate_routine(routine));
    mxcsr_leave(saved);
}

static struct routine *build(const struct engine *self, struct code_arena *arena, enum unit unit,
                             const union key *key, struct error *error)
{
    static routine_function *const run[UNIT_COUNT] = {emulate_vertex, emulate_setup, emulate_pixel};
    (void)arena;
    struct emulate_routine *routine = calloc(1, sizeof *routine);
    if (!routine) {
        error_set(error, "out of memory for a routine");
        return NULL;
    }
    routine->program = key_shader(unit, key);
    routine->layout = layout_of_unit(unit, key);
    routine->fuses = cpu_has_avx2_fma();
    routine->routine = (struct routine){.run = run[unit],
                                        .engine = self,
                                        .unit = unit,
                                        .key = *key,
                                        .data_bytes = sizeof *routine - sizeof routine->routine};
    return &routine->routine;
}

static void free_routine(struct code_arena *arena, struct routine *routine)
{
    (void)arena;
    free(routine);
}

const struct engine engine_emulate = {
    .name = "emulate",
    .description = "naive emulator: the specification performed, every state decided for every four elements",
    .width = EMULATE_WIDTH,
    .without_arena = true,
    .build = build,
    .free = free_routine,
};
