/* The beginning of a recording: calls that bring a new device into the state of this one. */
#include "capture/record_part.h"
#include "render/target/surface.h"

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

static void write_contents(struct triptych_device *device, struct target *target)
{
    struct triptych_target_description description;
    target_describe(target, &description);
    size_t bytes = target_contents_bytes(&description);
    void *data = malloc(bytes);
    if (!data) {
        record_memory_is_short(device);
        return;
    }
    target_read_contents(target, data);
    record_contents(device, data, bytes);
    free(data);
}

/* The contents of a surface with tiles, as the target. */
static void write_surface(struct triptych_device *device, const struct triptych_surface *surface)
{
    struct triptych_target_surfaces surfaces = {.depth_format = TRIPTYCH_DEPTH_NONE};
    struct target target = {.width = 0};
    const struct attachment *attachment = surface_attachment(surface);
    if (!attachment)
        return;
    *(attachment->format ? &surfaces.color[0] : &surfaces.depth) = *surface;
    record_attach(device, &surfaces);
    if (device_view(device, surface, &target, NULL) == TRIPTYCH_OK)
        write_contents(device, &target);
    else
        record_memory_is_short(device);
    target_destroy(&target);
}

/* Only tiles have stencil. */
static void write_stencil(struct triptych_device *device, triptych_texture *texture)
{
    for (const struct drawn_surface *drawn = texture->drawn; drawn; drawn = drawn->next)
        if (stencil_mask(drawn->attachment->depth_format) && !drawn->attachment->texels_newer)
            write_surface(device, &(struct triptych_surface){texture, drawn->level, drawn->slice, NULL});
}

