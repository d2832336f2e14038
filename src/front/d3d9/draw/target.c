/* The targets of a device, and scenes. */
#include "front/d3d9/call.h"
#include "front/d3d9/device.h"
#include "front/d3d9/draw/draw.h"
#include "front/d3d9/resource/surface.h"

/* Direct3D resets both for every new target 0, also while a block is recorded, and never records it. */
static void reset_areas(struct d3d9_device *device, const struct d3d9_image *image)
{
    struct d3d9_viewport viewport = {.width = image->width, .height = image->height, .max_z = 1};
    struct d3d9_rect scissor = {.right = (int32_t)image->width, .bottom = (int32_t)image->height};
    d3d9_state_set_now(device, D3D9_GROUP_VIEWPORT, 0, &viewport);
    d3d9_state_set_now(device, D3D9_GROUP_SCISSOR, 0, &scissor);
}

void d3d9_device_bind_target(struct d3d9_device *device, unsigned index, struct d3d9_surface *surface)
{
    d3d9_object_exchange((struct d3d9_object **)&device->target[index], (struct d3d9_object *)surface);
    device->late |= D3D9_LATE_TARGETS;
    if (!index && surface)
        reset_areas(device, &surface->image);
}

void d3d9_device_bind_depth(struct d3d9_device *device, struct d3d9_surface *surface)
{
    d3d9_object_exchange((struct d3d9_object **)&device->depth, (struct d3d9_object *)surface);
    device->late |= D3D9_LATE_TARGETS;
}

int32_t d3d9_device_set_render_target(struct d3d9_device *device, uint32_t index,
                                      struct d3d9_surface *surface)
{
    if (index >= TRIPTYCH_TARGETS || (!index && !surface))
        return D3D9_INVALID_CALL;
    if (surface && (!d3d9_surface_is_target(surface) || surface->resource.device != device))
        return D3D9_INVALID_CALL;
    d3d9_device_bind_target(device, index, surface);
    return D3D9_OK;
}

int32_t d3d9_device_get_render_target(struct d3d9_device *device, uint32_t index, struct d3d9_surface **out)
{
    if (!out || index >= TRIPTYCH_TARGETS)
        return D3D9_INVALID_CALL;
    *out = device->target[index];
    if (!*out)
        return D3D9_NOT_FOUND;
    d3d9_object_add_ref(&(*out)->resource.object);
    return D3D9_OK;
}

int32_t d3d9_device_set_depth_stencil_surface(struct d3d9_device *device, struct d3d9_surface *surface)
{
    if (surface && (!d3d9_surface_is_depth(surface) || surface->resource.device != device))
        return D3D9_INVALID_CALL;
    d3d9_device_bind_depth(device, surface);
    return D3D9_OK;
}

int32_t d3d9_device_get_depth_stencil_surface(struct d3d9_device *device, struct d3d9_surface **out)
{
    if (!out)
        return D3D9_INVALID_CALL;
    *out = device->depth;
    if (!*out)
        return D3D9_NOT_FOUND;
    d3d9_object_add_ref(&(*out)->resource.object);
    return D3D9_OK;
}

/* --- Scenes --- */

int32_t d3d9_device_begin_scene(struct d3d9_device *device)
{
    if (device->in_scene)
        return D3D9_INVALID_CALL;
    device->in_scene = true;
    return D3D9_OK;
}

int32_t d3d9_device_end_scene(struct d3d9_device *device)
{
    if (!device->in_scene)
        return D3D9_INVALID_CALL;
    device->in_scene = false;
    return D3D9_OK;
}
