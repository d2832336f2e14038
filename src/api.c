/* The public functions: null pointers are refused here, everything else by the device; the reason of a
 * failure is kept for triptych_error(). */
#define _GNU_SOURCE /* secure_getenv */
#include "container/record.h"
#include "draw/depth.h"
#include "draw/device.h"
#include "engines.h"
#include "shader/program.h"

#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char default_engine[] = "specialize";

/* --- Devices and engines ----------------------------------------------------------------------------------
 */

static enum triptych_result create(const struct triptych_options *options, triptych_device **device,
                                   struct error *error)
{
    const char *name = options && options->engine ? options->engine : default_engine;
    const struct engine *engine = engine_find(name);
    if (!engine) {
        error_set(error, "engine %s: there is none of that name", name);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    struct device_options device_options = {.debug = secure_getenv("TRIPTYCH_DEBUG")};
    if (options) {
        device_options.threads = options->threads;
        device_options.cache_bytes = options->cache_bytes;
        device_options.measure = options->measure != 0;
        if (options->debug)
            device_options.debug = options->debug;
    }
    return device_create(engine, &device_options, device, error);
}

enum triptych_result triptych_device_create(const struct triptych_options *options, triptych_device **device,
                                            char *reason, size_t size)
{
    struct error error = {{0}};
    enum triptych_result result = TRIPTYCH_BAD_ARGUMENT;
    if (device) {
        *device = NULL;
        result = create(options, device, &error);
        if (result == TRIPTYCH_OK)
            result = record_from_environment(*device, &error);
        if (result != TRIPTYCH_OK) {
            device_destroy(*device);
            *device = NULL;
        }
    } else {
        error_set(&error, "device is null: expected where to put it");
    }
    if (reason && size)
        snprintf(reason, size, "%s", error.text);
    return result;
}

void triptych_device_destroy(triptych_device *device)
{
    if (device && device->recorder)
        record_stop(device, NULL);
    device_destroy(device);
}

const char *triptych_error(const triptych_device *device)
{
    return device ? device->error.text : "device is null";
}

const char *triptych_debug_error(triptych_device *device)
{
    if (!device)
        return "device is null";
    device_debug_error(device, &device->debug_told);
    return device->debug_told.text;
}

const char *triptych_engine_name(unsigned i)
{
    return engine_at(i) ? engine_at(i)->name : NULL;
}

const char *triptych_engine_description(unsigned i)
{
    return engine_at(i) ? engine_at(i)->description : NULL;
}

unsigned triptych_engine_width(unsigned i)
{
    return engine_at(i) ? (unsigned)engine_at(i)->width : 0;
}

const char *triptych_engine_unavailable(unsigned i)
{
    return engine_at(i) ? engine_at(i)->unavailable() : NULL;
}

/* --- Arguments and results --------------------------------------------------------------------------------
 */

/* The reason is kept from the last failed call until the next one. */
static enum triptych_result finish(triptych_device *device, enum triptych_result result,
                                   const struct error *error)
{
    if (result != TRIPTYCH_OK)
        device->error = *error;
    return result;
}

static enum triptych_result null_argument(triptych_device *device, const char *what)
{
    struct error error = {{0}};
    error_set(&error, "%s is null", what);
    return finish(device, TRIPTYCH_BAD_ARGUMENT, &error);
}

/* As finish, after a change of the state. */
static enum triptych_result changed(triptych_device *device, enum triptych_result result,
                                    const struct error *error)
{
    if (result == TRIPTYCH_OK)
        device_state_changed(device);
    return finish(device, result, error);
}

/* --- Recording --------------------------------------------------------------------------------------------
 */

enum triptych_result triptych_record_start(triptych_device *device, const char *path)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!path)
        return null_argument(device, "path");
    struct error error = {{0}};
    return finish(device, record_start(device, path, &error), &error);
}

enum triptych_result triptych_record_stop(triptych_device *device)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    struct error error = {{0}};
    return finish(device, record_stop(device, &error), &error);
}

