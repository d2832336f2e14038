/* The operation stitcher reads a recording instead of the specification: each instruction calls the operation
 * of its binding again, which appends the usual fragment. */
#include "command/fuzz/bisect/probe.h"

#include "engines/stitch/bind.h"
#include "engines/stitch/stitch.h"

#include <stdlib.h>

struct reader {
    struct env env;
    uint32_t *value; /* the operation of each instruction */
    int open[NESTING_MAXIMUM + 1];
    unsigned depth;
};

#define GIVEN_flt(o)                                                                                         \
    , (flt)                                                                                                  \
    {                                                                                                        \
        value[i->operand[o]]                                                                                 \
    }
#define GIVEN_itg(o)                                                                                         \
    , (itg)                                                                                                  \
    {                                                                                                        \
        value[i->operand[o]]                                                                                 \
    }
#define GIVEN_fix(o)                                                                                         \
    , (fix)                                                                                                  \
    {                                                                                                        \
        value[i->operand[o]]                                                                                 \
    }
#define GIVEN_msk(o)                                                                                         \
    , (msk)                                                                                                  \
    {                                                                                                        \
        value[i->operand[o]]                                                                                 \
    }
#define GIVEN_non(o)

/* A row of the table of operations. */
static uint32_t read_row(struct env *e, const struct ir_instruction *i, const uint32_t *value)
{
    switch (i->op) {
#define OP(name, result, a, b, c, properties, expression)                                                    \
    case IR_##name:                                                                                          \
        return name(e GIVEN_##a(0) GIVEN_##b(1) GIVEN_##c(2)).id;
#define OPK(name, result, a, b, c, properties, expression)                                                   \
    case IR_##name:                                                                                          \
        return name(e GIVEN_##a(0), i->k).id;
#define CAST(name, result, from)
#include "def/op.def"
#undef OP
#undef OPK
#undef CAST
    default: return 0;
    }
}

static uint32_t read_memory(struct env *e, const struct ir_instruction *i, uint32_t a)
{
    switch (i->op) {
    case IR_load: return load_i(e, i->base, i->k).id;
    case IR_uniform: return uniform_i(e, i->base, i->k).id;
    case IR_gather: return gather_i(e, i->base, i->field, (itg){a}, i->scale, i->k).id;
    case IR_store: store_i(e, i->base, i->k, (itg){a}); return 0;
    default: scatter_i(e, i->base, i->k, i->field, (itg){a}); return 0;
    }
}

static void read_control(struct reader *r, const struct ir_instruction *i, uint32_t a)
{
    struct env *e = &r->env;
    switch (i->op) {
    case IR_when: r->open[r->depth++] = when_begin(e, (msk){a}); break;
    case IR_loop: r->open[r->depth++] = loop_begin(e); break;
    case IR_end: when_end(e, r->open[--r->depth]); break;
    default: loop_again(e, (msk){a}, r->open[--r->depth]); break;
    }
}

static uint32_t read_instruction(struct reader *r, const struct ir *ir, uint32_t number)
{
    const struct ir_instruction *i = &ir->instruction[number];
    uint32_t a = r->value[i->operand[0]];
    struct env *e = env_at(&r->env, ir->file[i->file], i->line);
    switch (i->op) {
    case IR_nop: return 0;
    case IR_copy: return a;
    case IR_literal: return literal(e, (uint32_t)i->k);
    case IR_permute: return permute_f(e, (flt){a}, i->k).id;
    case IR_get: return variable_get(e, i->k);
    case IR_set: variable_set(e, i->k, a); return 0;
    case IR_load:
    case IR_uniform:
    case IR_gather:
    case IR_store:
    case IR_scatter: return read_memory(e, i, a);
    case IR_when:
    case IR_loop:
    case IR_end:
    case IR_again: read_control(r, i, a); return 0;
    default: return read_row(e, i, r->value);
    }
}

static void read_all(struct reader *r, struct plan *plan, const struct ir *ir, enum unit unit,
                     const union key *key)
{
    env_start(&r->env, plan, key_shader(unit, key));
    for (uint32_t number = 1; number < ir->count && r->depth < NESTING_MAXIMUM; number++)
        r->value[number] = read_instruction(r, ir, number);
    plan_locate_operations(plan, unit, key, r->env.program);
}

struct routine *probe_stitch(const struct ir *ir, struct code_arena *arena, const struct routine *like,
                             struct error *error)
{
    struct plan *plan = plan_take(error);
    if (!plan)
        return NULL;
    struct routine *routine = NULL;
    struct reader reader = {.value = calloc(ir->count, sizeof *reader.value)};
    if (reader.value) {
        read_all(&reader, plan, ir, like->unit, &like->key);
        routine = plan_routine(plan, like->engine, arena, like->unit, &like->key, error);
    } else {
        error_set(error, "out of memory for reading %u operations", ir->count);
    }
    free(reader.value);
    plan_give(plan);
    return routine;
}
