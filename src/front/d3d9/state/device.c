/* The values of a device from its creation to its end, and the methods about the device itself. */
#include "front/d3d9/device.h"
#include "front/d3d9/call.h"
#include "front/d3d9/state/block.h"
#include "front/d3d9/state/declaration.h"
#include "front/d3d9/state/shader.h"

#include <stdlib.h>

/* --- Life --- */

int32_t d3d9_device_make_state(struct d3d9_device *device, bool depth)
{
    bool software =
        device->creation.behavior_flags & (D3D9_CREATE_SOFTWARE_VERTICES | D3D9_CREATE_MIXED_VERTICES);
    device->vertex_floats = software ? D3D9_SOFTWARE_FLOATS : D3D9_VERTEX_FLOATS;
    device->state = d3d9_state_make(device->vertex_floats);
    if (!device->state)
        return D3D9_OUT_OF_MEMORY;
    triptych_set_convention(device->renderer, TRIPTYCH_PIXEL_CENTER, TRIPTYCH_PIXEL_CENTER_INTEGER);
    triptych_set_convention(device->renderer, TRIPTYCH_DEPTH_RANGE, TRIPTYCH_DEPTH_RANGE_ZERO);
    triptych_set_convention(device->renderer, TRIPTYCH_MULTIPLY, TRIPTYCH_MULTIPLY_LEGACY);
    d3d9_device_reset_state(device, depth);
    return D3D9_OK;
}

void d3d9_device_note_draws(struct d3d9_device *device)
{
    const struct d3d9_shader *shader = device->state->vertex_shader[0];
    bool fits = !shader || !shader->software || device->software_vertices;
    device->object.draws = device->state->declaration[0] && fits;
}

void d3d9_device_reset_state(struct d3d9_device *device, bool depth)
{
    struct d3d9_state_block *recording = device->recording;
    device->recording = NULL;
    if (recording)
        d3d9_object_drop(&recording->object);
    for (unsigned i = 0; i < TRIPTYCH_TARGETS; i++)
        d3d9_device_bind_target(device, i, NULL);
    d3d9_device_bind_depth(device, NULL);
    d3d9_lights_free(&device->lights);
    d3d9_state_initialize(device->state, device->vertex_floats, depth);
    device->software_vertices = device->creation.behavior_flags & D3D9_CREATE_SOFTWARE_VERTICES;
    device->in_scene = false;
    device->dialog_box = false;
    device->clip_status = (struct d3d9_clip_status){0, UINT32_MAX};
    d3d9_state_forward_all(device);
}

static void free_palettes(struct d3d9_device *device)
{
    while (device->palettes) {
        struct d3d9_palette *palette = device->palettes;
        device->palettes = palette->next;
        free(palette);
    }
}

void d3d9_device_free_state(struct d3d9_device *device)
{
    if (device->state)
        d3d9_device_reset_state(device, false);
    d3d9_state_free(device->state);
    device->state = NULL;
    while (device->declarations) {
        struct d3d9_declaration *declaration = device->declarations;
        device->declarations = declaration->next;
        d3d9_object_drop(&declaration->object);
    }
    free_palettes(device);
    triptych_buffer_destroy(device->renderer, device->zeros);
    device->zeros = NULL;
}

/* --- About the device --- */

int32_t d3d9_device_get_direct3d(struct d3d9_device *device, struct d3d9_factory **out)
{
    if (!out)
        return D3D9_INVALID_CALL;
    *out = (struct d3d9_factory *)device->object.parent;
    d3d9_object_add_ref(device->object.parent);
    return D3D9_OK;
}

int32_t d3d9_device_get_creation_parameters(struct d3d9_device *device,
                                            struct d3d9_creation_parameters *parameters)
{
    if (!parameters)
        return D3D9_INVALID_CALL;
    *parameters = device->creation;
    return D3D9_OK;
}

