#include "tests/support/routine/stitched.h"

#include "engines/stitch/bind.h"

static const struct fragment *const fragments[IR_OP_COUNT] = {
#define OP(name, ...)  [IR_##name] = &fragment_##name,
#define OPK(name, ...) [IR_##name] = &fragment_##name,
#define CAST(name, ...)
#include "def/op.def"
#undef OP
#undef OPK
#undef CAST
};

static const uint8_t form[IR_OP_COUNT] = {
#define OP(name, ...)  [IR_##name] = FORM_##name,
#define OPK(name, ...) [IR_##name] = FORM_##name,
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
    struct operation operation = {
        .kind = OPERATION_COMPUTE, .fragment = fragments[i->op], .form = form[i->op]};
    operation.operands = information->operands;
    operation.commutes = information->properties & IR_COMMUTES;
    for (int o = 0; o < information->operands; o++)
        operation.operand[o] = t->id[i->operand[o]];
    operation.k[0] = information->properties & IR_SHIFTS ? i->k : 0;
    return append_row(&t->env, operation);
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
    plan_locate_operations(plan, UNIT_VERTEX, &key, NULL);
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
    struct vertex_arguments call = {&data->job, data->input, data->output, PROGRAM_LANES};
    run(&call, NULL);
    code_free(arena, &span);
    return 0;
}

/* --- What fuses -------------------------------------------------------------------------------------- */

/* Values by type. The last few of each type are operands. */
struct fusing {
    struct ir *ir;
    uint64_t *seed;
    uint16_t value[TYPE_msk + 1][IR_CAPACITY];
    unsigned count[TYPE_msk + 1];
};

static uint16_t keep_value(struct fusing *f, struct ir_instruction i)
{
    uint16_t value = ir_append(f->ir, i);
    f->value[i.type][f->count[i.type]++] = value;
    return value;
}

static uint16_t pick_value(struct fusing *f, enum ir_type type)
{
    unsigned back = program_random(f->seed) % 4 ? 3 : 20;
    back = back < f->count[type] ? back : f->count[type];
    return f->value[type][f->count[type] - 1 - program_random(f->seed) % back];
}

static void keep_operation(struct fusing *f, enum ir_op op)
{
    const struct ir_op_information *information = &ir_op_information[op];
    struct ir_instruction i = {.op = (uint8_t)op, .type = information->result};
    for (int o = 0; o < information->operands; o++)
        i.operand[o] = pick_value(f, information->operand[o]);
    keep_value(f, i);
}

static void keep_literal(struct fusing *f, enum ir_type type)
{
    static const uint32_t bits[] = {0, 0xffffffff, 0x3f800000, 0xbf000000, 0x80000000};
    uint32_t k = bits[program_random(f->seed) % 5];
    keep_value(f, (struct ir_instruction){.op = IR_literal, .type = (uint8_t)type, .k = (int32_t)k});
}

static void keep_load(struct fusing *f, enum ir_type type)
{
    int32_t offset = (int32_t)(program_random(f->seed) % PROGRAM_ARRAYS) * PROGRAM_LANES * 4;
    struct ir_instruction i = {.op = IR_load, .type = (uint8_t)type, .base = BASE_INPUT, .k = offset};
    keep_value(f, i);
}

static void store_value(struct fusing *f, enum ir_type type)
{
    int32_t offset = (int32_t)(program_random(f->seed) % PROGRAM_STORES) * VERTEX_SLOT_BYTES;
    struct ir_instruction i = {.op = IR_store, .base = BASE_OUTPUT, .k = offset};
    i.operand[0] = pick_value(f, type);
    ir_append(f->ir, i);
}

void stitched_make_fusing(struct ir *ir, unsigned length, uint64_t *seed)
{
    static const uint8_t ops[] = {IR_neg_f, IR_neg_f, IR_neg_f,    IR_add_f,    IR_sub_f, IR_mad_f,
                                  IR_mad_f, IR_mad_f, IR_select_f, IR_select_i, IR_xor_i, IR_xor_i,
                                  IR_and_i, IR_and_i, IR_max_f,    IR_max_f,    IR_min_f, IR_lt_f};
    static struct fusing f;
    f.ir = ir;
    f.seed = seed;
    memset(f.count, 0, sizeof f.count);
    ir_start(ir);
    ir->file[ir->file_count++] = "program";
    for (int i = 0; i < 4; i++)
        keep_load(&f, TYPE_flt), keep_load(&f, TYPE_itg);
    keep_operation(&f, IR_lt_f);
    while (length--)
        switch (program_random(seed) % 8) {
        case 0: keep_literal(&f, TYPE_flt + program_random(seed) % 2); break;
        case 1: store_value(&f, TYPE_flt + program_random(seed) % 2); break;
        default: keep_operation(&f, ops[program_random(seed) % sizeof ops]); break;
        }
    store_value(&f, TYPE_flt);
    store_value(&f, TYPE_itg);
}
