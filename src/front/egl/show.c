/* Pictures of surfaces in drawables of X11, and from them. */
#include "front/gl/device.h"
#include "surface.h"

#include <stdlib.h>
#include <string.h>

static enum triptych_surface_format format_of(const struct egl_x11_picture *picture)
{
    return picture->bytes == 2         ? TRIPTYCH_SURFACE_R5G6B5
           : picture->size.depth == 32 ? TRIPTYCH_SURFACE_A8R8G8B8
                                       : TRIPTYCH_SURFACE_X8R8G8B8;
}

static bool flip(uint8_t *first, size_t stride, unsigned rows)
{
    uint8_t *row = malloc(stride);
    if (!row)
        return false;
    for (unsigned i = 0; i < rows / 2; i++) {
        uint8_t *a = first + i * stride, *b = first + (rows - 1 - i) * stride;
        memcpy(row, a, stride);
        memcpy(a, b, stride);
        memcpy(b, row, stride);
    }
    free(row);
    return true;
}

/* Row y of the picture is row height - 1 - y of the surface, whose height the picture has. */
static bool fill(struct egl_surface *surface, struct egl_x11_picture *picture,
                 const struct triptych_rectangle *part)
{
    struct gl_device *device = surface->gl.device;
    const unsigned bottom = picture->size.height - 1 - part->y;
    uint8_t *last = picture->pixels + bottom * picture->stride + (size_t)part->x * picture->bytes;
    if (!egl_x11_settle(&surface->object.display->x11, picture))
        return false;
    gl_device_enter(device, NULL);
    const enum triptych_result result = triptych_read_rectangle(
        device->renderer, &surface->gl.color, part, format_of(picture), last, -(ptrdiff_t)picture->stride);
    gl_device_leave(device);
    return !result;
}

bool egl_surface_show(struct egl_surface *surface, const struct triptych_rectangle *part)
{
    struct egl_x11_picture *picture = &surface->picture;
    const unsigned top = picture->size.height - part->y - part->height;
    if (!part->width || !part->height)
        return true;
    return fill(surface, picture, part) &&
           egl_x11_put(&surface->object.display->x11, picture, part->x, top, part->width, part->height);
}

bool egl_surface_copy(struct egl_surface *surface, struct egl_x11_picture *picture)
{
    const struct triptych_rectangle all = {0, 0, picture->size.width, picture->size.height};
    return fill(surface, picture, &all) &&
           egl_x11_put(&surface->object.display->x11, picture, 0, 0, all.width, all.height);
}

bool egl_surface_load(struct egl_surface *surface)
{
    struct egl_x11_picture *picture = &surface->picture;
    struct gl_device *device = surface->gl.device;
    if (!egl_x11_get(&surface->object.display->x11, picture) ||
        !flip(picture->pixels, picture->stride, picture->size.height))
        return false;
    gl_device_enter(device, NULL);
    const enum triptych_result result = triptych_write_rectangle(
        device->renderer, &surface->gl.color, NULL, format_of(picture), picture->pixels, picture->stride);
    gl_device_leave(device);
    return !result;
}