/* --- Target, buffers, textures ----------------------------------------------------------------------------
 */

enum triptych_result triptych_set_target(triptych_device *device, unsigned width, unsigned height)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    struct triptych_target_description description = {.width = width, .height = height};
    struct error error = {{0}};
    enum triptych_result result = device_set_target(device, &description, &error);
    if (result == TRIPTYCH_OK)
        record_target(device, &description);
    return finish(device, result, &error);
}

enum triptych_result triptych_set_target_description(triptych_device *device,
                                                     const struct triptych_target_description *description)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!description)
        return null_argument(device, "description");
    struct error error = {{0}};
    enum triptych_result result = device_set_target(device, description, &error);
    if (result == TRIPTYCH_OK)
        record_target(device, description);
    return finish(device, result, &error);
}

enum triptych_result triptych_buffer_create(triptych_device *device, const void *data, size_t bytes,
                                            triptych_buffer **buffer)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!data || !buffer)
        return null_argument(device, data ? "buffer" : "data");
    *buffer = NULL;
    struct error error = {{0}};
    if (!bytes || bytes > INT32_MAX) {
        error_set(&error, "buffer of %zu bytes: expected 1 to 2^31 - 1", bytes);
        return finish(device, TRIPTYCH_BAD_ARGUMENT, &error);
    }
    *buffer = buffer_create(data, bytes);
    if (!*buffer) {
        error_set(&error, "out of memory for a buffer of %zu bytes", bytes);
        return finish(device, TRIPTYCH_NO_MEMORY, &error);
    }
    (*buffer)->next = device->buffers;
    device->buffers = *buffer;
    record_new_buffer(device, *buffer);
    return TRIPTYCH_OK;
}

enum triptych_result triptych_buffer_destroy(triptych_device *device, triptych_buffer *buffer)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!buffer)
        return TRIPTYCH_OK;
    struct error error = {{0}};
    record_end_buffer(device, buffer);
    return finish(device, device_buffer_destroy(device, buffer, &error), &error);
}

enum triptych_result triptych_texture_create(triptych_device *device, const void *rgba, unsigned width,
                                             unsigned height, triptych_texture **texture)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!rgba || !texture)
        return null_argument(device, rgba ? "texture" : "image");
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8B8G8R8, width, height, 1, 1};
    struct error error = {{0}};
    enum triptych_result result = device_texture_create(device, &description, texture, &error);
    if (result == TRIPTYCH_OK)
        result = device_texture_update(device, *texture, 0, 0, NULL, rgba, 4 * (size_t)width, 0, &error);
    if (result == TRIPTYCH_OK) {
        record_new_texture(device, *texture);
        record_update(device, *texture, 0, 0, NULL, rgba, 4 * (size_t)width, 0);
    }
    return finish(device, result, &error);
}

enum triptych_result triptych_texture_define(triptych_device *device,
                                             const struct triptych_texture_description *description,
                                             triptych_texture **texture)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!description || !texture)
        return null_argument(device, description ? "texture" : "description");
    struct error error = {{0}};
    enum triptych_result result = device_texture_create(device, description, texture, &error);
    if (result == TRIPTYCH_OK)
        record_new_texture(device, *texture);
    return finish(device, result, &error);
}

enum triptych_result triptych_texture_update(triptych_device *device, triptych_texture *texture,
                                             unsigned face, unsigned level, const struct triptych_box *box,
                                             const void *data, size_t row_pitch, size_t slice_pitch)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!texture || !data)
        return null_argument(device, texture ? "data" : "texture");
    struct error error = {{0}};
    enum triptych_result result =
        device_texture_update(device, texture, face, level, box, data, row_pitch, slice_pitch, &error);
    if (result == TRIPTYCH_OK)
        record_update(device, texture, face, level, box, data, row_pitch, slice_pitch);
    return finish(device, result, &error);
}

enum triptych_result triptych_texture_generate_mips(triptych_device *device, triptych_texture *texture)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!texture)
        return null_argument(device, "texture");
    device_texture_generate_mips(device, texture);
    record_mips(device, texture);
    return TRIPTYCH_OK;
}

