/* The planner of operation granularity: reads the specification under the binding that appends operations,
 * then gives their values locations. */
#include "engines/stitch/bind.h"
#include "spec/spec.h"

/* --- Operations that are executed once a call ----------------------------------------------------------- */

/* Operations are the same for all elements of a call if their operands are literals, words of the job,
 * constants of the shader, and results of such operations. Their parts precede the routine's loop, which
 * reads their results from the stack frame (locate.c).
 *
 * A call with one element executes as many operations as without this, because an operation moves only if it
 * would usually be executed: outside of regions, or in a region with a condition of lanes that is in no other
 * region. Out of other regions at most an EXCESS-th as many operations move as are usually executed. */
enum { EXCESS = 8, BASE_OF_JOB = 0, BASE_OF_CONSTANTS = 4 };

struct search {
    struct plan *plan;
    uint32_t depth;
    uint32_t rare; /* the depth of the outermost region that may be skipped in the whole call, 0: none */
    uint32_t usual, moved_from_rare;
};

static bool is_word_of_call(const struct operation *operation)
{
    return operation->kind == OPERATION_READ && operation->fragment == &fragment_uniform &&
           (operation->k[1] == BASE_OF_JOB || operation->k[1] == BASE_OF_CONSTANTS);
}

static bool computes(const struct operation *operation)
{
    return operation->kind == OPERATION_COMPUTE && operation->form != FORM_none;
}

static enum once once_of(const struct plan *plan, const struct operation *operation)
{
    if (operation->kind == OPERATION_LITERAL || is_word_of_call(operation))
        return ONCE_READ;
    for (unsigned i = 0; i < operation->operands; i++)
        if (plan->operation[operation->operand[i]].once == ONCE_NOT)
            return ONCE_NOT;
    return computes(operation) ? ONCE_COMPUTED : ONCE_NOT;
}

static void cross(struct search *s, const struct operation *operation)
{
    switch (operation->kind) {
    case OPERATION_WHEN:
    case OPERATION_LOOP:
        s->depth++;
        bool uniform =
            operation->kind == OPERATION_WHEN && s->plan->operation[operation->operand[0]].once != ONCE_NOT;
        if (!s->rare && (s->depth > 1 || uniform))
            s->rare = s->depth;
        break;
    case OPERATION_END:
    case OPERATION_AGAIN:
        s->rare = s->rare == s->depth ? 0 : s->rare;
        s->depth--;
        break;
    default: break;
    }
}

static struct search search(struct plan *plan, uint32_t limit)
{
    struct search s = {.plan = plan};
    for (uint32_t number = 1; number < plan->operations; number++) {
        struct operation *operation = &plan->operation[number];
        cross(&s, operation);
        enum once once = once_of(plan, operation);
        if (once == ONCE_COMPUTED && s.rare && s.moved_from_rare == limit)
            once = ONCE_NOT;
        s.moved_from_rare += once == ONCE_COMPUTED && s.rare;
        s.usual += computes(operation) && !s.rare;
        operation->once = (uint8_t)once;
    }
    return s;
}

static void find_preamble(struct plan *plan)
{
    if (plan->unrecorded)
        return;
    struct search s = search(plan, UINT32_MAX);
    if (s.moved_from_rare > s.usual / EXCESS)
        search(plan, s.usual / EXCESS);
}

/* --- The planner ---------------------------------------------------------------------------------------- */

#define SIGN_BIT 0x80000000u

static_assert(offsetof(struct vertex_arguments, job) == offsetof(struct pixel_arguments, job),
              "shader_constants");

void plan_locate_operations(struct plan *plan, enum unit unit, const union key *key,
                            const struct program *program)
{
    plan->literal[plan->literals++] = SIGN_BIT;
    find_preamble(plan);
    plan_find_readers(plan);
    plan_append(plan, &fragment_literals, (union arguments){{0}});
    if (program) {
        int32_t constants =
            (int32_t)(offsetof(struct job, constants) + program->model->stage * sizeof(float *));
        plan_append(plan, &fragment_shader_constants,
                    (union arguments){{(int32_t)offsetof(struct vertex_arguments, job), constants}});
    }
    struct loop loop = plan_begin_call(plan, unit);
    int32_t bytes = plan_locate(plan, unit, &loop);
    plan_leave(plan, unit, key, &loop, bytes);
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
