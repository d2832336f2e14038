/* The methods that set and return values: states, matrices, material, viewport, textures, streams. */
#include "front/d3d9/call.h"
#include "front/d3d9/device.h"
#include "front/d3d9/state/block.h"
#include "front/d3d9/state/group.h"

#include <string.h>

void d3d9_state_set_now(struct d3d9_device *device, enum d3d9_group group, unsigned index, const void *value)
{
    if (d3d9_state_assign(device->state, group, index, value))
        d3d9_state_forward(device, group, index);
}

void d3d9_state_set(struct d3d9_device *device, enum d3d9_group group, unsigned index, const void *value)
{
    if (!device->recording) {
        d3d9_state_set_now(device, group, index, value);
        return;
    }
    d3d9_state_assign(device->recording->state, group, index, value);
    d3d9_mask_add(&device->recording->mask, d3d9_state_group[group].first + index);
}

/* --- States --- */

int32_t d3d9_device_set_render_state(struct d3d9_device *device, uint32_t state, uint32_t value)
{
    if (state < D3D9_RENDER_STATES)
        d3d9_state_set(device, D3D9_GROUP_RENDER, state, &value);
    return D3D9_OK;
}

int32_t d3d9_device_get_render_state(struct d3d9_device *device, uint32_t state, uint32_t *value)
{
    if (!value || state >= D3D9_RENDER_STATES)
        return D3D9_INVALID_CALL;
    *value = device->state->render[state];
    return D3D9_OK;
}

/* Samplers and states that do not exist are ignored, as by Direct3D. */
int32_t d3d9_device_set_sampler_state(struct d3d9_device *device, uint32_t sampler, uint32_t state,
                                      uint32_t value)
{
    int i = d3d9_state_sampler(sampler);
    if (i >= 0 && state < D3D9_SAMPLER_STATES)
        d3d9_state_set(device, D3D9_GROUP_SAMPLER, (unsigned)i * D3D9_SAMPLER_STATES + state, &value);
    return D3D9_OK;
}

int32_t d3d9_device_get_sampler_state(struct d3d9_device *device, uint32_t sampler, uint32_t state,
                                      uint32_t *value)
{
    int i = d3d9_state_sampler(sampler);
    if (!value)
        return D3D9_INVALID_CALL;
    *value = i >= 0 && state < D3D9_SAMPLER_STATES
                 ? device->state->sampler[(unsigned)i * D3D9_SAMPLER_STATES + state]
                 : 0;
    return D3D9_OK;
}

int32_t d3d9_device_set_texture_stage_state(struct d3d9_device *device, uint32_t stage, uint32_t state,
                                            uint32_t value)
{
    if (stage < TRIPTYCH_STAGES && state < D3D9_STAGE_STATES)
        d3d9_state_set(device, D3D9_GROUP_STAGE, stage * D3D9_STAGE_STATES + state, &value);
    return D3D9_OK;
}

int32_t d3d9_device_get_texture_stage_state(struct d3d9_device *device, uint32_t stage, uint32_t state,
                                            uint32_t *value)
{
    if (!value)
        return D3D9_INVALID_CALL;
    *value = stage < TRIPTYCH_STAGES && state < D3D9_STAGE_STATES
                 ? device->state->stage[stage * D3D9_STAGE_STATES + state]
                 : 0;
    return D3D9_OK;
}

/* --- Matrices --- */

int32_t d3d9_device_set_transform(struct d3d9_device *device, uint32_t state,
                                  const struct d3d9_matrix *matrix)
{
    int i = d3d9_state_transform(state);
    if (!matrix)
        return D3D9_INVALID_CALL;
    if (i >= 0)
        d3d9_state_set(device, D3D9_GROUP_TRANSFORM, (unsigned)i, matrix);
    return D3D9_OK;
}

