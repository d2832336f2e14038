/* Destinations of random shaders: registers, masks and modifiers of results. */
#include "command/fuzz/case/shader_part.h"

unsigned fuzz_shader_choose_mask(struct maker *maker, const struct shader_operation *row)
{
    static const uint8_t old[] = {MASK_FULL, MASK_FULL, MASK_FULL, MASK_XYZ, MASK_W};
    bool any = maker->model->column != COLUMN_VS_1_1;
    if (row->destination == OPERAND_RESULT && has_texture_values(maker))
        return old[below(maker, sizeof old)];
    switch (row->masks) {
    case MASKS_FULL: return MASK_FULL;
    case MASKS_FULL_2: any = shader_major(maker->model) == 3; break;
    case MASKS_XY: return MASK_XY;
    case MASKS_XYZ: return MASK_XYZ;
    case MASKS_XY_XYZ: return one_in(maker, 4) ? MASK_XY : MASK_XYZ;
    case MASKS_NORMAL: return one_in(maker, 2) ? MASK_XYZ : MASK_FULL;
    case MASKS_WITHIN_XYZ: return 1 + below(maker, MASK_XYZ);
    case MASKS_WITHIN_XY: return 1 + below(maker, MASK_XY);
    case MASKS_FRACTION:
        if (!any)
            return 2 + below(maker, 2);
        break;
    default: any = true;
    }
    return any && one_in(maker, 2) ? 1 + below(maker, MASK_FULL) : MASK_FULL;
}

void fuzz_shader_choose_modifiers(struct maker *maker, struct shader_instruction *instruction)
{
    const struct shader_operation *row = &shader_operations[instruction->opcode];
    struct shader_operand *result = &instruction->destination;
    bool narrow = shader_is_narrow(maker->model), old = row->flags & IS_TEXTURE;
    bool saturates =
        (is_pixel(maker) || shader_major(maker->model) == 3) && !(row->flags & IS_UNSATURATED) && !old;
    if (saturates && one_in(maker, 6))
        result->modifier |= RESULT_SATURATE;
    if (is_pixel(maker) && !narrow && one_in(maker, 8))
        result->modifier |= RESULT_PARTIAL;
    if (narrow && !old && one_in(maker, 5))
        result->shift =
            (int8_t)(maker->model->column == COLUMN_PS_1_4 ? random_between(maker->random, -3, 3)
                                                           : random_between(maker->random, -1, 2));
}

/* Rather a register whose value has been read. */
static unsigned choose_written(struct maker *maker)
{
    uint32_t set = maker->pool == 32 ? UINT32_MAX : (1u << maker->pool) - 1;
    if (set & ~maker->fresh && below(maker, 4))
        set &= ~maker->fresh;
    return fuzz_shader_any_bit(maker, set);
}

void fuzz_shader_choose_result(struct maker *maker, struct shader_instruction *instruction)
{
    const struct shader_operation *row = &shader_operations[instruction->opcode];
    unsigned mask = fuzz_shader_choose_mask(maker, row);
    if (row->destination == OPERAND_ADDRESS)
        instruction->destination = fuzz_shader_result(FILE_ADDRESS, 0, mask);
    else if (row->destination == OPERAND_FLAGS)
        instruction->destination = fuzz_shader_result(FILE_PREDICATE, 0, mask);
    else
        instruction->destination = fuzz_shader_result(FILE_TEMPORARY, choose_written(maker), mask);
    if (row->destination == OPERAND_RESULT)
        fuzz_shader_make_element(maker, &instruction->destination);
    if (row->destination == OPERAND_RESULT || row->destination == OPERAND_TEMPORARY)
        fuzz_shader_choose_modifiers(maker, instruction);
}
