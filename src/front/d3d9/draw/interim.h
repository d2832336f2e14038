/* Calls of the renderer that are not in its interface yet, made of those that are. */
#ifndef D3D9_DRAW_INTERIM_H
#define D3D9_DRAW_INTERIM_H

#include "front/d3d9/device.h"

struct triptych_clear_values {
    unsigned flags;
    float color[4];
    float depth;
    unsigned stencil;
    unsigned color_mask, stencil_mask;
    int everywhere;
};

void d3d9_interim_clear(struct d3d9_device *, const struct triptych_clear_values *,
                        const struct triptych_rectangle *, unsigned count);

#endif
