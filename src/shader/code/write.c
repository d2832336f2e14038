/* The writer of bytecode (shader/code/token.h). Every shader can be encoded, except one with an instruction
 * of too many tokens, and no row of the table has as many. */
#include "shader/shader.h"
#include "shader/code/token.h"

#include <stdlib.h>

/* Of one instruction: itself, destination, predicate, sources, each with an index register; or literals. */
enum { INSTRUCTION_TOKENS = 1 + 2 * (2 + SHADER_SOURCES) };

struct writer {
    const struct shader_model *model;
    uint32_t *at;
};

static uint32_t type_bits(unsigned type)
{
    return (type & 7) << 28 | (type >> 3) << 11;
}

/* File, number and bit 31, the same for sources and destinations. */
static uint32_t register_bits(unsigned file, unsigned index)
{
    const struct shader_register *row = &shader_registers[file];
    unsigned type = row->type, block = index / TOKEN_REGISTERS;
    if (row->index != NUMBERED)
        index = row->index;
    if (file == FILE_CONSTANT && block)
        type = TOKEN_TYPE_CONTINUED + block - 1;
    return TOKEN_SET | type_bits(type) | (index & (TOKEN_REGISTERS - 1));
}

/* The index register, in models that have a token for it. */
static void put_relative(struct writer *writer, const struct shader_operand *operand)
{
    if (!operand->relative)
        return;
    writer->at[-1] |= TOKEN_RELATIVE;
    if (shader_major(writer->model) < 2)
        return;
    uint32_t swizzle = operand->relative == FILE_ADDRESS ? operand->component * 0x55u : SWIZZLE_NONE;
    *writer->at++ = register_bits(operand->relative, 0) | swizzle << 16;
}

static void put_source(struct writer *writer, const struct shader_operand *operand)
{
    *writer->at++ = register_bits(operand->file, operand->index) | (uint32_t)operand->swizzle << 16 |
                    (uint32_t)operand->modifier << 24;
    put_relative(writer, operand);
}

static void put_destination(struct writer *writer, const struct shader_operand *operand)
{
    *writer->at++ = register_bits(operand->file, operand->index) | (uint32_t)operand->swizzle << 16 |
                    (uint32_t)operand->modifier << 20 | ((uint32_t)operand->shift & 15) << 24;
    put_relative(writer, operand);
}

static void put_operands(struct writer *writer, const struct shader_instruction *instruction)
{
    const struct shader_operation *row = &shader_operations[instruction->opcode];
    if (row->destination == OPERAND_DECLARED)
        *writer->at++ = TOKEN_SET | (uint32_t)instruction->kind << 27 |
                        (uint32_t)instruction->usage_index << 16 | instruction->usage;
    if (row->destination)
        put_destination(writer, &instruction->destination);
    if (instruction->predicate.file)
        put_source(writer, &instruction->predicate);
    for (unsigned i = 0; i < SHADER_SOURCES && row->source[i]; i++)
        put_source(writer, &instruction->source[i]);
    if (row->destination == OPERAND_CONSTANT || row->destination == OPERAND_CONSTANT_INTEGER)
        for (unsigned i = 0; i < 4; i++)
            *writer->at++ = instruction->literal[i];
    if (row->destination == OPERAND_CONSTANT_BOOLEAN)
        *writer->at++ = instruction->literal[0];
}

static void put_instruction(struct writer *writer, const struct shader_instruction *instruction)
{
    const struct shader_operation *row = &shader_operations[instruction->opcode];
    uint32_t *head = writer->at++;
    put_operands(writer, instruction);
    uint32_t behind = (uint32_t)(writer->at - head - 1);
    *head = row->opcode | (row->control == COMPARISON ? instruction->comparison : row->control) << 16 |
            (shader_major(writer->model) >= 2 ? behind << 24 : 0) |
            (instruction->predicate.file ? TOKEN_PREDICATED : 0) | (instruction->coissue ? TOKEN_COISSUE : 0);
}

int shader_encode(const struct shader *shader, uint32_t **tokens, size_t *count, struct error *error)
{
    const struct shader_model *model = shader->model;
    *tokens = malloc(((size_t)shader->count * INSTRUCTION_TOKENS + 2) * sizeof **tokens);
    if (!*tokens)
        return error_set(error, "%s: not enough memory for its tokens", shader->path);
    struct writer writer = {.model = model, .at = *tokens};
    *writer.at++ = (model->stage == STAGE_VERTEX ? TOKEN_VERTEX : TOKEN_PIXEL) | model->version;
    for (uint32_t i = 0; i < shader->count; i++)
        put_instruction(&writer, &shader->instructions[i]);
    *writer.at++ = TOKEN_END;
    *count = (size_t)(writer.at - *tokens);
    return 0;
}
