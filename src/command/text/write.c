/* Canonical text: resources, then calls, in their order. Default values of calls are not written, to keep the
 * text short. Numbers have the fewest digits that are read as the same binary32. */
#include "base/file.h"
#include "base/half.h"
#include "base/memory_file.h"
#include "render/texture/format.h"
#include "capture/layout.h"
#include "command/assets/asset.h"
#include "command/assets/folder.h"
#include "capture/word.h"
#include "command/text/write_part.h"

#include <errno.h>
#include <inttypes.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VALUES_PER_LINE = 16 };

/* Numbers of matrices are read as binary64 and rounded later, so both ways must give the same number. Numbers
 * without decimal digits are written as bits. */
void write_number(struct writer *writer, float number)
{
    char text[32];
    if (!isfinite(number)) {
        fprintf(writer->out, " bits:%08" PRIx32, triptych_float_bits(number));
        return;
    }
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)number);
        if (strtof(text, NULL) == number && (float)strtod(text, NULL) == number)
            break;
    }
    fprintf(writer->out, " %s", text);
}

void write_numbers(struct writer *writer, const float *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++)
        write_number(writer, numbers[i]);
}

/* --- Resources ------------------------------------------------------------------------------------------ */

static void write_path(struct writer *writer, const char *path)
{
    const char *parts[2] = {path[0] == '/' ? "" : writer->prefix, path};
    fputs(" \"", writer->out);
    for (int p = 0; p < 2; p++)
        for (const char *c = parts[p]; *c; c++) {
            if (*c == '"' || *c == '\\')
                fputc('\\', writer->out);
            fputc(*c, writer->out);
        }
    fputc('"', writer->out);
}

/* { color... } */
static void write_colors(struct writer *writer, const uint32_t *colors, size_t count, size_t line)
{
    fputs(" {", writer->out);
    for (size_t i = 0; i < count; i++)
        fprintf(writer->out, "%s0x%08" PRIx32, i % line ? " " : "\n    ", colors[i]);
    fputs("\n}", writer->out);
}

static void write_image(struct writer *writer, const struct resource *resource)
{
    size_t count = resource->texel_bytes / 4, width = resource->texture.width;
    size_t line = width < VALUES_PER_LINE ? width : VALUES_PER_LINE;
    fprintf(writer->out, " %u %u {", resource->texture.width, resource->texture.height);
    for (size_t i = 0; i < count; i++) {
        const uint8_t *c = resource->texels + 4 * i;
        fprintf(writer->out, "%s%02x%02x%02x%02x", i % line ? " " : "\n    ", c[3], c[0], c[1], c[2]);
    }
    fputs("\n}", writer->out);
}

static void write_hexadecimal(struct writer *writer, const uint8_t *bytes, size_t count)
{
    fputs(" {", writer->out);
    for (size_t i = 0; i < count; i++)
        fprintf(writer->out, "%s%02x", i % 32 ? i % 4 ? "" : " " : "\n    ", bytes[i]);
    fputs("\n}", writer->out);
}

static void write_bytes(struct writer *writer, const uint8_t *bytes, size_t count)
{
    fputs(" bytes", writer->out);
    write_hexadecimal(writer, bytes, count);
}

static void write_texture_type(struct writer *writer, const struct resource *resource)
{
    const struct triptych_texture_description *texture = &resource->texture;
    fprintf(writer->out, " %s %s %u", word_text(WORDS_TEXTURETYPE, texture->type),
            format_find(texture->format)->name, texture->width);
    if (texture->type != TRIPTYCH_TEXTURE_CUBE)
        fprintf(writer->out, " %u", texture->height);
    if (texture->type == TRIPTYCH_TEXTURE_VOLUME)
        fprintf(writer->out, " %u", texture->depth);
    if (texture->levels != (resource->mips ? 0 : 1))
        fprintf(writer->out, " levels %u", texture->levels);
    if (resource->mips)
        fputs(" mips", writer->out);
}

