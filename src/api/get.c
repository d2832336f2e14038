/* Getters: the state that the application has set. Each refuses the arguments that its setter refuses. */
#include "api/api.h"

#include <string.h>

/* Begins a getter with a place for its result, and an index below `count`. */
static struct error *begin(triptych_device *device, bool given, const char *what, unsigned i, unsigned count)
{
    struct error *error = api_begin_with(device, given, "result");
    if (!error || i < count)
        return error;
    error_set(error, "%s %u: expected 0 to %u", what, i, count - 1);
    api_finish(device, TRIPTYCH_BAD_ARGUMENT);
    return NULL;
}

/* --- States --------------------------------------------------------------------------------------------- */

enum triptych_result triptych_get_state(triptych_device *device, enum triptych_state which, uint32_t *value)
{
    if (!begin(device, value, "state", which, TRIPTYCH_STATE_COUNT))
        return TRIPTYCH_BAD_ARGUMENT;
    *value = device->state.value[which];
    return TRIPTYCH_OK;
}

enum triptych_result triptych_get_sampler_state(triptych_device *device, unsigned sampler,
                                                enum triptych_sampler_state which, uint32_t *value)
{
    if (!begin(device, value, "sampler", sampler, TRIPTYCH_SAMPLERS) ||
        !begin(device, value, "sampler state", which, TRIPTYCH_SAMPLER_STATE_COUNT))
        return TRIPTYCH_BAD_ARGUMENT;
    *value = device->state.sampler[sampler][which];
    return TRIPTYCH_OK;
}

enum triptych_result triptych_get_stage_state(triptych_device *device, unsigned stage,
                                              enum triptych_stage_state which, uint32_t *value)
{
    if (!begin(device, value, "stage", stage, TRIPTYCH_STAGES) ||
        !begin(device, value, "stage state", which, TRIPTYCH_STAGE_STATE_COUNT))
        return TRIPTYCH_BAD_ARGUMENT;
    *value = device->state.stage[stage][which];
    return TRIPTYCH_OK;
}

enum triptych_result triptych_get_convention(triptych_device *device, enum triptych_convention which,
                                             unsigned *value)
{
    if (!begin(device, value, "convention", which, TRIPTYCH_CONVENTION_COUNT))
        return TRIPTYCH_BAD_ARGUMENT;
    *value = device->state.convention[which];
    return TRIPTYCH_OK;
}

/* --- Geometry and light --------------------------------------------------------------------------------- */

enum triptych_result triptych_get_transform(triptych_device *device, enum triptych_transform which,
                                            float matrix[4][4])
{
    if (!begin(device, matrix, "transform", which, TRIPTYCH_TRANSFORM_COUNT))
        return TRIPTYCH_BAD_ARGUMENT;
    memcpy(matrix, device->state.transform[which], sizeof device->state.transform[which]);
    return TRIPTYCH_OK;
}

enum triptych_result triptych_get_viewport(triptych_device *device, struct triptych_viewport *viewport)
{
    if (!api_begin_with(device, viewport, "result"))
        return TRIPTYCH_BAD_ARGUMENT;
    *viewport = device->state.viewport;
    return TRIPTYCH_OK;
}

enum triptych_result triptych_get_scissor(triptych_device *device, struct triptych_rectangle *rectangle)
{
    if (!api_begin_with(device, rectangle, "result"))
        return TRIPTYCH_BAD_ARGUMENT;
    const struct scissor *scissor = &device->state.scissor;
    *rectangle = (struct triptych_rectangle){scissor->x, scissor->y, scissor->width, scissor->height};
    return TRIPTYCH_OK;
}

enum triptych_result triptych_get_clip_mask(triptych_device *device, struct triptych_clip_mask *mask)
{
    if (!api_begin_with(device, mask, "result"))
        return TRIPTYCH_BAD_ARGUMENT;
    *mask = device->state.clip_mask;
    return TRIPTYCH_OK;
}

enum triptych_result triptych_get_clip_plane(triptych_device *device, unsigned i, float plane[4])
{
    if (!begin(device, plane, "clip plane", i, TRIPTYCH_CLIP_PLANES))
        return TRIPTYCH_BAD_ARGUMENT;
    memcpy(plane, device->state.clip_plane[i], sizeof device->state.clip_plane[i]);
    return TRIPTYCH_OK;
}

