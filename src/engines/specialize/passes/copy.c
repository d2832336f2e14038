/* Copy propagation. Afterwards no instruction uses a copy, and the copies are nops. Casts are copies, so
 * operands are no longer of exactly the types of the tables (struct ir). */
#include "engines/specialize/passes/pass.h"

struct copy_memory {
    uint16_t source[IR_CAPACITY]; /* of each copy what it copies, of other values themselves */
};

static_assert(sizeof(struct copy_memory) <= PASS_SCRATCH, "scratch memory is large enough");

unsigned pass_copy(struct ir *ir, struct pass_memory *memory)
{
    struct copy_memory *m = pass_scratch(memory, sizeof *m);
    unsigned changes = 0;
    m->source[0] = 0;
    for (uint32_t number = 1; number < ir->count; number++) {
        struct ir_instruction *i = &ir->instruction[number];
        for (int o = 0; o < 3; o++)
            i->operand[o] = m->source[i->operand[o]];
        m->source[number] = (uint16_t)number;
        if (i->op != IR_copy)
            continue;
        m->source[number] = i->operand[0];
        ir->typed &= i->type == ir->instruction[i->operand[0]].type;
        *i = (struct ir_instruction){0};
        changes++;
    }
    return changes;
}
