/* Constant folding: an operation whose operands are all literals is evaluated now, by the table's own
 * expression. Runs under the contract's MXCSR. */
#include "jit/pass.h"

static const struct ir_instruction *literal(const struct ir *ir, unsigned value)
{
    const struct ir_instruction *i = &ir->instruction[value];
    return i->op == IR_literal ? i : NULL;
}

static int is_table_operation(unsigned op)
{
    return op > IR_nop && op < IR_copy;
}

static int fold(struct ir *ir, struct ir_instruction *i)
{
    const struct ir_op_information *information = &ir_op_information[i->op];
    uint32_t word[3] = {0};
    for (int o = 0; o < information->operands; o++) {
        const struct ir_instruction *operand = literal(ir, i->operand[o]);
        if (!operand)
            return 0;
        word[o] = (uint32_t)operand->k;
    }
    i->k = (int32_t)ir_evaluate(i->op, word[0], word[1], word[2], i->k);
    i->op = IR_literal;
    i->operand[0] = i->operand[1] = i->operand[2] = 0;
    return 1;
}

unsigned pass_fold(struct ir *ir, struct pass_memory *memory)
{
    unsigned changes = 0;
    (void)memory;
    for (uint32_t number = 1; number < ir->count; number++) {
        struct ir_instruction *i = &ir->instruction[number];
        if (is_table_operation(i->op))
            changes += (unsigned)fold(ir, i);
    }
    return changes;
}
