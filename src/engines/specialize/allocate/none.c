/* The allocator `none`: no value has a register. Each has a home, a word for each lane in the stack frame,
 * which it shares with no other value. So nothing needs to be known of uses and lifetimes, and the code is
 * selected in one pass, as in VCODE (Engler 1996): operands are read from their homes, and each result is
 * computed in a scratch register and stored. The homes are numbered before, because the code of a region's
 * end stores to the joins that follow it.
 *
 * Literals and slots of the constant table are in memory already. */
#include "engines/specialize/allocate/allocate.h"

static void give_home(struct allocation *a, uint32_t number, const struct ir_instruction *i)
{
    a->residence[number] = RESIDENCE_REGISTER;
    a->reg[number] = allocate_is_mask(a, i) ? MASK_RESULT : SCRATCH_RESULT;
    a->split[number] = (uint16_t)number;
    a->slot[number] = (uint16_t)a->slots++;
}

void allocate_by_none(const struct ir *ir, struct allocation *a, uint64_t registers)
{
    (void)registers;
    a->slots = 0;
    for (uint32_t number = 0; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        a->residence[number] = allocate_is_constant(i) ? RESIDENCE_MEMORY : RESIDENCE_NONE;
        a->reg[number] = NO_REGISTER;
        a->split[number] = NEVER;
        a->slot[number] = NO_SLOT;
        a->last[number] = (uint16_t)(ir->count - 1);
        if (allocate_defines_value(i) && !allocate_is_constant(i))
            give_home(a, number, i);
    }
    a->spills = a->slots;
}
