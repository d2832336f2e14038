/* Checks of calls from containers, which the grammar of the text makes for calls from text. call_code() has
 * already checked enumerations and array indices. Afterwards calls are followed like those of any stream
 * (follow.c). */
#include "render/device/device.h"
#include "render/target/rectangle.h"
#include "shader/program/program.h"
#include "command/stream/valid.h"
#include "command/stream/functions.h"

#include <math.h>
#include <string.h>

static int check_resource(const struct stream *stream, uint32_t number, const struct call_field *field,
                          struct error *error)
{
    if (number == NO_RESOURCE && field->or_none)
        return 0;
    if (number >= stream->resource_count)
        return error_set(error, "found resource %u, expected one defined before", number);
    const struct resource *resource = &stream->resources[number];
    if (!resource->name || !(field->types >> resource->type & 1))
        return error_set(error, "found resource %u (%s), expected one of another kind", number,
                         resource->name ? resource->name : "released");
    return 0;
}

static int check_finite(const float *numbers, size_t count, struct error *error)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(numbers[i]))
            return error_set(error, "found a number that is not finite, expected finite ones");
    return 0;
}

/* Of both kinds: the values come first. */
int valid_clear(const struct stream *stream, const struct call *call, struct error *error)
{
    (void)stream;
    const struct call_clear *clear = call_clear_values(call);
    return check_finite(clear->color, clear->flags & TRIPTYCH_CLEAR_COLOR ? 4 : 0, error) ||
                   check_finite(&clear->depth, clear->flags & TRIPTYCH_CLEAR_DEPTH ? 1 : 0, error)
               ? -1
               : 0;
}

/* Colours must be consecutive. */
int valid_target(const struct stream *stream, const struct call *call, struct error *error)
{
    const struct triptych_target_description *target = &call->target;
    (void)stream;
    for (int t = 1; t < TRIPTYCH_TARGETS; t++)
        if (target->color_format[t] && !target->color_format[t - 1])
            return error_set(error, "found colour target %d without the one before it, expected both", t);
    return device_check_target(target, error) ? -1 : 0;
}

int valid_set(const struct stream *stream, const struct call *call, struct error *error)
{
    const struct triptych_state_row *state = triptych_state_at(call->set.table, call->set.row);
    float number;
    (void)stream;
    memcpy(&number, &call->set.value, sizeof number);
    return state->kind->notation == TRIPTYCH_NOTATION_REAL ? check_finite(&number, 1, error) : 0;
}

int valid_declare(const struct stream *stream, const struct call *call, struct error *error)
{
    const struct call_declared *e = call->declare.element;
    (void)stream;
    for (uint32_t b = 0; b < call->declare.count; b++) {
        if (e[b].format == TRIPTYCH_FORMAT_NONE)
            return error_set(error, "found an element without a format, expected one");
        for (uint32_t a = 0; a < b; a++)
            if (e[a].usage == e[b].usage && e[a].usage_index == e[b].usage_index)
                return error_set(error, "found usage %u with index %u again, expected it once", e[b].usage,
                                 e[b].usage_index);
    }
    return 0;
}

int valid_shader(const struct stream *stream, const struct call *call, struct error *error)
{
    if (call->resource == NO_RESOURCE)
        return 0;
    const struct shader_model *model = stream->resources[call->resource].program->model;
    if (model->stage != (int)call->shader.stage)
        return error_set(error, "found a shader of model %s, expected one of the other stage", model->name);
    return 0;
}

int valid_bind_indices(const struct stream *stream, const struct call *call, struct error *error)
{
    if (call->resource == NO_RESOURCE)
        return call->bind_indices.bits
                   ? error_set(error, "found a number of bits without indices, expected indices")
                   : 0;
    const struct resource *resource = &stream->resources[call->resource];
    bool bytes = resource->type == RESOURCE_BUFFER && resource->value_type == VALUE_BYTES;
    if (bytes != (call->bind_indices.bits != 0))
        return error_set(error, "found %u bits for %s, expected them only for bytes", call->bind_indices.bits,
                         resource->name);
    return bytes || resource->index_count
               ? 0
               : error_set(error, "found a buffer of other values, expected one of integers or bytes");
}

int valid_attach(const struct stream *stream, const struct call *call, struct error *error)
{
    bool given = call->attach.depth.resource != NO_RESOURCE, format = call->attach.depth_format != 0;
    (void)stream;
    for (int t = 0; t < TRIPTYCH_TARGETS; t++)
        given |= call->attach.color[t].resource != NO_RESOURCE;
    if (given != call->attach.some)
        return error_set(error, "found %s, expected %s",
                         given ? "attach none with surfaces" : "attach without a surface",
                         given ? "none" : "at least one, or attach none");
    if (format && (!call->attach.some || call->attach.depth.resource != NO_RESOURCE))
        return error_set(error, "found a depth format beside a depth surface, expected one of them");
    return 0;
}

static int valid_part(const struct triptych_rectangle *part, struct error *error)
{
    if (part->width ? !part->height : part->x || part->y || part->height)
        return error_set(error, "found a part without pixels, expected at least one, or all zeros");
    return 0;
}

int valid_copy(const struct stream *stream, const struct call *call, struct error *error)
{
    (void)stream;
    return valid_part(&call->copy.part[0], error) || valid_part(&call->copy.part[1], error) ? -1 : 0;
}

int valid_fill(const struct stream *stream, const struct call *call, struct error *error)
{
    (void)stream;
    return valid_part(&call->fill.part, error);
}

