/* The planner of operation granularity: reads the spec under the binding that appends fragments. */
#include "stitch/bind.h"
#include "spec/spec.h"

void plan_operations(struct plan *plan, enum unit unit, const union key *key)
{
    struct env e = {.plan = plan, .program = key_shader(unit, key)};
    struct loop loop = plan_enter(plan, unit, NULL, 0);
    switch (unit) {
    case UNIT_VERTEX: spec_vertex(&e, &key->vertex); break;
    case UNIT_SETUP: spec_setup(&e, &key->setup); break;
    default: spec_pixel(&e, &key->pixel);
    }
    if (e.frame_bytes > UNSHARED_BYTES && !e.variables)
        e.frame_bytes = plan_share_slots(plan, e.frame_bytes);
    plan_leave(plan, unit, key, &loop, e.frame_bytes);
}
