/* What the text's grammar makes sure of, for calls that come from a container: that they name resources of the right
 * kinds, and say nothing that has no text. call_code() has seen to enumerations and array indices already; what is
 * executed is then followed like any other stream (check.c). */
#include "draw/device.h"
#include "shader/program.h"
#include "stream/check.h"

#include <math.h>
#include <string.h>

static int check_resources(const struct stream *stream, struct call *call, struct error *error)
{
    struct call_resource resources[CALL_RESOURCES];
    unsigned count = call_resources(call, resources);
    for (unsigned i = 0; i < count; i++) {
        uint32_t number = *resources[i].number;
        if (number == NO_RESOURCE && resources[i].optional)
            continue;
        if (number >= stream->resource_count)
            return error_set(error, "found resource %u, expected one defined before", number);
        const struct resource *resource = &stream->resources[number];
        if (!resource->name || !(resources[i].types >> resource->type & 1))
            return error_set(error, "found resource %u (%s), expected one of another kind", number,
                             resource->name ? resource->name : "released");
    }
    return 0;
}

static int check_finite(const float *numbers, size_t count, struct error *error)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(numbers[i]))
            return error_set(error, "found a number that is not finite, expected finite ones");
    return 0;
}

static int check_light(const struct triptych_light *light, struct error *error)
{
    const float single[] = {light->range, light->theta, light->phi, light->falloff};
    return check_finite(light->diffuse, 4, error) || check_finite(light->ambient, 4, error) ||
                   check_finite(light->specular, 4, error) || check_finite(light->direction, 3, error) ||
                   check_finite(light->position, 3, error) || check_finite(light->attenuation, 3, error) ||
                   check_finite(single, 4, error)
               ? -1
               : 0;
}

static int check_material(const struct triptych_material *material, struct error *error)
{
    return check_finite(material->diffuse, 4, error) || check_finite(material->ambient, 4, error) ||
                   check_finite(material->emissive, 4, error) || check_finite(material->specular, 4, error) ||
                   check_finite(&material->power, 1, error)
               ? -1
               : 0;
}

static int check_viewport(const struct triptych_viewport *v, struct error *error)
{
    const float numbers[] = {v->x, v->y, v->width, v->height, v->depth_near, v->depth_far};
    return check_finite(numbers, 6, error);
}

static int check_clear(const struct call *call, struct error *error)
{
    unsigned flags = call->clear.flags;
    return check_finite(call->clear.color, flags & TRIPTYCH_CLEAR_COLOR ? 4 : 0, error) ||
                   check_finite(&call->clear.depth, flags & TRIPTYCH_CLEAR_DEPTH ? 1 : 0, error)
               ? -1
               : 0;
}

/* Colours stand one behind the other. */
static int check_target(const struct triptych_target_description *target, struct error *error)
{
    for (int t = 1; t < TRIPTYCH_TARGETS; t++)
        if (target->color_format[t] && !target->color_format[t - 1])
            return error_set(error, "found colour target %d without the one before it, expected both", t);
    return device_check_target(target, error) ? -1 : 0;
}

static int check_set(const struct call *call, struct error *error)
{
    const struct triptych_state_row *state = triptych_state_at(call->set.table, call->set.row);
    float number;
    memcpy(&number, &call->set.value, sizeof number);
    return state->kind->notation == TRIPTYCH_NOTATION_REAL ? check_finite(&number, 1, error) : 0;
}

