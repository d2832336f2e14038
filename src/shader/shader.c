#include "shader/shader.h"
#include "base/file.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATH_SHOWN = 200 };

struct shader *shader_create(const char *path, bool bytecode, struct error *error)
{
    struct shader *shader = calloc(1, sizeof *shader);
    char *copy = strdup(path);
    if (!shader || !copy) {
        free(shader);
        free(copy);
        error_set(error, "%s: not enough memory", path);
        return NULL;
    }
    shader->path = copy;
    shader->bytecode = bytecode;
    return shader;
}

void shader_free(struct shader *shader)
{
    if (!shader)
        return;
    free(shader->instructions);
    free(shader->names);
    free(shader->path);
    free(shader);
}

struct shader_instruction *shader_append(struct shader *shader, struct error *error)
{
    if (shader->count == SHADER_INSTRUCTIONS) {
        error_set(error, "%s: more than %d instructions", shader->path, SHADER_INSTRUCTIONS);
        return NULL;
    }
    if (shader->count == shader->capacity) {
        uint32_t capacity = shader->capacity ? 2 * shader->capacity : 64;
        void *grown = realloc(shader->instructions, capacity * sizeof *shader->instructions);
        if (!grown) {
            error_set(error, "%s: not enough memory for %" PRIu32 " instructions", shader->path, capacity);
            return NULL;
        }
        shader->instructions = grown;
        shader->capacity = capacity;
    }
    struct shader_instruction *instruction = &shader->instructions[shader->count++];
    memset(instruction, 0, sizeof *instruction);
    return instruction;
}

int shader_fail(const struct shader *shader, const struct shader_instruction *instruction,
                const struct shader_operand *operand, struct error *error, const char *reason, ...)
{
    char text[ERROR_CAPACITY];
    size_t length = strlen(shader->path);
    bool cut = length > PATH_SHOWN;
    const char *dots = cut ? "..." : "", *path = shader->path + (cut ? length - PATH_SHOWN : 0);
    va_list arguments;
    va_start(arguments, reason);
    vsnprintf(text, sizeof text, reason, arguments);
    va_end(arguments);
    unsigned inside = operand && operand->place ? operand->place : 0;
    if (shader->bytecode)
        return error_set(error, "%s%s: token %" PRIu32 ": %s", dots, path, instruction->place + inside, text);
    return error_set(error, "%s%s:%" PRIu32 ":%u: %s", dots, path, instruction->place,
                     inside ? inside : instruction->column, text);
}

int shader_load(const char *path, struct shader **shader, struct error *error)
{
    char *data;
    size_t bytes;
    *shader = NULL;
    if (file_read(path, SHADER_BYTES, &data, &bytes, error))
        return -1;
    bool bytecode = bytes >= 4 && (unsigned char)data[3] == 0xff;
    int bad = bytecode ? shader_read(path, data, bytes, shader, error)
                       : shader_assemble(path, data, bytes, shader, error);
    free(data);
    return bad;
}
