/* Calls of the interface as calls of a stream. */
#include "capture/record_part.h"
#include "base/minmax.h"
#include "render/target/surface.h"

#include <locale.h>
#include <stdlib.h>
#include <string.h>

/* --- Resources ------------------------------------------------------------------------------------------ */

void record_new_buffer(struct triptych_device *device, triptych_buffer *buffer)
{
    if (device_recorder(device))
        buffer->recorded = record_bytes(device, buffer->data, buffer->bytes);
}

void record_new_texture(struct triptych_device *device, triptych_texture *texture)
{
    struct resource resource = {.type = RESOURCE_TEXTURE, .source = TEXTURE_EMPTY};
    if (!device_recorder(device))
        return;
    resource.texture = (struct triptych_texture_description){
        texture->type,  (enum triptych_surface_format)texture->format->number,
        texture->width, texture->height,
        texture->depth, texture->levels};
    texture->recorded = record_define(device, &resource);
}

void record_new_image(struct triptych_device *device, triptych_image *image)
{
    struct resource resource = {.type = RESOURCE_IMAGE, .image = image->description};
    if (device_recorder(device))
        image->recorded = record_define(device, &resource);
}

/* Prints canonical text. The front end needs a locale whose numbers have a decimal point. */
static int print_shader(const triptych_shader *made, struct resource *resource)
{
    struct shader *shader;
    locale_t locale = newlocale(LC_NUMERIC_MASK, "C", NULL);
    if (!locale)
        return -1;
    locale_t before = uselocale(locale);
    int result = made->source_is_text
                     ? shader_assemble("shader", made->source, made->source_bytes, &shader, NULL)
                     : shader_read("shader", made->source, made->source_bytes, &shader, NULL);
    if (!result) {
        result = shader_print(shader, &resource->code, &resource->code_bytes, NULL);
        shader_free(shader);
    }
    uselocale(before);
    freelocale(locale);
    return result;
}

void record_new_shader(struct triptych_device *device, triptych_shader *shader)
{
    struct resource resource = {.type = RESOURCE_SHADER};
    if (!device_recorder(device))
        return;
    if (print_shader(shader, &resource))
        record_memory_is_short(device);
    shader->recorded = record_define(device, &resource);
    free(resource.code);
}

void record_new_query(struct triptych_device *device, triptych_query *query)
{
    if (device_recorder(device) && query->type == TRIPTYCH_QUERY_OCCLUSION)
        query->recorded = record_define(device, &(struct resource){.type = RESOURCE_QUERY});
}

/* --- Ends of resources ---------------------------------------------------------------------------------- */

void record_end_buffer(struct triptych_device *device, const triptych_buffer *buffer)
{
    const struct state *state = device_state(device);
    if (!device_recorder(device) || !device_has_buffer(device, buffer))
        return;
    for (unsigned i = 0; i < TRIPTYCH_STREAMS; i++)
        if (state->stream[i].buffer == buffer)
            record_stream(device, i, NULL, 0, 0);
    for (unsigned a = 0; a < TRIPTYCH_ATTRIBUTE_COUNT; a++)
        if (state->element[a].format && state->element[a].stream >= TRIPTYCH_STREAMS &&
            state->stream[state->element[a].stream].buffer == buffer)
            record_element(device, (enum triptych_attribute)a, &(struct triptych_element){0});
    if (state->indices == buffer)
        record_indices(device, NULL, 0);
    record_release(device, buffer->recorded);
}

void record_end_texture(struct triptych_device *device, const triptych_texture *texture)
{
    if (!device_recorder(device) || !device_has_texture(device, texture))
        return;
    if (device_draws_to(device, texture))
        record_attach(device, NULL);
    for (unsigned i = 0; i < TRIPTYCH_SAMPLERS; i++)
        if (device_state(device)->texture[i] == texture)
            record_bind_texture(device, i, NULL);
    if (device_state(device)->clip_mask.texture == texture)
        record_clip_mask(device, &(const struct triptych_clip_mask){.texture = NULL});
    record_release(device, texture->recorded);
}

