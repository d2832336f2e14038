/* Plans: appending parts, and the loop around the parts of every routine. */
#include "engines/stitch/plan.h"

#include "machine/mxcsr.h"

#include <stdatomic.h>
#include <stdlib.h>

/* A plan that is not in use, or null. Simultaneous builds, which are rare, allocate their own. */
static _Atomic(struct plan *) spare;

/* When the library is unloaded or the process ends. */
__attribute__((destructor)) static void free_spare(void)
{
    free(atomic_exchange(&spare, NULL));
}

struct plan *plan_take(struct error *error)
{
    struct plan *plan = atomic_exchange(&spare, NULL);
    if (!plan)
        plan = malloc(sizeof *plan);
    if (!plan)
        error_set(error, "out of memory for a plan (%zu bytes)", sizeof *plan);
    return plan;
}

void plan_give(struct plan *plan)
{
    free(atomic_exchange(&spare, plan));
}

static int exceeds(struct error *error, const char *what, unsigned more, unsigned room)
{
    return error_set(error, "the stitcher's plan of %u %s exceeds its room of %u", room + more, what, room);
}

int plan_complete(const struct plan *plan, struct error *error)
{
    if (plan->missing)
        return error_set(error, "the stitcher lacks a fragment for a part of the plan");
    if (plan->dropped)
        return exceeds(error, "parts", plan->dropped, PART_CAPACITY);
    if (plan->unrecorded)
        return exceeds(error, "operations", plan->unrecorded, OPERATION_CAPACITY);
    if (plan->unpooled)
        return exceeds(error, "literals", plan->unpooled, POOL_CAPACITY);
    if (plan->depth > NESTING_MAXIMUM)
        return exceeds(error, "regions in one another", plan->depth - NESTING_MAXIMUM, NESTING_MAXIMUM);
    if (plan->lost)
        return error_set(error, "the stitcher's plan reads %u values outside of their region", plan->lost);
    if (plan->frame_bytes > FRAME_BYTES_MAXIMUM)
        return error_set(error, "the stitcher's frame of %d bytes exceeds its room of %d",
                         (int)plan->frame_bytes, FRAME_BYTES_MAXIMUM);
    return 0;
}

static uint32_t vectors(const struct part *part, unsigned arguments)
{
    uint32_t mask = 0;
    for (; arguments; arguments &= arguments - 1)
        mask |= 1u << (REGISTER_VECTORS + part->arguments.value[__builtin_ctz(arguments)]);
    return mask;
}

uint32_t part_reads(const struct part *part)
{
    uint32_t base = part->fragment->based ? 1u << part->arguments.value[ARGUMENT_BASE] : 0;
    return part->fragment->in | base | vectors(part, part->fragment->read);
}

uint32_t part_gives(const struct part *part)
{
    return part->fragment->out | vectors(part, part->fragment->given);
}

uint32_t part_changes(const struct part *part)
{
    return part->fragment->clobbered | part_gives(part);
}

void plan_land(struct plan *plan, unsigned part, unsigned n)
{
    plan->part[part].arguments.value[n] = (int32_t)plan->count;
}

#define FIELD(unit, field) (int32_t) offsetof(struct unit##_arguments, field)
#define ENTRY(field)       (int32_t) offsetof(struct entry, field)

static unsigned begin_vertex(struct plan *plan)
{
    const union arguments fields = {.vertex_begin = {.job = FIELD(vertex, job),
                                                     .index = FIELD(vertex, index),
                                                     .out = FIELD(vertex, out),
                                                     .count = FIELD(vertex, count)}};
    return plan_append(plan, &fragment_vertex_begin, fields);
}

/* The loop of vertices: an element reads and writes a word of each array. */
static unsigned begin_blit(struct plan *plan)
{
    const union arguments fields = {.vertex_begin = {.job = FIELD(blit, job),
                                                     .index = FIELD(blit, index),
                                                     .out = FIELD(blit, out),
                                                     .count = FIELD(blit, count)}};
    return plan_append(plan, &fragment_vertex_begin, fields);
}

