/* The beginning of a recording: calls that bring a new device into the state of this one.
 *
 * Streams begin with the default of each state, identity transforms, zeros in constants and clip planes, the
 * material and the lights call_default_..., and no bindings (docs/streams.md, Frames). */
#include "capture/record_part.h"
#include "render/target/target.h"

#include <stdlib.h>
#include <string.h>

/* --- Resources ------------------------------------------------------------------------------------------ */

static void write_texture(struct triptych_device *device, triptych_texture *texture)
{
    size_t bytes = texture_texel_bytes(texture);
    void *data = malloc(bytes);
    record_new_texture(device, texture);
    if (data) {
        device_read_texels(device, texture, data);
        record_texels(device, texture, data, bytes);
    } else {
        record_memory_is_short(device);
    }
    free(data);
}

static void write_resources(struct triptych_device *device)
{
    for (triptych_buffer *buffer = device_resources(device)->buffers; buffer; buffer = buffer->next)
        record_new_buffer(device, buffer);
    for (triptych_texture *texture = device_resources(device)->textures; texture; texture = texture->next)
        write_texture(device, texture);
    for (triptych_shader *shader = device_resources(device)->shaders; shader; shader = shader->next)
        record_new_shader(device, shader);
    for (triptych_query *query = device_queries(device); query; query = query->next)
        record_new_query(device, query);
}

/* --- Targets -------------------------------------------------------------------------------------------- */

static void write_contents(struct triptych_device *device, struct target *target,
                           const struct triptych_target_description *description)
{
    size_t bytes = target_contents_bytes(description);
    void *data = malloc(bytes);
    if (!data) {
        record_memory_is_short(device);
        return;
    }
    target_read_contents(target, data);
    record_contents(device, data, bytes);
    free(data);
}

static void write_main_target(struct triptych_device *device)
{
    struct target *target = device_main_target(device);
    struct triptych_target_description description;
    if (!target->width)
        return;
    target_describe(target, &description);
    record_target(device, &description);
    write_contents(device, target, &description);
}

static void write_targets(struct triptych_device *device)
{
    struct triptych_target_description description;
    const struct scissor *scissor = &device_state(device)->scissor;
    write_main_target(device);
    if (device_drawn_textures(device)) {
        record_attach(device, device_drawn_textures(device));
        target_describe(device_target(device), &description);
        write_contents(device, device_target(device), &description);
    }
    if (!device_target(device)->width)
        return;
    record_viewport(device, &device_state(device)->viewport);
    record_scissor(device, scissor->x, scissor->y, scissor->width, scissor->height);
}

/* --- State ---------------------------------------------------------------------------------------------- */

static uint32_t value_of(const struct state *state, enum triptych_state_table table, unsigned i, unsigned row)
{
    if (table == TRIPTYCH_SAMPLER_STATES)
        return state->sampler[i][row];
    return table == TRIPTYCH_STAGE_STATES ? state->stage[i][row] : state->value[row];
}

static void write_values(struct triptych_device *device)
{
    for (unsigned t = 0; t < TRIPTYCH_STATE_TABLE_COUNT; t++) {
        enum triptych_state_table table = (enum triptych_state_table)t;
        for (unsigned i = 0; i < triptych_table_size(table); i++)
            for (unsigned row = 0; triptych_state_at(table, row); row++) {
                uint32_t value = value_of(device_state(device), table, i, row);
                if (value != triptych_state_default(table, row, i))
                    record_value(device, table, i, row, value);
            }
    }
}

static void write_transforms(struct triptych_device *device)
{
    static const float identity[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    static const float zero[4];
    const struct state *state = device_state(device);
    for (unsigned t = 0; t < TRIPTYCH_TRANSFORM_COUNT; t++)
        if (memcmp(state->transform[t], identity, sizeof identity))
            record_transform(device, (enum triptych_transform)t, (const float(*)[4])state->transform[t]);
    for (unsigned i = 0; i < TRIPTYCH_CLIP_PLANES; i++)
        if (memcmp(state->clip_plane[i], zero, sizeof zero))
            record_clip_plane(device, i, state->clip_plane[i]);
    for (unsigned i = 0; i < TRIPTYCH_CONVENTION_COUNT; i++)
        if (state->convention[i])
            record_convention(device, (enum triptych_convention)i, state->convention[i]);
}

/* The initial lights of a device differ from those of a stream. */
static void write_lights(struct triptych_device *device)
{
    const struct state *state = device_state(device);
    if (memcmp(&state->material, &call_default_material, sizeof state->material))
        record_material(device, &state->material);
    for (unsigned i = 0; i < TRIPTYCH_LIGHTS; i++) {
        if (memcmp(&state->light[i], &call_default_light, sizeof state->light[i]))
            record_light(device, i, &state->light[i]);
        if (state->light_enabled[i])
            record_enable_light(device, i, 1);
    }
}

static void write_constants(struct triptych_device *device, enum triptych_shader_stage stage)
{
    static const uint8_t zero[16];
    const struct shader_registers *registers = device_registers(device, stage);
    for (unsigned i = 0; i < TRIPTYCH_SHADER_FLOATS; i++)
        if (memcmp(registers->floats[i], zero, sizeof zero))
            record_floats(device, stage, i, registers->floats[i], 1);
    for (unsigned i = 0; i < TRIPTYCH_SHADER_INTEGERS; i++)
        if (memcmp(registers->integers[i], zero, sizeof zero))
            record_integers(device, stage, i, registers->integers[i], 1);
    for (unsigned i = 0; i < TRIPTYCH_SHADER_BOOLEANS; i++)
        if (device_state(device)->booleans[stage] >> i & 1)
            record_booleans(device, stage, i, &(const int32_t){1}, 1);
}

static void write_shaders(struct triptych_device *device)
{
    for (int i = 0; i < SHADER_STAGES; i++) {
        enum triptych_shader_stage stage = (enum triptych_shader_stage)i;
        if (device_shader(device, stage))
            record_shader(device, (enum shader_stage)i, device_shader(device, stage));
        write_constants(device, stage);
    }
}

static void write_bindings(struct triptych_device *device)
{
    static const struct left_out none;
    const struct state *state = device_state(device);
    for (unsigned i = 0; i < TRIPTYCH_SAMPLERS; i++)
        if (state->texture[i])
            record_bind_texture(device, i, state->texture[i]);
    for (unsigned i = 0; i < TRIPTYCH_STREAMS; i++) {
        const struct state_stream *stream = &state->stream[i];
        if (stream->buffer)
            record_stream(device, i, stream->buffer, stream->offset, stream->stride);
        if (stream->frequency != TRIPTYCH_FREQUENCY_VERTEX)
            record_frequency(device, i, stream->frequency, stream->count);
    }
    record_vertex_input(device, &none);
    if (state->indices)
        record_indices(device, state->indices, state->index_bits);
}

void record_beginning(struct triptych_device *device)
{
    device_finish(device);
    write_resources(device);
    write_targets(device);
    write_values(device);
    write_transforms(device);
    write_lights(device);
    write_shaders(device);
    write_bindings(device);
    record_open_queries(device, CALL_BEGIN_QUERY);
}
