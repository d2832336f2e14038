/* Calls of a stream executed on a device. */
#include "command/play/play_part.h"
#include "command/stream/functions.h"
#include "command/stream/valid.h"
#include "render/texture/texture.h"

#include <string.h>

/* --- Resources ------------------------------------------------------------------------------------------ */

static triptych_texture *handle_texture(const struct player *player, uint32_t number)
{
    return number == NO_RESOURCE ? NULL : player->handles[number].texture;
}

static triptych_query *handle_query(const struct player *player, uint32_t number)
{
    return number == NO_RESOURCE ? NULL : player->handles[number].query;
}

static triptych_shader *handle_shader(const struct player *player, uint32_t number)
{
    return number == NO_RESOURCE ? NULL : player->handles[number].shader;
}

/* The bytes of vertices, or of a buffer of any type. */
static triptych_buffer *handle_buffer(const struct player *player, uint32_t number)
{
    const struct handles *handles = number == NO_RESOURCE ? NULL : &player->handles[number];
    return !handles ? NULL : handles->vertices ? handles->vertices : handles->indices;
}

/* --- State ---------------------------------------------------------------------------------------------- */

enum triptych_result play_target(struct player *player, const struct call *call)
{
    return triptych_set_target_description(player->device, &call->target);
}

enum triptych_result play_viewport(struct player *player, const struct call *call)
{
    return triptych_set_viewport(player->device, &call->viewport);
}

enum triptych_result player_set_value(triptych_device *device, enum triptych_state_table table, uint32_t i,
                                      uint32_t row, uint32_t value)
{
    if (table == TRIPTYCH_SAMPLER_STATES)
        return triptych_set_sampler_state(device, i, (enum triptych_sampler_state)row, value);
    if (table == TRIPTYCH_STAGE_STATES)
        return triptych_set_stage_state(device, i, (enum triptych_stage_state)row, value);
    return triptych_set_state(device, (enum triptych_state)row, value);
}

enum triptych_result play_set(struct player *player, const struct call *call)
{
    return player_set_value(player->device, call->set.table, call->set.i, call->set.row, call->set.value);
}

enum triptych_result player_set_transform(struct player *player, enum triptych_transform which,
                                          const float matrix[4][4])
{
    memcpy(player->transform[which], matrix, sizeof player->transform[which]);
    return triptych_set_transform(player->device, which, matrix);
}

enum triptych_result play_transform(struct player *player, const struct call *call)
{
    return player_set_transform(player, call->transform.which, call->transform.matrix);
}

enum triptych_result play_material(struct player *player, const struct call *call)
{
    return triptych_set_material(player->device, &call->material);
}

enum triptych_result play_light(struct player *player, const struct call *call)
{
    return triptych_set_light(player->device, call->light.index, &call->light.value);
}

enum triptych_result play_shader(struct player *player, const struct call *call)
{
    triptych_shader *shader = handle_shader(player, call->resource);
    return call->shader.stage == TRIPTYCH_SHADER_PIXEL ? triptych_set_pixel_shader(player->device, shader)
                                                       : triptych_set_vertex_shader(player->device, shader);
}

enum triptych_result play_constants(struct player *player, const struct call *call)
{
    triptych_device *device = player->device;
    enum triptych_shader_stage stage = call->constants.stage;
    unsigned first = call->constants.first, count = call->constants.count;
    if (call->constants.type == CONSTANTS_BOOLEAN)
        return triptych_set_shader_booleans(device, stage, first, call->constants.booleans, count);
    if (call->constants.type == CONSTANTS_INTEGER)
        return triptych_set_shader_integers(device, stage, first, call->constants.integers[0], count);
    return triptych_set_shader_floats(device, stage, first, call->constants.floats[0], count);
}

/* The numbers are finite: the stream has been followed. */
enum triptych_result play_constant_matrix(struct player *player, const struct call *call)
{
    float constants[CONSTANTS_PER_CALL][4];
    stream_constants(call, (const float(*)[4][4])player->transform, constants);
    return triptych_set_shader_floats(player->device, call->constant_matrix.stage,
                                      call->constant_matrix.first, constants[0], call->constant_matrix.count);
}

/* --- Vertices ------------------------------------------------------------------------------------------- */

static enum triptych_result bind_element(struct player *player, enum triptych_attribute attribute,
                                         uint32_t resource, enum triptych_format format, size_t offset,
                                         size_t stride)
{
    struct triptych_element element = {.format = format, .offset = offset, .stride = stride};
    if (format != TRIPTYCH_FORMAT_NONE)
        element.buffer = handle_buffer(player, resource);
    return triptych_set_element(player->device, attribute, &element);
}

enum triptych_result play_bind_element(struct player *player, const struct call *call)
{
    return bind_element(player, call->element.attribute, call->resource, call->element.format,
                        call->element.offset, call->element.stride);
}

enum triptych_result play_bind_stream(struct player *player, const struct call *call)
{
    return triptych_set_stream(player->device, call->bind_stream.number,
                               handle_buffer(player, call->resource), call->bind_stream.offset,
                               call->bind_stream.stride);
}