enum triptych_result triptych_texture_destroy(triptych_device *device, triptych_texture *texture)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!texture)
        return TRIPTYCH_OK;
    struct error error = {{0}};
    record_end_texture(device, texture);
    return finish(device, device_texture_destroy(device, texture, &error), &error);
}

/* --- Shaders ----------------------------------------------------------------------------------------------
 */

typedef int shader_reader(const char *path, const char *data, size_t bytes, struct shader **shader,
                          struct error *error);

static int read_tokens(const char *path, const char *data, size_t bytes, struct shader **shader,
                       struct error *error)
{
    return shader_read(path, data, bytes, shader, error);
}

/* What recordings write of a shader that lives when they begin. */
static enum triptych_result keep_source(triptych_device *device, const void *data, size_t bytes, bool is_text,
                                        triptych_shader **shader, struct error *error)
{
    enum triptych_result result = device_shader_keep(*shader, data, bytes, is_text, error);
    if (result == TRIPTYCH_OK) {
        record_new_shader(device, *shader);
        return result;
    }
    device_shader_destroy(device, *shader, NULL);
    *shader = NULL;
    return result;
}

/* The front end's functions want a locale that writes numbers with a point. */
static enum triptych_result create_shader(triptych_device *device, const char *name, const void *data,
                                          size_t bytes, shader_reader *read, triptych_shader **result)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!data || !result)
        return null_argument(device, data ? "shader" : "code");
    *result = NULL;
    struct error error = {{0}};
    struct shader *shader;
    locale_t locale = newlocale(LC_NUMERIC_MASK, "C", NULL);
    if (!locale) {
        error_set(&error, "out of memory for a shader");
        return finish(device, TRIPTYCH_NO_MEMORY, &error);
    }
    locale_t before = uselocale(locale);
    enum triptych_result status;
    errno = 0;
    if (read(name ? name : "shader", data, bytes, &shader, &error)) {
        status = device_refusal(TRIPTYCH_BAD_ARGUMENT);
    } else {
        status = device_shader_create(device, shader, result, &error);
        shader_free(shader);
        if (status == TRIPTYCH_OK)
            status = keep_source(device, data, bytes, read == shader_assemble, result, &error);
    }
    uselocale(before);
    freelocale(locale);
    return finish(device, status, &error);
}

enum triptych_result triptych_shader_create(triptych_device *device, const char *name, const void *code,
                                            size_t bytes, triptych_shader **shader)
{
    return create_shader(device, name, code, bytes, read_tokens, shader);
}

enum triptych_result triptych_shader_assemble(triptych_device *device, const char *name, const char *text,
                                              size_t bytes, triptych_shader **shader)
{
    return create_shader(device, name, text, bytes, shader_assemble, shader);
}

enum triptych_result triptych_shader_destroy(triptych_device *device, triptych_shader *shader)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!shader)
        return TRIPTYCH_OK;
    struct error error = {{0}};
    record_end_shader(device, shader);
    return finish(device, device_shader_destroy(device, shader, &error), &error);
}

enum triptych_shader_stage triptych_shader_get_stage(const triptych_shader *shader)
{
    return shader && shader->program->model->stage == STAGE_PIXEL ? TRIPTYCH_SHADER_PIXEL
                                                                  : TRIPTYCH_SHADER_VERTEX;
}

const char *triptych_shader_get_model(const triptych_shader *shader)
{
    return shader ? shader->program->model->name : NULL;
}

static enum triptych_result set_shader(triptych_device *device, enum shader_stage stage,
                                       triptych_shader *shader)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    struct error error = {{0}};
    enum triptych_result result = device_set_shader(device, stage, shader, &error);
    if (result == TRIPTYCH_OK)
        record_shader(device, stage, shader);
    return finish(device, result, &error);
}

enum triptych_result triptych_set_vertex_shader(triptych_device *device, triptych_shader *shader)
{
    return set_shader(device, STAGE_VERTEX, shader);
}

