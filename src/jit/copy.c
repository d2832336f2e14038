/* Copy propagation. Leaves no use of a copy; the copies themselves become nops. */
#include "jit/pass.h"

unsigned pass_copy(struct ir *ir, struct pass_memory *memory)
{
    unsigned changes = 0;
    uint16_t *source = memory->map;
    source[0] = 0;
    for (uint32_t number = 1; number < ir->count; number++) {
        struct ir_instruction *i = &ir->instruction[number];
        for (int o = 0; o < 3; o++)
            i->operand[o] = source[i->operand[o]];
        source[number] = (uint16_t)number;
        if (i->op != IR_copy)
            continue;
        source[number] = i->operand[0];
        *i = (struct ir_instruction){0};
        changes++;
    }
    return changes;
}
