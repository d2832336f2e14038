#include "tests/support/stitched.h"

#include "stitch/bind.h"

static const struct fragment *const fragments[IR_OP_COUNT] = {
#define OP(name, ...)  [IR_##name] = &fragment_##name,
#define OPK(name, ...) [IR_##name] = &fragment_##name,
#define CAST(name, ...)
#include "def/op.def"
#undef OP
#undef OPK
#undef CAST
};

struct translation {
    struct env env;
    uint32_t id[IR_CAPACITY]; /* of each value */
    int region[IR_CAPACITY];  /* the open ones */
    unsigned depth;
};

static uint32_t table_operation(struct translation *t, const struct ir_instruction *i)
{
    const struct ir_op_information *information = &ir_op_information[i->op];
    struct operation operation = {.kind = OPERATION_COMPUTE, .fragment = fragments[i->op]};
    operation.operands = information->operands;
    operation.commutes = information->properties & IR_COMMUTES;
    for (int o = 0; o < information->operands; o++)
        operation.operand[o] = t->id[i->operand[o]];
    operation.k[0] = information->properties & IR_SHIFTS ? i->k : 0;
    return append(&t->env, operation);
}

static uint32_t translate(struct translation *t, const struct ir_instruction *i)
{
    uint32_t a = t->id[i->operand[0]];
    switch (i->op) {
    case IR_copy: return a;
    case IR_permute: return permute_f(&t->env, (flt){a}, i->k).id;
    case IR_literal: return literal(&t->env, (uint32_t)i->k);
    case IR_load: return load_i(&t->env, i->base, i->k).id;
    case IR_uniform: return uniform_i(&t->env, i->base, i->k).id;
    case IR_gather: return gather_i(&t->env, i->base, i->field, (itg){a}, i->scale, i->k).id;
    case IR_store: store_i(&t->env, i->base, i->k, (itg){a}); break;
    case IR_scatter: scatter_i(&t->env, i->base, i->k, i->field, (itg){a}); break;
    case IR_when: t->region[t->depth++] = when_begin(&t->env, (msk){a}); break;
    case IR_end: when_end(&t->env, t->region[--t->depth]); break;
    case IR_loop: t->region[t->depth++] = loop_begin(&t->env); break;
    case IR_again: loop_again(&t->env, (msk){a}, t->region[--t->depth]); break;
    case IR_set: set_i(&t->env, i->k, (itg){a}); break;
    case IR_get: return get_i(&t->env, i->k).id;
    case IR_nop: break;
    default: return table_operation(t, i);
    }
    return 0;
}

int stitched_plan(struct plan *plan, const struct ir *ir)
{
    static struct translation t;
    static const union key key;
    env_start(&t.env, plan, NULL);
    env_at(&t.env, "program", 1);
    t.depth = 0;
    for (uint32_t number = 1; number < ir->count; number++)
        t.id[number] = translate(&t, &ir->instruction[number]);
    plan_place_operations(plan, UNIT_VERTEX, &key, NULL);
    return plan->frame_bytes;
}

int stitched_run(struct plan *plan, const struct ir *ir, struct code_arena *arena, struct program_data *data,
                 struct error *error)
{
    struct code_span span;
    stitched_plan(plan, ir);
    if (plan_join(plan, arena, &span, error))
        return -1;
    routine_function *run;
    memcpy(&run, &(const void *){span.executable}, sizeof run);
    struct vertex_call call = {&data->job, data->input, data->output, PROGRAM_LANES};
    run(&call, NULL);
    code_free(arena, &span);
    return 0;
}