static int check_declaration(const struct call *call, struct error *error)
{
    const struct declared *e = call->declare.element;
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

static int check_shader(const struct stream *stream, const struct call *call, struct error *error)
{
    if (call->resource == NO_RESOURCE)
        return 0;
    const struct shader_model *model = stream->resources[call->resource].program->model;
    if (model->stage != (int)call->shader)
        return error_set(error, "found a shader of model %s, expected one of the other stage", model->name);
    return 0;
}

static int check_indices(const struct stream *stream, const struct call *call, struct error *error)
{
    if (call->resource == NO_RESOURCE)
        return call->index_bits ? error_set(error, "found bits of no indices, expected indices") : 0;
    const struct resource *resource = &stream->resources[call->resource];
    int bytes = resource->type == RESOURCE_BUFFER && resource->value_type == VALUE_BYTES;
    if (bytes != (call->index_bits != 0))
        return error_set(error, "found %u bits for %s, expected them for bytes alone", call->index_bits,
                         resource->name);
    return bytes || resource->index_count
               ? 0
               : error_set(error, "found a buffer of other values, expected one of integers or bytes");
}

static int check_attached(const struct call *call, struct error *error)
{
    int given = call->attach.depth.resource != NO_RESOURCE, format = call->attach.depth_format != 0;
    for (int t = 0; t < TRIPTYCH_TARGETS; t++)
        given |= call->attach.color[t].resource != NO_RESOURCE;
    if (given != call->attach.some)
        return error_set(error, "found %s, expected textures to draw to, or none at all",
                         given ? "textures of no target" : "no texture");
    if (format && (!call->attach.some || call->attach.depth.resource != NO_RESOURCE))
        return error_set(error, "found a depth format beside a depth texture, expected one of them");
    return 0;
}

static int check_parts(const struct call *call, struct error *error)
{
    for (int i = 0; i < 2; i++) {
        const struct triptych_rectangle *part = &call->copy.part[i];
        if (part->width ? !part->height : part->x || part->y || part->height)
            return error_set(error, "found a part without pixels, expected at least one, or all zeros");
    }
    return 0;
}

static int check_box(const struct stream *stream, const struct call *call, struct error *error)
{
    const struct triptych_box *box = &call->update.box;
    if (!box->width && (box->x || box->y || box->z || box->height || box->depth))
        return error_set(error, "found a box without texels, expected at least one");
    return check_update(stream, call, error);
}

int call_check(const struct stream *stream, struct call *call, struct error *error)
{
    if (check_resources(stream, call, error))
        return -1;
    switch (call->type) {
    case CALL_TARGET: return check_target(&call->target, error);
    case CALL_VIEWPORT: return check_viewport(&call->viewport, error);
    case CALL_SET: return check_set(call, error);
    case CALL_CLIP_PLANE: return check_finite(call->clip_plane.plane, 4, error);
    case CALL_TRANSFORM: return check_finite(call->transform.matrix[0], 16, error);
    case CALL_MATERIAL: return check_material(&call->material, error);
    case CALL_LIGHT: return check_light(&call->light.value, error);
    case CALL_BIND_INDICES: return check_indices(stream, call, error);
    case CALL_DECLARE: return check_declaration(call, error);
    case CALL_FVF:
        return check_fvf(call->fvf)
                   ? error_set(error, "found vertex format 0x%x, expected parts of one", call->fvf)
                   : 0;
    case CALL_SHADER: return check_shader(stream, call, error);
    case CALL_UPDATE: return check_box(stream, call, error);
    case CALL_ATTACH: return check_attached(call, error);
    case CALL_COPY: return check_parts(call, error);
    case CALL_CLEAR: return check_clear(call, error);
    default: return 0;
    }
}

static void note(struct stream *stream, uint32_t number)
{
    if (number != NO_RESOURCE)
        stream->resources[number].changes = 1;
}

void stream_note_changes(struct stream *stream, const struct call *call)
{
    if (call->type == CALL_UPDATE || call->type == CALL_MIPS || call->type == CALL_TEXELS)
        note(stream, call->resource);
    if (call->type == CALL_COPY)
        note(stream, call->copy.surface[1].resource);
    for (int t = 0; t < TRIPTYCH_TARGETS && call->type == CALL_ATTACH; t++)
        note(stream, call->attach.color[t].resource);
    if (call->type == CALL_ATTACH)
        note(stream, call->attach.depth.resource);
}

int vertices_check_bits(const struct resource *resource, struct error *error)
{
    for (unsigned e = 0; e < STREAM_ELEMENTS; e++) {
        const struct vertex_type *type = &vertex_types[resource->layout.format[e]];
        unsigned used = (unsigned)type->bits * type->components % 32;
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
