/* Canonical text: the resources in their order, then the calls in theirs. What a call leaves to its default
 * is not written, so that the text stays short; numbers have as few digits as read back as the same binary32.
 */
#include "base/file.h"
#include "base/half.h"
#include "base/memory_file.h"
#include "draw/format.h"
#include "container/layout.h"
#include "stream/asset.h"
#include "stream/folder.h"
#include "stream/stream.h"
#include "stream/words.h"

#include <errno.h>
#include <inttypes.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct writer {
    FILE *out;
    const struct stream *stream;
    char *prefix; /* from the new text's folder to that of the old, in front of relative paths; "" if they are
                     one */
    int by_path;  /* the files of the resource that is being written have its data */
    int starved;  /* that could not be found out for want of memory */
};

enum { VALUES_PER_LINE = 16 };

/* Numbers of matrices are read as binary64 and rounded later: both ways have to give the number. What decimal digits
 * cannot say is written as its bits. */
static void write_number(struct writer *writer, float number)
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

static void write_numbers(struct writer *writer, const float *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++)
        write_number(writer, numbers[i]);
}

/* --- Resources --------------------------------------------------------------------------------------------
 */

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

/* What follows the type, the sides and the levels. */
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

/* Component c of a packed type. */
static void write_packed(struct writer *writer, const struct vertex_type *type, const uint8_t *data,
                         unsigned c)
{
    uint32_t word, bit = c * type->bits;
    memcpy(&word, data + bit / 32 * 4, sizeof word);
    uint32_t field = word >> bit % 32 & ((1u << type->bits) - 1), sign = 1u << (type->bits - 1);
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
    const struct vertex_type *type = &vertex_types[format];
    uint32_t color;
    float number;
    memcpy(&color, data, sizeof color);
    if (type->encoding == ENCODING_COLOR)
        fprintf(writer->out, " 0x%08" PRIx32, color);
    else if (type->encoding != ENCODING_FLOAT)
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

/* Lines of their own, behind four spaces. */
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
    int files = resource->path || resource->face_path[0];
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
    case RESOURCE_SEQUENCE: return;
    }
    fputc('\n', writer->out);
}

/* --- Calls ------------------------------------------------------------------------------------------------
 */

/* A word and its numbers, unless they are the default's. */
static void write_field(struct writer *writer, const char *word, const float *numbers, const float *initial,
                        size_t count)
{
    if (initial && !memcmp(numbers, initial, count * sizeof *numbers))
        return;
    fprintf(writer->out, " %s", word);
    write_numbers(writer, numbers, count);
}

static void write_value(struct writer *writer, const struct triptych_kind *kind, uint32_t value)
{
    const char *word = triptych_value_word(kind, value);
    float number;
    if (word)
        fprintf(writer->out, " %s", word);
    else if (kind->notation == TRIPTYCH_NOTATION_HEXADECIMAL)
        fprintf(writer->out, " 0x%08" PRIx32, value);
    else if (kind->notation == TRIPTYCH_NOTATION_NUMBER)
        fprintf(writer->out, " %" PRIu32, value);
    else {
        memcpy(&number, &value, sizeof number);
        write_number(writer, number);
    }
}

static void write_set(struct writer *writer, const struct call *call)
{
    const struct triptych_state_row *state = triptych_state_at(call->set.table, call->set.row);
    fputs(triptych_table_name(call->set.table), writer->out);
    if (call->set.table != TRIPTYCH_RENDER_STATES)
        fprintf(writer->out, " %" PRIu32, call->set.i);
    fprintf(writer->out, " %s", state->name);
    write_value(writer, state->kind, call->set.value);
}

static void write_transform_name(struct writer *writer, unsigned which)
{
    if (which >= TRIPTYCH_TRANSFORM_WORLD1)
        fprintf(writer->out, " world %u", which - TRIPTYCH_TRANSFORM_WORLD1 + 1);
    else if (which >= TRIPTYCH_TRANSFORM_TEXTURE0)
        fprintf(writer->out, " texture %u", which - TRIPTYCH_TRANSFORM_TEXTURE0);
    else
        fprintf(writer->out, " %s", word_text(WORDS_TRANSFORM, which));
}

static void write_material(struct writer *writer, const struct triptych_material *material)
{
    const struct triptych_material *initial = &stream_default_material;
    fputs("material", writer->out);
    write_field(writer, "diffuse", material->diffuse, initial->diffuse, 4);
    write_field(writer, "ambient", material->ambient, initial->ambient, 4);
    write_field(writer, "emissive", material->emissive, initial->emissive, 4);
    write_field(writer, "specular", material->specular, initial->specular, 4);
    write_field(writer, "power", &material->power, &initial->power, 1);
}

