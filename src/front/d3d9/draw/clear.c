/* Clear. */
#include "front/d3d9/call.h"
#include "front/d3d9/draw/draw.h"
#include "front/d3d9/resource/surface.h"

#include <stdlib.h>

/* D3DCLEAR. */
enum { CLEAR_TARGET = 1, CLEAR_DEPTH = 2, CLEAR_STENCIL = 4 };

/* Direct3D's corners as a rectangle inside of the renderer's limits. Corners in the wrong order are empty. */
static struct triptych_rectangle rectangle_of(const struct d3d9_rect *from)
{
    uint32_t left = from->left > 0 ? (uint32_t)from->left : 0, top = from->top > 0 ? (uint32_t)from->top : 0;
    uint32_t right = from->right > 0 ? (uint32_t)from->right : 0;
    uint32_t bottom = from->bottom > 0 ? (uint32_t)from->bottom : 0;
    return (struct triptych_rectangle){left, top, right > left ? right - left : 0,
                                       bottom > top ? bottom - top : 0};
}

static int32_t clear_rectangles(struct d3d9_device *device, const struct triptych_clear_values *values,
                                const struct d3d9_rect *rectangles, uint32_t count)
{
    struct triptych_rectangle *list = calloc(count, sizeof *list);
    if (!list)
        return D3D9_OUT_OF_MEMORY;
    uint32_t used = 0;
    for (uint32_t i = 0; i < count; i++) {
        list[used] = rectangle_of(rectangles + i);
        used += list[used].width && list[used].height;
    }
    if (used)
        triptych_clear_rectangles(device->renderer, values, list, used);
    free(list);
    return D3D9_OK;
}

static int32_t check_clear(const struct d3d9_device *device, uint32_t flags)
{
    if (!(flags & (CLEAR_TARGET | CLEAR_DEPTH | CLEAR_STENCIL)))
        return D3D9_INVALID_CALL;
    if (flags & (CLEAR_DEPTH | CLEAR_STENCIL) && !device->depth)
        return D3D9_INVALID_CALL;
    return D3D9_OK;
}

/* The surfaces in `flags` that exist. */
static unsigned renderer_flags(const struct d3d9_device *device, uint32_t flags)
{
    unsigned clear = flags & CLEAR_TARGET ? TRIPTYCH_CLEAR_COLOR : 0;
    enum triptych_depth_format format =
        device->depth ? (enum triptych_depth_format)device->depth->image.format->depth_format
                      : TRIPTYCH_DEPTH_NONE;
    if (flags & CLEAR_DEPTH && device->depth && triptych_depth_bits(format))
        clear |= TRIPTYCH_CLEAR_DEPTH;
    if (flags & CLEAR_STENCIL && device->depth && triptych_stencil_bits(format))
        clear |= TRIPTYCH_CLEAR_STENCIL;
    return clear;
}

/* An array without rectangles clears nothing, a number without array everything. */
int32_t d3d9_device_clear(struct d3d9_device *device, uint32_t count, const struct d3d9_rect *rectangles,
                          uint32_t flags, uint32_t color, float z, uint32_t stencil)
{
    int32_t result = check_clear(device, flags);
    if (result != D3D9_OK || (rectangles && !count) || !d3d9_draw_prepare_targets(device))
        return result;
    struct triptych_clear_values values = {.flags = renderer_flags(device, flags),
                                           .color = {(float)(color >> 16 & 255) / 255,
                                                     (float)(color >> 8 & 255) / 255,
                                                     (float)(color & 255) / 255, (float)(color >> 24) / 255},
                                           .depth = z > 0 ? z < 1 ? z : 1 : 0,
                                           .stencil = stencil,
                                           .color_mask = 15,
                                           .stencil_mask = UINT32_MAX};
    if (rectangles)
        return clear_rectangles(device, &values, rectangles, count);
    triptych_clear_rectangles(device->renderer, &values, NULL, 0);
    return D3D9_OK;
}