enum triptych_result triptych_get_material(triptych_device *device, struct triptych_material *material)
{
    if (!api_begin_with(device, material, "result"))
        return TRIPTYCH_BAD_ARGUMENT;
    *material = device->state.material;
    return TRIPTYCH_OK;
}

enum triptych_result triptych_get_light(triptych_device *device, unsigned index, struct triptych_light *light)
{
    if (!begin(device, light, "light", index, TRIPTYCH_LIGHTS))
        return TRIPTYCH_BAD_ARGUMENT;
    *light = device->state.light[index];
    return TRIPTYCH_OK;
}

enum triptych_result triptych_get_light_enable(triptych_device *device, unsigned index, int *enable)
{
    if (!begin(device, enable, "light", index, TRIPTYCH_LIGHTS))
        return TRIPTYCH_BAD_ARGUMENT;
    *enable = device->state.light_enabled[index];
    return TRIPTYCH_OK;
}

/* --- Objects -------------------------------------------------------------------------------------------- */

enum triptych_result triptych_get_texture(triptych_device *device, unsigned sampler,
                                          triptych_texture **texture)
{
    if (!begin(device, texture, "sampler", sampler, TRIPTYCH_SAMPLERS))
        return TRIPTYCH_BAD_ARGUMENT;
    *texture = device->state.texture[sampler];
    return TRIPTYCH_OK;
}

static enum triptych_result get_shader(triptych_device *device, enum shader_stage stage,
                                       triptych_shader **shader)
{
    if (!api_begin_with(device, shader, "result"))
        return TRIPTYCH_BAD_ARGUMENT;
    *shader = device->shader[stage];
    return TRIPTYCH_OK;
}

enum triptych_result triptych_get_vertex_shader(triptych_device *device, triptych_shader **shader)
{
    return get_shader(device, STAGE_VERTEX, shader);
}

enum triptych_result triptych_get_pixel_shader(triptych_device *device, triptych_shader **shader)
{
    return get_shader(device, STAGE_PIXEL, shader);
}

enum triptych_result triptych_get_target_surfaces(triptych_device *device,
                                                  struct triptych_target_surfaces *surfaces)
{
    if (!api_begin_with(device, surfaces, "result"))
        return TRIPTYCH_BAD_ARGUMENT;
    const struct triptych_target_surfaces *drawn = device_drawn_surfaces(device);
    *surfaces = drawn ? *drawn : (struct triptych_target_surfaces){0};
    return TRIPTYCH_OK;
}

void triptych_image_get_description(const triptych_image *image,
                                    struct triptych_image_description *description)
{
    if (description)
        *description = image ? image->description : (struct triptych_image_description){0};
}

size_t triptych_buffer_get_bytes(const triptych_buffer *buffer)
{
    return buffer ? buffer->bytes : 0;
}

void triptych_texture_get_description(const triptych_texture *texture,
                                      struct triptych_texture_description *description)
{
    if (!description)
        return;
    *description = (struct triptych_texture_description){0};
    if (texture)
        *description = (struct triptych_texture_description){
            texture->type,  (enum triptych_surface_format)texture->format->number,
            texture->width, texture->height,
            texture->depth, texture->levels};
}

/* --- Constants ------------------------------------------------------------------------------------------ */

/* The error of a getter of constants, or null if these constants do not exist. */
static struct error *begin_constants(triptych_device *device, enum constant_file file,
                                     enum triptych_shader_stage stage, unsigned first, unsigned count,
                                     bool given)
{
    struct error *error = api_begin_with(device, given || !count, "values");
    enum triptych_result result =
        error ? state_check_constants(file, stage, first, count, error) : TRIPTYCH_BAD_ARGUMENT;
    if (error && result != TRIPTYCH_OK)
        api_finish(device, result);
    return result == TRIPTYCH_OK ? error : NULL;
}

