/* Single calls of a stream, as calls of a device, and the state before the first. */
#include "draw/texture.h"
#include "stream/check.h"
#include "stream/play_part.h"

#include <string.h>

static enum triptych_result set_transform(struct player *player, enum triptych_transform which,
                                          const float matrix[4][4])
{
    memcpy(player->transform[which], matrix, sizeof player->transform[which]);
    return triptych_set_transform(player->device, which, matrix);
}

static enum triptych_result set_shader(struct player *player, const struct call *call)
{
    triptych_shader *shader = call->resource == NO_RESOURCE ? NULL : player->handles[call->resource].shader;
    return call->shader == TRIPTYCH_SHADER_PIXEL ? triptych_set_pixel_shader(player->device, shader)
                                                 : triptych_set_vertex_shader(player->device, shader);
}

static enum triptych_result set_constants(triptych_device *device, const struct call *call)
{
    enum triptych_shader_stage stage = call->constants.stage;
    unsigned first = call->constants.first, count = call->constants.count;
    if (call->constants.type == CONSTANTS_BOOLEAN)
        return triptych_set_shader_booleans(device, stage, first, call->constants.booleans, count);
    if (call->constants.type == CONSTANTS_INTEGER)
        return triptych_set_shader_integers(device, stage, first, call->constants.integers[0], count);
    return triptych_set_shader_floats(device, stage, first, call->constants.floats[0], count);
}

/* That they are finite was checked when the stream was read. */
static enum triptych_result set_constant_matrix(struct player *player, const struct call *call)
{
    float constants[CONSTANTS_PER_CALL][4];
    stream_constants(call, (const float(*)[4][4])player->transform, constants);
    return triptych_set_shader_floats(player->device, call->constant_matrix.stage,
                                      call->constant_matrix.first, constants[0], call->constant_matrix.count);
}

static triptych_buffer *buffer_of(const struct player *player, uint32_t resource)
{
    const struct handles *handles = &player->handles[resource];
    return handles->vertices ? handles->vertices : handles->indices;
}

static enum triptych_result bind_element(struct player *player, enum triptych_attribute attribute,
                                         uint32_t resource, enum triptych_format format, size_t offset,
                                         size_t stride)
{
    struct triptych_element element = {.format = format, .offset = offset, .stride = stride};
    if (format != TRIPTYCH_FORMAT_NONE)
        element.buffer = buffer_of(player, resource);
    return triptych_set_element(player->device, attribute, &element);
}

static enum triptych_result bind_stream(struct player *player, const struct call *call)
{
    triptych_buffer *buffer = call->resource == NO_RESOURCE ? NULL : buffer_of(player, call->resource);
    return triptych_set_stream(player->device, call->bind_stream.number, buffer, call->bind_stream.offset,
                               call->bind_stream.stride);
}

static enum triptych_result declare(struct player *player, const struct call *call)
{
    struct triptych_declaration_element elements[TRIPTYCH_DECLARATION_ELEMENTS];
    unsigned count = stream_declaration(call, elements);
    return triptych_set_declaration(player->device, elements, count);
}

static enum triptych_result bind_vertices(struct player *player, uint32_t resource)
{
    const struct layout *layout = &player->stream->resources[resource].layout;
    struct triptych_declaration_element elements[STREAM_ELEMENTS];
    unsigned count = stream_declare_layout(layout, elements);
    enum triptych_result result = triptych_set_declaration(player->device, elements, count);
    if (count && !result)
        return triptych_set_stream(player->device, 0, buffer_of(player, resource), 0, layout->stride);
    for (unsigned a = 0; a < TRIPTYCH_ATTRIBUTE_COUNT && !result; a++)
        if (layout->format[a] != TRIPTYCH_FORMAT_NONE)
            result = bind_element(player, (enum triptych_attribute)a, resource, layout->format[a],
                                  layout->offset[a], layout->stride);
    return result;
}

