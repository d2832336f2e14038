/* Constant folding: an operation whose operands are all literals is evaluated, by the expression of its row
 * in def/op.def. A region whose mask is a literal becomes unconditional or is removed, and the joins after it
 * become copies. Run it under the contract's MXCSR. */
#include "engines/specialize/passes/pass.h"

static const struct ir_instruction *literal(const struct ir *ir, unsigned value)
{
    const struct ir_instruction *i = &ir->instruction[value];
    return i->op == IR_literal ? i : NULL;
}

static bool fold(struct ir *ir, struct ir_instruction *i)
{
    uint32_t word[3] = {0};
    for (unsigned o = 0; o < ir_operands(i); o++) {
        const struct ir_instruction *operand = literal(ir, i->operand[o]);
        if (!operand)
            return false;
        word[o] = (uint32_t)operand->k;
    }
    i->k = (int32_t)ir_evaluate(i->op, word[0], word[1], word[2], i->k);
    i->op = IR_literal;
    i->operand[0] = i->operand[1] = i->operand[2] = 0;
    return true;
}

/* The `end` of a `when`. */
static uint32_t find_end(const struct ir *ir, uint32_t number)
{
    for (unsigned depth = 0;; number++) {
        depth += ir->instruction[number].op == IR_when;
        depth -= ir->instruction[number].op == IR_end;
        if (!depth)
            return number;
    }
}

/* Makes copies of the joins after a region that always runs, or never. */
static void decide_joins(struct ir *ir, uint32_t end, bool runs)
{
    for (uint32_t n = end + 1; n < ir->count; n++) {
        struct ir_instruction *i = &ir->instruction[n];
        if (i->op != IR_join && i->op != IR_nop)
            return;
        if (i->op == IR_join) {
            i->op = IR_copy;
            i->operand[0] = i->operand[runs];
            i->operand[1] = 0;
        }
    }
}

static bool fold_region(struct ir *ir, uint32_t when)
{
    const struct ir_instruction *mask = literal(ir, ir->instruction[when].operand[0]);
    if (!mask)
        return false;
    uint32_t end = find_end(ir, when);
    decide_joins(ir, end, mask->k != 0);
    for (uint32_t n = when; n <= end; n++)
        if (!mask->k || n == when || n == end)
            ir->instruction[n] = (struct ir_instruction){0};
    return true;
}

unsigned pass_fold(struct ir *ir, struct pass_memory *memory)
{
    unsigned changes = 0;
    (void)memory;
    for (uint32_t number = 1; number < ir->count; number++) {
        struct ir_instruction *i = &ir->instruction[number];
        if (ir_properties(i) & IR_COMPUTES)
            changes += fold(ir, i);
        else if (i->op == IR_when)
            changes += fold_region(ir, number);
    }
    return changes;
}
