/* How values reach the renderer.
 *
 * Most are passed on when they change: the renderer itself only remembers them until a draw. Values
 * that depend on other objects are passed on before the next draw or clear (draw/prepare.c): device->late has
 * their groups. */
#include "front/d3d9/device.h"
#include "front/d3d9/state/group.h"

#include <string.h>

static void forward_value(struct d3d9_device *device, enum triptych_state_table table, unsigned i, int row,
                          uint32_t value)
{
    if (row < 0)
        return;
    value = d3d9_state_sanitize(table, (unsigned)row, i, value);
    if (table == TRIPTYCH_RENDER_STATES)
        triptych_set_state(device->renderer, (enum triptych_state)row, value);
    else if (table == TRIPTYCH_SAMPLER_STATES)
        triptych_set_sampler_state(device->renderer, i, (enum triptych_sampler_state)row, value);
    else
        triptych_set_stage_state(device->renderer, i, (enum triptych_stage_state)row, value);
}

/* Graphics chips of Direct3D 9 clip always; the state is a promise of the program that allows them not to. */
static void forward_render(struct d3d9_device *device, unsigned number)
{
    enum { CLIPPING = 136 };
    if (number == CLIPPING)
        return;
    forward_value(device, TRIPTYCH_RENDER_STATES, 0, d3d9_state_render_row(number),
                  device->state->render[number]);
}

static void forward_sampler(struct d3d9_device *device, unsigned index)
{
    unsigned sampler = index / D3D9_SAMPLER_STATES;
    if (device->first_level >> sampler & 1)
        device->late |= D3D9_LATE_TEXTURES; /* draw/prepare.c changes states of such samplers */
    else if (sampler < TRIPTYCH_SAMPLERS)
        forward_value(device, TRIPTYCH_SAMPLER_STATES, sampler,
                      d3d9_state_sampler_row(index % D3D9_SAMPLER_STATES), device->state->sampler[index]);
}

static void forward_stage(struct d3d9_device *device, unsigned index)
{
    forward_value(device, TRIPTYCH_STAGE_STATES, index / D3D9_STAGE_STATES,
                  d3d9_state_stage_row(index % D3D9_STAGE_STATES), device->state->stage[index]);
}

static void forward_transform(struct d3d9_device *device, unsigned index)
{
    float matrix[4][4];
    for (int i = 0; i < 16; i++)
        matrix[i / 4][i % 4] = d3d9_state_finite(device->state->transform[index].m[i / 4][i % 4]);
    triptych_set_transform(device->renderer, (enum triptych_transform)index, (const float(*)[4])matrix);
}

static void copy_color(float color[4], const struct d3d9_color_value *from)
{
    color[0] = d3d9_state_finite(from->r);
    color[1] = d3d9_state_finite(from->g);
    color[2] = d3d9_state_finite(from->b);
    color[3] = d3d9_state_finite(from->a);
}

static void forward_material(struct d3d9_device *device)
{
    const struct d3d9_material *from = device->state->material;
    struct triptych_material material = {.power = d3d9_state_finite(from->power)};
    copy_color(material.diffuse, &from->diffuse);
    copy_color(material.ambient, &from->ambient);
    copy_color(material.specular, &from->specular);
    copy_color(material.emissive, &from->emissive);
    if (material.power < 0)
        material.power = 0;
    triptych_set_material(device->renderer, &material);
}

static void forward_clip_plane(struct d3d9_device *device, unsigned index)
{
    float plane[4];
    for (int i = 0; i < 4; i++)
        plane[i] = d3d9_state_finite(device->state->clip_plane[index][i]);
    triptych_set_clip_plane(device->renderer, index, plane);
}