enum triptych_result triptych_get_shader_floats(triptych_device *device, enum triptych_shader_stage stage,
                                                unsigned first, float *values, unsigned count)
{
    if (!begin_constants(device, CONSTANT_FLOAT, stage, first, count, values))
        return TRIPTYCH_BAD_ARGUMENT;
    if (count)
        memcpy(values, device->registers[stage].floats[first], count * sizeof(float[4]));
    return TRIPTYCH_OK;
}

enum triptych_result triptych_get_shader_integers(triptych_device *device, enum triptych_shader_stage stage,
                                                  unsigned first, int32_t *values, unsigned count)
{
    if (!begin_constants(device, CONSTANT_INTEGER, stage, first, count, values))
        return TRIPTYCH_BAD_ARGUMENT;
    if (count)
        memcpy(values, device->registers[stage].integers[first], count * sizeof(int32_t[4]));
    return TRIPTYCH_OK;
}

enum triptych_result triptych_get_shader_booleans(triptych_device *device, enum triptych_shader_stage stage,
                                                  unsigned first, int32_t *values, unsigned count)
{
    if (!begin_constants(device, CONSTANT_BOOLEAN, stage, first, count, values))
        return TRIPTYCH_BAD_ARGUMENT;
    for (unsigned i = 0; i < count; i++)
        values[i] = device->state.booleans[stage] >> (first + i) & 1;
    return TRIPTYCH_OK;
}

/* --- Vertices ------------------------------------------------------------------------------------------- */

enum triptych_result triptych_get_declaration(triptych_device *device,
                                              struct triptych_declaration_element *elements, unsigned room,
                                              unsigned *count)
{
    struct triptych_declaration_element all[TRIPTYCH_DECLARATION_ELEMENTS];
    struct error *error = api_begin_with_both(device, elements || !room, "elements", count, "count");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    unsigned found = state_declaration(&device->state, all);
    if (found > room) {
        error_set(error, "an array of %u elements: expected at least %u", room, found);
        return api_finish(device, TRIPTYCH_BAD_ARGUMENT);
    }
    if (found)
        memcpy(elements, all, found * sizeof *elements);
    *count = found;
    return TRIPTYCH_OK;
}

enum triptych_result triptych_get_stream(triptych_device *device, unsigned stream, triptych_buffer **buffer,
                                         size_t *offset, size_t *stride)
{
    if (!begin(device, buffer && offset && stride, "stream", stream, TRIPTYCH_STREAMS))
        return TRIPTYCH_BAD_ARGUMENT;
    const struct state_stream *found = device->state.stream + stream;
    *buffer = found->buffer;
    *offset = found->offset;
    *stride = found->stride;
    return TRIPTYCH_OK;
}

enum triptych_result triptych_get_stream_frequency(triptych_device *device, unsigned stream,
                                                   enum triptych_frequency *frequency, uint32_t *count)
{
    if (!begin(device, frequency && count, "stream", stream, TRIPTYCH_STREAMS))
        return TRIPTYCH_BAD_ARGUMENT;
    const struct state_stream *found = device->state.stream + stream;
    *frequency = found->frequency;
    *count = found->count ? found->count : 1;
    return TRIPTYCH_OK;
}

enum triptych_result triptych_get_element(triptych_device *device, enum triptych_attribute attribute,
                                          struct triptych_element *element)
{
    if (!begin(device, element, "attribute", attribute, TRIPTYCH_ATTRIBUTE_COUNT))
        return TRIPTYCH_BAD_ARGUMENT;
    const struct state_element *found = &device->state.element[attribute];
    *element = (struct triptych_element){.format = TRIPTYCH_FORMAT_NONE};
    if (found->format && found->stream >= TRIPTYCH_STREAMS) {
        const struct state_stream *stream = state_stream_of(&device->state, attribute);
        *element = (struct triptych_element){found->format, stream->buffer, stream->offset, stream->stride};
    }
    return TRIPTYCH_OK;
}

enum triptych_result triptych_get_indices(triptych_device *device, triptych_buffer **buffer, unsigned *bits)
{
    if (!api_begin_with_both(device, buffer, "buffer", bits, "bits"))
        return TRIPTYCH_BAD_ARGUMENT;
    *buffer = device->state.indices;
    *bits = device->state.index_bits;
    return TRIPTYCH_OK;
}
