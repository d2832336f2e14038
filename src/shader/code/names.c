/* The constant table that compilers leave in a shader's comment: the names of constants.
 *
 * After the letters CTAB, from which offsets are counted (the layout of D3DXSHADER_CONSTANTTABLE):
 *
 *   0  size of this header, 28    4  offset of the creator's name    8  version token
 *   12 number of constants        16 offset of the constants         20 flags
 *   24 offset of the target's name
 *
 * and per constant, 20 bytes (D3DXSHADER_CONSTANTINFO):
 *
 *   0  offset of the name         4  register set: b, i, c, s        6  first register
 *   8  registers                  10 reserved                        12 offset of the type
 *   16 offset of the default value
 *
 * Types and defaults are not read. Names become printable text of at most SHADER_NAME_BYTES - 1 bytes. */
#include "shader/code/read.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { HEADER_BYTES = 28, CONSTANT_BYTES = 20, NAMES = 8192 };

static uint32_t word(const unsigned char *at)
{
    return at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static uint16_t half(const unsigned char *at)
{
    return (uint16_t)(at[0] | at[1] << 8);
}

static void copy_name(char name[SHADER_NAME_BYTES], const unsigned char *from, size_t bytes)
{
    size_t i = 0;
    for (; i < bytes && i < SHADER_NAME_BYTES - 1 && from[i]; i++)
        name[i] = (char)(from[i] > ' ' && from[i] < 0x7f ? from[i] : '?');
    name[i] = 0;
}

static bool read_constant(struct shader_name *name, const unsigned char *table, size_t bytes, uint32_t offset)
{
    static const uint8_t files[] = {FILE_BOOLEAN, FILE_INTEGER, FILE_CONSTANT, FILE_SAMPLER};
    const unsigned char *constant = table + offset;
    uint32_t text = word(constant);
    unsigned set = half(constant + 4);
    if (text >= bytes || set >= sizeof files)
        return false;
    copy_name(name->name, table + text, bytes - text);
    name->file = files[set];
    name->index = half(constant + 6);
    name->count = half(constant + 8);
    return true;
}

int shader_read_names(struct shader *shader, const unsigned char *comment, size_t bytes, uint32_t token,
                      struct error *error)
{
    if (bytes < 4 || memcmp(comment, "CTAB", 4))
        return 0;
    const unsigned char *table = comment + 4;
    bytes -= 4;
    uint32_t count = bytes >= HEADER_BYTES ? word(table + 12) : 0;
    uint32_t first = bytes >= HEADER_BYTES ? word(table + 16) : 0;
    if (bytes < HEADER_BYTES || count > NAMES || first > bytes ||
        (size_t)count * CONSTANT_BYTES > bytes - first)
        return error_set(
            error, "%s: token %" PRIu32 ": found a broken constant table, expected one that fits its comment",
            shader->path, token);
    if (!count)
        return 0;
    if (shader->name_count + (size_t)count > NAMES)
        return error_set(error, "%s: more than %d names of constants", shader->path, NAMES);
    struct shader_name *names = realloc(shader->names, (shader->name_count + (size_t)count) * sizeof *names);
    if (!names)
        return error_set(error, "%s: not enough memory for the names of constants", shader->path);
    shader->names = names;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t offset = first + i * CONSTANT_BYTES;
        if (!read_constant(&names[shader->name_count], table, bytes, offset))
            return error_set(error,
                             "%s: token %" PRIu32 ": found a broken entry %" PRIu32 " of the constant table",
                             shader->path, token, i);
        shader->name_count++;
    }
    return 0;
}
