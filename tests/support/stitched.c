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
    int32_t slot[IR_CAPACITY]; /* of each value */
    int region[IR_CAPACITY];   /* the open ones */
    unsigned depth;
};

static int32_t table_operation(struct translation *t, const struct ir_instruction *i)
{
    const struct ir_op_information *information = &ir_op_information[i->op];
    int32_t a = t->slot[i->operand[0]], b = t->slot[i->operand[1]], c = t->slot[i->operand[2]];
    struct arguments arguments = {{0, a, information->properties & IR_SHIFTS ? i->k : b, c}};
    return append_value(&t->env, fragments[i->op], arguments, information->operands);
}

static int32_t translate(struct translation *t, const struct ir_instruction *i)
{
    int32_t a = t->slot[i->operand[0]];
    switch (i->op) {
    case IR_copy: return a;
    case IR_permute: return permute_f(&t->env, (flt){a}, i->k).slot;
    case IR_literal: return literal(&t->env, (uint32_t)i->k);
    case IR_load: return load_i(&t->env, i->base, i->k).slot;
    case IR_uniform: return uniform_i(&t->env, i->base, i->k).slot;
    case IR_gather: return gather_i(&t->env, i->base, i->field, (itg){a}, i->scale, i->k).slot;
    case IR_store: store_i(&t->env, i->base, i->k, (itg){a}); break;
    case IR_scatter: scatter_i(&t->env, i->base, i->k, i->field, (itg){a}); break;
    case IR_when: t->region[t->depth++] = when_begin(&t->env, (msk){a}); break;
    case IR_end: when_end(&t->env, t->region[--t->depth]); break;
    case IR_nop: break;
    default: return table_operation(t, i);
    }
    return 0;
}

int stitched_plan(struct plan *plan, const struct ir *ir, int share)
{
    static struct translation t;
    static const union key key;
    t.env = (struct env){.plan = plan, .file = "program", .line = 1};
    t.depth = 0;
    struct loop loop = plan_enter(plan, UNIT_VERTEX, NULL, 0);
    for (uint32_t number = 1; number < ir->count; number++)
        t.slot[number] = translate(&t, &ir->instruction[number]);
    int32_t bytes = share ? plan_share_slots(plan, t.env.frame_bytes) : t.env.frame_bytes;
    plan_leave(plan, UNIT_VERTEX, &key, &loop, bytes);
    return bytes;
}

int stitched_run(struct plan *plan, const struct ir *ir, int share, struct code_arena *arena,
                 struct program_data *data, struct error *error)
{
    struct code_span span;
    stitched_plan(plan, ir, share);
    if (plan_join(plan, arena, &span, error))
        return -1;
    routine_function *run;
    memcpy(&run, &(const void *){span.executable}, sizeof run);
    struct vertex_call call = {&data->job, data->input, data->output, PROGRAM_LANES};
    run(&call, NULL);
    code_free(arena, &span);
    return 0;
}
