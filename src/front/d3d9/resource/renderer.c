#include "renderer.h"
#include "front/d3d9/result.h"

int32_t d3d9_renderer_result(enum triptych_result result)
{
    switch (result) {
    case TRIPTYCH_OK: return D3D9_OK;
    case TRIPTYCH_NO_MEMORY: return D3D9_OUT_OF_VIDEO_MEMORY;
    case TRIPTYCH_UNSUPPORTED: return D3D9_NOT_AVAILABLE;
    default: return D3D9_INVALID_CALL;
    }
}

/* Formats that are not valid for targets are those of textures. */
int32_t d3d9_renderer_create_image(triptych_device *device, const struct d3d9_format *format, uint32_t width,
                                   uint32_t height, uint32_t samples, struct triptych_surface *surface)
{
    bool depth = format->drawn == D3D9_DRAWN_DEPTH;
    const struct triptych_image_description image = {
        .format = depth ? 0 : (enum triptych_surface_format)format->number,
        .depth_format = format->depth_format,
        .width = width,
        .height = height,
        .samples = samples,
    };
    const struct triptych_texture_description texture = {
        TRIPTYCH_TEXTURE_2D, format->number, width, height, 1, 1};
    *surface = (struct triptych_surface){0};
    return d3d9_renderer_result(format->drawn == D3D9_DRAWN_NOTHING
                                    ? triptych_texture_define(device, &texture, &surface->texture)
                                    : triptych_image_create(device, &image, &surface->image));
}

void d3d9_renderer_destroy_image(triptych_device *device, struct triptych_surface *surface)
{
    triptych_image_destroy(device, surface->image);
    triptych_texture_destroy(device, surface->texture);
    *surface = (struct triptych_surface){0};
}

/* Depth and compressed texels have only the format of their surface. */
static enum triptych_surface_format memory_format(const struct d3d9_format *format)
{
    bool own = d3d9_format_is_depth(format) || format->side > 1;
    return own ? 0 : (enum triptych_surface_format)format->number;
}

/* Texels of such an image can be locked, and have any values. */
static bool keeps_nothing(const struct d3d9_format *format)
{
    return format->number == TRIPTYCH_SURFACE_NULL;
}

int32_t d3d9_renderer_read(triptych_device *device, const struct triptych_surface *surface,
                           const struct d3d9_format *format, const struct triptych_rectangle *part,
                           void *data, size_t pitch)
{
    if (keeps_nothing(format))
        return D3D9_OK;
    return d3d9_renderer_result(
        triptych_read_rectangle(device, surface, part, memory_format(format), data, (ptrdiff_t)pitch));
}

int32_t d3d9_renderer_write(triptych_device *device, const struct triptych_surface *surface,
                            const struct d3d9_format *format, const struct triptych_rectangle *part,
                            const void *data, size_t pitch)
{
    if (keeps_nothing(format))
        return D3D9_OK;
    return d3d9_renderer_result(
        triptych_write_rectangle(device, surface, part, memory_format(format), data, pitch));
}

int32_t d3d9_renderer_fill(triptych_device *device, const struct triptych_surface *surface,
                           const struct triptych_rectangle *part, const float color[4])
{
    return d3d9_renderer_result(triptych_fill(device, surface, part, color));
}