static void write_light(struct writer *writer, uint32_t index, const struct triptych_light *light)
{
    const struct triptych_light *initial = &stream_default_light;
    static const char *const type[] = {"directional", "point", "spot"};
    fprintf(writer->out, "light %" PRIu32 " %s", index, type[light->type]);
    write_field(writer, "diffuse", light->diffuse, initial->diffuse, 4);
    write_field(writer, "ambient", light->ambient, initial->ambient, 4);
    write_field(writer, "specular", light->specular, initial->specular, 4);
    if (light->type != TRIPTYCH_LIGHT_POINT)
        write_field(writer, "direction", light->direction, initial->direction, 3);
    if (light->type == TRIPTYCH_LIGHT_DIRECTIONAL)
        return;
    write_field(writer, "position", light->position, initial->position, 3);
    write_field(writer, "range", &light->range, &initial->range, 1);
    write_field(writer, "attenuation", light->attenuation, initial->attenuation, 3);
    if (light->type == TRIPTYCH_LIGHT_POINT)
        return;
    write_field(writer, "theta", &light->theta, &initial->theta, 1);
    write_field(writer, "phi", &light->phi, &initial->phi, 1);
    write_field(writer, "falloff", &light->falloff, &initial->falloff, 1);
}

static void write_bind_element(struct writer *writer, const struct call *call, const char *name)
{
    fprintf(writer->out, "bind element %s", word_text(WORDS_ATTRIBUTE, call->element.attribute));
    if (call->element.format == TRIPTYCH_FORMAT_NONE)
        fputs(" none", writer->out);
    else
        fprintf(writer->out, " %s %s %" PRIu32 " %" PRIu32, word_text(WORDS_FORMAT, call->element.format),
                name, call->element.offset, call->element.stride);
}

static void write_bind_stream(struct writer *writer, const struct call *call, const char *name)
{
    fprintf(writer->out, "bind stream %" PRIu32 " %s", call->bind_stream.number, name);
    if (call->resource != NO_RESOURCE)
        fprintf(writer->out, " %" PRIu32 " %" PRIu32, call->bind_stream.offset, call->bind_stream.stride);
}

static void write_declare(struct writer *writer, const struct call *call)
{
    fputs("declare", writer->out);
    for (uint32_t i = 0; i < call->declare.count; i++) {
        const struct declared *element = &call->declare.element[i];
        if (!i || element->stream != element[-1].stream)
            fprintf(writer->out, " %u", element->stream);
        fprintf(writer->out, " %s:%s@%u", stream_element_word(element->usage, element->usage_index),
                word_text(WORDS_FORMAT, element->format), 4u * element->words);
    }
}

static void write_fvf(struct writer *writer, uint32_t fvf)
{
    static const struct {
        const char *word;
        uint32_t mask, value;
    } rows[] = {
#define FVF(word, mask, value, meaning) {#word, mask, value},
#include "def/fvf.def"
#undef FVF
    };
    fputs("fvf", writer->out);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if ((fvf & rows[i].mask) == rows[i].value)
            fprintf(writer->out, " %s", rows[i].word);
}

static const char *stage_word(enum triptych_shader_stage stage)
{
    return stage == TRIPTYCH_SHADER_PIXEL ? "pixel" : "vertex";
}

static void write_constants(struct writer *writer, const struct call *call)
{
    static const char *const word[] = {
        [CONSTANTS_FLOAT] = "constant", [CONSTANTS_INTEGER] = "integer", [CONSTANTS_BOOLEAN] = "boolean"};
    const int32_t *integers = call->constants.integers[0];
    fprintf(writer->out, "%s%s %" PRIu32, stage_word(call->constants.stage), word[call->constants.type],
            call->constants.first);
    if (call->constants.type == CONSTANTS_FLOAT)
        write_numbers(writer, call->constants.floats[0], 4 * (size_t)call->constants.count);
    else if (call->constants.type == CONSTANTS_INTEGER)
        for (int i = 0; i < (integers[3] ? 4 : 3); i++)
            fprintf(writer->out, " %" PRId32, integers[i]);
    else
        for (uint32_t i = 0; i < call->constants.count; i++)
            fputs(call->constants.booleans[i] ? " true" : " false", writer->out);
}

static void write_constant_matrix(struct writer *writer, const struct call *call)
{
    fprintf(writer->out, "%sconstant %" PRIu32 " transform", stage_word(call->constant_matrix.stage),
            call->constant_matrix.first);
    for (uint32_t i = 0; i < call->constant_matrix.factors; i++)
        write_transform_name(writer, call->constant_matrix.factor[i]);
    fprintf(writer->out, "%s%s", call->constant_matrix.inverse ? " inverse" : "",
            call->constant_matrix.transposed ? " transposed" : "");
    if (call->constant_matrix.count < CONSTANTS_PER_CALL)
        fprintf(writer->out, " count %" PRIu32, call->constant_matrix.count);
}

