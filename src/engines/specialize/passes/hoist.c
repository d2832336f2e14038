/* Hoists words of the job and constants of shaders out of the routine's loop over its elements: a uniform
 * read becomes a slot of the routine's constant table. The table is in the stack frame, is filled once before
 * the loop, and its slots are memory operands of the instructions that use them. The pass runs after the
 * repeated ones, since it leads to no further simplification.
 *
 * Requires that the pass `common` has merged equal reads; otherwise each takes a slot, until the table is
 * full. */
#include "engines/specialize/passes/pass.h"

/* Returns the slot of the word, or -1 if the table is full. */
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