int32_t d3d9_device_set_software_vertex_processing(struct d3d9_device *device, int32_t software)
{
    bool mixed = device->creation.behavior_flags & D3D9_CREATE_MIXED_VERTICES;
    if (!mixed && device->software_vertices != (software != 0))
        return D3D9_INVALID_CALL;
    device->software_vertices = software != 0;
    device->late |= D3D9_LATE_SHADERS;
    d3d9_device_note_draws(device);
    return D3D9_OK;
}

int32_t d3d9_device_get_software_vertex_processing(struct d3d9_device *device)
{
    return device->software_vertices;
}

int32_t d3d9_device_set_clip_status(struct d3d9_device *device, const struct d3d9_clip_status *status)
{
    if (!status)
        return D3D9_INVALID_CALL;
    device->clip_status = *status;
    return D3D9_OK;
}

int32_t d3d9_device_get_clip_status(struct d3d9_device *device, struct d3d9_clip_status *status)
{
    if (!status)
        return D3D9_INVALID_CALL;
    *status = device->clip_status;
    return D3D9_OK;
}

int32_t d3d9_device_set_dialog_box_mode(struct d3d9_device *device, int32_t enable)
{
    device->dialog_box = enable != 0;
    return D3D9_OK;
}

/* Every state that a draw accepts takes one pass. Textures need filters. */
int32_t d3d9_device_validate_device(struct d3d9_device *device, uint32_t *passes)
{
    enum { MAGNIFY = 5, MINIFY = 6 }; /* D3DSAMP_MAGFILTER, D3DSAMP_MINFILTER */
    for (unsigned i = 0; i < TRIPTYCH_SAMPLERS; i++) {
        const uint32_t *sampler = device->state->sampler + i * D3D9_SAMPLER_STATES;
        if (sampler[MAGNIFY] == TRIPTYCH_FILTER_NONE || sampler[MINIFY] == TRIPTYCH_FILTER_NONE)
            return D3D9_UNSUPPORTED_TEXTURE_FILTER;
    }
    if (passes)
        *passes = 1;
    return D3D9_OK;
}

/* --- Palettes --- */

/* Returns null if it has no entries. */
static struct d3d9_palette *find_palette(struct d3d9_device *device, uint32_t number)
{
    struct d3d9_palette *palette = device->palettes;
    while (palette && palette->number != number)
        palette = palette->next;
    return palette;
}

/* Alpha in palettes is a capability that the device does not report. */
int32_t d3d9_device_set_palette_entries(struct d3d9_device *device, uint32_t number,
                                        const struct d3d9_palette_entry *entries)
{
    struct d3d9_palette *palette = find_palette(device, number);
    if (!entries || number > UINT16_MAX)
        return D3D9_INVALID_CALL;
    for (int i = 0; i < 256; i++)
        if (entries[i].flags != 255)
            return D3D9_INVALID_CALL;
    if (!palette) {
        palette = malloc(sizeof *palette);
        if (!palette)
            return D3D9_OUT_OF_MEMORY;
        palette->number = number;
        palette->next = device->palettes;
        device->palettes = palette;
    }
    for (int i = 0; i < 256; i++)
        palette->entry[i] = entries[i];
    return D3D9_OK;
}

int32_t d3d9_device_get_palette_entries(struct d3d9_device *device, uint32_t number,
                                        struct d3d9_palette_entry *entries)
{
    const struct d3d9_palette *palette = find_palette(device, number);
    if (!entries || !palette)
        return D3D9_INVALID_CALL;
    for (int i = 0; i < 256; i++)
        entries[i] = palette->entry[i];
    return D3D9_OK;
}

int32_t d3d9_device_set_current_texture_palette(struct d3d9_device *device, uint32_t number)
{
    if (!find_palette(device, number))
        return D3D9_INVALID_CALL;
    device->palette = number;
    return D3D9_OK;
}

int32_t d3d9_device_get_current_texture_palette(struct d3d9_device *device, uint32_t *number)
{
    if (!number)
        return D3D9_INVALID_CALL;
    *number = device->palette;
    return D3D9_OK;
}
