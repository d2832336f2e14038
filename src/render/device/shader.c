/* The device's shaders and their constants. A shader that is set is a program in the state; which
 * constants a draw depends on is known from there, so that a change of others costs nothing. */
#include "render/device/device_part.h"
#include "shader/program/program.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* --- Shaders --- */

enum triptych_result device_shader_create(struct triptych_device *device, const struct shader *shader,
                                          struct triptych_shader **result, struct error *error)
{
    *result = NULL;
    if (constants_create(&device->constants, error))
        return TRIPTYCH_NO_MEMORY;
    struct triptych_shader *made = malloc(sizeof *made);
    if (!made) {
        error_set(error, "out of memory for a shader");
        return TRIPTYCH_NO_MEMORY;
    }
    errno = 0;
    *made = (struct triptych_shader){.device = device, .program = program_acquire(shader, error)};
    if (!made->program) {
        free(made);
        return device_refusal(TRIPTYCH_BAD_ARGUMENT);
    }
    made->next = device->resources.shaders;
    device->resources.shaders = *result = made;
    return TRIPTYCH_OK;
}

enum triptych_result device_set_shader(struct triptych_device *device, enum shader_stage stage,
                                       struct triptych_shader *shader, struct error *error)
{
    static const char *const name[] = {[STAGE_VERTEX] = "vertex", [STAGE_PIXEL] = "pixel"};
    if (shader && shader->device != device) {
        error_set(error, "%s shader of another device: expected one of this", name[stage]);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (shader && shader->program->model->stage != stage) {
        error_set(error, "%s shader of model %s: expected a model of %s shaders", name[stage],
                  shader->program->model->name, name[stage]);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    const struct program *program = shader ? shader->program : NULL;
    device->shader[stage] = shader;
    if (program == device->state.program[stage])
        return TRIPTYCH_OK;
    device->state.program[stage] = program;
    device->integers_checked = false;
    device_state_changed(device, CHANGE_OF_SHADER);
    return TRIPTYCH_OK;
}

enum triptych_result device_shader_keep(struct triptych_shader *shader, const void *source, size_t bytes,
                                        bool is_text, struct error *error)
{
    shader->source = malloc(bytes + 1);
    if (!shader->source) {
        error_set(error, "out of memory for a shader of %zu bytes", bytes);
        return TRIPTYCH_NO_MEMORY;
    }
    memcpy(shader->source, source, bytes);
    shader->source_bytes = bytes;
    shader->source_is_text = is_text;
    return TRIPTYCH_OK;
}

static void free_shader(struct triptych_shader *shader)
{
    free(shader->source);
    program_release(shader->program);
    free(shader);
}

static struct triptych_shader **find(struct triptych_device *device, const struct triptych_shader *shader)
{
    struct triptych_shader **at = &device->resources.shaders;
    while (*at && *at != shader)
        at = &(*at)->next;
    return at;
}

bool device_has_shader(struct triptych_device *device, const struct triptych_shader *shader)
{
    return *find(device, shader);
}

enum triptych_result device_shader_destroy(struct triptych_device *device, struct triptych_shader *shader,
                                           struct error *error)
{
    struct triptych_shader **at = find(device, shader);
    if (!*at) {
        error_set(error, "shader to destroy: expected one of this device");
        return TRIPTYCH_BAD_ARGUMENT;
    }
    for (int stage = 0; stage < SHADER_STAGES; stage++)
        if (device->shader[stage] == shader)
            device_set_shader(device, stage, NULL, error);
    device_finish(device);
    *at = shader->next;
    free_shader(shader);
    return TRIPTYCH_OK;
}

void device_free_shaders(struct triptych_device *device)
{
    for (struct triptych_shader *shader = device->resources.shaders, *next; shader; shader = next) {
        next = shader->next;
        free_shader(shader);
    }
    constants_destroy(&device->constants);
}

/* --- Constants --- */

/* Copies rows of constants; returns whether one below `read` has changed. */
static bool set_rows(void *rows, const void *values, unsigned first, unsigned count, unsigned read)
{
    char *to = (char *)rows + 16 * (size_t)first;
    unsigned seen = first >= read ? 0 : read - first < count ? read - first : count;
    bool changed = seen && memcmp(to, values, 16 * (size_t)seen);
    if (count)
        memcpy(to, values, 16 * (size_t)count);
    return changed;
}

enum triptych_result device_set_floats(struct triptych_device *device, enum triptych_shader_stage stage,
                                       unsigned first, const float *values, unsigned count,
                                       struct error *error)
{
    enum triptych_result result = state_check_constants(CONSTANT_FLOAT, stage, first, count, error);
    if (result != TRIPTYCH_OK)
        return result;
    const struct program *newest = device->constants.program[stage];
    if (set_rows(device->registers[stage].floats, values, first, count, newest ? newest->constants : 0))
        constants_changed(&device->constants, stage);
    return TRIPTYCH_OK;
}

enum triptych_result device_set_integers(struct triptych_device *device, enum triptych_shader_stage stage,
                                         unsigned first, const int32_t *values, unsigned count,
                                         struct error *error)
{
    enum triptych_result result = state_check_constants(CONSTANT_INTEGER, stage, first, count, error);
    if (result != TRIPTYCH_OK)
        return result;
    if (set_rows(device->registers[stage].integers, values, first, count, TRIPTYCH_SHADER_INTEGERS)) {
        constants_changed(&device->constants, stage);
        device->integers_checked = false;
    }
    return TRIPTYCH_OK;
}

enum triptych_result device_set_booleans(struct triptych_device *device, enum triptych_shader_stage stage,
                                         unsigned first, const int32_t *values, unsigned count,
                                         struct error *error)
{
    enum triptych_result result = state_check_constants(CONSTANT_BOOLEAN, stage, first, count, error);
    if (result != TRIPTYCH_OK)
        return result;
    uint16_t *booleans = &device->state.booleans[stage], before = *booleans;
    for (unsigned i = 0; i < count; i++) {
        uint16_t bit = (uint16_t)(1 << (first + i));
        *booleans = (uint16_t)(values[i] ? *booleans | bit : *booleans & ~bit);
    }
    const struct program *program = device->state.program[stage];
    if (program && (before ^ *booleans) & program->booleans)
        device_state_changed(device, CHANGE_OF_SHADER);
    return TRIPTYCH_OK;
}

enum triptych_result device_check_integers(struct triptych_device *device, struct error *error)
{
    if (device->integers_checked)
        return TRIPTYCH_OK;
    enum triptych_result result = state_check_integers(&device->state, error);
    device->integers_checked = result == TRIPTYCH_OK;
    return result;
}