/* The depth format of a write to depth; NONE: a colour. */
static enum triptych_depth_format written_depth(const struct stream *stream,
                                                const struct call_set_pixels *write)
{
    if (write->surface.resource == NO_RESOURCE)
        return TRIPTYCH_DEPTH_NONE;
    const struct resource *resource = &stream->resources[write->surface.resource];
    if (resource->type == RESOURCE_IMAGE)
        return resource->image.format ? TRIPTYCH_DEPTH_NONE : resource->image.depth_format;
    return (enum triptych_depth_format)format_find(resource->texture.format)->depth;
}

/* The surface's own format if the write has none. */
static const struct format *written_format(const struct stream *stream, const struct call_set_pixels *write)
{
    if (write->format || write->surface.resource == NO_RESOURCE)
        return format_find(write->format);
    const struct resource *resource = &stream->resources[write->surface.resource];
    return format_find(resource->type == RESOURCE_IMAGE ? resource->image.format : resource->texture.format);
}

size_t valid_set_pixels_row(const struct stream *stream, const struct call_set_pixels *write, size_t *rows)
{
    const struct pixels depth = {.depth_format = written_depth(stream, write)};
    const struct format *format = written_format(stream, write);
    *rows = write->part.height;
    if (depth.depth_format != TRIPTYCH_DEPTH_NONE)
        return write->part.width * pixels_memory_bytes(&depth, NULL);
    *rows = format_blocks(format, write->part.height);
    return texture_row_bytes(format, write->part.width);
}

int valid_set_pixels(const struct stream *stream, const struct call *call, struct error *error)
{
    const struct call_set_pixels *write = &call->set_pixels;
    size_t rows, bytes;
    if (!write->part.width || !write->part.height)
        return error_set(error, "found a part without pixels, expected at least one");
    if (!write->format && write->surface.resource == NO_RESOURCE)
        return error_set(error, "found no format of pixels of the target, expected one");
    if (write->format && !format_find(write->format))
        return error_set(error, "found format %u, expected one of Direct3D 9's", (unsigned)write->format);
    size_t expected = valid_set_pixels_row(stream, write, &rows) * rows;
    resource_data(&stream->resources[write->source], &bytes);
    if (bytes < expected || bytes >= expected + 4) /* a value's bytes cannot always be divided */
        return error_set(error, "found %zu bytes in %s, expected %zu", bytes,
                         stream->resources[write->source].name, expected);
    return 0;
}

int valid_update_bytes(const struct stream *stream, const struct call *call, struct error *error)
{
    const struct resource *resources = stream->resources;
    const struct triptych_box *box = call->update.box.width ? &call->update.box : NULL;
    struct triptych_texture shape;
    texture_describe(&resources[call->resource].texture, &shape, NULL);
    size_t pitch = (size_t)1 << 20, bytes;
    if (texture_check_update(&shape, call->update.face, call->update.level, box, pitch, pitch * pitch, error))
        return -1;
    resource_data(&resources[call->update.source], &bytes);
    size_t expected = texture_level_bytes(&shape, call->update.level);
    if (box)
        expected = texture_row_bytes(shape.format, box->width) * format_blocks(shape.format, box->height) *
                   box->depth;
    if (bytes < expected || bytes >= expected + 4) /* a value's bytes cannot always be divided */
        return error_set(error, "found %zu bytes in %s, expected %zu", bytes,
                         resources[call->update.source].name, expected);
    return 0;
}

int valid_update(const struct stream *stream, const struct call *call, struct error *error)
{
    const struct triptych_box *box = &call->update.box;
    if (!box->width && (box->x || box->y || box->z || box->height || box->depth))
        return error_set(error, "found a box without texels, expected at least one");
    return valid_update_bytes(stream, call, error);
}

static const struct {
    uint32_t mask, value;
} fvf_parts[] = {
#define FVF(word, mask, value, meaning) {mask, value},
#include "def/state/fvf.def"
#undef FVF
};

int valid_fvf(const struct stream *stream, const struct call *call, struct error *error)
{
    uint32_t rest = call->fvf.code;
    (void)stream;
    for (size_t i = 0; i < sizeof fvf_parts / sizeof *fvf_parts; i++)
        if ((call->fvf.code & fvf_parts[i].mask) == fvf_parts[i].value)
            rest &= ~fvf_parts[i].mask;
    return call->fvf.code && !rest
               ? 0
               : error_set(error, "found vertex format 0x%x, expected parts of one", call->fvf.code);
}

/* --- All calls ------------------------------------------------------------------------------------------ */

int valid_call(const struct stream *stream, struct call *call, struct error *error)
{
    const struct call_field *fields = call_row(call->type)->fields;
    for (const struct call_field *f = fields; (f = call_next_resource(f)); f++)
        if (check_resource(stream, *call_resource(call, f), f, error))
            return -1;
    for (const struct call_field *f = fields; f->kind != FIELD_END; f++)
        if (f->kind == FIELD_FLOATS && check_finite(call_floats(call, f), f->count, error))
            return -1;
    return calls_functions[call->type].check ? calls_functions[call->type].check(stream, call, error) : 0;
}

int valid_vertex_bits(const struct resource *resource, struct error *error)
{
    for (unsigned e = 0; e < STREAM_ELEMENTS; e++) {
        const struct vertex_type *type = &key_vertex_types[resource->layout.format[e]];
        unsigned bits = (unsigned)type->bits * type->components, used = bits % 8 ? bits % 32 : 0;
        for (uint32_t v = 0; used && v < resource->vertex_count; v++) {
            const uint8_t *vertex = resource->vertices + (size_t)v * resource->layout.stride;
            uint32_t word;
            memcpy(&word, vertex + resource->layout.offset[e] + type->bytes - sizeof word, sizeof word);
            if (word >> used)
                return error_set(error, "found 0x%08x of type %s in vertex %u, expected zeros above bit %u",
                                 word, type->word, v, used - 1);
        }
    }
    return 0;
}
