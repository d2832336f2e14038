/* Plans: appending parts, and the loops that every routine has around its own. */
#include "stitch/plan.h"

#include "base/mxcsr.h"

#include <stdatomic.h>
#include <stdlib.h>

/* One plan that nobody uses, or none. Builds at the same time, which are rare, make their own. */
static _Atomic(struct plan *) spare;

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

#define CALL(unit, field) (int32_t) offsetof(struct unit##_call, field)
#define ENTRY(field)      (int32_t) offsetof(struct entry, field)

static struct loop begin_vertex(struct plan *plan)
{
    struct arguments fields = {
        {CALL(vertex, job), CALL(vertex, index), CALL(vertex, out), CALL(vertex, count)}};
    struct loop loop = {.begin = plan_append(plan, &fragment_vertex_begin, fields)};
    loop.top = plan->count;
    return loop;
}

static struct loop begin_setup(struct plan *plan)
{
    struct arguments fields = {
        {CALL(setup, job), CALL(setup, index), CALL(setup, vertices), CALL(setup, out), CALL(setup, count)}};
    struct loop loop = {.begin = plan_append(plan, &fragment_setup_begin, fields)};
    loop.top = plan->count;
    return loop;
}

static struct loop begin_pixel(struct plan *plan)
{
    struct arguments fields = {{CALL(pixel, job), CALL(pixel, entries), CALL(pixel, count)}};
    struct arguments block = {{ENTRY(triangle), ENTRY(coverage), ENTRY(block), CALL(pixel, triangles),
                               CALL(pixel, lanes), CALL(pixel, color), CALL(pixel, depth)}};
    struct loop loop = {.begin = plan_append(plan, &fragment_pixel_begin, fields)};
    loop.top = plan_append(plan, &fragment_pixel_entry, block);
    loop.chunk = plan_append(plan, &fragment_pixel_chunk, (struct arguments){{0}});
    return loop;
}

void plan_enter(struct plan *plan)
{
    plan->count = plan->dropped = plan->unrecorded = plan->unpooled = plan->depth = plan->lost = 0;
    plan->literals = plan->variables = 0;
    plan->operations = 1;
    plan->stored = 0;
    plan->frame_bytes = 0;
    plan->counts = (struct plan_counts){0};
    plan->operation[0] = (struct operation){0};
    plan->value[0] = (struct value){0};
    plan_append(plan, &fragment_enter, (struct arguments){{0, MXCSR_CONTRACT}});
}

struct loop plan_begin(struct plan *plan, enum unit unit)
{
    static struct loop (*const begin[UNIT_COUNT])(struct plan *) = {begin_vertex, begin_setup, begin_pixel};
    return begin[unit](plan);
}

void plan_leave(struct plan *plan, enum unit unit, const union key *key, const struct loop *loop,
                int frame_bytes)
{
    int32_t top = (int32_t)loop->top;
    plan->frame_bytes = frame_bytes;
    plan->part[0].arguments.value[0] = -frame_bytes;
    switch (unit) {
    case UNIT_VERTEX:
        plan_append(plan, &fragment_vertex_next, (struct arguments){{top}});
        plan_land(plan, loop->begin, 4);
        break;
    case UNIT_SETUP: {
        int32_t stride = setup_layout(&key->setup).stride;
        plan_append(plan, &fragment_setup_next, (struct arguments){{8 * stride, top}});
        plan_land(plan, loop->begin, 5);
        break;
    }
    default:
        plan_land(plan, loop->chunk, 0);
        plan_append(plan, &fragment_pixel_next, (struct arguments){{(int32_t)loop->chunk, top}});
    }
    plan_append(plan, &fragment_leave, (struct arguments){{0}});
}