/* `bits` is 0 where the resource says them. */
static enum triptych_result bind_indices(struct player *player, uint32_t resource, uint32_t bits)
{
    if (resource == NO_RESOURCE)
        return triptych_set_indices(player->device, NULL, 16);
    const struct handles *handles = &player->handles[resource];
    return triptych_set_indices(player->device, bits ? handles->vertices : handles->indices,
                                bits ? bits : player->stream->resources[resource].index_bits);
}

static enum triptych_result bind_texture(struct player *player, unsigned sampler, uint32_t resource)
{
    return triptych_set_texture(player->device, sampler,
                                resource == NO_RESOURCE ? NULL : player->handles[resource].texture);
}

static enum triptych_result bind_mesh(struct player *player, uint32_t resource)
{
    enum triptych_result result = bind_vertices(player, resource);
    return result ? result : bind_indices(player, resource, 0);
}

static enum triptych_result set_value(triptych_device *device, enum triptych_state_table table, uint32_t i,
                                      uint32_t row, uint32_t value)
{
    if (table == TRIPTYCH_SAMPLER_STATES)
        return triptych_set_sampler_state(device, i, (enum triptych_sampler_state)row, value);
    if (table == TRIPTYCH_STAGE_STATES)
        return triptych_set_stage_state(device, i, (enum triptych_stage_state)row, value);
    return triptych_set_state(device, (enum triptych_state)row, value);
}

static enum triptych_result update_texture(struct player *player, const struct call *call)
{
    const struct resource *resources = player->stream->resources;
    triptych_texture *texture = player->handles[call->resource].texture;
    struct triptych_texture shape;
    texture_describe(&resources[call->resource].texture, &shape, NULL);
    const struct texture_level *level = &shape.level[call->update.level];
    const struct triptych_box *box = call->update.box.width ? &call->update.box : NULL;
    size_t row = texture_row_bytes(shape.format, box ? box->width : (unsigned)level->width);
    size_t rows = format_blocks(shape.format, box ? box->height : (unsigned)level->height), bytes;
    const void *data = resource_data(&resources[call->update.source], &bytes);
    return triptych_texture_update(player->device, texture, call->update.face, call->update.level, box, data,
                                   row, row * rows);
}

static enum triptych_result write_texels(struct player *player, const struct call *call)
{
    size_t bytes;
    const void *data = resource_data(&player->stream->resources[call->texels.source], &bytes);
    return triptych_texture_write_texels(player->device, player->handles[call->resource].texture, data,
                                         bytes);
}

static enum triptych_result write_contents(struct player *player, const struct call *call)
{
    size_t bytes;
    const void *data = resource_data(&player->stream->resources[call->resource], &bytes);
    return triptych_write_contents(player->device, data, bytes);
}

static struct triptych_surface surface_of(const struct player *player, const struct stream_surface *surface)
{
    triptych_texture *texture =
        surface->resource == NO_RESOURCE ? NULL : player->handles[surface->resource].texture;
    return (struct triptych_surface){texture, surface->level, surface->slice};
}

static enum triptych_result attach(struct player *player, const struct call *call)
{
    struct triptych_target_textures textures = {.depth_format = call->attach.depth_format};
    if (!call->attach.some)
        return triptych_set_target_textures(player->device, NULL);
    for (int t = 0; t < TRIPTYCH_TARGETS; t++)
        textures.color[t] = surface_of(player, &call->attach.color[t]);
    textures.depth = surface_of(player, &call->attach.depth);
    return triptych_set_target_textures(player->device, &textures);
}

static enum triptych_result copy(struct player *player, const struct call *call)
{
    struct triptych_surface surface[2];
    const struct triptych_rectangle *part[2];
    for (int i = 0; i < 2; i++) {
        surface[i] = surface_of(player, &call->copy.surface[i]);
        part[i] = call->copy.part[i].width ? &call->copy.part[i] : NULL;
    }
    return triptych_copy(player->device, &surface[0], part[0], &surface[1], part[1], call->copy.filter);
}

