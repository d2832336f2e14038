/* The batch interpreter's engines: the loops that put batches together, and a lane count each.
 *
 * Vertices and triangles come in order, and a batch is as many as fit. For pixels a batch gathers quads with
 * coverage from consecutive entries. A quad that is in the batch already ends it, for the second one has to
 * find what the first has written; nothing else in a pixel call depends on the order, but for counters: the
 * quads of all blocks add up in one place for each of a block's four, so routines that count end a batch
 * there. The frame is on the stack, as routines run on many threads at once. */
#include "emu/batch.h"

#include "base/mxcsr.h"
#include "shader/program.h"

#include <stdlib.h>
#include <string.h>

enum { BATCH_LANES = 64, FRAME_ALIGNMENT = 64, BLOCK_QUADS = BLOCK_PIXELS / GROUP_LANES };

struct batch_routine {
    struct routine routine;
    struct plan *plan;
};

const struct plan *batch_plan(const struct routine *routine)
{
    return ((const struct batch_routine *)(const void *)routine)->plan;
}

static void set_common(struct batch *batch, enum base base, const void *address)
{
    for (int group = 0; group < GROUPS_MAXIMUM; group++)
        batch->base[base][group] = address;
}

static void flush(struct batch *batch, const struct plan *plan)
{
    if (batch->groups[0])
        plan_run(plan, batch);
    batch->groups[0] = 0;
}

static unsigned add_group(struct batch *batch, const struct plan *plan)
{
    if (batch->groups[0] * GROUP_LANES == plan->lanes)
        flush(batch, plan);
    return batch->groups[0]++;
}

static void run_vertices(struct batch *batch, const struct plan *plan, const struct vertex_call *call)
{
    set_common(batch, BASE_JOB, call->job);
    set_common(batch, BASE_CONSTANT, call->job->constants[STAGE_VERTEX]);
    for (uint32_t i = 0; i < call->count; i += GROUP_LANES) {
        unsigned group = add_group(batch, plan);
        batch->base[BASE_INPUT][group] = (const uint8_t *)(call->index + i);
        batch->base[BASE_OUTPUT][group] = (const uint8_t *)(call->out + i);
    }
    flush(batch, plan);
}

static void run_setup(struct batch *batch, const struct plan *plan, const struct setup_call *call,
                      size_t stride)
{
    set_common(batch, BASE_JOB, call->job);
    set_common(batch, BASE_VERTICES, call->vertices);
    for (uint32_t i = 0; i < call->count; i += GROUP_LANES) {
        unsigned group = add_group(batch, plan);
        batch->base[BASE_INPUT][group] = (const uint8_t *)(call->index + i);
        batch->base[BASE_OUTPUT][group] = call->out + i * stride;
    }
    flush(batch, plan);
}

/* Which quads a pixel batch holds: of each block of the tile, and at all. */
struct held {
    uint8_t block[TILE_BLOCKS];
    unsigned places;
};

static void add_quad(struct batch *batch, const struct plan *plan, const struct pixel_call *call,
                     const struct entry *entry, unsigned quad, struct held *held)
{
    unsigned bit = 1u << quad;
    if (batch->groups[0] * GROUP_LANES == plan->lanes || held->block[entry->block] & bit ||
        (plan->counts && held->places & bit)) {
        flush(batch, plan);
        memset(held, 0, sizeof *held);
    }
    held->block[entry->block] |= (uint8_t)bit;
    held->places |= bit;
    unsigned group = batch->groups[0]++, lane = quad * GROUP_LANES;
    size_t word = (size_t)entry->block * BLOCK_PIXELS + lane;
    batch->base[BASE_ENTRY][group] = (const uint8_t *)entry;
    batch->base[BASE_TRIANGLE][group] = call->triangles + entry->triangle;
    batch->base[BASE_LANES][group] = (const uint8_t *)call->lanes + 4 * lane;
    batch->base[BASE_COLOR][group] = (const uint8_t *)(call->color + word);
    batch->base[BASE_DEPTH][group] = (const uint8_t *)(call->depth + word);
}