/* The renderer refuses to draw with numbers that make no sense in a loop, if the shader reads them. */
static void forward_integer(struct d3d9_device *device, enum triptych_shader_stage stage,
                            int32_t (*integers)[4], unsigned index)
{
    static const struct {
        int32_t first, last;
    } range[4] = {{0, 255}, {0, 255}, {-128, 127}, {INT32_MIN, INT32_MAX}};
    int32_t numbers[4];
    for (int i = 0; i < 4; i++) {
        int32_t n = integers[index][i];
        numbers[i] = n < range[i].first ? range[i].first : n > range[i].last ? range[i].last : n;
    }
    triptych_set_shader_integers(device->renderer, stage, index, numbers, 1);
}

void d3d9_state_forward(struct d3d9_device *device, enum d3d9_group group, unsigned index)
{
    struct d3d9_state *state = device->state;
    triptych_device *renderer = device->renderer;
    switch (group) {
    case D3D9_GROUP_RENDER: forward_render(device, index); break;
    case D3D9_GROUP_SAMPLER: forward_sampler(device, index); break;
    case D3D9_GROUP_STAGE: forward_stage(device, index); break;
    case D3D9_GROUP_TRANSFORM: forward_transform(device, index); break;
    case D3D9_GROUP_MATERIAL: forward_material(device); break;
    case D3D9_GROUP_CLIP_PLANE: forward_clip_plane(device, index); break;
    case D3D9_GROUP_VIEWPORT:
    case D3D9_GROUP_SCISSOR: device->late |= D3D9_LATE_AREA; break;
    case D3D9_GROUP_TEXTURE: device->late |= D3D9_LATE_TEXTURES; break;
    case D3D9_GROUP_STREAM:
    case D3D9_GROUP_FREQUENCY:
    case D3D9_GROUP_INDICES: device->late |= D3D9_LATE_STREAMS; break;
    case D3D9_GROUP_DECLARATION:
        device->late |= D3D9_LATE_DECLARATION;
        d3d9_device_note_draws(device);
        break;
    case D3D9_GROUP_VERTEX_SHADER:
        device->late |= D3D9_LATE_SHADERS;
        d3d9_device_note_draws(device);
        break;
    case D3D9_GROUP_PIXEL_SHADER: device->late |= D3D9_LATE_SHADERS; break;
    case D3D9_GROUP_VERTEX_FLOAT:
        triptych_set_shader_floats(renderer, TRIPTYCH_SHADER_VERTEX, index, state->vertex_float[index], 1);
        break;
    case D3D9_GROUP_PIXEL_FLOAT:
        triptych_set_shader_floats(renderer, TRIPTYCH_SHADER_PIXEL, index, state->pixel_float[index], 1);
        break;
    case D3D9_GROUP_VERTEX_INTEGER:
        forward_integer(device, TRIPTYCH_SHADER_VERTEX, state->vertex_integer, index);
        break;
    case D3D9_GROUP_PIXEL_INTEGER:
        forward_integer(device, TRIPTYCH_SHADER_PIXEL, state->pixel_integer, index);
        break;
    case D3D9_GROUP_VERTEX_BOOLEAN:
        triptych_set_shader_booleans(renderer, TRIPTYCH_SHADER_VERTEX, index, state->vertex_boolean + index,
                                     1);
        break;
    case D3D9_GROUP_PIXEL_BOOLEAN:
        triptych_set_shader_booleans(renderer, TRIPTYCH_SHADER_PIXEL, index, state->pixel_boolean + index, 1);
        break;
    case D3D9_GROUP_PATCHES:
    case D3D9_GROUPS: break;
    }
}

void d3d9_state_forward_all(struct d3d9_device *device)
{
    for (unsigned group = 0; group < D3D9_GROUPS; group++) {
        unsigned count =
            group == D3D9_GROUP_VERTEX_FLOAT ? device->vertex_floats : d3d9_state_group[group].count;
        for (unsigned i = 0; i < count; i++)
            d3d9_state_forward(device, (enum d3d9_group)group, i);
    }
    device->late = D3D9_LATE_ALL;
}
