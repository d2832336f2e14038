/* Instructions of random shaders: an operation with random operands is put before the validator, and stays
 * if it agrees. */
#include "base/minmax.h"
#include "command/fuzz/case/shader_part.h"

enum { TRIES = 8 };

/* --- Magnitudes -------------------------------------------------------------------------------------------
 * Values are about below 2 to the power of these: enough to keep most shaders from running into infinity. */

enum { SIZE_UNIT = 0, SIZE_CONSTANT = 1, SIZE_INPUT = 2, SIZE_NARROW = 3, SIZE_PLACE = 7 };

static unsigned size_of_source(const struct maker *maker, const struct shader_operand *source)
{
    switch (source->file) {
    case FILE_TEMPORARY: return maker->size[source->index];
    case FILE_INPUT:
    case FILE_TEXTURE: return SIZE_INPUT;
    case FILE_SPRITE:
    case FILE_PLACE: return SIZE_PLACE;
    case FILE_CONSTANT: return SIZE_CONSTANT;
    default: return SIZE_UNIT;
    }
}

static unsigned size_of_operation(const struct shader_instruction *instruction, unsigned a, unsigned b,
                                  unsigned c)
{
    switch (instruction->opcode) {
    case SHADER_ADD:
    case SHADER_SUB:
    case SHADER_DSX:
    case SHADER_DSY: return max_u32(a, b) + 1;
    case SHADER_MUL:
    case SHADER_DST: return a + b;
    case SHADER_MAD: return max_u32(a + b, c) + 1;
    case SHADER_LRP: return a + max_u32(b, c) + 1;
    case SHADER_DP2ADD: return max_u32(a + b + 1, c) + 1;
    case SHADER_DP3:
    case SHADER_DP4:
    case SHADER_CRS:
    case SHADER_BEM:
    case SHADER_M4X4:
    case SHADER_M4X3:
    case SHADER_M3X4:
    case SHADER_M3X3:
    case SHADER_M3X2: return a + b + 2;
    case SHADER_FRC:
    case SHADER_SGN:
    case SHADER_SLT:
    case SHADER_SGE:
    case SHADER_SEQ:
    case SHADER_SNE:
    case SHADER_SINCOS:
    case SHADER_SINCOS_2: return SIZE_UNIT;
    case SHADER_NRM: return instruction->destination.swizzle & MASK_W ? MAKER_WILD : SIZE_UNIT;
    case SHADER_EXP:
    case SHADER_EXPP: return a <= 3 ? 1u << a : MAKER_WILD;
    case SHADER_LIT: return a ? MAKER_WILD : SIZE_UNIT;
    case SHADER_RCP:
    case SHADER_RSQ:
    case SHADER_LOG:
    case SHADER_LOGP:
    case SHADER_DIV:
    case SHADER_SQRT:
    case SHADER_POW: return MAKER_WILD;
    default: return max_u32(a, max_u32(b, c));
    }
}

static unsigned size_of_result(const struct maker *maker, const struct shader_instruction *instruction)
{
    const struct shader_operand *source = instruction->source;
    if (instruction->destination.modifier & RESULT_SATURATE ||
        shader_operations[instruction->opcode].flags & IS_TEXTURE)
        return SIZE_UNIT;
    if (shader_is_narrow(maker->model))
        return SIZE_NARROW;
    unsigned size = size_of_operation(instruction, size_of_source(maker, &source[0]),
                                      size_of_source(maker, &source[1]), size_of_source(maker, &source[2]));
    return size > MAKER_WILD ? MAKER_WILD : size;
}

/* --- One instruction ------------------------------------------------------------------------------------ */

/* Counters of loops are none of the registers that are chosen. */
static uint32_t bit_of(unsigned index)
{
    return index < MAKER_TEMPORARIES ? 1u << index : 0;
}

/* Notes the registers that the instruction read and wrote, for later choices. */
static void note(struct maker *maker, const struct shader_instruction *instruction)
{
    const struct shader_operation *row = &shader_operations[instruction->opcode];
    const struct shader_operand *result = &instruction->destination;
    for (unsigned i = 0; i < SHADER_SOURCES && row->source[i]; i++)
        if (instruction->source[i].file == FILE_TEMPORARY)
            maker->fresh &= ~bit_of(instruction->source[i].index);
    if (row->source[1] == OPERAND_SCRATCH)
        for (unsigned i = 1; i <= 2; i++)
            maker->size[instruction->source[i].index] = MAKER_WILD;
    maker->executed += row->flags & IS_SETUP ? 0 : maker->trips;
    if (row->destination != OPERAND_RESULT && row->destination != OPERAND_TEMPORARY)
        return;
    if (result->file != FILE_TEMPORARY)
        return;
    bool all = result->swizzle == MASK_FULL && !instruction->predicate.file && !maker->check.block_count;
    unsigned size = size_of_result(maker, instruction);
    maker->fresh |= bit_of(result->index);
    maker->size[result->index] = (uint8_t)(all ? size : max_u32(size, maker->size[result->index]));
}

