/* What a device draws to. */
#include "front/d3d9/device.h"

void d3d9_device_bind_target(struct d3d9_device *device, unsigned index, struct d3d9_surface *surface)
{
    d3d9_object_exchange((struct d3d9_object **)&device->target[index], (struct d3d9_object *)surface);
    device->late |= D3D9_LATE_TARGETS;
}

void d3d9_device_bind_depth(struct d3d9_device *device, struct d3d9_surface *surface)
{
    d3d9_object_exchange((struct d3d9_object **)&device->depth, (struct d3d9_object *)surface);
    device->late |= D3D9_LATE_TARGETS;
}
