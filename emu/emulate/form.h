/* A form of the emulator: the specification under the lane binding, and the loops of the units around
 * it. A file of a form defines these names and includes this one:
 *
 *   FORM        the name of the form
 *   FORM_ARRAY  1: float registers are in one array (emu/emulate/array.h); 0: in the files of the machine
 *   FORM_ONCE   1: shader instructions are decoded in the build (emu/emulate/once.h); 0: in every run */
#include "emu/emulate/bind.h"
#include "emu/emulate/routine.h"
#include "machine/mxcsr.h"

#if FORM_ARRAY
#define MACHINE(e, m)  struct machine *const m = (e)->machine
#define READ_REGISTERS array_read
#endif
#if FORM_ONCE
#define EXECUTE_NEXT once_execute
#endif

#if FORM_ARRAY
#include "emu/emulate/array.h"
#endif
#if FORM_ONCE
#include "emu/emulate/once.h"
#endif
#include "spec/spec.h"

static size_t prepare(struct emulate_routine *routine)
{
    (void)routine;
#if FORM_ARRAY
    array_prepare(routine);
#endif
#if FORM_ONCE
    return once_prepare(routine);
#else
    return 0;
#endif
}

static const struct emulate_routine *emulate_routine(const struct routine *routine)
{
    return (const struct emulate_routine *)(const void *)routine;
}

/* Prepares an environment for a run of the routine with this job. */
static void begin(struct env *e, const struct routine *routine, const struct job *job)
{
    e->routine = emulate_routine(routine);
    e->program = e->routine->program;
    e->fuses = e->routine->fuses;
    e->base[BASE_JOB] = (const uint8_t *)job;
    if (e->program)
        e->base[BASE_CONSTANT] = (const uint8_t *)job->constants[e->program->model->stage];
}

/* Memory for the machine that MACHINE finds, and its constants. */
#if FORM_ARRAY
#define BEGIN_SHADER(e)                                                                                      \
    union register_array array;                                                                              \
    if ((e)->program)                                                                                        \
    array_begin(e, &array)
#else
#define BEGIN_SHADER(e) (void)(e)
#endif

static void emulate_vertex(const void *arguments, const struct routine *routine)
{
    const struct vertex_arguments *call = arguments;
    unsigned saved = mxcsr_enter();
    struct env e;
    begin(&e, routine, call->job);
    BEGIN_SHADER(&e);
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
    BEGIN_SHADER(&e);
    for (uint32_t i = 0; i < call->count; i++)
        emulate_block(&e, call, call->entries + i, emulate_routine(routine));
    mxcsr_leave(saved);
}

static void emulate_blit(const void *arguments, const struct routine *routine)
{
    const struct blit_arguments *call = arguments;
    unsigned saved = mxcsr_enter();
    struct env e = {.fuses = emulate_routine(routine)->fuses};
    e.base[BASE_JOB] = (const uint8_t *)call->job;
    for (uint32_t i = 0; i < call->count; i += EMULATE_WIDTH) {
        e.base[BASE_INPUT] = (const uint8_t *)(call->index + i);
        e.base[BASE_OUTPUT] = (const uint8_t *)(call->out + i);
        spec_blit(&e, &routine->key.blit);
    }
    mxcsr_leave(saved);
}

const struct emulate_form FORM = {{[UNIT_VERTEX] = emulate_vertex,
                                   [UNIT_SETUP] = emulate_setup,
                                   [UNIT_PIXEL] = emulate_pixel,
                                   [UNIT_BLIT] = emulate_blit},
                                  prepare};