enum triptych_result triptych_set_pixel_shader(triptych_device *device, triptych_shader *shader)
{
    return set_shader(device, STAGE_PIXEL, shader);
}

enum triptych_result triptych_set_shader_floats(triptych_device *device, enum triptych_shader_stage stage,
                                                unsigned first, const float *values, unsigned count)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!values && count)
        return null_argument(device, "values");
    struct error error = {{0}};
    enum triptych_result result = device_set_floats(device, stage, first, values, count, &error);
    if (result == TRIPTYCH_OK)
        record_floats(device, stage, first, values, count);
    return finish(device, result, &error);
}

enum triptych_result triptych_set_shader_integers(triptych_device *device, enum triptych_shader_stage stage,
                                                  unsigned first, const int32_t *values, unsigned count)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!values && count)
        return null_argument(device, "values");
    struct error error = {{0}};
    enum triptych_result result = device_set_integers(device, stage, first, values, count, &error);
    if (result == TRIPTYCH_OK)
        record_integers(device, stage, first, values, count);
    return finish(device, result, &error);
}

enum triptych_result triptych_set_shader_booleans(triptych_device *device, enum triptych_shader_stage stage,
                                                  unsigned first, const int32_t *values, unsigned count)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!values && count)
        return null_argument(device, "values");
    struct error error = {{0}};
    enum triptych_result result = device_set_booleans(device, stage, first, values, count, &error);
    if (result == TRIPTYCH_OK)
        record_booleans(device, stage, first, values, count);
    return finish(device, result, &error);
}

/* --- State ------------------------------------------------------------------------------------------------
 */

static enum triptych_result set_value(triptych_device *device, enum triptych_state_table table, unsigned i,
                                      unsigned row, uint32_t value)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    struct error error = {{0}};
    enum triptych_result result = state_set_value(&device->state, table, i, row, value, &error);
    if (result == TRIPTYCH_OK)
        record_value(device, table, i, row, value);
    return changed(device, result, &error);
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
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!matrix)
        return null_argument(device, "matrix");
    struct error error = {{0}};
    enum triptych_result result = state_set_transform(&device->state, which, matrix, &error);
    if (result == TRIPTYCH_OK)
        record_transform(device, which, matrix);
    return changed(device, result, &error);
}

enum triptych_result triptych_set_viewport(triptych_device *device, const struct triptych_viewport *viewport)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!viewport)
        return null_argument(device, "viewport");
    struct error error = {{0}};
    if (!device->target.width) {
        error_set(&error, "no target: expected set_target before a viewport");
        return finish(device, TRIPTYCH_BAD_CALL, &error);
    }
    enum triptych_result result =
        state_set_viewport(&device->state, viewport, device->target.width, device->target.height, &error);
    if (result == TRIPTYCH_OK)
        record_viewport(device, viewport);
    return changed(device, result, &error);
}

enum triptych_result triptych_set_scissor(triptych_device *device, unsigned x, unsigned y, unsigned width,
                                          unsigned height)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    struct error error = {{0}};
    if (!device->target.width) {
        error_set(&error, "no target: expected set_target before a scissor rectangle");
        return finish(device, TRIPTYCH_BAD_CALL, &error);
    }
    enum triptych_result result = state_set_scissor(&device->state, (struct scissor){x, y, width, height},
                                                    device->target.width, device->target.height, &error);
    if (result == TRIPTYCH_OK)
        record_scissor(device, x, y, width, height);
    return changed(device, result, &error);
}

enum triptych_result triptych_set_clip_plane(triptych_device *device, unsigned i, const float plane[4])
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!plane)
        return null_argument(device, "plane");
    struct error error = {{0}};
    enum triptych_result result = state_set_clip_plane(&device->state, i, plane, &error);
    if (result == TRIPTYCH_OK)
        record_clip_plane(device, i, plane);
    return changed(device, result, &error);
}

