/* Shaders from bytecode, which the renderer checks and compiles. */
#include "front/d3d9/state/shader.h"
#include "front/d3d9/call.h"
#include "front/d3d9/device.h"
#include "front/d3d9/size.h"

#include <stdlib.h>
#include <string.h>

enum {
    VERTEX_VERSION = 0xfffe0000,
    PIXEL_VERSION = 0xffff0000,
    TOKEN_END = 0xffff,
    TOKEN_COMMENT = 0xfffe,
    SOFTWARE_MINOR = 0xff
};

static void destroy_shader(struct d3d9_object *object)
{
    struct d3d9_shader *shader = (struct d3d9_shader *)object;
    triptych_shader_destroy(shader->device->renderer, shader->shader);
    free(shader->code);
}

/* Gives a vertex shader the software model that has everything of its own. Returns false if there is none. */
static bool make_software(uint32_t *code, uint64_t tokens)
{
    enum { FIRST_VERSION = 0xfffe0101 };
    uint32_t major = code[0] >> 8 & 0xff;
    if (code[0] == (uint32_t)FIRST_VERSION)
        return d3d9_state_lengthen(code, tokens);
    code[0] |= SOFTWARE_MINOR;
    return major == 2 || major == 3;
}

/* The program gets its own tokens back, so that the renderer's are a copy. */
static enum triptych_result pass_on(struct d3d9_shader *shader, bool software)
{
    uint64_t tokens = shader->bytes / sizeof *shader->code;
    enum triptych_result result = TRIPTYCH_BAD_ARGUMENT;
    uint32_t *code = malloc(shader->bytes);
    if (!code)
        return TRIPTYCH_NO_MEMORY;
    memcpy(code, shader->code, shader->bytes);
    d3d9_state_tolerate(code, tokens);
    if (!software || make_software(code, tokens))
        result = triptych_shader_create(shader->device->renderer, NULL, code, shader->bytes, &shader->shader);
    free(code);
    return result;
}

/* A vertex shader that exceeds its model is one for software vertex processing. */
static int32_t compile(struct d3d9_shader *shader)
{
    bool vertex = shader->object.interface == D3D9_INTERFACE_VERTEX_SHADER;
    bool software_device = shader->device->vertex_floats > D3D9_VERTEX_FLOATS;
    shader->software = vertex && (shader->code[0] & 0xff) == SOFTWARE_MINOR;
    if (shader->software && !software_device)
        return D3D9_INVALID_CALL;
    enum triptych_result result = pass_on(shader, false);
    if (result == TRIPTYCH_BAD_ARGUMENT && vertex && software_device) {
        result = pass_on(shader, true);
        shader->software = true;
    }
    if (result == TRIPTYCH_OK)
        return D3D9_OK;
    return result == TRIPTYCH_NO_MEMORY ? D3D9_OUT_OF_MEMORY : D3D9_INVALID_CALL;
}

/* Direct3D refuses pixel shaders that read the position that vertex shaders give. Model 3.0 has lengths in
 * its tokens. */
static bool reads_position(const uint32_t *code, uint64_t tokens)
{
    enum { VERSION = 0xffff0300, DECLARE = 0x1f, USAGE = 0xf001f, INPUT = 0x10000000, REGISTER = 0x70001800 };
    for (uint64_t i = 1; code[0] >> 8 == (uint32_t)VERSION >> 8 && i + 2 < tokens;) {
        uint32_t opcode = code[i] & 0xffff;
        if (opcode == DECLARE && !(code[i + 1] & USAGE) && (code[i + 2] & REGISTER) == INPUT)
            return true;
        i += 1 + (opcode == TOKEN_COMMENT ? code[i] >> 16 & 0x7fff : code[i] >> 24 & 15);
    }
    return false;
}

static int32_t create_shader(struct d3d9_device *device, enum d3d9_interface interface, uint32_t version,
                             const uint32_t *code, struct d3d9_shader **out)
{
    if (!code || !out)
        return D3D9_INVALID_CALL;
    uint64_t tokens = d3d9_size_code(code);
    if ((code[0] & 0xffff0000) != version || code[tokens - 1] != TOKEN_END || reads_position(code, tokens))
        return D3D9_INVALID_CALL;
    struct d3d9_shader *shader = d3d9_object_make(sizeof *shader, interface, &device->object, destroy_shader);
    if (!shader)
        return D3D9_OUT_OF_MEMORY;
    shader->device = device;
    shader->bytes = (uint32_t)(tokens * sizeof *code);
    shader->code = malloc(shader->bytes);
    int32_t result = D3D9_OUT_OF_MEMORY;
    if (shader->code) {
        memcpy(shader->code, code, shader->bytes);
        result = compile(shader);
    }
    shader->object.draws = !shader->software;
    if (result == D3D9_OK)
        *out = shader;
    else
        d3d9_object_release(&shader->object);
    return result;
}

int32_t d3d9_device_create_vertex_shader(struct d3d9_device *device, const uint32_t *code,
                                         struct d3d9_vertex_shader **out)
{
    return create_shader(device, D3D9_INTERFACE_VERTEX_SHADER, VERTEX_VERSION, code,
                         (struct d3d9_shader **)out);
}

int32_t d3d9_device_create_pixel_shader(struct d3d9_device *device, const uint32_t *code,
                                        struct d3d9_pixel_shader **out)
{
    return create_shader(device, D3D9_INTERFACE_PIXEL_SHADER, PIXEL_VERSION, code,
                         (struct d3d9_shader **)out);
}

/* Without an array it returns the size. */
static int32_t get_function(const struct d3d9_shader *shader, void *code, uint32_t *bytes)
{
    if (!bytes)
        return D3D9_INVALID_CALL;
    if (code && *bytes < shader->bytes)
        return D3D9_INVALID_CALL;
    *bytes = shader->bytes;
    if (code)
        memcpy(code, shader->code, shader->bytes);
    return D3D9_OK;
}

int32_t d3d9_vertex_shader_get_function(struct d3d9_vertex_shader *shader, void *code, uint32_t *bytes)
{
    return get_function(&shader->shader, code, bytes);
}

int32_t d3d9_pixel_shader_get_function(struct d3d9_pixel_shader *shader, void *code, uint32_t *bytes)
{
    return get_function(&shader->shader, code, bytes);
}

/* --- Setting --- */

int32_t d3d9_device_set_vertex_shader(struct d3d9_device *device, struct d3d9_vertex_shader *shader)
{
    d3d9_state_set(device, D3D9_GROUP_VERTEX_SHADER, 0, &shader);
    return D3D9_OK;
}

int32_t d3d9_device_set_pixel_shader(struct d3d9_device *device, struct d3d9_pixel_shader *shader)
{
    d3d9_state_set(device, D3D9_GROUP_PIXEL_SHADER, 0, &shader);
    return D3D9_OK;
}

static int32_t get_shader(struct d3d9_shader *shader, void *out)
{
    if (!out)
        return D3D9_INVALID_CALL;
    memcpy(out, &shader, sizeof shader);
    if (shader)
        d3d9_object_add_ref(&shader->object);
    return D3D9_OK;
}

int32_t d3d9_device_get_vertex_shader(struct d3d9_device *device, struct d3d9_vertex_shader **out)
{
    return get_shader(device->state->vertex_shader[0], out);
}

int32_t d3d9_device_get_pixel_shader(struct d3d9_device *device, struct d3d9_pixel_shader **out)
{
    return get_shader(device->state->pixel_shader[0], out);
}