static void run_pixels(struct batch *batch, const struct plan *plan, const struct pixel_call *call)
{
    struct held held = {0};
    set_common(batch, BASE_JOB, call->job);
    set_common(batch, BASE_CONSTANT, call->job->constants[STAGE_PIXEL]);
    for (uint32_t i = 0; i < call->count; i++)
        for (unsigned quad = 0; quad < BLOCK_QUADS; quad++)
            if (call->entries[i].coverage >> quad * GROUP_LANES & ((1 << GROUP_LANES) - 1))
                add_quad(batch, plan, call, call->entries + i, quad, &held);
    flush(batch, plan);
}

static void run(const void *call, const struct routine *routine)
{
    const struct plan *plan = batch_plan(routine);
    uint8_t stack[plan->frame_bytes + FRAME_ALIGNMENT];
    struct batch batch;
    unsigned saved = mxcsr_enter();
    batch.frame = stack + (-(uintptr_t)stack & (FRAME_ALIGNMENT - 1));
    batch.groups[0] = 0;
    batch.groups[1] = 1;
    plan_start(plan, batch.frame);
    switch (routine->unit) {
    case UNIT_VERTEX: run_vertices(&batch, plan, call); break;
    case UNIT_SETUP: run_setup(&batch, plan, call, setup_layout(&routine->key.setup).stride); break;
    default: run_pixels(&batch, plan, call); break;
    }
    mxcsr_leave(saved);
}

struct routine *batch_routine(const struct ir *ir, unsigned lanes, enum unit unit, const union key *key,
                              struct error *error)
{
    struct batch_routine *batch = calloc(1, sizeof *batch);
    if (!batch) {
        error_set(error, "out of memory for a routine");
        return NULL;
    }
    batch->plan = plan_create(ir, lanes, error);
    if (!batch->plan) {
        free(batch);
        return NULL;
    }
    struct routine *routine = &batch->routine;
    routine->run = run;
    routine->unit = unit;
    routine->key = *key;
    routine->parts = batch->plan->count;
    routine->data_bytes = (uint32_t)(sizeof *batch + batch->plan->count * sizeof(struct plan_step));
    return routine;
}

static struct routine *build_with(const struct engine *engine, enum unit unit, const union key *key,
                                  struct error *error)
{
    struct ir *ir = ir_take(unit, key, error);
    if (!ir)
        return NULL;
    struct routine *routine = batch_routine(ir, (unsigned)engine->width, unit, key, error);
    ir_give(ir);
    if (routine)
        routine->engine = engine;
    return routine;
}

static void free_routine(struct code_arena *arena, struct routine *routine)
{
    (void)arena;
    plan_free(((struct batch_routine *)(void *)routine)->plan);
    free(routine);
}

static const char *unavailable(void)
{
    return NULL;
}

/* The engines differ in their width alone, and builders are told no engine: one for each. */
#define ENGINE(variable, title, lanes, named)                                                                \
    static struct routine *build_##variable(struct code_arena *arena, enum unit unit, const union key *key,  \
                                            struct error *error)                                             \
    {                                                                                                        \
        (void)arena;                                                                                         \
        return build_with(&engine_##variable, unit, key, error);                                             \
    }                                                                                                        \
    const struct engine engine_##variable = {                                                                \
        .name = title,                                                                                       \
        .description = "interpreter of the recording, one operation at a time over batches of elements",     \
        .width = lanes,                                                                                      \
        .without_arena = 1,                                                                                  \
        .on_request = named,                                                                                 \
        .unavailable = unavailable,                                                                          \
        .build = build_##variable,                                                                           \
        .free = free_routine,                                                                                \
    };

ENGINE(batch, "batch", BATCH_LANES, 0)
#define BATCH(lanes) ENGINE(batch_##lanes, "batch-" #lanes, lanes, 1)
#include "def/batch.def"
#undef BATCH
