#include "engines/external/lanes.h"

bool external_is_one(const struct ir_instruction *instruction)
{
    return instruction->op == IR_literal || instruction->op == IR_uniform;
}

static bool stands_alone(const struct ir_instruction *i)
{
    return ir_properties(i) & (IR_WRITES | IR_OPENS | IR_CLOSES);
}

static void mark_crossings(const struct ir *ir, struct lanes *lanes, uint32_t number)
{
    const struct ir_instruction *i = &ir->instruction[number];
    for (unsigned o = 0; o < ir_operands(i); o++)
        if (lanes->group[i->operand[o]] != lanes->group[number] &&
            !external_is_one(&ir->instruction[i->operand[o]]))
            lanes->crosses[i->operand[o]] = true;
}

void external_group_lanes(const struct ir *ir, bool sets_alone, struct lanes *lanes)
{
    uint32_t group = 1;
    lanes->group[0] = 0;
    for (uint32_t number = 1; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        lanes->crosses[number] = false;
        bool permutes = i->op == IR_permute && lanes->group[i->operand[0]] == group;
        bool alone = stands_alone(i) || (sets_alone && i->op == IR_set);
        group += permutes || alone;
        lanes->group[number] = group;
        group += alone;
    }
    for (uint32_t number = 1; number < ir->count; number++)
        mark_crossings(ir, lanes, number);
}
