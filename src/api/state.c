/* States, transforms, lights, textures and vertex declarations. */
#include "api/api.h"

#include <stdio.h>
#include <string.h>

/* Warns of a number instead of the bits of a float: such bits are a subnormal float, almost 0. */
static void warn_of_bits(const triptych_device *device, enum triptych_state_table table, unsigned row,
                         uint32_t value)
{
    const struct triptych_state_row *state = triptych_state_at(table, row);
    char text[ERROR_CAPACITY];
    if (state->kind->notation != TRIPTYCH_NOTATION_REAL || value & 0x7f800000 || !(value & 0x7fffff))
        return;
    snprintf(text, sizeof text,
             "%s %s: value %u is the bits of a float near 0, expected triptych_float_bits()",
             triptych_table_name(table), state->name, value);
    device_report(device, TRIPTYCH_LOG_WARNING, text);
}

static enum triptych_result set_value(triptych_device *device, enum triptych_state_table table, unsigned i,
                                      unsigned row, uint32_t value)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    unsigned change = state_has_value(&device->state, table, i, row, value) ? 0 : PARTS_ALL;
    enum triptych_result result =
        change ? state_set_value(&device->state, table, i, row, value, error) : TRIPTYCH_OK;
    if (result == TRIPTYCH_OK)
        record_value(device, table, i, row, value);
    if (change && result == TRIPTYCH_OK) {
        change = change_of_value(table, row);
        warn_of_bits(device, table, row, value);
    }
    return api_changed(device, result, change);
}

enum triptych_result triptych_set_state(triptych_device *device, enum triptych_state which, uint32_t value)
{
    return set_value(device, TRIPTYCH_RENDER_STATES, 0, which, value);
}

enum triptych_result triptych_set_sampler_state(triptych_device *device, unsigned sampler,
                                                enum triptych_sampler_state which, uint32_t value)
{
    return set_value(device, TRIPTYCH_SAMPLER_STATES, sampler, which, value);
}

enum triptych_result triptych_set_stage_state(triptych_device *device, unsigned stage,
                                              enum triptych_stage_state which, uint32_t value)
{
    return set_value(device, TRIPTYCH_STAGE_STATES, stage, which, value);
}

enum triptych_result triptych_set_transform(triptych_device *device, enum triptych_transform which,
                                            const float matrix[4][4])
{
    struct error *error = api_begin_with(device, matrix, "matrix");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = state_set_transform(&device->state, which, matrix, error);
    if (result == TRIPTYCH_OK)
        record_transform(device, which, matrix);
    return api_changed(device, result, change_of_transform(which));
}

enum triptych_result triptych_set_viewport(triptych_device *device, const struct triptych_viewport *viewport)
{
    struct error *error = api_begin_with(device, viewport, "viewport");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!device_target(device)->width) {
        error_set(error, "no target: expected set_target before a viewport");
        return api_finish(device, TRIPTYCH_BAD_CALL);
    }
    enum triptych_result result = state_set_viewport(&device->state, viewport, error);
    if (result == TRIPTYCH_OK)
        record_viewport(device, viewport);
    return api_changed(device, result, CHANGE_OF_VIEWPORT);
}

enum triptych_result triptych_set_scissor(triptych_device *device, unsigned x, unsigned y, unsigned width,
                                          unsigned height)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!device_target(device)->width) {
        error_set(error, "no target: expected set_target before a scissor rectangle");
        return api_finish(device, TRIPTYCH_BAD_CALL);
    }
    state_set_scissor(&device->state, (struct scissor){x, y, width, height});
    record_scissor(device, x, y, width, height);
    return api_changed(device, TRIPTYCH_OK, CHANGE_OF_SCISSOR);
}

enum triptych_result triptych_set_clip_mask(triptych_device *device, triptych_texture *texture, int x, int y,
                                            unsigned box_x, unsigned box_y, unsigned box_width,
                                            unsigned box_height)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    const struct triptych_clip_mask mask = {texture, x, y, {box_x, box_y, box_width, box_height}};
    enum triptych_result result = state_set_clip_mask(&device->state, &mask, error);
    if (result == TRIPTYCH_OK)
        record_clip_mask(device, &mask);
    return api_changed(device, result, CHANGE_OF_CLIP_MASK);
}

enum triptych_result triptych_set_clip_plane(triptych_device *device, unsigned i, const float plane[4])
{
    struct error *error = api_begin_with(device, plane, "plane");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = state_set_clip_plane(&device->state, i, plane, error);
    if (result == TRIPTYCH_OK)
        record_clip_plane(device, i, plane);
    return api_changed(device, result, CHANGE_OF_CLIP_PLANE);
}

enum triptych_result triptych_set_convention(triptych_device *device, enum triptych_convention which,
                                             unsigned value)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = state_set_convention(&device->state, which, value, error);
    if (result == TRIPTYCH_OK)
        record_convention(device, which, value);
    return api_changed(device, result, PARTS_ALL);
}

enum triptych_result triptych_set_material(triptych_device *device, const struct triptych_material *material)
{
    struct error *error = api_begin_with(device, material, "material");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    unsigned change = change_of_material(&device->state.material, material);
    enum triptych_result result = state_set_material(&device->state, material, error);
    if (result == TRIPTYCH_OK)
        record_material(device, material);
    return api_changed(device, result, change);
}

