/* The reader of bytecode. The tokens are not trusted: every read is checked against the end, every field
 * against its range, and an instruction's length against its tokens. Unused bits must be zero. So a shader
 * that was read is encoded as the same tokens, except for comments.
 *
 * A relative index by aL may have the swizzle .xyzw or .x. */
#include "shader/code/read.h"
#include "shader/code/token.h"

#include <inttypes.h>
#include <string.h>

struct reader {
    struct shader *shader;
    struct error *error;
    const unsigned char *data;
    uint32_t count, at;                     /* tokens, and the next one's number */
    struct shader_instruction *instruction; /* the one being read, or null */
};

static int fail_at(struct reader *reader, uint32_t token, const char *reason, uint32_t value)
{
    return error_set(reader->error, "%s: token %" PRIu32 ": found 0x%08" PRIx32 ", %s", reader->shader->path,
                     token, value, reason);
}

static uint32_t token_at(const struct reader *reader, uint32_t token)
{
    const unsigned char *bytes = reader->data + 4 * (size_t)token;
    return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static int take(struct reader *reader, uint32_t *token)
{
    if (reader->at == reader->count)
        return error_set(reader->error, "%s: token %" PRIu32 ": found the end of the data, expected %s",
                         reader->shader->path, reader->at,
                         reader->instruction ? "an operand" : "an instruction or the end token 0x0000ffff");
    *token = token_at(reader, reader->at++);
    return 0;
}

/* Refuses the last token that was read. */
static int refuse(struct reader *reader, uint32_t token, const char *reason)
{
    return fail_at(reader, reader->at - 1, reason, token);
}

/* --- Operands ------------------------------------------------------------------------------------------ */

/* File and number, from bits that sources and destinations share. */
static int decode_register(struct reader *reader, uint32_t token, struct shader_operand *operand)
{
    const struct shader_model *model = reader->shader->model;
    unsigned type = (token >> 28 & 7) | (token >> 11 & 3) << 3, index = token & (TOKEN_REGISTERS - 1);
    if (!(token & TOKEN_SET))
        return refuse(reader, token, "expected an operand, whose bit 31 is set");
    if (token & 0xc000)
        return refuse(reader, token, "expected an operand, whose bits 14 and 15 are zero");
    if (type >= TOKEN_TYPE_CONTINUED && type < TOKEN_TYPE_CONTINUED + 3) {
        index += (type - TOKEN_TYPE_CONTINUED + 1) * TOKEN_REGISTERS;
        type = TOKEN_TYPE_CONSTANT;
    }
    for (unsigned file = 1; file < FILE_COUNT; file++) {
        const struct shader_register *row = &shader_registers[file];
        if (row->type != type || !shader_register_count(file, model) ||
            (row->index != NUMBERED && row->index != index))
            continue;
        operand->file = (uint8_t)file;
        operand->index = (uint16_t)(row->index == NUMBERED ? index : 0);
        operand->place = (uint16_t)(reader->at - 1 - reader->instruction->place);
        return 0;
    }
    return refuse(reader, token, "expected a register that the shader's model has");
}

/* Reads the index register that follows an operand. */
static int read_relative(struct reader *reader, uint32_t token, struct shader_operand *operand)
{
    struct shader_operand index = {0};
    uint32_t relative = 0;
    if (!(token & TOKEN_RELATIVE))
        return 0;
    if (shader_registers[operand->file].index != NUMBERED)
        return refuse(reader, token, "expected no relative addressing of this register");
    operand->relative = FILE_ADDRESS;
    if (shader_major(reader->shader->model) < 2)
        return reader->shader->model->stage == STAGE_VERTEX
                   ? 0
                   : refuse(reader, token, "expected no relative addressing in this model");
    if (take(reader, &relative) || decode_register(reader, relative, &index))
        return -1;
    unsigned swizzle = relative >> 16 & 0xff;
    if ((index.file != FILE_ADDRESS && index.file != FILE_LOOP) || index.index || relative & TOKEN_RELATIVE ||
        relative & 0x0f000000)
        return refuse(reader, relative, "expected a0 or aL, for relative addressing");
    if (!swizzle_replicates(swizzle) && !(index.file == FILE_LOOP && swizzle == SWIZZLE_NONE))
        return refuse(reader, relative, "expected one component of a0");
    operand->relative = index.file;
    operand->component = index.file == FILE_ADDRESS ? swizzle & 3 : 0;
    return 0;
}

static int read_source(struct reader *reader, struct shader_operand *operand)
{
    uint32_t token = 0;
    if (take(reader, &token) || decode_register(reader, token, operand))
        return -1;
    operand->swizzle = (uint8_t)(token >> 16);
    operand->modifier = token >> 24 & 15;
    if (operand->modifier >= MODIFIER_COUNT ||
        shader_modifiers[operand->modifier].columns[reader->shader->model->column] == '.')
        return refuse(reader, token, "expected a modifier that the shader's model has");
    return read_relative(reader, token, operand);
}

static int read_destination(struct reader *reader, struct shader_operand *operand)
{
    uint32_t token = 0;
    if (take(reader, &token) || decode_register(reader, token, operand))
        return -1;
    unsigned shift = token >> 24 & 15;
    operand->swizzle = token >> 16 & 15;
    operand->modifier = token >> 20 & 15;
    operand->shift = (int8_t)(shift < 8 ? (int)shift : (int)shift - 16);
    if (!operand->swizzle)
        return refuse(reader, token, "expected a mask that is not empty");
    if (operand->modifier & ~(RESULT_SATURATE | RESULT_PARTIAL | RESULT_CENTROID))
        return refuse(reader, token, "expected a result modifier that exists");
    if (operand->shift < -3 || operand->shift > 3)
        return refuse(reader, token, "expected a shift from -3 to 3");
    return read_relative(reader, token, operand);
}

/* dcl's first token, then the register. */
static int read_declaration(struct reader *reader, struct shader_instruction *instruction)
{
    uint32_t token = 0, place = reader->at;
    if (take(reader, &token))
        return -1;
    instruction->usage = token & 15;
    instruction->usage_index = token >> 16 & 15;
    instruction->kind = token >> 27 & 15;
    if (!(token & TOKEN_SET) || token & 0x07f0fff0)
        return refuse(reader, token, "expected a usage, whose other bits are zero");
    if (!shader_word_name(shader_usages, instruction->usage))
        return refuse(reader, token, "expected a usage from 0 to 13");
    if (read_destination(reader, &instruction->destination))
        return -1;
    unsigned file = instruction->destination.file;
    if (file == FILE_SAMPLER ? !shader_word_name(shader_kinds, instruction->kind) : instruction->kind)
        return fail_at(reader, place, "expected a kind of texture (2, 3 or 4) for a sampler and none else",
                       token);
    if (!shader_has_usage(file, reader->shader->model) && (instruction->usage || instruction->usage_index))
        return fail_at(reader, place, "expected no usage of this register", token);
    return 0;
}

static int read_literals(struct reader *reader, struct shader_instruction *instruction)
{
    bool boolean = instruction->opcode == SHADER_DEFB;
    for (unsigned i = 0; i < (boolean ? 1 : 4); i++)
        if (take(reader, &instruction->literal[i]))
            return -1;
    /* Any value but zero is true. */
    if (boolean)
        instruction->literal[0] = instruction->literal[0] != 0;
    return 0;
}

static int read_operands(struct reader *reader, struct shader_instruction *instruction, bool predicated)
{
    const struct shader_operation *row = &shader_operations[instruction->opcode];
    bool literals = row->destination >= OPERAND_CONSTANT && row->destination <= OPERAND_CONSTANT_BOOLEAN;
    if (row->destination == OPERAND_DECLARED ? read_declaration(reader, instruction)
        : row->destination                   ? read_destination(reader, &instruction->destination)
                                             : 0)
        return -1;
    if (predicated) {
        uint32_t place = reader->at;
        if (read_source(reader, &instruction->predicate))
            return -1;
        if (instruction->predicate.file != FILE_PREDICATE || instruction->predicate.relative)
            return fail_at(reader, place, "expected the predicate p0", token_at(reader, place));
    }
    if (literals)
        return read_literals(reader, instruction);
    for (unsigned i = 0; i < SHADER_SOURCES && row->source[i]; i++)
        if (read_source(reader, &instruction->source[i]))
            return -1;
    return 0;
}

/* --- Instructions -------------------------------------------------------------------------------------- */

static enum shader_opcode find_operation(const struct shader_model *model, unsigned opcode, unsigned control)
{
    for (unsigned i = 0; i < SHADER_COUNT; i++) {
        const struct shader_operation *row = &shader_operations[i];
        if (row->opcode == opcode && shader_slots(row, model) >= 0 &&
            (row->control == COMPARISON ? shader_word_name(shader_comparisons, control) != NULL
                                        : row->control == control))
            return i;
    }
    return SHADER_COUNT;
}

static int read_instruction(struct reader *reader, uint32_t token)
{
    const struct shader_model *model = reader->shader->model;
    unsigned control = token >> 16 & 0xff, length = token >> 24 & 15;
    bool modern = shader_major(model) >= 2;
    enum shader_opcode opcode = find_operation(model, token & 0xffff, control);
    if (opcode == SHADER_COUNT)
        return refuse(reader, token, "expected an instruction that the shader's model has");
    if (token & 0xa0000000 || (token & TOKEN_COISSUE && (modern || model->stage == STAGE_VERTEX)) ||
        (token & TOKEN_PREDICATED && !modern))
        return refuse(reader, token, "expected an instruction, whose reserved bits are zero");
    struct shader_instruction *instruction = shader_append(reader->shader, reader->error);
    if (!instruction)
        return -1;
    instruction->opcode = (uint8_t)opcode;
    instruction->place = reader->at - 1;
    instruction->coissue = token & TOKEN_COISSUE;
    if (shader_operations[opcode].control == COMPARISON)
        instruction->comparison = (uint8_t)control;
    reader->instruction = instruction;
    if (read_operands(reader, instruction, token & TOKEN_PREDICATED))
        return -1;
    reader->instruction = NULL;
    if (length != (modern ? reader->at - instruction->place - 1 : 0))
        return fail_at(reader, instruction->place,
                       modern ? "expected the number of its operands' tokens in bits 24 to 27"
                              : "expected zero in bits 24 to 27",
                       token);
    return 0;
}

/* Reads the names in a comment, and skips it. */
static int read_comment(struct reader *reader, uint32_t token)
{
    uint32_t length = token >> 16 & 0x7fff;
    if (token & TOKEN_SET)
        return refuse(reader, token, "expected a comment, whose bit 31 is zero");
    if (length > reader->count - reader->at)
        return refuse(reader, token, "expected a comment that ends before the data");
    if (shader_read_names(reader->shader, reader->data + 4 * (size_t)reader->at, 4 * (size_t)length,
                          reader->at, reader->error))
        return -1;
    reader->at += length;
    return 0;
}

static int read_version(struct reader *reader)
{
    uint32_t token = 0;
    if (take(reader, &token))
        return -1;
    for (unsigned i = MODEL_COUNT; i-- > 0;) { /* the first model with a version is used: 2_x */
        const struct shader_model *model = &shader_models[i];
        if (token == ((model->stage == STAGE_VERTEX ? TOKEN_VERTEX : TOKEN_PIXEL) | model->version))
            reader->shader->model = model;
    }
    return reader->shader->model
               ? 0
               : refuse(reader, token,
                        "expected a version token, 0xfffe0101 to 0xfffe0300 or 0xffff0101 to "
                        "0xffff0300");
}

static int read_tokens(struct reader *reader)
{
    uint32_t token = 0;
    if (read_version(reader))
        return -1;
    for (;;) {
        if (take(reader, &token))
            return -1;
        if (token == TOKEN_END)
            break;
        if ((token & 0xffff) == TOKEN_COMMENT ? read_comment(reader, token) : read_instruction(reader, token))
            return -1;
    }
    if (reader->at == reader->count)
        return 0;
    return fail_at(reader, reader->at, "expected nothing after the end token", token_at(reader, reader->at));
}

int shader_read(const char *path, const void *code, size_t bytes, struct shader **shader, struct error *error)
{
    struct reader reader = {.shader = shader_create(path, true, error), .error = error, .data = code};
    *shader = NULL;
    if (!reader.shader)
        return -1;
    if (bytes > SHADER_BYTES || bytes % 4) {
        error_set(error, "%s: %zu bytes, expected a multiple of 4, at most %d", path, bytes, SHADER_BYTES);
    } else {
        reader.count = (uint32_t)(bytes / 4);
        if (!read_tokens(&reader)) {
            *shader = reader.shader;
            return 0;
        }
    }
    shader_free(reader.shader);
    return -1;
}