enum triptych_result triptych_set_convention(triptych_device *device, enum triptych_convention which,
                                             unsigned value)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    struct error error = {{0}};
    enum triptych_result result = state_set_convention(&device->state, which, value, &error);
    if (result == TRIPTYCH_OK)
        record_convention(device, which, value);
    return changed(device, result, &error);
}

enum triptych_result triptych_set_material(triptych_device *device, const struct triptych_material *material)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!material)
        return null_argument(device, "material");
    struct error error = {{0}};
    enum triptych_result result = state_set_material(&device->state, material, &error);
    if (result == TRIPTYCH_OK)
        record_material(device, material);
    return changed(device, result, &error);
}

enum triptych_result triptych_set_light(triptych_device *device, unsigned index,
                                        const struct triptych_light *light)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!light)
        return null_argument(device, "light");
    struct error error = {{0}};
    enum triptych_result result = state_set_light(&device->state, index, light, &error);
    if (result == TRIPTYCH_OK)
        record_light(device, index, light);
    return changed(device, result, &error);
}

enum triptych_result triptych_enable_light(triptych_device *device, unsigned index, int enable)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    struct error error = {{0}};
    if (index >= TRIPTYCH_LIGHTS) {
        error_set(&error, "light %u: expected 0 to %u", index, TRIPTYCH_LIGHTS - 1);
        return finish(device, TRIPTYCH_BAD_ARGUMENT, &error);
    }
    device->state.light_enabled[index] = enable != 0;
    record_enable_light(device, index, enable);
    return changed(device, TRIPTYCH_OK, &error);
}

enum triptych_result triptych_set_texture(triptych_device *device, unsigned sampler,
                                          triptych_texture *texture)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    struct error error = {{0}};
    if (sampler >= TRIPTYCH_SAMPLERS) {
        error_set(&error, "sampler %u: expected 0 to %u", sampler, TRIPTYCH_SAMPLERS - 1);
        return finish(device, TRIPTYCH_BAD_ARGUMENT, &error);
    }
    device->state.texture[sampler] = texture;
    record_bind_texture(device, sampler, texture);
    return changed(device, TRIPTYCH_OK, &error);
}

enum triptych_result triptych_set_element(triptych_device *device, enum triptych_attribute attribute,
                                          const struct triptych_element *element)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!element)
        return null_argument(device, "element");
    struct error error = {{0}};
    enum triptych_result result = state_set_element(&device->state, attribute, element, &error);
    if (result == TRIPTYCH_OK)
        record_element(device, attribute, element);
    return changed(device, result, &error);
}

enum triptych_result triptych_set_declaration(triptych_device *device,
                                              const struct triptych_declaration_element *elements,
                                              unsigned count)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!elements && count)
        return null_argument(device, "elements");
    struct error error = {{0}};
    enum triptych_result result = state_set_declaration(&device->state, elements, count, &error);
    if (result == TRIPTYCH_OK)
        record_declaration(device, elements, count);
    return changed(device, result, &error);
}

enum triptych_result triptych_set_fvf(triptych_device *device, uint32_t fvf)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    struct error error = {{0}};
    enum triptych_result result = state_set_fvf(&device->state, fvf, &error);
    if (result == TRIPTYCH_OK)
        record_fvf(device, fvf);
    return changed(device, result, &error);
}

enum triptych_result triptych_set_stream(triptych_device *device, unsigned stream, triptych_buffer *buffer,
                                         size_t offset, size_t stride)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    struct error error = {{0}};
    enum triptych_result result = state_set_stream(&device->state, stream, buffer, offset, stride, &error);
    if (result == TRIPTYCH_OK)
        record_stream(device, stream, buffer, offset, stride);
    return changed(device, result, &error);
}

enum triptych_result triptych_set_stream_frequency(triptych_device *device, unsigned stream,
                                                   enum triptych_frequency frequency, uint32_t count)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    struct error error = {{0}};
    enum triptych_result result = state_set_frequency(&device->state, stream, frequency, count, &error);
    if (result == TRIPTYCH_OK)
        record_frequency(device, stream, frequency, count);
    return changed(device, result, &error);
}