void record_end_image(struct triptych_device *device, const triptych_image *image)
{
    if (!device_recorder(device) || !device_has_image(device, image))
        return;
    if (device_draws_to_image(device, image))
        record_attach(device, NULL);
    record_release(device, image->recorded);
}

void record_end_shader(struct triptych_device *device, const triptych_shader *shader)
{
    if (!device_recorder(device) || !device_has_shader(device, shader))
        return;
    for (int stage = 0; stage < SHADER_STAGES; stage++)
        if (device_shader(device, (enum triptych_shader_stage)stage) == shader)
            record_shader(device, (enum shader_stage)stage, NULL);
    record_release(device, shader->recorded);
}

void record_end_query(struct triptych_device *device, const triptych_query *query)
{
    if (!device_recorder(device) || !device_has_query(device, query) ||
        query->type != TRIPTYCH_QUERY_OCCLUSION)
        return;
    if (query->phase == QUERY_BEGUN)
        record_call(device, &(struct call){.type = CALL_END_QUERY, .resource = query->recorded});
    record_release(device, query->recorded);
}

/* --- State ---------------------------------------------------------------------------------------------- */

void record_value(struct triptych_device *device, enum triptych_state_table table, unsigned i, unsigned row,
                  uint32_t value)
{
    if (device_recorder(device))
        record_call(device,
                    &(struct call){.type = CALL_SET, .resource = NO_RESOURCE, .set = {table, i, row, value}});
}

void record_convention(struct triptych_device *device, enum triptych_convention which, unsigned value)
{
    if (device_recorder(device))
        record_call(
            device,
            &(struct call){.type = CALL_CONVENTION, .resource = NO_RESOURCE, .convention = {which, value}});
}

void record_clip_mask(struct triptych_device *device, const struct triptych_clip_mask *mask)
{
    struct call call = {.type = CALL_CLIP_MASK, .resource = NO_RESOURCE};
    if (!device_recorder(device))
        return;
    if (mask->texture)
        call.resource = mask->texture->recorded;
    call.clip_mask.x = mask->x;
    call.clip_mask.y = mask->y;
    call.clip_mask.box_x = min_u32(mask->box.x, TRIPTYCH_TARGET_MAXIMUM);
    call.clip_mask.box_y = min_u32(mask->box.y, TRIPTYCH_TARGET_MAXIMUM);
    call.clip_mask.box_width = min_u32(mask->box.width, TRIPTYCH_TARGET_MAXIMUM);
    call.clip_mask.box_height = min_u32(mask->box.height, TRIPTYCH_TARGET_MAXIMUM);
    record_call(device, &call);
}

void record_clip_plane(struct triptych_device *device, unsigned i, const float plane[4])
{
    if (!device_recorder(device))
        return;
    struct call call = {.type = CALL_CLIP_PLANE, .resource = NO_RESOURCE, .clip_plane.index = i};
    memcpy(call.clip_plane.plane, plane, sizeof call.clip_plane.plane);
    record_call(device, &call);
}

void record_transform(struct triptych_device *device, enum triptych_transform which, const float matrix[4][4])
{
    if (!device_recorder(device))
        return;
    struct call call = {.type = CALL_TRANSFORM, .resource = NO_RESOURCE, .transform.which = which};
    memcpy(call.transform.matrix, matrix, sizeof call.transform.matrix);
    record_call(device, &call);
}

void record_material(struct triptych_device *device, const struct triptych_material *material)
{
    if (device_recorder(device))
        record_call(device,
                    &(struct call){.type = CALL_MATERIAL, .resource = NO_RESOURCE, .material = *material});
}

void record_light(struct triptych_device *device, unsigned index, const struct triptych_light *light)
{
    if (!device_recorder(device))
        return;
    struct call call = {.type = CALL_LIGHT, .resource = NO_RESOURCE};
    call.light.index = index;
    call.light.value = *light;
    record_call(device, &call);
}