/* Everything that stays from call to call. */
enum triptych_result player_execute_state(struct player *player, const struct call *call)
{
    triptych_device *device = player->device;
    switch (call->type) {
    case CALL_TARGET: return triptych_set_target_description(device, &call->target);
    case CALL_VIEWPORT: return triptych_set_viewport(device, &call->viewport);
    case CALL_SCISSOR:
        return triptych_set_scissor(device, call->scissor.x, call->scissor.y, call->scissor.width,
                                    call->scissor.height);
    case CALL_SET: return set_value(device, call->set.table, call->set.i, call->set.row, call->set.value);
    case CALL_CONVENTION:
        return triptych_set_convention(device, call->convention.which, call->convention.value);
    case CALL_CLIP_PLANE:
        return triptych_set_clip_plane(device, call->clip_plane.index, call->clip_plane.plane);
    case CALL_TRANSFORM: return set_transform(player, call->transform.which, call->transform.matrix);
    case CALL_MATERIAL: return triptych_set_material(device, &call->material);
    case CALL_LIGHT: return triptych_set_light(device, call->light.index, &call->light.value);
    case CALL_ENABLE_LIGHT: return triptych_enable_light(device, call->light.index, call->light.on);
    case CALL_BIND_TEXTURE: return bind_texture(player, call->sampler, call->resource);
    case CALL_BIND_VERTICES: return bind_vertices(player, call->resource);
    case CALL_BIND_INDICES: return bind_indices(player, call->resource, call->index_bits);
    case CALL_BIND_ELEMENT:
        return bind_element(player, call->element.attribute, call->resource, call->element.format,
                            call->element.offset, call->element.stride);
    case CALL_BIND_STREAM: return bind_stream(player, call);
    case CALL_DECLARE: return declare(player, call);
    case CALL_FVF: return triptych_set_fvf(device, call->fvf);
    case CALL_FREQUENCY:
        return triptych_set_stream_frequency(device, call->frequency.stream, call->frequency.frequency,
                                             call->frequency.count);
    case CALL_DRAW_MESH: return bind_mesh(player, call->resource);
    case CALL_SHADER: return set_shader(player, call);
    case CALL_CONSTANTS: return set_constants(device, call);
    case CALL_CONSTANT_MATRIX: return set_constant_matrix(player, call);
    case CALL_UPDATE: return update_texture(player, call);
    case CALL_MIPS: return triptych_texture_generate_mips(device, player->handles[call->resource].texture);
    case CALL_TEXELS: return write_texels(player, call);
    case CALL_ATTACH: return attach(player, call);
    case CALL_CONTENTS:
    case CALL_RELEASE:
    case CALL_COPY:
    case CALL_CLEAR:
    case CALL_DRAW:
    case CALL_DRAW_INDEXED:
    case CALL_BEGIN_QUERY:
    case CALL_END_QUERY:
    case CALL_FRAME:
    case CALL_PLAY:
    case CALL_SEQUENCE: return TRIPTYCH_OK;
    }
    return TRIPTYCH_OK;
}

enum triptych_result player_execute_pixels(struct player *player, const struct call *call)
{
    triptych_device *device = player->device;
    switch (call->type) {
    case CALL_COPY: return copy(player, call);
    case CALL_CONTENTS: return write_contents(player, call);
    case CALL_CLEAR:
        return triptych_clear_buffers(device, call->clear.flags, call->clear.color, call->clear.depth,
                                      call->clear.stencil);
    case CALL_BEGIN_QUERY: return triptych_query_begin(device, player->handles[call->resource].query);
    case CALL_END_QUERY:
        player->handles[call->resource].frame = player->frame;
        return triptych_query_end(device, player->handles[call->resource].query);
    case CALL_DRAW: return triptych_draw(device, call->draw.primitive, call->draw.first, call->draw.count);
    case CALL_DRAW_INDEXED:
        return triptych_draw_indexed(device, call->draw.primitive, call->draw.base, call->draw.first,
                                     call->draw.count);
    case CALL_DRAW_MESH:
        return triptych_draw_indexed(device, TRIPTYCH_TRIANGLE_LIST, 0, 0,
                                     player->stream->resources[call->resource].index_count / 3);
    default: return TRIPTYCH_OK;
    }
}

