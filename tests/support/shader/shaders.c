#include "tests/support/shader/shaders.h"

#include <stdlib.h>
#include <unity.h>

uint32_t shader_random(uint64_t *random, uint32_t below)
{
    *random ^= *random >> 12;
    *random ^= *random << 25;
    *random ^= *random >> 27;
    return (uint32_t)((*random * 0x2545f4914f6cdd1d) >> 32) % below;
}

struct shader *shader_blank(const struct shader_model *model)
{
    struct shader *shader = shader_create("generated", false, NULL);
    TEST_ASSERT_NOT_NULL(shader);
    shader->model = model;
    return shader;
}

/* Chooses a register file of the model that fits the kind of operand. */
static enum shader_file choose_file(const struct shader_model *model, enum shader_operand_kind kind,
                                    uint64_t *random)
{
    static const struct {
        uint8_t kind, file;
    } fixed[] = {
        {OPERAND_ADDRESS, FILE_ADDRESS},
        {OPERAND_FLAGS, FILE_PREDICATE},
        {OPERAND_STAGE, FILE_TEXTURE},
        {OPERAND_TEMPORARY, FILE_TEMPORARY},
        {OPERAND_CONSTANT, FILE_CONSTANT},
        {OPERAND_CONSTANT_INTEGER, FILE_INTEGER},
        {OPERAND_CONSTANT_BOOLEAN, FILE_BOOLEAN},
        {OPERAND_SCRATCH, FILE_TEMPORARY},
        {OPERAND_SERIES, FILE_CONSTANT},
        {OPERAND_SAMPLER, FILE_SAMPLER},
        {OPERAND_SAMPLED, FILE_TEXTURE},
        {OPERAND_CONDITION, FILE_BOOLEAN},
        {OPERAND_PREDICATE, FILE_PREDICATE},
        {OPERAND_INTEGER, FILE_INTEGER},
        {OPERAND_COUNTER, FILE_LOOP},
        {OPERAND_LABEL, FILE_LABEL},
        {OPERAND_SET, FILE_TEXTURE},
        {OPERAND_MATRIX, FILE_CONSTANT},
    };
    for (size_t i = 0; i < sizeof fixed / sizeof *fixed; i++)
        if (fixed[i].kind == kind)
            return fixed[i].file;
    bool destination = kind == OPERAND_RESULT;
    for (;;) {
        enum shader_file file = 1 + shader_random(random, FILE_COUNT - 1);
        const struct shader_register *row = &shader_registers[file];
        if (shader_register_count(file, model) &&
            (kind == OPERAND_DECLARED || (row->access & (destination ? CAN_WRITE : CAN_READ))))
            return file;
    }
}

static void choose_register(const struct shader_model *model, struct shader_operand *operand,
                            enum shader_operand_kind kind, uint64_t *random)
{
    operand->file = choose_file(model, kind, random);
    const struct shader_register *row = &shader_registers[operand->file];
    if (row->index != NUMBERED)
        return;
    operand->index = (uint16_t)shader_random(random, shader_register_count(operand->file, model));
    bool vertex = model->stage == STAGE_VERTEX, three = shader_major(model) == 3;
    bool indexed = (operand->file == FILE_CONSTANT && vertex) || (operand->file == FILE_INPUT && three) ||
                   operand->file == FILE_OUTPUT;
    if (kind == OPERAND_CONSTANT || kind == OPERAND_DECLARED || !indexed || shader_random(random, 3))
        return;
    bool loop = !vertex || (model->column != COLUMN_VS_1_1 && shader_random(random, 2));
    operand->relative = loop ? FILE_LOOP : FILE_ADDRESS;
    if (!loop && model->column != COLUMN_VS_1_1)
        operand->component = (uint8_t)shader_random(random, 4);
}

static void choose_source(const struct shader_model *model, struct shader_operand *operand,
                          enum shader_operand_kind kind, uint64_t *random)
{
    choose_register(model, operand, kind, random);
    do
        operand->modifier = (uint8_t)shader_random(random, MODIFIER_COUNT);
    while (shader_modifiers[operand->modifier].columns[model->column] == '.');
    operand->swizzle = (uint8_t)(shader_random(random, 2) ? SWIZZLE_NONE : shader_random(random, 256));
}

static void choose_destination(const struct shader_model *model, struct shader_operand *operand,
                               enum shader_operand_kind kind, uint64_t *random)
{
    choose_register(model, operand, kind, random);
    operand->swizzle = (uint8_t)(shader_random(random, 2) ? MASK_FULL : 1 + shader_random(random, 15));
    operand->modifier = (uint8_t)shader_random(random, 8);
    operand->shift = (int8_t)((int)shader_random(random, 7) - 3);
}

static void choose_declaration(const struct shader_model *model, struct shader_instruction *instruction,
                               uint64_t *random)
{
    unsigned file = instruction->destination.file;
    if (file == FILE_SAMPLER)
        instruction->kind = (uint8_t)(2 + shader_random(random, 3));
    if (!shader_has_usage(file, model))
        return;
    instruction->usage = (uint8_t)shader_random(random, 14);
    instruction->usage_index = (uint8_t)shader_random(random, 16);
}

void shader_add_random(struct shader *shader, enum shader_opcode opcode, uint64_t *random)
{
    const struct shader_operation *row = &shader_operations[opcode];
    const struct shader_model *model = shader->model;
    struct shader_instruction *instruction = shader_append(shader, NULL);
    TEST_ASSERT_NOT_NULL(instruction);
    instruction->opcode = (uint8_t)opcode;
    if (row->control == COMPARISON)
        instruction->comparison = (uint8_t)(1 + shader_random(random, 6));
    instruction->coissue =
        model->stage == STAGE_PIXEL && shader_major(model) == 1 && !shader_random(random, 4);
    if (row->destination)
        choose_destination(model, &instruction->destination, row->destination, random);
    if (row->destination == OPERAND_DECLARED)
        choose_declaration(model, instruction, random);
    if (shader_register_count(FILE_PREDICATE, model) && !shader_random(random, 4))
        choose_source(model, &instruction->predicate, OPERAND_PREDICATE, random);
    if (row->destination == OPERAND_CONSTANT_BOOLEAN)
        instruction->literal[0] = shader_random(random, 2);
    else if (row->destination == OPERAND_CONSTANT || row->destination == OPERAND_CONSTANT_INTEGER)
        for (unsigned i = 0; i < 4; i++)
            instruction->literal[i] = shader_random(random, 0xffffffff);
    for (unsigned i = 0; i < SHADER_SOURCES && row->source[i]; i++)
        choose_source(model, &instruction->source[i], row->source[i], random);
}

void shader_damage(struct shader *shader, uint64_t *random)
{
    struct shader_instruction *at = &shader->instructions[shader_random(random, shader->count)];
    struct shader_operand *operand =
        shader_random(random, 2) ? &at->source[shader_random(random, 3)] : &at->destination;
    switch (shader_random(random, 6)) {
    case 0: operand->index = (uint16_t)shader_random(random, shader_random(random, 2) ? 8 : 2048); break;
    case 1:
        operand->swizzle = (uint8_t)(1 + shader_random(random, operand == &at->destination ? 15 : 255));
        break;
    case 2: operand->modifier = (uint8_t)shader_random(random, 8); break;
    case 3: *at = shader->instructions[shader_random(random, shader->count)]; break;
    case 4:
        if (operand->file)
            operand->file = (uint8_t)(1 + shader_random(random, FILE_COUNT - 1));
        break;
    default: shader->count = 1 + shader_random(random, shader->count); break;
    }
}
