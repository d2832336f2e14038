/* The cursor of a device: which surfaces can be one. The Windows side makes it. */
#include "front/d3d9/call.h"
#include "front/d3d9/device.h"
#include "front/d3d9/resource/surface.h"

static bool is_power_of_two(uint32_t n)
{
    return n && !(n & (n - 1));
}

/* Its sides are powers of two, at most those of the display mode. */
int32_t d3d9_device_set_cursor_properties(struct d3d9_device *device, uint32_t x, uint32_t y,
                                          struct d3d9_surface *surface)
{
    (void)x, (void)y;
    if (!surface || surface->image.format->number != TRIPTYCH_SURFACE_A8R8G8B8)
        return D3D9_INVALID_CALL;
    const struct d3d9_host_adapter *adapter = d3d9_host_adapter(device->creation.adapter);
    uint32_t width = surface->image.width, height = surface->image.height;
    if (!is_power_of_two(width) || !is_power_of_two(height))
        return D3D9_INVALID_CALL;
    if (adapter && (width > adapter->current.width || height > adapter->current.height))
        return D3D9_INVALID_CALL;
    return D3D9_OK;
}
