/* The constants of shaders. */
#include "front/d3d9/call.h"
#include "front/d3d9/device.h"
#include "front/d3d9/state/block.h"
#include "front/d3d9/state/group.h"

#include <string.h>

/* Registers `first` to first + count - 1 of one file. */
static int32_t set_each(struct d3d9_device *device, enum d3d9_group group, uint32_t limit, uint32_t first,
                        const void *values, uint32_t count)
{
    size_t bytes = d3d9_state_group[group].bytes;
    if (!values || first >= limit)
        return D3D9_INVALID_CALL;
    if (count > limit - first)
        count = limit - first;
    for (uint32_t i = 0; i < count; i++)
        d3d9_state_set(device, group, first + i, (const char *)values + i * bytes);
    return D3D9_OK;
}

static int32_t get_each(struct d3d9_device *device, enum d3d9_group group, uint32_t limit, uint32_t first,
                        void *values, uint32_t count)
{
    if (!values || first >= limit)
        return D3D9_INVALID_CALL;
    if (count > limit - first)
        count = limit - first;
    memcpy(values, d3d9_state_element(device->state, group, first), count * d3d9_state_group[group].bytes);
    return D3D9_OK;
}

/* Floats are passed on immediately: most constants are floats. */
static int32_t set_floats(struct d3d9_device *device, enum triptych_shader_stage stage, enum d3d9_group group,
                          uint32_t limit, uint32_t first, const float *values, uint32_t count)
{
    if (!values || first > limit || count > limit - first)
        return D3D9_INVALID_CALL;
    if (device->recording)
        return count ? set_each(device, group, limit, first, values, count) : D3D9_OK;
    memcpy(d3d9_state_element(device->state, group, first), values, count * 4 * sizeof *values);
    triptych_set_shader_floats(device->renderer, stage, first, values, count);
    return D3D9_OK;
}

static int32_t get_floats(struct d3d9_device *device, enum d3d9_group group, uint32_t limit, uint32_t first,
                          float *values, uint32_t count)
{
    if (!values || first > limit || count > limit - first)
        return D3D9_INVALID_CALL;
    memcpy(values, d3d9_state_element(device->state, group, first), count * 4 * sizeof *values);
    return D3D9_OK;
}

int32_t d3d9_device_set_vertex_shader_constant_f(struct d3d9_device *device, uint32_t first,
                                                 const float *values, uint32_t count)
{
    return set_floats(device, TRIPTYCH_SHADER_VERTEX, D3D9_GROUP_VERTEX_FLOAT, device->vertex_floats, first,
                      values, count);
}

int32_t d3d9_device_get_vertex_shader_constant_f(struct d3d9_device *device, uint32_t first, float *values,
                                                 uint32_t count)
{
    return get_floats(device, D3D9_GROUP_VERTEX_FLOAT, device->vertex_floats, first, values, count);
}

int32_t d3d9_device_set_pixel_shader_constant_f(struct d3d9_device *device, uint32_t first,
                                                const float *values, uint32_t count)
{
    return set_floats(device, TRIPTYCH_SHADER_PIXEL, D3D9_GROUP_PIXEL_FLOAT, D3D9_PIXEL_FLOATS, first, values,
                      count);
}

int32_t d3d9_device_get_pixel_shader_constant_f(struct d3d9_device *device, uint32_t first, float *values,
                                                uint32_t count)
{
    return get_floats(device, D3D9_GROUP_PIXEL_FLOAT, D3D9_PIXEL_FLOATS, first, values, count);
}

int32_t d3d9_device_set_vertex_shader_constant_i(struct d3d9_device *device, uint32_t first,
                                                 const int32_t *values, uint32_t count)
{
    return set_each(device, D3D9_GROUP_VERTEX_INTEGER, D3D9_INTEGERS, first, values, count);
}

int32_t d3d9_device_get_vertex_shader_constant_i(struct d3d9_device *device, uint32_t first, int32_t *values,
                                                 uint32_t count)
{
    return get_each(device, D3D9_GROUP_VERTEX_INTEGER, D3D9_INTEGERS, first, values, count);
}

int32_t d3d9_device_set_pixel_shader_constant_i(struct d3d9_device *device, uint32_t first,
                                                const int32_t *values, uint32_t count)
{
    return set_each(device, D3D9_GROUP_PIXEL_INTEGER, D3D9_INTEGERS, first, values, count);
}

int32_t d3d9_device_get_pixel_shader_constant_i(struct d3d9_device *device, uint32_t first, int32_t *values,
                                                uint32_t count)
{
    return get_each(device, D3D9_GROUP_PIXEL_INTEGER, D3D9_INTEGERS, first, values, count);
}

int32_t d3d9_device_set_vertex_shader_constant_b(struct d3d9_device *device, uint32_t first,
                                                 const int32_t *values, uint32_t count)
{
    return set_each(device, D3D9_GROUP_VERTEX_BOOLEAN, D3D9_BOOLEANS, first, values, count);
}

int32_t d3d9_device_get_vertex_shader_constant_b(struct d3d9_device *device, uint32_t first, int32_t *values,
                                                 uint32_t count)
{
    return get_each(device, D3D9_GROUP_VERTEX_BOOLEAN, D3D9_BOOLEANS, first, values, count);
}

int32_t d3d9_device_set_pixel_shader_constant_b(struct d3d9_device *device, uint32_t first,
                                                const int32_t *values, uint32_t count)
{
    return set_each(device, D3D9_GROUP_PIXEL_BOOLEAN, D3D9_BOOLEANS, first, values, count);
}

int32_t d3d9_device_get_pixel_shader_constant_b(struct d3d9_device *device, uint32_t first, int32_t *values,
                                                uint32_t count)
{
    return get_each(device, D3D9_GROUP_PIXEL_BOOLEAN, D3D9_BOOLEANS, first, values, count);
}