enum triptych_result triptych_set_indices(triptych_device *device, triptych_buffer *buffer, unsigned bits)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    struct error error = {{0}};
    if (buffer && bits != 16 && bits != 32) {
        error_set(&error, "indices of %u bits: expected 16 or 32", bits);
        return finish(device, TRIPTYCH_BAD_ARGUMENT, &error);
    }
    device->state.indices = buffer;
    device->state.index_bits = buffer ? bits : 0;
    record_indices(device, buffer, bits);
    return TRIPTYCH_OK;
}

/* --- Drawing and reading ----------------------------------------------------------------------------------
 */

enum triptych_result triptych_draw(triptych_device *device, enum triptych_primitive primitive, uint32_t first,
                                   uint32_t count)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    struct error error = {{0}};
    enum triptych_result result = device_draw(device, primitive, first, count, &error);
    if (result == TRIPTYCH_OK)
        record_draw(device, primitive, first, count);
    return finish(device, result, &error);
}

enum triptych_result triptych_draw_indexed(triptych_device *device, enum triptych_primitive primitive,
                                           int32_t base, uint32_t first, uint32_t count)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    struct error error = {{0}};
    enum triptych_result result = device_draw_indexed(device, primitive, base, first, count, &error);
    if (result == TRIPTYCH_OK)
        record_draw_indexed(device, primitive, base, first, count);
    return finish(device, result, &error);
}

enum triptych_result triptych_clear(triptych_device *device, const float color[4], float depth)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    struct clear_values values = {(color ? TRIPTYCH_CLEAR_COLOR : 0) | (depth < 0 ? 0 : TRIPTYCH_CLEAR_DEPTH),
                                  color, depth, 0};
    struct error error = {{0}};
    enum triptych_result result = device_clear(device, &values, &error);
    if (result == TRIPTYCH_OK)
        record_clear(device, &values);
    return finish(device, result, &error);
}

enum triptych_result triptych_clear_buffers(triptych_device *device, unsigned flags, const float color[4],
                                            float depth, unsigned stencil)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (flags & TRIPTYCH_CLEAR_COLOR && !color)
        return null_argument(device, "color");
    struct clear_values values = {flags, color, depth, stencil};
    struct error error = {{0}};
    enum triptych_result result = device_clear(device, &values, &error);
    if (result == TRIPTYCH_OK)
        record_clear(device, &values);
    return finish(device, result, &error);
}

/* --- Queries ----------------------------------------------------------------------------------------------
 */

enum triptych_result triptych_query_create(triptych_device *device, enum triptych_query_type type,
                                           triptych_query **query)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!query)
        return null_argument(device, "query");
    *query = NULL;
    struct error error = {{0}};
    if ((unsigned)type >= TRIPTYCH_QUERY_COUNT) {
        error_set(&error, "query type %u: expected 0 to %u", (unsigned)type, TRIPTYCH_QUERY_COUNT - 1);
        return finish(device, TRIPTYCH_BAD_ARGUMENT, &error);
    }
    *query = query_create(&device->queries, type);
    if (*query) {
        record_new_query(device, *query);
        return TRIPTYCH_OK;
    }
    error_set(&error, "out of memory for a query");
    return finish(device, TRIPTYCH_NO_MEMORY, &error);
}

enum triptych_result triptych_query_destroy(triptych_device *device, triptych_query *query)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!query)
        return TRIPTYCH_OK;
    struct error error = {{0}};
    record_end_query(device, query);
    return finish(device, device_query_destroy(device, query, &error), &error);
}

enum triptych_result triptych_query_begin(triptych_device *device, triptych_query *query)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!query)
        return null_argument(device, "query");
    struct error error = {{0}};
    enum triptych_result result = device_query_begin(device, query, &error);
    if (result == TRIPTYCH_OK)
        record_query(device, query, 1);
    return finish(device, result, &error);
}

enum triptych_result triptych_query_end(triptych_device *device, triptych_query *query)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!query)
        return null_argument(device, "query");
    struct error error = {{0}};
    enum triptych_result result = device_query_end(device, query, &error);
    if (result == TRIPTYCH_OK)
        record_query(device, query, 0);
    return finish(device, result, &error);
}