void record_enable_light(struct triptych_device *device, unsigned index, bool on)
{
    if (!device_recorder(device))
        return;
    struct call call = {.type = CALL_ENABLE_LIGHT, .resource = NO_RESOURCE};
    call.enable_light.index = index;
    call.enable_light.on = on;
    record_call(device, &call);
}

void record_bind_texture(struct triptych_device *device, unsigned sampler, const triptych_texture *texture)
{
    if (!device_recorder(device))
        return;
    struct call call = {.type = CALL_BIND_TEXTURE, .bind_texture.sampler = sampler};
    call.resource = texture ? texture->recorded : NO_RESOURCE;
    record_call(device, &call);
}

void record_shader(struct triptych_device *device, enum shader_stage stage, const triptych_shader *shader)
{
    if (!device_recorder(device))
        return;
    struct call call = {.type = CALL_SHADER, .shader.stage = (enum triptych_shader_stage)stage};
    call.resource = shader ? shader->recorded : NO_RESOURCE;
    record_call(device, &call);
}

/* --- Constants ------------------------------------------------------------------------------------------ */

void record_floats(struct triptych_device *device, enum triptych_shader_stage stage, unsigned first,
                   const float *values, unsigned count)
{
    while (device_recorder(device) && count) {
        unsigned part = count < CONSTANTS_PER_CALL ? count : CONSTANTS_PER_CALL;
        struct call call = {.type = CALL_CONSTANTS, .resource = NO_RESOURCE};
        call.constants.stage = stage;
        call.constants.type = CONSTANTS_FLOAT;
        call.constants.first = first;
        call.constants.count = part;
        memcpy(call.constants.floats, values, part * sizeof *call.constants.floats);
        record_call(device, &call);
        first += part;
        values += 4 * (size_t)part;
        count -= part;
    }
}

void record_integers(struct triptych_device *device, enum triptych_shader_stage stage, unsigned first,
                     const int32_t *values, unsigned count)
{
    for (unsigned i = 0; i < count && device_recorder(device); i++) {
        struct call call = {.type = CALL_CONSTANTS, .resource = NO_RESOURCE};
        call.constants.stage = stage;
        call.constants.type = CONSTANTS_INTEGER;
        call.constants.first = first + i;
        call.constants.count = 1;
        memcpy(call.constants.integers, values + 4 * (size_t)i, sizeof *call.constants.integers);
        record_call(device, &call);
    }
}

void record_booleans(struct triptych_device *device, enum triptych_shader_stage stage, unsigned first,
                     const int32_t *values, unsigned count)
{
    struct call call = {.type = CALL_CONSTANTS, .resource = NO_RESOURCE};
    if (!device_recorder(device) || !count)
        return;
    call.constants.stage = stage;
    call.constants.type = CONSTANTS_BOOLEAN;
    call.constants.first = first;
    call.constants.count = count;
    for (unsigned i = 0; i < count; i++)
        call.constants.booleans[i] = values[i] != 0;
    record_call(device, &call);
}

/* --- Buffers -------------------------------------------------------------------------------------------- */

void record_write(struct triptych_device *device, const triptych_buffer *buffer, struct buffer_span span)
{
    if (!device_recorder(device))
        return;
    struct call call = {.type = CALL_WRITE, .resource = buffer->recorded};
    call.write.offset = (uint32_t)span.begin;
    call.write.source = record_bytes(device, buffer->data + span.begin, span.end - span.begin);
    record_call(device, &call);
    record_release(device, call.write.source);
}

void record_discard(struct triptych_device *device, const triptych_buffer *buffer)
{
    if (device_recorder(device))
        record_call(device, &(struct call){.type = CALL_DISCARD, .resource = buffer->recorded});
}

void record_mapped(struct triptych_device *device, const triptych_buffer *buffer)
{
    if (buffer->map_mode != TRIPTYCH_MAP_READ)
        record_write(device, buffer, buffer->mapped);
}

void record_all_mapped(struct triptych_device *device)
{
    const struct device_resources *resources = device_resources(device);
    for (const triptych_buffer *buffer = resources->buffers; buffer && resources->mapped;
         buffer = buffer->next)
        if (buffer->is_mapped)
            record_mapped(device, buffer);
}