enum triptych_result play_declare(struct player *player, const struct call *call)
{
    struct triptych_declaration_element elements[TRIPTYCH_DECLARATION_ELEMENTS];
    unsigned count = stream_declaration(call, elements);
    return triptych_set_declaration(player->device, elements, count);
}

enum triptych_result play_bind_vertices(struct player *player, const struct call *call)
{
    uint32_t resource = call->resource;
    const struct layout *layout = &player->stream->resources[resource].layout;
    struct triptych_declaration_element elements[STREAM_ELEMENTS];
    unsigned count = stream_declare_layout(layout, elements);
    enum triptych_result result = triptych_set_declaration(player->device, elements, count);
    if (count && !result)
        return triptych_set_stream(player->device, 0, handle_buffer(player, resource), 0, layout->stride);
    for (unsigned a = 0; a < TRIPTYCH_ATTRIBUTE_COUNT && !result; a++)
        if (layout->format[a] != TRIPTYCH_FORMAT_NONE)
            result = bind_element(player, (enum triptych_attribute)a, resource, layout->format[a],
                                  layout->offset[a], layout->stride);
    return result;
}

/* `bits` is 0 if the resource has them. */
enum triptych_result player_bind_indices(struct player *player, uint32_t resource, uint32_t bits)
{
    if (resource == NO_RESOURCE)
        return triptych_set_indices(player->device, NULL, 16);
    const struct handles *handles = &player->handles[resource];
    return triptych_set_indices(player->device, bits ? handles->vertices : handles->indices,
                                bits ? bits : player->stream->resources[resource].index_bits);
}

enum triptych_result play_bind_indices(struct player *player, const struct call *call)
{
    return player_bind_indices(player, call->resource, call->bind_indices.bits);
}

enum triptych_result play_bind_mesh(struct player *player, const struct call *call)
{
    enum triptych_result result = play_bind_vertices(player, call);
    return result ? result : player_bind_indices(player, call->resource, 0);
}

/* --- Changes of buffers --------------------------------------------------------------------------------- */

enum triptych_result play_write(struct player *player, const struct call *call)
{
    size_t bytes;
    const void *data = resource_data(&player->stream->resources[call->write.source], &bytes);
    return triptych_buffer_update(player->device, handle_buffer(player, call->resource), call->write.offset,
                                  data, bytes);
}

/* A discard clears all bytes but those that it maps. */
enum triptych_result play_discard(struct player *player, const struct call *call)
{
    triptych_buffer *buffer = handle_buffer(player, call->resource);
    void *data;
    enum triptych_result result =
        triptych_buffer_map(player->device, buffer, 0, 1, TRIPTYCH_MAP_DISCARD, &data);
    if (result)
        return result;
    memset(data, 0, 1);
    return triptych_buffer_unmap(player->device, buffer);
}

/* --- Textures ------------------------------------------------------------------------------------------- */

enum triptych_result play_update(struct player *player, const struct call *call)
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

enum triptych_result play_texels(struct player *player, const struct call *call)
{
    size_t bytes;
    const void *data = resource_data(&player->stream->resources[call->texels.source], &bytes);
    return triptych_texture_write_texels(player->device, player->handles[call->resource].texture, data,
                                         bytes);
}

enum triptych_result play_contents(struct player *player, const struct call *call)
{
    size_t bytes;
    const void *data = resource_data(&player->stream->resources[call->resource], &bytes);
    return triptych_write_contents(player->device, data, bytes);
}

static struct triptych_surface surface_of(const struct player *player, const struct call_surface *surface)
{
    triptych_image *image =
        surface->resource == NO_RESOURCE ? NULL : player->handles[surface->resource].image;
    return (struct triptych_surface){handle_texture(player, surface->resource), surface->level,
                                     surface->slice, image};
}

enum triptych_result play_attach(struct player *player, const struct call *call)
{
    struct triptych_target_surfaces surfaces = {.depth_format = call->attach.depth_format};
    if (!call->attach.some)
        return triptych_set_target_surfaces(player->device, NULL);
    for (int t = 0; t < TRIPTYCH_TARGETS; t++)
        surfaces.color[t] = surface_of(player, &call->attach.color[t]);
    surfaces.depth = surface_of(player, &call->attach.depth);
    return triptych_set_target_surfaces(player->device, &surfaces);
}

enum triptych_result play_copy(struct player *player, const struct call *call)
{
    struct triptych_surface surface[2];
    const struct triptych_rectangle *part[2];
    for (int i = 0; i < 2; i++) {
        surface[i] = surface_of(player, &call->copy.surface[i]);
        part[i] = call->copy.part[i].width ? &call->copy.part[i] : NULL;
    }
    return triptych_copy(player->device, &surface[0], part[0], &surface[1], part[1], call->copy.filter);
}