enum triptych_result triptych_query_result(triptych_device *device, triptych_query *query, uint64_t *result)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!query || !result)
        return null_argument(device, query ? "result" : "query");
    struct error error = {{0}};
    return finish(device, device_query_result(device, query, result, &error), &error);
}

enum triptych_result triptych_finish(triptych_device *device)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    device_finish(device);
    record_frame(device);
    return TRIPTYCH_OK;
}

enum triptych_result triptych_read_color(triptych_device *device, uint32_t *rgba)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!rgba)
        return null_argument(device, "image");
    struct error error = {{0}};
    return finish(device, device_read_target(device, 0, rgba, &error), &error);
}

enum triptych_result triptych_read_target(triptych_device *device, unsigned t, uint32_t *rgba)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!rgba)
        return null_argument(device, "image");
    struct error error = {{0}};
    return finish(device, device_read_target(device, t, rgba, &error), &error);
}

enum triptych_result triptych_read_target_numbers(triptych_device *device, unsigned t, float *rgba)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!rgba)
        return null_argument(device, "image");
    struct error error = {{0}};
    return finish(device, device_read_target_numbers(device, t, rgba, &error), &error);
}

enum triptych_result triptych_set_target_textures(triptych_device *device,
                                                  const struct triptych_target_textures *textures)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    struct error error = {{0}};
    bool changes = textures || device->draws_to_textures;
    enum triptych_result result = device_set_target_textures(device, textures, &error);
    if (result == TRIPTYCH_OK && changes)
        record_attach(device, textures);
    return finish(device, result, &error);
}

enum triptych_result triptych_copy(triptych_device *device, const struct triptych_surface *source,
                                   const struct triptych_rectangle *source_part,
                                   const struct triptych_surface *target,
                                   const struct triptych_rectangle *target_part,
                                   enum triptych_copy_filter filter)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!source || !target)
        return null_argument(device, source ? "target" : "source");
    struct surface_copy copy = {.surface = {source, target}, .filter = filter};
    struct error error = {{0}};
    if (source_part)
        copy.part[0] = *source_part;
    if (target_part)
        copy.part[1] = *target_part;
    enum triptych_result result = device_copy(device, &copy, &error);
    if (result == TRIPTYCH_OK)
        record_copy(device, &copy);
    return finish(device, result, &error);
}

enum triptych_result triptych_read_surface(triptych_device *device, const struct triptych_surface *surface,
                                           uint32_t *rgba)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!surface || !rgba)
        return null_argument(device, surface ? "image" : "surface");
    struct error error = {{0}};
    return finish(device, device_read_surface(device, surface, rgba, &error), &error);
}

enum triptych_result triptych_read_surface_numbers(triptych_device *device,
                                                   const struct triptych_surface *surface, float *rgba)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!surface || !rgba)
        return null_argument(device, surface ? "image" : "surface");
    struct error error = {{0}};
    return finish(device, device_read_surface_numbers(device, surface, rgba, &error), &error);
}

enum triptych_result triptych_read_depth(triptych_device *device, float *depth)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!depth)
        return null_argument(device, "image");
    struct error error = {{0}};
    return finish(device, device_read_depth(device, depth, &error), &error);
}

enum triptych_result triptych_read_stencil(triptych_device *device, uint8_t *stencil)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!stencil)
        return null_argument(device, "image");
    struct error error = {{0}};
    return finish(device, device_read_stencil(device, stencil, &error), &error);
}

enum triptych_result triptych_read_sample(triptych_device *device, unsigned sample, uint32_t *rgba,
                                          float *depth, uint8_t *stencil)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    struct error error = {{0}};
    return finish(device, device_read_sample(device, sample, rgba, depth, stencil, &error), &error);
}

size_t triptych_contents_bytes(const triptych_device *device)
{
    return device ? device_contents_bytes(device) : 0;
}

