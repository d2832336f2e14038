/* The words of the job and the constants of shaders, out of the loop over what a call lists: a uniform read
 * of the job becomes a slot of the frame's constants, filled once before the loop, and from there a memory
 * operand of whatever uses it. Runs after the other passes: it adds no value.
 *
 * Requires that equal reads are one (common), else each takes a slot of its own until none is left. */
#include "jit/pass.h"

static int find_constant(struct ir *ir, const struct ir_instruction *i)
{
    for (uint32_t c = 0; c < ir->constant_count; c++)
        if (ir->constant[c].base == i->base && ir->constant[c].offset == i->k)
            return (int)c;
    if (ir->constant_count == IR_CONSTANTS)
        return -1;
    ir->constant[ir->constant_count] = (struct ir_constant){i->base, i->k};
    return (int)ir->constant_count++;
}

unsigned pass_hoist(struct ir *ir, struct pass_memory *memory)
{
    unsigned changes = 0;
    (void)memory;
    for (uint32_t number = 1; number < ir->count; number++) {
        struct ir_instruction *i = &ir->instruction[number];
        if (i->op != IR_uniform || (i->base != BASE_JOB && i->base != BASE_CONSTANT))
            continue;
        int slot = find_constant(ir, i);
        if (slot < 0)
            break;
        i->op = IR_constant;
        i->k = slot;
        changes++;
    }
    return changes;
}