static void write_update(struct writer *writer, const struct call *call, const char *name)
{
    const struct triptych_box *box = &call->update.box;
    fprintf(writer->out, "update %s", name);
    if (call->update.face)
        fprintf(writer->out, " face %" PRIu32, call->update.face);
    if (call->update.level)
        fprintf(writer->out, " level %" PRIu32, call->update.level);
    if (box->width)
        fprintf(writer->out, " box %u %u %u %u %u %u", box->x, box->y, box->z, box->width, box->height,
                box->depth);
    fprintf(writer->out, " %s", writer->stream->resources[call->update.source].name);
}

static void write_clear(struct writer *writer, const struct call *call)
{
    fputs("clear", writer->out);
    if (call->clear.flags & TRIPTYCH_CLEAR_COLOR)
        write_field(writer, "color", call->clear.color, NULL, 4);
    if (call->clear.flags & TRIPTYCH_CLEAR_DEPTH)
        write_field(writer, "depth", &call->clear.depth, NULL, 1);
    if (call->clear.flags & TRIPTYCH_CLEAR_STENCIL)
        fprintf(writer->out, " stencil %" PRIu32, call->clear.stencil);
}

static void write_draw(struct writer *writer, const struct call *call)
{
    const char *primitive = word_text(WORDS_PRIMITIVE, call->draw.primitive);
    if (call->type == CALL_DRAW_INDEXED)
        fprintf(writer->out, "draw-indexed %s %" PRId32, primitive, call->draw.base);
    else
        fprintf(writer->out, "draw %s", primitive);
    fprintf(writer->out, " %" PRIu32 " %" PRIu32, call->draw.first, call->draw.count);
}

static void write_color_formats(struct writer *writer, const struct triptych_target_description *target)
{
    for (unsigned t = 0; t < TRIPTYCH_TARGETS && target->color_format[t]; t++)
        fprintf(writer->out, "%s %s", t ? "" : " color", format_find(target->color_format[t])->name);
}

static void write_surface(struct writer *writer, const char *word, const struct stream_surface *surface)
{
    fprintf(writer->out, " %s%s", word,
            surface->resource == NO_RESOURCE ? "target" : writer->stream->resources[surface->resource].name);
    if (surface->level)
        fprintf(writer->out, " level %" PRIu32, surface->level);
    if (surface->slice)
        fprintf(writer->out, " slice %" PRIu32, surface->slice);
}

static void write_attach(struct writer *writer, const struct call *call)
{
    int last = TRIPTYCH_TARGETS - 1;
    fputs(call->attach.some ? "attach" : "attach none", writer->out);
    while (last >= 0 && call->attach.color[last].resource == NO_RESOURCE)
        last--;
    for (int t = 0; t <= last && call->attach.some; t++)
        if (call->attach.color[t].resource != NO_RESOURCE)
            write_surface(writer, "color ", &call->attach.color[t]);
        else
            fputs(" color none", writer->out);
    if (call->attach.depth.resource != NO_RESOURCE)
        write_surface(writer, "depth ", &call->attach.depth);
    if (call->attach.depth_format)
        fprintf(writer->out, " depthformat %s", word_text(WORDS_DEPTH, call->attach.depth_format));
}

static void write_copy(struct writer *writer, const struct call *call)
{
    fputs("copy", writer->out);
    for (int i = 0; i < 2; i++) {
        const struct triptych_rectangle *part = &call->copy.part[i];
        write_surface(writer, i ? "to " : "", &call->copy.surface[i]);
        if (part->width)
            fprintf(writer->out, " part %u %u %u %u", part->x, part->y, part->width, part->height);
    }
    fputs(call->copy.filter == TRIPTYCH_COPY_LINEAR ? " linear" : "", writer->out);
}