static void write_surfaces(struct triptych_device *device)
{
    for (triptych_image *image = device_resources(device)->images; image; image = image->next) {
        record_new_image(device, image);
        write_surface(device, &(struct triptych_surface){.image = image});
    }
    for (triptych_texture *texture = device_resources(device)->textures; texture; texture = texture->next)
        write_stencil(device, texture);
    record_attach(device, NULL);
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

static void write_main_target(struct triptych_device *device)
{
    struct target *target = device_main_target(device);
    struct triptych_target_description description;
    if (!target->width)
        return;
    target_describe(target, &description);
    record_target(device, &description);
    write_contents(device, target);
}

static void write_targets(struct triptych_device *device)
{
    const struct scissor *scissor = &device_state(device)->scissor;
    write_main_target(device);
    write_surfaces(device);
    if (device_drawn_surfaces(device)) {
        record_attach(device, device_drawn_surfaces(device));
        write_contents(device, device_target(device));
    }
    if (!device_target(device)->width)
        return;
    record_viewport(device, &device_state(device)->viewport);
    record_scissor(device, scissor->x, scissor->y, scissor->width, scissor->height);
}

struct visit {
    const struct triptych_device *device;
    record_visitor *visit;
    void *user;
};

static void take(const struct visit *v, struct call *call)
{
    call->resource = NO_RESOURCE;
    v->visit(v->user, call);
}

/* --- States --------------------------------------------------------------------------------------------- */

static uint32_t value_of(const struct state *state, enum triptych_state_table table, unsigned i, unsigned row)
{
    if (table == TRIPTYCH_SAMPLER_STATES)
        return state->sampler[i][row];
    return table == TRIPTYCH_STAGE_STATES ? state->stage[i][row] : state->value[row];
}

static void visit_row(const struct visit *v, enum triptych_state_table table, unsigned i, unsigned row)
{
    uint32_t value = value_of(device_state(v->device), table, i, row);
    if (value != triptych_state_default(table, row, i))
        take(v, &(struct call){.type = CALL_SET, .set = {table, i, row, value}});
}

static void visit_values(const struct visit *v)
{
    for (unsigned t = 0; t < TRIPTYCH_STATE_TABLE_COUNT; t++) {
        enum triptych_state_table table = (enum triptych_state_table)t;
        for (unsigned i = 0; i < triptych_table_size(table); i++)
            for (unsigned row = 0; triptych_state_at(table, row); row++)
                visit_row(v, table, i, row);
    }
}

/* --- Transforms ----------------------------------------------------------------------------------------- */

static void visit_transforms(const struct visit *v)
{
    static const float identity[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    for (unsigned t = 0; t < TRIPTYCH_TRANSFORM_COUNT; t++) {
        struct call call = {.type = CALL_TRANSFORM, .transform.which = (enum triptych_transform)t};
        memcpy(call.transform.matrix, device_state(v->device)->transform[t], sizeof call.transform.matrix);
        if (memcmp(call.transform.matrix, identity, sizeof identity))
            take(v, &call);
    }
}

static void visit_clip_planes(const struct visit *v)
{
    static const float zero[4];
    for (unsigned i = 0; i < TRIPTYCH_CLIP_PLANES; i++) {
        struct call call = {.type = CALL_CLIP_PLANE, .clip_plane.index = i};
        memcpy(call.clip_plane.plane, device_state(v->device)->clip_plane[i], sizeof call.clip_plane.plane);
        if (memcmp(call.clip_plane.plane, zero, sizeof zero))
            take(v, &call);
    }
}

static void visit_conventions(const struct visit *v)
{
    for (unsigned i = 0; i < TRIPTYCH_CONVENTION_COUNT; i++)
        if (device_state(v->device)->convention[i])
            take(v,
                 &(struct call){.type = CALL_CONVENTION,
                                .convention = {.which = i, .value = device_state(v->device)->convention[i]}});
}

/* --- Light ---------------------------------------------------------------------------------------------- */

/* The initial lights of a device differ from those of a stream. */
static void visit_lights(const struct visit *v)
{
    const struct state *state = device_state(v->device);
    if (memcmp(&state->material, &call_default_material, sizeof state->material))
        take(v, &(struct call){.type = CALL_MATERIAL, .material = state->material});
    for (unsigned i = 0; i < TRIPTYCH_LIGHTS; i++) {
        struct call light = {.type = CALL_LIGHT, .light = {i, state->light[i]}};
        struct call enable = {.type = CALL_ENABLE_LIGHT, .enable_light = {.index = i, .on = true}};
        if (memcmp(&state->light[i], &call_default_light, sizeof state->light[i]))
            take(v, &light);
        if (state->light_enabled[i])
            take(v, &enable);
    }
}

/* --- Constants ------------------------------------------------------------------------------------------ */

static struct call constant(enum triptych_shader_stage stage, enum call_constant_type type, unsigned i)
{
    struct call call = {.type = CALL_CONSTANTS};
    call.constants.stage = stage;
    call.constants.type = type;
    call.constants.first = i;
    call.constants.count = 1;
    return call;
}

static void visit_constants(const struct visit *v, enum triptych_shader_stage stage)
{
    static const uint8_t zero[16];
    const struct shader_registers *registers = device_registers(v->device, stage);
    for (unsigned i = 0; i < TRIPTYCH_SHADER_FLOATS; i++) {
        struct call call = constant(stage, CONSTANTS_FLOAT, i);
        memcpy(call.constants.floats[0], registers->floats[i], sizeof zero);
        if (memcmp(registers->floats[i], zero, sizeof zero))
            take(v, &call);
    }
    for (unsigned i = 0; i < TRIPTYCH_SHADER_INTEGERS; i++) {
        struct call call = constant(stage, CONSTANTS_INTEGER, i);
        memcpy(call.constants.integers[0], registers->integers[i], sizeof zero);
        if (memcmp(registers->integers[i], zero, sizeof zero))
            take(v, &call);
    }
    for (unsigned i = 0; i < TRIPTYCH_SHADER_BOOLEANS; i++) {
        struct call call = constant(stage, CONSTANTS_BOOLEAN, i);
        call.constants.booleans[0] = 1;
        if (device_state(v->device)->booleans[stage] >> i & 1)
            take(v, &call);
    }
}

void record_differences(const struct triptych_device *device, record_visitor *visit, void *user)
{
    const struct visit v = {device, visit, user};
    visit_values(&v);
    visit_transforms(&v);
    visit_clip_planes(&v);
    visit_conventions(&v);
    visit_lights(&v);
    for (int stage = 0; stage < SHADER_STAGES; stage++)
        visit_constants(&v, (enum triptych_shader_stage)stage);
}

/* --- The beginning -------------------------------------------------------------------------------------- */

static void append(void *user, const struct call *call)
{
    record_call(user, call);
}

static void write_shaders(struct triptych_device *device)
{
    for (int i = 0; i < SHADER_STAGES; i++) {
        const struct triptych_shader *shader = device_shader(device, (enum triptych_shader_stage)i);
        if (shader)
            record_shader(device, (enum shader_stage)i, shader);
    }
}

static void write_bindings(struct triptych_device *device)
{
    static const struct left_out none;
    const struct state *state = device_state(device);
    for (unsigned i = 0; i < TRIPTYCH_SAMPLERS; i++)
        if (state->texture[i])
            record_bind_texture(device, i, state->texture[i]);
    if (state->clip_mask.texture)
        record_clip_mask(device, &state->clip_mask);
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
    device_finish_target(device);
    write_resources(device);
    write_targets(device);
    record_differences(device, append, device);
    write_shaders(device);
    write_bindings(device);
    record_open_queries(device, CALL_BEGIN_QUERY);
}