/* Writes the contents, which follow the type, the sides and the levels. */
static void write_contents(struct writer *writer, const struct resource *resource)
{
    switch (resource->source) {
    case TEXTURE_EMPTY: fputs(" empty", writer->out); break;
    case TEXTURE_IMAGE:
    case TEXTURE_DDS:
    case TEXTURE_BYTES: write_bytes(writer, resource->texels, resource->texel_bytes); break;
    case TEXTURE_GRADIENT: fputs(" gradient", writer->out); break;
    case TEXTURE_CHECKER:
        fprintf(writer->out, " checker %" PRIu32 " 0x%08" PRIx32 " 0x%08" PRIx32, resource->cell,
                resource->colors[0], resource->colors[1]);
        break;
    case TEXTURE_COLORS:
    case TEXTURE_FILL:
        fputs(resource->source == TEXTURE_FILL ? " fill" : " colors", writer->out);
        write_colors(writer, resource->colors, resource->color_count, VALUES_PER_LINE / 2);
        break;
    case TEXTURE_FILES:
        if (!writer->by_path) {
            write_bytes(writer, resource->texels, resource->texel_bytes);
            break;
        }
        fputs(" files", writer->out);
        for (int face = 0; face < 6 && resource->face_path[face]; face++)
            write_path(writer, resource->face_path[face]);
        break;
    }
}

static void write_texture(struct writer *writer, const struct resource *resource)
{
    fprintf(writer->out, "texture %s", resource->name);
    if (resource->path && writer->by_path) {
        fputs(" file", writer->out);
        write_path(writer, resource->path);
    } else if (resource->source == TEXTURE_IMAGE) {
        write_image(writer, resource);
    } else {
        write_texture_type(writer, resource);
        write_contents(writer, resource);
    }
}

/* Writes component `c` of a packed format. */
static void write_packed(struct writer *writer, const struct vertex_type *type, const uint8_t *data,
                         unsigned c)
{
    uint32_t words[4] = {0}, bit = c * type->bits;
    memcpy(words, data, type->bytes);
    uint32_t sign = 1u << (type->bits - 1);
    uint32_t field = words[bit / 32] >> bit % 32 & (sign | (sign - 1));
    if (type->encoding == ENCODING_HALF && (field & 0x7c00) == 0x7c00)
        fprintf(writer->out, " bits:%04" PRIx32, field);
    else if (type->encoding == ENCODING_HALF)
        write_number(writer, half_to_float((uint16_t)field));
    else if (type->encoding == ENCODING_SIGNED)
        fprintf(writer->out, " %" PRId32, (int32_t)((field ^ sign) - sign));
    else
        fprintf(writer->out, " %" PRIu32, field);
}

static void write_typed(struct writer *writer, enum triptych_format format, const uint8_t *data)
{
    const struct vertex_type *type = &key_vertex_types[format];
    uint32_t color;
    float number;
    if (type->encoding == ENCODING_COLOR) {
        memcpy(&color, data, sizeof color);
        fprintf(writer->out, " 0x%08" PRIx32, color);
    } else if (type->encoding != ENCODING_FLOAT)
        for (unsigned c = 0; c < type->components; c++)
            write_packed(writer, type, data, c);
    else
        for (unsigned c = 0; c < type->components; c++) {
            memcpy(&number, data + 4 * c, sizeof number);
            write_number(writer, number);
        }
}

static void write_vertices(struct writer *writer, const struct resource *resource)
{
    const struct layout *layout = &resource->layout;
    unsigned order[STREAM_ELEMENTS];
    unsigned count = layout_order(layout, order);
    for (unsigned i = 0; i < count; i++)
        fprintf(writer->out, " %s:%s", word_text(WORDS_ATTRIBUTE, order[i]),
                word_text(WORDS_FORMAT, layout->format[order[i]]));
    fputs(" {\n", writer->out);
    for (uint32_t v = 0; v < resource->vertex_count; v++) {
        const uint8_t *vertex = resource->vertices + (size_t)v * layout->stride;
        fputs("   ", writer->out);
        for (unsigned i = 0; i < count; i++)
            write_typed(writer, layout->format[order[i]], vertex + layout->offset[order[i]]);
        fputc('\n', writer->out);
    }
    fputc('}', writer->out);
}

