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

int plan_complete(const struct plan *plan, struct error *error)
{
    if (plan->dropped)
        return error_set(error, "the stitcher's plan of %u parts exceeds its room of %d",
                         plan->count + plan->dropped, PART_CAPACITY);
    if (plan->frame_bytes > FRAME_BYTES_MAXIMUM)
        return error_set(error, "the stitcher's frame of %d bytes exceeds its room of %d",
                         (int)plan->frame_bytes, FRAME_BYTES_MAXIMUM);
    return 0;
}

void plan_land(struct plan *plan, unsigned part, unsigned n)
{
    plan->part[part].arguments.value[n] = (int32_t)plan->count;
}

#define CALL(unit, field) (int32_t) offsetof(struct unit##_call, field)
#define ENTRY(field)      (int32_t) offsetof(struct entry, field)

static struct loop enter_vertex(struct plan *plan)
{
    struct arguments fields = {
        {CALL(vertex, job), CALL(vertex, index), CALL(vertex, out), CALL(vertex, count)}};
    struct loop loop = {.begin = plan_append(plan, &fragment_vertex_begin, fields)};
    loop.top = plan->count;
    return loop;
}

static struct loop enter_setup(struct plan *plan)
{
    struct arguments fields = {
        {CALL(setup, job), CALL(setup, index), CALL(setup, vertices), CALL(setup, out), CALL(setup, count)}};
    struct loop loop = {.begin = plan_append(plan, &fragment_setup_begin, fields)};
    loop.top = plan->count;
    return loop;
}

static struct loop enter_pixel(struct plan *plan)
{
    struct arguments fields = {{CALL(pixel, job), CALL(pixel, entries), CALL(pixel, count)}};
    struct arguments block = {{ENTRY(triangle), ENTRY(coverage), ENTRY(block), CALL(pixel, triangles),
                               CALL(pixel, lanes), CALL(pixel, color), CALL(pixel, depth)}};
    struct loop loop = {.begin = plan_append(plan, &fragment_pixel_begin, fields)};
    loop.top = plan_append(plan, &fragment_pixel_entry, block);
    loop.chunk = plan_append(plan, &fragment_pixel_chunk, (struct arguments){{0}});
    return loop;
}

struct loop plan_enter(struct plan *plan, enum unit unit, const struct fragment *once, int32_t argument)
{
    static struct loop (*const enter[UNIT_COUNT])(struct plan *) = {enter_vertex, enter_setup, enter_pixel};
    plan->count = plan->dropped = 0;
    plan->frame_bytes = 0;
    plan_append(plan, &fragment_enter, (struct arguments){{0, MXCSR_CONTRACT}});
    if (once)
        plan_append(plan, once, (struct arguments){{argument}});
    return enter[unit](plan);
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
