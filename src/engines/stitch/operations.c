/* The planner of operation granularity: reads the specification under the binding that appends operations,
 * then gives their values locations. */
#include "engines/stitch/bind.h"
#include "spec/spec.h"

#define SIGN_BIT 0x80000000u

static_assert(offsetof(struct vertex_arguments, job) == offsetof(struct pixel_arguments, job),
              "shader_constants");

void plan_locate_operations(struct plan *plan, enum unit unit, const union key *key,
                            const struct program *program)
{
    plan->literal[plan->literals++] = SIGN_BIT;
    plan_find_readers(plan);
    plan_append(plan, &fragment_literals, (union arguments){{0}});
    if (program) {
        int32_t constants =
            (int32_t)(offsetof(struct job, constants) + program->model->stage * sizeof(float *));
        plan_append(plan, &fragment_shader_constants,
                    (union arguments){{(int32_t)offsetof(struct vertex_arguments, job), constants}});
    }
    struct loop loop = plan_begin(plan, unit);
    plan_leave(plan, unit, key, &loop, plan_locate(plan));
}

void plan_operations(struct plan *plan, enum unit unit, const union key *key)
{
    struct env e;
    struct triangle_layout layout = layout_of_unit(unit, key);
    env_start(&e, plan, key_shader(unit, key));
    switch (unit) {
    case UNIT_VERTEX: spec_vertex(&e, &key->vertex); break;
    case UNIT_SETUP: spec_setup(&e, &key->setup, &layout); break;
    case UNIT_BLIT: spec_blit(&e, &key->blit); break;
    default: spec_pixel(&e, &key->pixel, &layout);
    }
    plan_locate_operations(plan, unit, key, e.program);
}
