/* Shaders, from text or bytecode, and their constants. */
#include "api/api.h"
#include "shader/program/program.h"

#include <locale.h>

typedef int shader_reader(const char *path, const char *data, size_t bytes, struct shader **shader,
                          struct error *error);

static int read_tokens(const char *path, const char *data, size_t bytes, struct shader **shader,
                       struct error *error)
{
    return shader_read(path, data, bytes, shader, error);
}

/* Keeps the source, which a recording that starts later writes. */
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

/* The front end needs a locale whose numbers have a decimal point. */
static enum triptych_result create_shader(triptych_device *device, const char *name, const void *data,
                                          size_t bytes, shader_reader *read, triptych_shader **result)
{
    struct error *error = api_begin_with_both(device, data, "code", result, "shader");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    *result = NULL;
    struct shader *shader;
    locale_t locale = newlocale(LC_NUMERIC_MASK, "C", NULL);
    if (!locale) {
        error_set(error, "out of memory for a shader");
        return api_finish(device, TRIPTYCH_NO_MEMORY);
    }
    locale_t before = uselocale(locale);
    enum triptych_result status;
    errno = 0;
    if (read(name ? name : "shader", data, bytes, &shader, error)) {
        status = device_refusal(TRIPTYCH_BAD_ARGUMENT);
    } else {
        status = device_shader_create(device, shader, result, error);
        shader_free(shader);
        if (status == TRIPTYCH_OK)
            status = keep_source(device, data, bytes, read == shader_assemble, result, error);
    }
    uselocale(before);
    freelocale(locale);
    return api_finish(device, status);
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
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!shader)
        return TRIPTYCH_OK;
    record_end_shader(device, shader);
    return api_finish(device, device_shader_destroy(device, shader, error));
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
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_set_shader(device, stage, shader, error);
    if (result == TRIPTYCH_OK)
        record_shader(device, stage, shader);
    return api_finish(device, result);
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
    struct error *error = api_begin_with(device, values || !count, "values");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_set_floats(device, stage, first, values, count, error);
    if (result == TRIPTYCH_OK)
        record_floats(device, stage, first, values, count);
    return api_finish(device, result);
}

enum triptych_result triptych_set_shader_integers(triptych_device *device, enum triptych_shader_stage stage,
                                                  unsigned first, const int32_t *values, unsigned count)
{
    struct error *error = api_begin_with(device, values || !count, "values");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_set_integers(device, stage, first, values, count, error);
    if (result == TRIPTYCH_OK)
        record_integers(device, stage, first, values, count);
    return api_finish(device, result);
}

enum triptych_result triptych_set_shader_booleans(triptych_device *device, enum triptych_shader_stage stage,
                                                  unsigned first, const int32_t *values, unsigned count)
{
    struct error *error = api_begin_with(device, values || !count, "values");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_set_booleans(device, stage, first, values, count, error);
    if (result == TRIPTYCH_OK)
        record_booleans(device, stage, first, values, count);
    return api_finish(device, result);
}
