/* Clear. */
#include "front/d3d9/call.h"
#include "front/d3d9/draw/draw.h"
#include "front/d3d9/resource/surface.h"

#include <math.h>
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

/* A clear as the renderer takes it. */
struct clear {
    struct triptych_clear_values values;
    struct triptych_rectangle *list;
    uint32_t count;
    bool srgb; /* colours are converted for targets that can be written in sRGB */
};

/* Direct3D converts the colour of a clear as that of a pixel. */
static float to_srgb(float linear)
{
    return linear <= 0.0031308F ? 12.92F * linear : 1.055F * powf(linear, 1 / 2.4F) - 0.055F;
}

static bool has_bytes(const struct d3d9_surface *target)
{
    return target && triptych_format_is_bytes((enum triptych_surface_format)target->image.format->number);
}

static void pass_clear(struct d3d9_device *device, const struct clear *clear,
                       const struct d3d9_surface *target)
{
    struct triptych_clear_values values = clear->values;
    for (int c = 0; c < 3 && clear->srgb && has_bytes(target); c++)
        values.color[c] = to_srgb(values.color[c]);
    triptych_clear_rectangles(device->renderer, &values, clear->list, clear->count);
}

/* Direct3D clears each surface by itself; the renderer clears what all have. */
static bool surfaces_differ(const struct d3d9_device *device)
{
    const struct d3d9_surface *first = device->depth;
    for (unsigned i = 0; i < TRIPTYCH_TARGETS; i++) {
        const struct d3d9_surface *other = d3d9_draw_target(device, i);
        if (first && other &&
            (other->image.width != first->image.width || other->image.height != first->image.height ||
             other->image.samples != first->image.samples))
            return true;
        first = first ? first : other;
    }
    return false;
}

static void clear_surface(struct d3d9_device *device, const struct clear *clear, struct d3d9_surface *target,
                          unsigned flags)
{
    struct triptych_target_surfaces targets = {.depth_format = TRIPTYCH_DEPTH_NONE};
    struct clear one = *clear;
    one.values.flags &= flags;
    if (!target || !one.values.flags ||
        !d3d9_surface_as_target(target, flags & TRIPTYCH_CLEAR_COLOR ? &targets.color[0] : &targets.depth) ||
        triptych_set_target_surfaces(device->renderer, &targets) != TRIPTYCH_OK)
        return;
    d3d9_draw_pass_areas(device);
    pass_clear(device, &one, target);
    device->late |= D3D9_LATE_TARGETS;
}

/* A depth surface with another number of samples than the target is not cleared. */
static void clear_each(struct d3d9_device *device, const struct clear *clear)
{
    const struct d3d9_surface *first = d3d9_draw_target(device, 0);
    for (unsigned i = 0; i < TRIPTYCH_TARGETS; i++)
        clear_surface(device, clear, d3d9_draw_target(device, i), TRIPTYCH_CLEAR_COLOR);
    if (!first || !device->depth || first->image.samples == device->depth->image.samples)
        clear_surface(device, clear, device->depth, TRIPTYCH_CLEAR_DEPTH | TRIPTYCH_CLEAR_STENCIL);
}

static bool list_rectangles(struct clear *clear, const struct d3d9_rect *rectangles, uint32_t count)
{
    clear->list = calloc(count, sizeof *clear->list);
    for (uint32_t i = 0; i < count && clear->list; i++) {
        clear->list[clear->count] = rectangle_of(rectangles + i);
        clear->count += clear->list[clear->count].width && clear->list[clear->count].height;
    }
    return clear->list;
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

static struct clear clear_of(const struct d3d9_device *device, uint32_t flags, uint32_t color, float z,
                             uint32_t stencil)
{
    enum { SRGB_WRITE = 194 }; /* D3DRS_SRGBWRITEENABLE */
    return (struct clear){
        .values = {.flags = renderer_flags(device, flags),
                   .color = {(float)(color >> 16 & 255) / 255, (float)(color >> 8 & 255) / 255,
                             (float)(color & 255) / 255, (float)(color >> 24) / 255},
                   .depth = z > 0 ? z < 1 ? z : 1 : 0,
                   .stencil = stencil,
                   .color_mask = 15,
                   .stencil_mask = UINT32_MAX},
        .srgb = device->state->render[SRGB_WRITE]};
}

/* An array without rectangles clears nothing, a number without array everything. */
int32_t d3d9_device_clear(struct d3d9_device *device, uint32_t count, const struct d3d9_rect *rectangles,
                          uint32_t flags, uint32_t color, float z, uint32_t stencil)
{
    int32_t result = check_clear(device, flags);
    if (result != D3D9_OK || (rectangles && !count))
        return result;
    struct clear clear = clear_of(device, flags, color, z, stencil);
    if (rectangles && !list_rectangles(&clear, rectangles, count))
        return D3D9_OUT_OF_MEMORY;
    if (rectangles && !clear.count) {
        free(clear.list);
        return D3D9_OK;
    }
    if (surfaces_differ(device))
        clear_each(device, &clear);
    else if (d3d9_draw_prepare_targets(device))
        pass_clear(device, &clear, d3d9_draw_target(device, 0));
    free(clear.list);
    return D3D9_OK;
}