/* --- Textures ------------------------------------------------------------------------------------------- */

/* Copies the rows of a change without padding. The caller frees them. Null if memory is short. */
static uint8_t *pack_rows(const struct triptych_texture *texture, const struct triptych_box *box,
                          const uint8_t *data, size_t row_pitch, size_t slice_pitch, size_t *bytes)
{
    size_t row = texture_row_bytes(texture->format, box->width);
    size_t rows = format_blocks(texture->format, box->height);
    uint8_t *packed = malloc(row * rows * box->depth), *at = packed;
    *bytes = row * rows * box->depth;
    for (size_t z = 0; packed && z < box->depth; z++)
        for (size_t y = 0; y < rows; y++, at += row)
            memcpy(at, data + z * slice_pitch + y * row_pitch, row);
    return packed;
}

void record_update(struct triptych_device *device, const triptych_texture *texture, unsigned face,
                   unsigned level, const struct triptych_box *box, const void *data, size_t row_pitch,
                   size_t slice_pitch)
{
    struct call call = {.type = CALL_UPDATE, .resource = texture->recorded};
    size_t bytes;
    if (!device_recorder(device))
        return;
    const struct texture_level *whole = &texture->level[level];
    const struct triptych_box all = {
        0, 0, 0, (unsigned)whole->width, (unsigned)whole->height, (unsigned)whole->depth};
    uint8_t *packed = pack_rows(texture, box ? box : &all, data, row_pitch, slice_pitch, &bytes);
    if (!packed)
        record_memory_is_short(device);
    call.update.face = face;
    call.update.level = level;
    call.update.box = box ? *box : (struct triptych_box){0};
    call.update.source = record_bytes(device, packed, packed ? bytes : 0);
    record_call(device, &call);
    record_release(device, call.update.source);
    free(packed);
}

void record_texels(struct triptych_device *device, const triptych_texture *texture, const void *data,
                   size_t bytes)
{
    if (!device_recorder(device))
        return;
    struct call call = {.type = CALL_TEXELS, .resource = texture->recorded};
    call.texels.source = record_bytes(device, data, bytes);
    record_call(device, &call);
    record_release(device, call.texels.source);
}

void record_contents(struct triptych_device *device, const void *data, size_t bytes)
{
    if (!device_recorder(device))
        return;
    uint32_t number = record_bytes(device, data, bytes);
    record_call(device, &(struct call){.type = CALL_CONTENTS, .resource = number});
    record_release(device, number);
}

/* --- Queries and frames --------------------------------------------------------------------------------- */

void record_query(struct triptych_device *device, triptych_query *query, int begin)
{
    if (device_recorder(device) && query->type == TRIPTYCH_QUERY_OCCLUSION)
        record_call(device, &(struct call){.type = begin ? CALL_BEGIN_QUERY : CALL_END_QUERY,
                                           .resource = query->recorded});
}

void record_open_queries(struct triptych_device *device, enum call_type type)
{
    for (triptych_query *query = device_queries(device); query; query = query->next)
        if (query->type == TRIPTYCH_QUERY_OCCLUSION && query->phase == QUERY_BEGUN)
            record_call(device, &(struct call){.type = type, .resource = query->recorded});
}

/* A query of a stream ends in its frame. A query that is open at the end of a frame begins again in the
 * next. */
void record_frame(struct triptych_device *device)
{
    if (!device_recorder(device))
        return;
    record_open_queries(device, CALL_END_QUERY);
    record_call(device, &(struct call){.type = CALL_FRAME, .resource = NO_RESOURCE});
    record_open_queries(device, CALL_BEGIN_QUERY);
    device_recorder(device)->framed = true;
}

void record_wait(struct triptych_device *device)
{
    struct recorder *recorder = device_recorder(device);
    if (!recorder || !recorder->drawn || recorder->waited)
        return;
    recorder->waited = true;
    recorder->waits++;
}
