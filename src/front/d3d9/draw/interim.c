#include "front/d3d9/draw/interim.h"

void d3d9_interim_clear(struct d3d9_device *device, const struct triptych_clear_values *values,
                        const struct triptych_rectangle *rectangles, unsigned count)
{
    uint32_t test = 0;
    if (!count)
        triptych_clear_buffers(device->renderer, values->flags, values->color, values->depth,
                               values->stencil);
    triptych_get_state(device->renderer, TRIPTYCH_STATE_SCISSORTESTENABLE, &test);
    for (unsigned i = 0; i < count; i++) {
        const struct triptych_rectangle *r = rectangles + i;
        triptych_set_state(device->renderer, TRIPTYCH_STATE_SCISSORTESTENABLE, 1);
        triptych_set_scissor(device->renderer, r->x, r->y, r->width, r->height);
        triptych_clear_buffers(device->renderer, values->flags, values->color, values->depth,
                               values->stencil);
    }
    triptych_set_state(device->renderer, TRIPTYCH_STATE_SCISSORTESTENABLE, test);
    device->late |= D3D9_LATE_AREA;
}
