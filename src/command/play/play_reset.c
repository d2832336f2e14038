/* The state in which streams begin. */
#include "command/play/play_part.h"

static enum triptych_result reset_lights(triptych_device *device)
{
    enum triptych_result result = triptych_set_material(device, &call_default_material);
    for (unsigned i = 0; i < TRIPTYCH_LIGHTS && !result; i++) {
        result = triptych_set_light(device, i, &call_default_light);
        if (!result)
            result = triptych_enable_light(device, i, 0);
    }
    return result;
}

static uint32_t first_value(const struct player *player, enum triptych_state_table table, unsigned row,
                            unsigned i)
{
    bool precision = table == TRIPTYCH_RENDER_STATES && row == TRIPTYCH_STATE_PRECISION;
    return precision ? player->stream->precision : triptych_state_default(table, row, i);
}

static enum triptych_result reset_table(const struct player *player, enum triptych_state_table table)
{
    enum triptych_result result = TRIPTYCH_OK;
    for (unsigned i = 0; i < triptych_table_size(table); i++)
        for (unsigned row = 0; triptych_state_at(table, row) && !result; row++)
            result = player_set_value(player->device, table, i, row, first_value(player, table, row, i));
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

/* Images, and textures that calls have changed, or will, as they were defined: made anew. */
static enum triptych_result reset_surfaces(struct player *player)
{
    const struct stream *stream = player->stream;
    enum triptych_result result = TRIPTYCH_OK;
    for (uint32_t i = 0; i < stream->resource_count && !result; i++) {
        const struct resource *resource = &stream->resources[i];
        if (resource->type != RESOURCE_IMAGE && (resource->type != RESOURCE_TEXTURE || !resource->changes))
            continue;
        player_destroy(player->device, &player->handles[i]);
        player->handles[i] = (struct handles){.frame = NOWHERE};
        result = player_create(player->device, resource, &player->handles[i]);
    }
    return result;
}

/* The same for vertices, indices and buffers. */
static enum triptych_result reset_buffers(struct player *player)
{
    const struct stream *stream = player->stream;
    enum triptych_result result = TRIPTYCH_OK;
    for (uint32_t i = 0; i < stream->resource_count && !result; i++) {
        const struct handles *handles = &player->handles[i];
        const struct resource *resource = &stream->resources[i];
        triptych_buffer *buffer = handles->vertices ? handles->vertices : handles->indices;
        size_t bytes;
        if (resource->changes && buffer) {
            const void *data = resource_data(resource, &bytes);
            result = triptych_buffer_update(player->device, buffer, 0, data, bytes);
        }
    }
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
    enum triptych_result result = triptych_set_target_surfaces(player->device, NULL);
    if (!result)
        result = reset_lights(player->device);
    if (!result)
        result = reset_surfaces(player);
    if (!result)
        result = reset_buffers(player);
    for (unsigned t = 0; t < TRIPTYCH_STATE_TABLE_COUNT && !result; t++)
        result = reset_table(player, (enum triptych_state_table)t);
    for (unsigned i = 0; i < TRIPTYCH_TRANSFORM_COUNT && !result; i++)
        result = player_set_transform(player, (enum triptych_transform)i, identity);
    for (unsigned i = 0; i < TRIPTYCH_CLIP_PLANES && !result; i++)
        result = triptych_set_clip_plane(player->device, i, (const float[4]){0});
    for (unsigned i = 0; i < TRIPTYCH_CONVENTION_COUNT && !result; i++)
        result = triptych_set_convention(player->device, (enum triptych_convention)i, 0);
    if (!result)
        result = reset_shaders(player->device);
    if (!result)
        result = reset_vertices(player->device);
    for (unsigned i = 0; i < TRIPTYCH_SAMPLERS && !result; i++)
        result = triptych_set_texture(player->device, i, NULL);
    if (!result)
        result = triptych_set_clip_mask(player->device, NULL, 0, 0, 0, 0, 0, 0);
    return result ? result : player_bind_indices(player, NO_RESOURCE, 0);
}