/* --- Before the first call ----------------------------------------------------------------------------------
 */

static enum triptych_result reset_lights(triptych_device *device)
{
    enum triptych_result result = triptych_set_material(device, &stream_default_material);
    for (unsigned i = 0; i < TRIPTYCH_LIGHTS && !result; i++) {
        result = triptych_set_light(device, i, &stream_default_light);
        if (!result)
            result = triptych_enable_light(device, i, 0);
    }
    return result;
}

static enum triptych_result reset_table(triptych_device *device, enum triptych_state_table table)
{
    enum triptych_result result = TRIPTYCH_OK;
    for (unsigned i = 0; i < triptych_table_size(table); i++)
        for (unsigned row = 0; triptych_state_at(table, row) && !result; row++)
            result = set_value(device, table, i, row, triptych_state_default(table, row, i));
    return result;
}

static enum triptych_result reset_vertices(triptych_device *device)
{
    enum triptych_result result = triptych_set_declaration(device, NULL, 0);
    for (unsigned i = 0; i < TRIPTYCH_STREAMS && !result; i++) {
        result = triptych_set_stream(device, i, NULL, 0, 0);
        if (!result)
            result = triptych_set_stream_frequency(device, i, TRIPTYCH_FREQUENCY_VERTEX, 1);
    }
    return result;
}

/* Textures that calls have changed, or will, as they were defined. */
static enum triptych_result reset_textures(struct player *player)
{
    const struct stream *stream = player->stream;
    enum triptych_result result = TRIPTYCH_OK;
    for (uint32_t i = 0; i < stream->resource_count && !result; i++)
        if (stream->resources[i].changes)
            result = player_fill(player->device, &stream->resources[i], player->handles[i].texture);
    return result;
}

static enum triptych_result reset_shaders(triptych_device *device)
{
    static const float floats[TRIPTYCH_SHADER_FLOATS][4];
    static const int32_t integers[TRIPTYCH_SHADER_INTEGERS][4];
    enum triptych_result result = triptych_set_vertex_shader(device, NULL);
    if (!result)
        result = triptych_set_pixel_shader(device, NULL);
    for (int i = 0; i < TRIPTYCH_SHADER_STAGE_COUNT && !result; i++) {
        enum triptych_shader_stage stage = (enum triptych_shader_stage)i;
        result = triptych_set_shader_floats(device, stage, 0, floats[0], TRIPTYCH_SHADER_FLOATS);
        if (!result)
            result = triptych_set_shader_integers(device, stage, 0, integers[0], TRIPTYCH_SHADER_INTEGERS);
        if (!result)
            result = triptych_set_shader_booleans(device, stage, 0, integers[0], TRIPTYCH_SHADER_BOOLEANS);
    }
    return result;
}

enum triptych_result player_reset(struct player *player)
{
    static const float identity[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    enum triptych_result result = triptych_set_target_textures(player->device, NULL);
    if (!result)
        result = reset_lights(player->device);
    if (!result)
        result = reset_textures(player);
    for (unsigned t = 0; t < TRIPTYCH_STATE_TABLE_COUNT && !result; t++)
        result = reset_table(player->device, (enum triptych_state_table)t);
    for (unsigned i = 0; i < TRIPTYCH_TRANSFORM_COUNT && !result; i++)
        result = set_transform(player, (enum triptych_transform)i, identity);
    for (unsigned i = 0; i < TRIPTYCH_CLIP_PLANES && !result; i++)
        result = triptych_set_clip_plane(player->device, i, (const float[4]){0});
    for (unsigned i = 0; i < TRIPTYCH_CONVENTION_COUNT && !result; i++)
        result = triptych_set_convention(player->device, (enum triptych_convention)i, 0);
    if (!result)
        result = reset_shaders(player->device);
    if (!result)
        result = reset_vertices(player->device);
    for (unsigned i = 0; i < TRIPTYCH_SAMPLERS && !result; i++)
        result = bind_texture(player, i, NO_RESOURCE);
    return result ? result : bind_indices(player, NO_RESOURCE, 0);
}