enum triptych_result triptych_set_light(triptych_device *device, unsigned index,
                                        const struct triptych_light *light)
{
    struct error *error = api_begin_with(device, light, "light");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    unsigned change = index < TRIPTYCH_LIGHTS ? change_of_light(&device->state.light[index], light) : 0;
    enum triptych_result result = state_set_light(&device->state, index, light, error);
    if (result == TRIPTYCH_OK)
        record_light(device, index, light);
    return api_changed(device, result, change);
}

enum triptych_result triptych_enable_light(triptych_device *device, unsigned index, int enable)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    if (index >= TRIPTYCH_LIGHTS) {
        error_set(error, "light %u: expected 0 to %u", index, TRIPTYCH_LIGHTS - 1);
        return api_finish(device, TRIPTYCH_BAD_ARGUMENT);
    }
    device->state.light_enabled[index] = enable != 0;
    record_enable_light(device, index, enable);
    return api_changed(device, TRIPTYCH_OK, CHANGE_OF_LIGHTS);
}

enum triptych_result triptych_set_texture(triptych_device *device, unsigned sampler,
                                          triptych_texture *texture)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    if (sampler >= TRIPTYCH_SAMPLERS) {
        error_set(error, "sampler %u: expected 0 to %u", sampler, TRIPTYCH_SAMPLERS - 1);
        return api_finish(device, TRIPTYCH_BAD_ARGUMENT);
    }
    unsigned change = change_of_texture(device->state.texture[sampler], texture);
    device->state.texture[sampler] = texture;
    record_bind_texture(device, sampler, texture);
    return api_changed(device, TRIPTYCH_OK, change);
}

enum triptych_result triptych_set_element(triptych_device *device, enum triptych_attribute attribute,
                                          const struct triptych_element *element)
{
    struct error *error = api_begin_with(device, element, "element");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = state_set_element(&device->state, attribute, element, error);
    if (result == TRIPTYCH_OK)
        record_element(device, attribute, element);
    return api_changed(device, result, CHANGE_OF_ELEMENTS);
}

/* Where vertices lie, before a call that may change it. Programs set the same declaration again for each
 * draw. */
struct vertex_layout {
    unsigned others;
    struct state_element element[TRIPTYCH_ATTRIBUTE_COUNT];
    struct state_other other[TRIPTYCH_DECLARATION_ELEMENTS];
};

static void note_layout(const struct state *state, struct vertex_layout *layout)
{
    layout->others = state->others;
    memcpy(layout->element, state->element, sizeof layout->element);
    memcpy(layout->other, state->other, layout->others * sizeof *layout->other);
}

static unsigned change_of_layout(const struct state *state, const struct vertex_layout *before)
{
    bool same = state->others == before->others &&
                !memcmp(state->element, before->element, sizeof before->element) &&
                !memcmp(state->other, before->other, before->others * sizeof *before->other);
    return same ? 0 : CHANGE_OF_ELEMENTS;
}

enum triptych_result triptych_set_declaration(triptych_device *device,
                                              const struct triptych_declaration_element *elements,
                                              unsigned count)
{
    struct error *error = api_begin_with(device, elements || !count, "elements");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    struct vertex_layout before;
    note_layout(&device->state, &before);
    enum triptych_result result = state_set_declaration(&device->state, elements, count, error);
    if (result == TRIPTYCH_OK)
        record_declaration(device, elements, count);
    return api_changed(device, result, change_of_layout(&device->state, &before));
}

enum triptych_result triptych_set_fvf(triptych_device *device, uint32_t fvf)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    struct vertex_layout before;
    note_layout(&device->state, &before);
    enum triptych_result result = state_set_fvf(&device->state, fvf, error);
    if (result == TRIPTYCH_OK)
        record_call(device, &(struct call){.type = CALL_FVF, .resource = NO_RESOURCE, .fvf.code = fvf});
    return api_changed(device, result, change_of_layout(&device->state, &before));
}

enum triptych_result triptych_set_stream(triptych_device *device, unsigned stream, triptych_buffer *buffer,
                                         size_t offset, size_t stride)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    bool same = state_has_stream(&device->state, stream, buffer, offset, stride);
    enum triptych_result result = state_set_stream(&device->state, stream, buffer, offset, stride, error);
    if (result == TRIPTYCH_OK)
        record_stream(device, stream, buffer, offset, stride);
    return api_changed(device, result, same ? 0 : CHANGE_OF_STREAM);
}

enum triptych_result triptych_set_stream_frequency(triptych_device *device, unsigned stream,
                                                   enum triptych_frequency frequency, uint32_t count)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = state_set_frequency(&device->state, stream, frequency, count, error);
    if (result == TRIPTYCH_OK)
        record_frequency(device, stream, frequency, count);
    return api_changed(device, result, CHANGE_OF_STREAM);
}

enum triptych_result triptych_set_indices(triptych_device *device, triptych_buffer *buffer, unsigned bits)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    if (buffer && bits != 8 && bits != 16 && bits != 32) {
        error_set(error, "indices of %u bits: expected 8, 16 or 32", bits);
        return api_finish(device, TRIPTYCH_BAD_ARGUMENT);
    }
    device->state.indices = buffer;
    device->state.index_bits = buffer ? bits : 0;
    record_indices(device, buffer, bits);
    return TRIPTYCH_OK;
}
