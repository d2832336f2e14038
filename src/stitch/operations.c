/* The planner of operation granularity: reads the spec under the binding that appends operations, and lets
 * them be placed. */
#include "stitch/bind.h"
#include "spec/spec.h"

#define SIGN_BIT 0x80000000u

static_assert(offsetof(struct vertex_call, job) == offsetof(struct pixel_call, job), "shader_constants");

void plan_place_operations(struct plan *plan, enum unit unit, const union key *key,
                           const struct program *program)
{
    plan->literal[plan->literals++] = SIGN_BIT;
    plan_find_readers(plan);
    plan_append(plan, &fragment_literals, (struct arguments){{0}});
    if (program) {
        int32_t constants =
            (int32_t)(offsetof(struct job, constants) + program->model->stage * sizeof(float *));
        plan_append(plan, &fragment_shader_constants,
                    (struct arguments){{(int32_t)offsetof(struct vertex_call, job), constants}});
    }
    struct loop loop = plan_begin(plan, unit);
    plan_leave(plan, unit, key, &loop, plan_place(plan));
}

void plan_operations(struct plan *plan, enum unit unit, const union key *key)
{
    struct env e;
    struct triangle_layout layout = unit_layout(unit, key);
    env_start(&e, plan, key_shader(unit, key));
    switch (unit) {
    case UNIT_VERTEX: spec_vertex(&e, &key->vertex); break;
    case UNIT_SETUP: spec_setup(&e, &key->setup, &layout); break;
    default: spec_pixel(&e, &key->pixel, &layout);
    }
    plan_place_operations(plan, unit, key, e.program);
}
