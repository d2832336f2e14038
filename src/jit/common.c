/* Common subexpressions: hash-consing from front to back. An earlier instruction may stand for a later
 * equal one when its region is still open there; reads count only where no routine writes
 * (ir_is_invariant_read). Operands are looked up as what stands for them, so that whole expressions are
 * found in one round. What a variable or a phi is changes, so that they are not shared. */
#include "jit/pass.h"

#include <string.h>

enum { TABLE_MASK = PASS_TABLE - 1 };

struct scope {
    struct pass_memory *memory; /* region[number], flag[region]: open; map: parent region of a `when` */
    uint16_t current;
};

static void enter_or_leave(struct scope *scope, const struct ir_instruction *i, uint32_t number)
{
    if (i->op == IR_when) {
        scope->memory->map[number] = scope->current;
        scope->memory->flag[number] = 1;
        scope->current = (uint16_t)number;
    } else if (i->op == IR_end) {
        scope->memory->flag[scope->current] = 0;
        scope->current = scope->memory->map[scope->current];
    }
}

static int may_share(const struct ir_instruction *i)
{
    unsigned properties = ir_op_information[i->op].properties;
    if (i->op == IR_nop || i->op == IR_copy || properties & (IR_EFFECT | IR_PLACED))
        return 0;
    return !(properties & IR_READS) || ir_is_invariant_read(i);
}

static void order_operands(struct ir_instruction *i)
{
    if (ir_op_information[i->op].properties & IR_COMMUTES && i->operand[0] > i->operand[1]) {
        uint16_t first = i->operand[0];
        i->operand[0] = i->operand[1];
        i->operand[1] = first;
    }
}

static uint32_t hash(const struct ir_instruction *i)
{
    uint64_t h = i->op | (uint64_t)i->base << 8 | (uint64_t)i->operand[0] << 16 |
                 (uint64_t)i->operand[1] << 32 | (uint64_t)i->operand[2] << 48;
    h = (h ^ (uint64_t)(uint32_t)i->k << 7 ^ (uint64_t)(uint32_t)i->field << 29) * 0x9e3779b97f4a7c15ull;
    return (uint32_t)(h >> 40);
}

static int same(const struct ir_instruction *x, const struct ir_instruction *y)
{
    return x->op == y->op && x->base == y->base && x->scale == y->scale && x->k == y->k &&
           x->field == y->field && !memcmp(x->operand, y->operand, sizeof x->operand);
}

unsigned pass_common(struct ir *ir, struct pass_memory *memory)
{
    unsigned changes = 0;
    struct scope scope = {memory, 0};
    /* A table no larger than the routine needs: clearing it is most of the cost. */
    uint32_t mask = 63;
    while (mask < 2 * ir->count)
        mask = 2 * mask + 1;
    mask &= TABLE_MASK;
    memset(memory->table, 0, (mask + 1) * sizeof memory->table[0]);
    memory->flag[0] = 1;
    memory->same[0] = 0;
    for (uint32_t number = 1; number < ir->count; number++) {
        struct ir_instruction *i = &ir->instruction[number];
        enter_or_leave(&scope, i, number);
        memory->same[number] = (uint16_t)number;
        for (int o = 0; o < 3; o++)
            i->operand[o] = memory->same[i->operand[o]];
        if (!may_share(i))
            continue;
        order_operands(i);
        uint32_t slot = hash(i) & mask;
        while (memory->table[slot] && !same(&ir->instruction[memory->table[slot]], i))
            slot = (slot + 1) & mask;
        /* One whose region is closed gives up its place: regions do not open again. */
        if (memory->table[slot] && memory->flag[memory->region[memory->table[slot]]]) {
            memory->same[number] = memory->table[slot];
            *i = (struct ir_instruction){.op = IR_copy,
                                         .type = i->type,
                                         .operand = {memory->table[slot]},
                                         .line = i->line,
                                         .file = i->file};
            changes++;
        } else {
            memory->table[slot] = (uint16_t)number;
            memory->region[number] = scope.current;
        }
    }
    return changes;
}
