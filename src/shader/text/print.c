/* The disassembler: canonical text, which assembles to the same tokens.
 *
 * One instruction per line, in small letters as in the tables; components are x, y, z, w. A full mask and an
 * identity swizzle are left out. A swizzle that replicates a component is that letter; any other is four
 * letters. Numbers of def are the shortest decimals that give the same bits, or those bits in hexadecimal if
 * they are not finite. Names of constants are printed first, as comments. */
#include "base/bits.h"
#include "base/memory_file.h"
#include "shader/shader.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char components[] = "xyzw";

static void print_register(FILE *out, const struct shader_operand *operand)
{
    const struct shader_register *row = &shader_registers[operand->file];
    fputs(row->name, out);
    if (row->index == NUMBERED)
        fprintf(out, "%u", operand->index);
    if (operand->relative == FILE_ADDRESS)
        fprintf(out, "[a0.%c]", components[operand->component]);
    else if (operand->relative)
        fprintf(out, "[%s]", shader_registers[operand->relative].name);
}

static void print_source(FILE *out, const struct shader_operand *operand)
{
    const struct shader_modifier *modifier = &shader_modifiers[operand->modifier];
    unsigned swizzle = operand->swizzle;
    fputs(modifier->before, out);
    print_register(out, operand);
    fputs(modifier->after, out);
    if (swizzle == SWIZZLE_NONE)
        return;
    fputc('.', out);
    for (unsigned i = 0; i < (swizzle_replicates(swizzle) ? 1 : 4); i++)
        fputc(components[swizzle_component(swizzle, i)], out);
}

static void print_destination(FILE *out, const struct shader_operand *operand)
{
    print_register(out, operand);
    if (operand->swizzle == MASK_FULL)
        return;
    fputc('.', out);
    for (unsigned i = 0; i < 4; i++)
        if (operand->swizzle >> i & 1)
            fputc(components[i], out);
}

static void print_result(FILE *out, const struct shader_operand *operand)
{
    if (operand->shift)
        fprintf(out, "_%c%d", operand->shift < 0 ? 'd' : 'x', 1 << abs(operand->shift));
    if (operand->modifier & RESULT_SATURATE)
        fputs("_sat", out);
    if (operand->modifier & RESULT_PARTIAL)
        fputs("_pp", out);
    if (operand->modifier & RESULT_CENTROID)
        fputs("_centroid", out);
}

static void print_declaration(FILE *out, const struct shader_instruction *instruction,
                              const struct shader_model *model)
{
    if (instruction->kind) {
        fprintf(out, "_%s", shader_word_name(shader_kinds, instruction->kind));
    } else if (shader_has_usage(instruction->destination.file, model)) {
        fprintf(out, "_%s", shader_word_name(shader_usages, instruction->usage));
        if (instruction->usage_index)
            fprintf(out, "%u", instruction->usage_index);
    }
}

static void print_float(FILE *out, uint32_t bits)
{
    char text[32];
    float value = bits_to_float(bits), back;
    if (!isfinite(value)) {
        fprintf(out, "0x%08" PRIx32, bits);
        return;
    }
    for (int digits = 1; digits <= 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)value);
        back = strtof(text, NULL);
        if (!memcmp(&back, &value, sizeof value))
            break;
    }
    fputs(text, out);
}

static void print_literals(FILE *out, const struct shader_instruction *instruction)
{
    unsigned kind = shader_operations[instruction->opcode].destination;
    if (kind == OPERAND_CONSTANT_BOOLEAN) {
        fputs(instruction->literal[0] ? ", true" : ", false", out);
        return;
    }
    for (unsigned i = 0; i < 4; i++) {
        fputs(", ", out);
        if (kind == OPERAND_CONSTANT)
            print_float(out, instruction->literal[i]);
        else
            fprintf(out, "%" PRId32, (int32_t)instruction->literal[i]);
    }
}

static void print_instruction(FILE *out, const struct shader_instruction *instruction,
                              const struct shader_model *model)
{
    const struct shader_operation *row = &shader_operations[instruction->opcode];
    const char *between = " ";
    if (instruction->predicate.file) {
        fputc('(', out);
        print_source(out, &instruction->predicate);
        fputs(") ", out);
    }
    fprintf(out, "%s%s", instruction->coissue ? "+" : "", row->name);
    if (instruction->comparison)
        fprintf(out, "_%s", shader_word_name(shader_comparisons, instruction->comparison));
    if (row->destination == OPERAND_DECLARED)
        print_declaration(out, instruction, model);
    if (row->destination) {
        print_result(out, &instruction->destination);
        fputs(between, out);
        print_destination(out, &instruction->destination);
        between = ", ";
    }
    if (row->destination >= OPERAND_CONSTANT && row->destination <= OPERAND_CONSTANT_BOOLEAN)
        print_literals(out, instruction);
    for (unsigned i = 0; i < SHADER_SOURCES && row->source[i]; i++) {
        fputs(between, out);
        print_source(out, &instruction->source[i]);
        between = ", ";
    }
    fputc('\n', out);
}

static void print_names(FILE *out, const struct shader *shader)
{
    for (uint32_t i = 0; i < shader->name_count; i++) {
        const struct shader_name *name = &shader->names[i];
        fprintf(out, "; %s%u", shader_registers[name->file].name, name->index);
        if (name->count > 1)
            fprintf(out, " to %s%u", shader_registers[name->file].name, name->index + name->count - 1u);
        fprintf(out, ": %s\n", name->name);
    }
}

int shader_print(const struct shader *shader, char **text, size_t *bytes, struct error *error)
{
    FILE *out = memory_file_open();
    *text = NULL;
    if (!out)
        return error_set(error, "%s: not enough memory for its text", shader->path);
    fprintf(out, "%s\n", shader->model->name);
    print_names(out, shader);
    for (uint32_t i = 0; i < shader->count; i++)
        print_instruction(out, &shader->instructions[i], shader->model);
    return memory_file_close(out, text, bytes)
               ? error_set(error, "%s: not enough memory for its text", shader->path)
               : 0;
}