static unsigned begin_setup(struct plan *plan)
{
    const union arguments fields = {.setup_begin = {.job = FIELD(setup, job),
                                                    .index = FIELD(setup, index),
                                                    .vertices = FIELD(setup, vertices),
                                                    .out = FIELD(setup, out),
                                                    .count = FIELD(setup, count)}};
    return plan_append(plan, &fragment_setup_begin, fields);
}

static unsigned begin_pixel(struct plan *plan)
{
    const union arguments fields = {.pixel_begin = {.job = FIELD(pixel, job),
                                                    .entries = FIELD(pixel, entries),
                                                    .count = FIELD(pixel, count)}};
    return plan_append(plan, &fragment_pixel_begin, fields);
}

void plan_enter(struct plan *plan)
{
    plan->count = plan->dropped = plan->missing = plan->unrecorded = plan->unpooled = plan->depth =
        plan->lost = 0;
    plan->literals = plan->variables = 0;
    plan->operations = 1;
    plan->stored = 0;
    plan->frame_bytes = 0;
    plan->counts = (struct plan_counts){0};
    plan->operation[0] = (struct operation){0};
    plan->value[0] = (struct value){0};
    plan_append(plan, &fragment_enter, (union arguments){.enter = {.mxcsr = MXCSR_CONTRACT}});
}

struct loop plan_begin_call(struct plan *plan, enum unit unit)
{
    static unsigned (*const begin[UNIT_ALL])(struct plan *) = {[UNIT_VERTEX] = begin_vertex,
                                                               [UNIT_SETUP] = begin_setup,
                                                               [UNIT_PIXEL] = begin_pixel,
                                                               [UNIT_BLIT] = begin_blit};
    return (struct loop){.begin = begin[unit](plan)};
}

void plan_begin_loop(struct plan *plan, enum unit unit, struct loop *loop)
{
    const union arguments block = {.pixel_entry = {.triangle = ENTRY(triangle),
                                                   .coverage = ENTRY(coverage),
                                                   .block = ENTRY(block),
                                                   .triangles = FIELD(pixel, triangles),
                                                   .lanes = FIELD(pixel, lanes),
                                                   .color = FIELD(pixel, color),
                                                   .depth = FIELD(pixel, depth)}};
    loop->top = plan->count;
    if (unit != UNIT_PIXEL)
        return;
    plan_append(plan, &fragment_pixel_entry, block);
    loop->chunk = plan_append_plain(plan, &fragment_pixel_chunk);
}

struct loop plan_begin(struct plan *plan, enum unit unit)
{
    struct loop loop = plan_begin_call(plan, unit);
    plan_begin_loop(plan, unit, &loop);
    return loop;
}

void plan_leave(struct plan *plan, enum unit unit, const union key *key, const struct loop *loop,
                int frame_bytes)
{
    int32_t top = (int32_t)loop->top;
    plan->frame_bytes = frame_bytes;
    plan->part[0].arguments.enter.frame = -frame_bytes;
    switch (unit) {
    case UNIT_VERTEX:
    case UNIT_BLIT:
        plan_append(plan, &fragment_vertex_next, (union arguments){.vertex_next = {.to_loop = top}});
        plan_land(plan, loop->begin, ARGUMENT(vertex_begin, to_leave));
        break;
    case UNIT_SETUP: {
        int32_t stride = layout_of_setup(&key->setup).stride;
        plan_append(plan, &fragment_setup_next,
                    (union arguments){.setup_next = {.records = 8 * stride, .to_loop = top}});
        plan_land(plan, loop->begin, ARGUMENT(setup_begin, to_leave));
        break;
    }
    default:
        plan_land(plan, loop->chunk, ARGUMENT(pixel_chunk, to_next));
        plan_append(plan, &fragment_pixel_next,
                    (union arguments){.pixel_next = {.to_chunk = (int32_t)loop->chunk, .to_entry = top}});
    }
    plan_append_plain(plan, &fragment_leave);
}