static void write_indices(struct writer *writer, const struct resource *resource)
{
    const uint16_t *narrow = resource->indices;
    const uint32_t *wide = resource->indices;
    fputs(" {", writer->out);
    for (uint32_t i = 0; i < resource->index_count; i++)
        fprintf(writer->out, "%s%" PRIu32, i % VALUES_PER_LINE ? " " : "\n    ",
                resource->index_bits == 16 ? narrow[i] : wide[i]);
    fputs("\n}", writer->out);
}

static void write_values(struct writer *writer, const struct resource *resource)
{
    enum triptych_format format =
        resource->value_type == VALUE_COLOR ? TRIPTYCH_FORMAT_COLOR : TRIPTYCH_FORMAT_FLOAT1;
    fputs(" {", writer->out);
    for (size_t i = 0; i < resource->vertex_bytes / 4; i++) {
        fputs(i % VALUES_PER_LINE ? "" : "\n   ", writer->out);
        write_typed(writer, format, resource->vertices + 4 * i);
    }
    fputs("\n}", writer->out);
}

static void write_target_image(struct writer *writer, const struct resource *resource)
{
    const struct triptych_image_description *image = &resource->image;
    fprintf(writer->out, "image %s %u %u", resource->name, image->width, image->height);
    if (image->format)
        fprintf(writer->out, " %s", format_find(image->format)->name);
    else
        fprintf(writer->out, " depth %s", word_text(WORDS_DEPTH, image->depth_format));
    if (image->samples)
        fprintf(writer->out, " samples %u", image->samples);
}

static void write_mesh(struct writer *writer, const struct resource *resource)
{
    const struct mesh_options *options = &resource->options;
    if (!writer->by_path || options->source == MESH_DATA) {
        fputs(" data", writer->out);
        write_vertices(writer, resource);
        fprintf(writer->out, " %" PRIu32, resource->index_bits);
        write_indices(writer, resource);
        return;
    }
    fprintf(writer->out, " %s", word_text(WORDS_MESH, options->source));
    if (resource->path)
        write_path(writer, resource->path);
    if (options->source == MESH_BEZIER)
        fprintf(writer->out, " subdivisions %u", options->subdivisions);
    if (options->source == MESH_TORUS)
        write_numbers(writer, &options->tube, 1);
    if (options->cells[0])
        fprintf(writer->out, " %" PRIu32 " %" PRIu32, options->cells[0], options->cells[1]);
    if (options->source == MESH_SHADOW) {
        fprintf(writer->out, " %s %s", writer->stream->resources[options->caster].name,
                options->light_is_point ? "point" : "directional");
        write_numbers(writer, options->light, 3);
        write_numbers(writer, &options->length, 1);
    }
    if (options->normals != NORMALS_SMOOTH)
        fprintf(writer->out, " normals %s", word_text(WORDS_NORMALS, options->normals));
    if (options->texcoords != TEXCOORDS_KEEP)
        fprintf(writer->out, " texcoords %s", word_text(WORDS_TEXCOORDS, options->texcoords));
    if (options->bones)
        fputs(" bones", writer->out);
    if (options->repeat[0] != 0) {
        fputs(" repeat", writer->out);
        write_numbers(writer, options->repeat, 2);
    }
    if (options->center)
        fputs(" center", writer->out);
    if (options->fit > 0) {
        fputs(" fit", writer->out);
        write_number(writer, options->fit);
    }
}

/* Writes the text, each line after four spaces. */
static void write_shader(struct writer *writer, const struct resource *resource)
{
    if (resource->path && writer->by_path) {
        write_path(writer, resource->path);
        return;
    }
    fputs(" {\n", writer->out);
    for (const char *line = resource->code, *end; *line; line = end + 1) {
        end = strchr(line, '\n');
        fprintf(writer->out, "    %.*s\n", (int)(end - line), line);
    }
    fputc('}', writer->out);
}