int32_t d3d9_device_get_transform(struct d3d9_device *device, uint32_t state, struct d3d9_matrix *matrix)
{
    int i = d3d9_state_transform(state);
    if (!matrix || i < 0)
        return D3D9_INVALID_CALL;
    *matrix = device->state->transform[i];
    return D3D9_OK;
}

/* The product matrix * current. It is never recorded. */
int32_t d3d9_device_multiply_transform(struct d3d9_device *device, uint32_t state,
                                       const struct d3d9_matrix *matrix)
{
    int i = d3d9_state_transform(state);
    struct d3d9_matrix product = {{{0}}};
    if (!matrix)
        return D3D9_INVALID_CALL;
    if (i < 0)
        return D3D9_OK;
    for (int row = 0; row < 4; row++)
        for (int column = 0; column < 4; column++)
            for (int k = 0; k < 4; k++)
                product.m[row][column] += matrix->m[row][k] * device->state->transform[i].m[k][column];
    d3d9_state_set_now(device, D3D9_GROUP_TRANSFORM, (unsigned)i, &product);
    return D3D9_OK;
}

/* --- Material, areas, planes --- */

int32_t d3d9_device_set_material(struct d3d9_device *device, const struct d3d9_material *material)
{
    if (!material)
        return D3D9_INVALID_CALL;
    d3d9_state_set(device, D3D9_GROUP_MATERIAL, 0, material);
    return D3D9_OK;
}

int32_t d3d9_device_get_material(struct d3d9_device *device, struct d3d9_material *material)
{
    if (!material)
        return D3D9_INVALID_CALL;
    *material = *device->state->material;
    return D3D9_OK;
}

int32_t d3d9_device_set_viewport(struct d3d9_device *device, const struct d3d9_viewport *viewport)
{
    if (!viewport)
        return D3D9_INVALID_CALL;
    d3d9_state_set(device, D3D9_GROUP_VIEWPORT, 0, viewport);
    return D3D9_OK;
}

int32_t d3d9_device_get_viewport(struct d3d9_device *device, struct d3d9_viewport *viewport)
{
    if (!viewport)
        return D3D9_INVALID_CALL;
    *viewport = *device->state->viewport;
    return D3D9_OK;
}

int32_t d3d9_device_set_scissor_rect(struct d3d9_device *device, const struct d3d9_rect *rectangle)
{
    if (!rectangle)
        return D3D9_INVALID_CALL;
    d3d9_state_set(device, D3D9_GROUP_SCISSOR, 0, rectangle);
    return D3D9_OK;
}

int32_t d3d9_device_get_scissor_rect(struct d3d9_device *device, struct d3d9_rect *rectangle)
{
    if (!rectangle)
        return D3D9_INVALID_CALL;
    *rectangle = *device->state->scissor;
    return D3D9_OK;
}

/* Numbers beyond the last plane mean the last plane. */
static unsigned plane_number(uint32_t index)
{
    return index < TRIPTYCH_CLIP_PLANES ? index : TRIPTYCH_CLIP_PLANES - 1;
}

int32_t d3d9_device_set_clip_plane(struct d3d9_device *device, uint32_t index, const float *plane)
{
    if (!plane)
        return D3D9_INVALID_CALL;
    d3d9_state_set(device, D3D9_GROUP_CLIP_PLANE, plane_number(index), plane);
    return D3D9_OK;
}

int32_t d3d9_device_get_clip_plane(struct d3d9_device *device, uint32_t index, float *plane)
{
    if (!plane)
        return D3D9_INVALID_CALL;
    memcpy(plane, device->state->clip_plane[plane_number(index)], sizeof *device->state->clip_plane);
    return D3D9_OK;
}

int32_t d3d9_device_set_n_patch_mode(struct d3d9_device *device, float segments)
{
    d3d9_state_set(device, D3D9_GROUP_PATCHES, 0, &segments);
    return D3D9_OK;
}

float d3d9_device_get_n_patch_mode(struct d3d9_device *device)
{
    return device->state->patches[0];
}