bool fuzz_shader_add(struct maker *maker, const struct shader_instruction *instruction)
{
    struct shader *shader = maker->shader;
    struct check before = maker->check;
    struct shader_instruction *added = shader_append(shader, maker->error);
    if (!added) {
        maker->failed = true;
        return false;
    }
    *added = *instruction;
    added->place = shader->count + 1; /* its line, after that of the model */
    maker->made->proposed++;
    if (check_instruction(&maker->check, shader->count - 1)) {
        maker->made->refused++;
        maker->check = before;
        shader->count--;
        error_clear(&maker->refusal);
        return false;
    }
    note(maker, instruction);
    return true;
}

bool fuzz_shader_has(const struct maker *maker, enum shader_opcode opcode)
{
    const struct shader_operation *row = &shader_operations[opcode];
    const struct shader_model *model = maker->model;
    return shader_slots(row, model) >= 0 &&
           !(row->flags & IS_DIFFERENCE && !(model->capabilities & CAN_DIFFERENCE)) &&
           !(row->flags & IS_PREDICATES && !(model->capabilities & CAN_PREDICATION)) &&
           !(row->flags & IS_FLOW && !model->loops) && !(row->flags & IS_DYNAMIC && !model->dynamic);
}

bool fuzz_shader_has_room(const struct maker *maker, unsigned slots)
{
    const struct shader_model *model = maker->model;
    slots += maker->reserve;
    if (model->slots && maker->check.slots + slots > model->slots)
        return false;
    return !model->arithmetic || maker->check.arithmetic + slots <= model->arithmetic;
}

/* The destination is another register than the sources where it has to be. */
static bool is_apart(const struct shader_instruction *instruction)
{
    const struct shader_operand *result = &instruction->destination;
    for (unsigned i = 0; i < SHADER_SOURCES; i++)
        if (instruction->source[i].file == result->file && instruction->source[i].index == result->index)
            return false;
    return true;
}

static bool propose_once(struct maker *maker, enum shader_opcode opcode,
                         const struct shader_operand *destination)
{
    const struct shader_operation *row = &shader_operations[opcode];
    struct shader_instruction instruction = {.opcode = (uint8_t)opcode};
    if (row->control == COMPARISON)
        instruction.comparison = (uint8_t)(1 + below(maker, 6));
    if (destination)
        instruction.destination = *destination;
    else if (row->destination)
        fuzz_shader_choose_result(maker, &instruction);
    for (unsigned i = 0; i < SHADER_SOURCES && row->source[i]; i++)
        if (!fuzz_shader_choose_source(maker, &instruction, i))
            return false;
    if (row->flags & IS_APART && !is_opengl(maker) && !is_apart(&instruction))
        return false;
    bool apart =
        row->flags & IS_GRADIENT && instruction.source[0].file == FILE_TEMPORARY && !is_opengl(maker);
    bool gives = row->destination && !(row->flags & (IS_SETUP | IS_FLOW)) && !destination && !apart;
    if (gives && maker->check.written.predicate && maker->predicated && one_in(maker, maker->predicated))
        instruction.predicate = fuzz_shader_choose_predicate(maker, instruction.destination.swizzle);
    if (!maker->wild && row->destination == OPERAND_RESULT) {
        unsigned size = size_of_result(maker, &instruction);
        if (destination ? size > MAKER_LARGE : size > MAKER_LARGE && below(maker, 5))
            return false;
    }
    return fuzz_shader_add(maker, &instruction);
}

bool fuzz_shader_propose(struct maker *maker, enum shader_opcode opcode,
                         const struct shader_operand *destination)
{
    for (unsigned i = 0; i < TRIES && !maker->failed; i++)
        if (propose_once(maker, opcode, destination))
            return true;
    return false;
}

static bool gives_value(const struct maker *maker, enum shader_opcode opcode)
{
    const struct shader_operation *row = &shader_operations[opcode];
    return row->destination == OPERAND_RESULT && !(row->flags & (IS_TEXTURE | IS_SETUP | IS_FLOW)) &&
           fuzz_shader_has(maker, opcode) &&
           !(row->flags & IS_GRADIENT &&
             (maker->options->registers || (!is_opengl(maker) && check_is_divergent(&maker->check))));
}

bool fuzz_shader_propose_any(struct maker *maker, const struct shader_operand *destination)
{
    for (unsigned i = 0; i < TRIES && !maker->failed; i++) {
        enum shader_opcode opcode;
        do
            opcode = below(maker, SHADER_COUNT);
        while (!gives_value(maker, opcode));
        if (destination && shader_operations[opcode].masks != MASKS_ANY)
            continue;
        if (propose_once(maker, opcode, destination))
            return true;
    }
    return fuzz_shader_propose(maker, SHADER_MOV, destination);
}

bool fuzz_shader_declare(struct maker *maker, struct shader_operand declared, unsigned usage,
                         unsigned usage_index, unsigned kind)
{
    return fuzz_shader_add(maker, &(struct shader_instruction){.opcode = SHADER_DCL,
                                                               .destination = declared,
                                                               .usage = (uint8_t)usage,
                                                               .usage_index = (uint8_t)usage_index,
                                                               .kind = (uint8_t)kind});
}