static void write_resource(struct writer *writer, const struct resource *resource)
{
    bool files = resource->path || (resource->type == RESOURCE_TEXTURE && resource->face_path[0]);
    errno = 0;
    writer->by_path = !files || !resource->embedded || asset_is_unchanged(writer->stream, resource);
    writer->starved |= !writer->by_path && errno == ENOMEM;
    switch (resource->type) {
    case RESOURCE_TEXTURE: write_texture(writer, resource); break;
    case RESOURCE_VERTICES:
        fprintf(writer->out, "vertices %s", resource->name);
        write_vertices(writer, resource);
        break;
    case RESOURCE_INDICES:
        fprintf(writer->out, "indices %s %" PRIu32, resource->name, resource->index_bits);
        write_indices(writer, resource);
        break;
    case RESOURCE_BUFFER:
        fprintf(writer->out, "buffer %s %s", resource->name, word_text(WORDS_VALUE, resource->value_type));
        if (resource->value_type == VALUE_BYTES)
            write_hexadecimal(writer, resource->vertices, resource->vertex_bytes);
        else if (resource->indices)
            write_indices(writer, resource);
        else
            write_values(writer, resource);
        break;
    case RESOURCE_MESH:
        fprintf(writer->out, "mesh %s", resource->name);
        write_mesh(writer, resource);
        break;
    case RESOURCE_SHADER:
        fprintf(writer->out, "shader %s", resource->name);
        write_shader(writer, resource);
        break;
    case RESOURCE_QUERY: fprintf(writer->out, "query %s", resource->name); break;
    case RESOURCE_IMAGE: write_target_image(writer, resource); break;
    case RESOURCE_SEQUENCE: return;
    }
    fputc('\n', writer->out);
}

/* --- Streams -------------------------------------------------------------------------------------------- */

char *stream_write_call(const struct stream *stream, const struct call *call)
{
    struct writer writer = {.stream = stream, .out = memory_file_open()};
    locale_t locale = newlocale(LC_NUMERIC_MASK, "C", NULL);
    char *text = NULL;
    size_t bytes;
    if (writer.out && locale) {
        locale_t before = uselocale(locale);
        write_call(&writer, call);
        uselocale(before);
    }
    if (writer.out)
        memory_file_close(writer.out, &text, &bytes);
    if (locale)
        freelocale(locale);
    return text;
}

static int write_all(struct writer *writer, char **text, size_t *bytes)
{
    writer->out = memory_file_open();
    if (!writer->out)
        return -1;
    fputs("triptych 1\n", writer->out);
    for (uint32_t i = 0; i < writer->stream->resource_count; i++)
        write_resource(writer, &writer->stream->resources[i]);
    write_calls(writer);
    int closed = memory_file_close(writer->out, text, bytes);
    return writer->starved ? -1 : closed;
}

int stream_write(const struct stream *stream, const char *path, char **text, size_t *bytes,
                 struct error *error)
{
    struct writer writer = {.stream = stream};
    *text = NULL;
    int result = folder_prefix(stream, path, &writer.prefix, error);
    locale_t locale = result ? NULL : newlocale(LC_NUMERIC_MASK, "C", NULL);
    if (locale) {
        locale_t before = uselocale(locale);
        result = write_all(&writer, text, bytes);
        uselocale(before);
        freelocale(locale);
    } else {
        result = -1;
    }
    free(writer.prefix);
    if (!result)
        return 0;
    free(*text);
    *text = NULL;
    return error_set(error, "%s: not enough memory", path);
}

int stream_save(const struct stream *stream, const char *path, struct error *error)
{
    char *text;
    size_t bytes;
    if (stream_write(stream, path, &text, &bytes, error))
        return -1;
    int result = file_write(path, text, bytes, error);
    free(text);
    return result;
}