enum triptych_result play_set_pixels(struct player *player, const struct call *call)
{
    size_t rows, bytes, pitch = valid_set_pixels_row(player->stream, &call->set_pixels, &rows);
    struct triptych_surface surface = surface_of(player, &call->set_pixels.surface);
    const void *data = resource_data(&player->stream->resources[call->set_pixels.source], &bytes);
    return triptych_write_rectangle(player->device, &surface, &call->set_pixels.part, call->set_pixels.format,
                                    data, pitch);
}

enum triptych_result play_fill(struct player *player, const struct call *call)
{
    struct triptych_surface surface = surface_of(player, &call->fill.surface);
    return triptych_fill(player->device, &surface, call->fill.part.width ? &call->fill.part : NULL,
                         call->fill.color);
}

/* --- Pixels --------------------------------------------------------------------------------------------- */

enum triptych_result play_clear_parts(struct player *player, const struct call *call)
{
    const struct call_clear_parts *parts = &call->clear_parts;
    struct triptych_rectangle rectangle[PARTS_PER_CALL];
    struct triptych_clear_values values = {.flags = parts->clear.flags,
                                           .depth = parts->clear.depth,
                                           .stencil = parts->clear.stencil,
                                           .color_mask = parts->color_mask,
                                           .stencil_mask = parts->stencil_mask,
                                           .everywhere = parts->everywhere};
    memcpy(values.color, parts->clear.color, sizeof values.color);
    for (uint32_t i = 0; i < parts->count; i++)
        rectangle[i] = (struct triptych_rectangle){parts->part[i].x, parts->part[i].y, parts->part[i].width,
                                                   parts->part[i].height};
    return triptych_clear_rectangles(player->device, &values, rectangle, parts->count);
}

enum triptych_result play_clear(struct player *player, const struct call *call)
{
    return triptych_clear_buffers(player->device, call->clear.flags, call->clear.color, call->clear.depth,
                                  call->clear.stencil);
}

enum triptych_result play_draw_mesh(struct player *player, const struct call *call)
{
    return triptych_draw_indexed(player->device, TRIPTYCH_TRIANGLE_LIST, 0, 0,
                                 player->stream->resources[call->resource].index_count / 3);
}

enum triptych_result play_draw_user(struct player *player, const struct call *call)
{
    size_t bytes;
    const void *vertices = resource_data(&player->stream->resources[call->resource], &bytes);
    return triptych_draw_user(player->device, (enum triptych_primitive)call->draw_user.primitive,
                              call->draw_user.count, vertices, call->draw_user.stride);
}

enum triptych_result play_draw_indexed_user(struct player *player, const struct call *call)
{
    const struct resource *resources = player->stream->resources;
    uint32_t stride = call->draw_indexed_user.stride;
    size_t bytes, index_bytes;
    const void *vertices = resource_data(&resources[call->resource], &bytes);
    const void *indices = resource_data(&resources[call->draw_indexed_user.indices], &index_bytes);
    return triptych_draw_indexed_user(player->device,
                                      (enum triptych_primitive)call->draw_indexed_user.primitive,
                                      call->draw_indexed_user.count, indices, call->draw_indexed_user.bits,
                                      (uint32_t)(bytes / stride), vertices, stride);
}

enum triptych_result play_end_query(struct player *player, const struct call *call)
{
    player->handles[call->resource].frame = player->frame;
    return triptych_query_end(player->device, handle_query(player, call->resource));
}

/* --- All calls ------------------------------------------------------------------------------------------ */

/* Regular calls (capture/call.def): the public function with the fields of the call. */
static enum triptych_result play_regular(struct player *player, const struct call *call)
{
#define U8(member, name, most, what)               , call->member.name
#define U16(member, name, most, what)              , call->member.name
#define U32(member, name, most, what)              , call->member.name
#define S32(member, name, what)                    , call->member.name
#define BOOL(member, name, what)                   , call->member.name
#define WORD(member, name, list, most, what)       , call->member.name
#define FLOATS(member, name, count, what)          , call->member.name
#define RESOURCE(path, types, or_none, kind, what) , handle_##kind(player, call->path)
#define CALL(name, number, word, traits, member, function, fields)                                           \
    case CALL_##name:                                                                                        \
        return function(player->device fields);
#define CALL_OF(name, number, word, traits, type, member, fields)
#define CALL_BARE(name, number, word, traits, fields)
    switch (call->type) {
#include "capture/call.def"
    default: return TRIPTYCH_OK;
    }
#include "capture/call_undefine.h"
}

enum triptych_result player_execute_state(struct player *player, const struct call *call)
{
    const struct stream_functions *functions = &calls_functions[call->type];
    if (functions->play)
        return functions->play(player, call);
    return call_row(call->type)->traits & CALL_PIXELS ? TRIPTYCH_OK : play_regular(player, call);
}

enum triptych_result player_execute_pixels(struct player *player, const struct call *call)
{
    const struct stream_functions *functions = &calls_functions[call->type];
    if (functions->draw)
        return functions->draw(player, call);
    return call_row(call->type)->traits & CALL_PIXELS ? play_regular(player, call) : TRIPTYCH_OK;
}