static void write_call(struct writer *writer, const struct call *call)
{
    FILE *out = writer->out;
    const char *name =
        call->resource == NO_RESOURCE ? "none" : writer->stream->resources[call->resource].name;
    switch (call->type) {
    case CALL_TARGET:
        fprintf(out, "target %u %u", call->target.width, call->target.height);
        if (call->target.depth_format)
            fprintf(out, " depth %s", word_text(WORDS_DEPTH, call->target.depth_format));
        if (call->target.samples)
            fprintf(out, " samples %u", call->target.samples);
        write_color_formats(writer, &call->target);
        break;
    case CALL_ATTACH: write_attach(writer, call); break;
    case CALL_COPY: write_copy(writer, call); break;
    case CALL_VIEWPORT: {
        const struct triptych_viewport *v = &call->viewport;
        const float numbers[6] = {v->x, v->y, v->width, v->height, v->depth_near, v->depth_far};
        fputs("viewport", out);
        write_numbers(writer, numbers, 6);
        break;
    }
    case CALL_SCISSOR:
        fprintf(out, "scissor %" PRIu32 " %" PRIu32 " %" PRIu32 " %" PRIu32, call->scissor.x, call->scissor.y,
                call->scissor.width, call->scissor.height);
        break;
    case CALL_SET: write_set(writer, call); break;
    case CALL_CONVENTION:
        fprintf(out, "convention %s %s", word_text(WORDS_CONVENTION, call->convention.which),
                word_text(WORDS_PIXEL_CENTER + call->convention.which, call->convention.value));
        break;
    case CALL_CLIP_PLANE:
        fprintf(out, "clipplane %" PRIu32, call->clip_plane.index);
        write_numbers(writer, call->clip_plane.plane, 4);
        break;
    case CALL_TRANSFORM:
        fputs("transform", out);
        write_transform_name(writer, call->transform.which);
        write_field(writer, "matrix", &call->transform.matrix[0][0], NULL, 16);
        break;
    case CALL_MATERIAL: write_material(writer, &call->material); break;
    case CALL_LIGHT: write_light(writer, call->light.index, &call->light.value); break;
    case CALL_ENABLE_LIGHT:
        fprintf(out, "light %" PRIu32 " %s", call->light.index, call->light.on ? "on" : "off");
        break;
    case CALL_BIND_TEXTURE:
        fprintf(out, "bind texture ");
        if (call->sampler)
            fprintf(out, "%" PRIu32 " ", call->sampler);
        fprintf(out, "%s", name);
        break;
    case CALL_BIND_VERTICES: fprintf(out, "bind vertices %s", name); break;
    case CALL_BIND_INDICES:
        fprintf(out, "bind indices %s", name);
        if (call->index_bits)
            fprintf(out, " %" PRIu32, call->index_bits);
        break;
    case CALL_BIND_ELEMENT: write_bind_element(writer, call, name); break;
    case CALL_BIND_STREAM: write_bind_stream(writer, call, name); break;
    case CALL_DECLARE: write_declare(writer, call); break;
    case CALL_FVF: write_fvf(writer, call->fvf); break;
    case CALL_FREQUENCY:
        fprintf(out, "frequency %" PRIu32 " %s %" PRIu32, call->frequency.stream,
                word_text(WORDS_FREQUENCY, call->frequency.frequency), call->frequency.count);
        break;
    case CALL_SHADER: fprintf(out, "%sshader %s", stage_word(call->shader), name); break;
    case CALL_CONSTANTS: write_constants(writer, call); break;
    case CALL_CONSTANT_MATRIX: write_constant_matrix(writer, call); break;
    case CALL_UPDATE: write_update(writer, call, name); break;
    case CALL_MIPS: fprintf(out, "mips %s", name); break;
    case CALL_TEXELS:
        fprintf(out, "texels %s %s", name, writer->stream->resources[call->texels.source].name);
        break;
    case CALL_CONTENTS: fprintf(out, "contents %s", name); break;
    case CALL_RELEASE: fprintf(out, "release %s", name); break;
    case CALL_CLEAR: write_clear(writer, call); break;
    case CALL_DRAW:
    case CALL_DRAW_INDEXED: write_draw(writer, call); break;
    case CALL_DRAW_MESH: fprintf(out, "draw mesh %s", name); break;
    case CALL_BEGIN_QUERY: fprintf(out, "begin-query %s", name); break;
    case CALL_END_QUERY: fprintf(out, "end-query %s", name); break;
    case CALL_FRAME: fputs("frame", out); break;
    case CALL_PLAY: fprintf(out, "play %s", name); break;
    case CALL_SEQUENCE: fprintf(out, "sequence %s", name); break;
    }
    fputc('\n', out);
}

static void write_calls(struct writer *writer)
{
    const struct stream *stream = writer->stream;
    uint32_t end = UINT32_MAX; /* of the sequence that is open */
    for (uint32_t i = 0; i <= stream->call_count; i++) {
        if (i == end) {
            fputs("end\n", writer->out);
            end = UINT32_MAX;
        }
        if (i == stream->call_count)
            break;
        const struct call *call = &stream->calls[i];
        if (end != UINT32_MAX)
            fputs("    ", writer->out);
        write_call(writer, call);
        if (call->type == CALL_SEQUENCE)
            end = i + 1 + call->sequence.count;
    }
}

/* --- Streams ----------------------------------------------------------------------------------------------
 */

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