enum triptych_result triptych_read_contents(triptych_device *device, void *data)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!data)
        return null_argument(device, "data");
    struct error error = {{0}};
    return finish(device, device_read_contents(device, data, &error), &error);
}

enum triptych_result triptych_write_contents(triptych_device *device, const void *data, size_t bytes)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!data)
        return null_argument(device, "data");
    struct error error = {{0}};
    enum triptych_result result = device_write_contents(device, data, bytes, &error);
    if (result == TRIPTYCH_OK)
        record_contents(device, data, bytes);
    return finish(device, result, &error);
}

size_t triptych_texture_texel_bytes(const triptych_texture *texture)
{
    return texture ? texture_texel_bytes(texture) : 0;
}

enum triptych_result triptych_texture_read_texels(triptych_device *device, triptych_texture *texture,
                                                  void *data)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!texture || !data)
        return null_argument(device, texture ? "data" : "texture");
    device_read_texels(device, texture, data);
    return TRIPTYCH_OK;
}

enum triptych_result triptych_texture_write_texels(triptych_device *device, triptych_texture *texture,
                                                   const void *data, size_t bytes)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!texture || !data)
        return null_argument(device, texture ? "data" : "texture");
    struct error error = {{0}};
    enum triptych_result result = device_write_texels(device, texture, data, bytes, &error);
    if (result == TRIPTYCH_OK)
        record_texels(device, texture, data, bytes);
    return finish(device, result, &error);
}

void triptych_get_target(const triptych_device *device, struct triptych_target_description *description)
{
    if (!description)
        return;
    *description = (struct triptych_target_description){0};
    if (device && device->target.width)
        target_describe(&device->target, description);
}

int triptych_format_is_bytes(enum triptych_surface_format number)
{
    const struct format *format = format_find(number);
    return format && format->storage == STORAGE_RGBA8;
}

static int known_format(enum triptych_depth_format format)
{
    return (unsigned)format < TRIPTYCH_DEPTH_COUNT;
}

unsigned triptych_depth_bits(enum triptych_depth_format format)
{
    return known_format(format) ? depth_formats[format].depth_bits : 0;
}

unsigned triptych_stencil_bits(enum triptych_depth_format format)
{
    return known_format(format) ? depth_formats[format].stencil_bits : 0;
}

const char *triptych_depth_format_name(enum triptych_depth_format format)
{
    return known_format(format) ? depth_formats[format].name : NULL;
}

void triptych_target_size(const triptych_device *device, unsigned *width, unsigned *height)
{
    if (width)
        *width = device ? device->target.width : 0;
    if (height)
        *height = device ? device->target.height : 0;
}

void triptych_get_statistics(const triptych_device *device, struct triptych_statistics *statistics)
{
    if (!statistics)
        return;
    memset(statistics, 0, sizeof *statistics);
    if (device)
        device_get_statistics(device, statistics);
}

int triptych_get_routine(triptych_device *device, unsigned i, struct triptych_routine_info *info)
{
    struct routine routine;
    if (!device || !info || !cache_get(device->cache, i, &routine))
        return 0;
    *info = (struct triptych_routine_info){
        .number = routine.number,
        .unit = unit_name[routine.unit],
        .key = key_print(routine.unit, &routine.key, device->key_text),
        .build_ns = routine.build_ns,
        .hits = routine.hits,
        .code_bytes = routine.code_bytes,
        .parts = routine.parts,
        .spills = routine.spills,
        .fused = routine.fused,
        .carried = routine.carried,
        .run_ns = routine.time ? __atomic_load_n(&routine.time->ns, __ATOMIC_RELAXED) : 0,
        .elements = routine.time ? __atomic_load_n(&routine.time->elements, __ATOMIC_RELAXED) : 0,
        .shader = routine.unit == UNIT_VERTEX  ? key_program(routine.key.vertex.shader)
                  : routine.unit == UNIT_PIXEL ? key_program(routine.key.pixel.shader)
                                               : 0,
        .granularity = routine.granularity,
    };
    return 1;
}
