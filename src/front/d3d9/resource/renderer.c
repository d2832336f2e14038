#include "renderer.h"
#include "front/d3d9/result.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

int32_t d3d9_renderer_result(enum triptych_result result)
{
    switch (result) {
    case TRIPTYCH_OK: return D3D9_OK;
    case TRIPTYCH_NO_MEMORY: return D3D9_OUT_OF_VIDEO_MEMORY;
    case TRIPTYCH_UNSUPPORTED: return D3D9_NOT_AVAILABLE;
    default: return D3D9_INVALID_CALL;
    }
}

static enum triptych_surface_format stored(const struct d3d9_format *format)
{
    if (format->drawn == D3D9_DRAWN_DEPTH)
        return triptych_stencil_bits(format->depth_format)       ? TRIPTYCH_SURFACE_D24S8
               : triptych_depth_bits(format->depth_format) == 16 ? TRIPTYCH_SURFACE_D16
                                                                 : TRIPTYCH_SURFACE_D24X8;
    return format->sampled ? (enum triptych_surface_format)format->number : TRIPTYCH_SURFACE_A8R8G8B8;
}

int32_t d3d9_renderer_create_image(triptych_device *device, const struct d3d9_format *format, uint32_t width,
                                   uint32_t height, uint32_t samples, struct triptych_surface *surface)
{
    (void)samples;
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, stored(format), width, height, 1, 1,
    };
    *surface = (struct triptych_surface){0};
    return d3d9_renderer_result(triptych_texture_define(device, &description, &surface->texture));
}

void d3d9_renderer_destroy_image(triptych_device *device, struct triptych_surface *surface)
{
    triptych_texture_destroy(device, surface->texture);
    *surface = (struct triptych_surface){0};
}

static uint64_t encode(const struct d3d9_channel *channel, float value)
{
    uint64_t most = (UINT64_C(1) << channel->bits) - 1;
    if (channel->kind == D3D9_CHANNEL_UNSIGNED)
        return (uint64_t)lrint(fmax(0, fmin(1, value)) * (double)most) << channel->shift;
    if (channel->kind == D3D9_CHANNEL_FLOAT && channel->bits == 32 && channel->shift < 64)
        return (uint64_t)triptych_float_bits(value) << channel->shift;
    return 0;
}

int32_t d3d9_renderer_read(triptych_device *device, const struct triptych_surface *surface,
                           const struct d3d9_format *format, const struct triptych_rectangle *r, void *data,
                           size_t pitch)
{
    struct triptych_texture_description d;
    triptych_texture_get_description(surface->texture, &d);
    uint32_t width = d.width >> surface->level ? d.width >> surface->level : 1;
    uint32_t height = d.height >> surface->level ? d.height >> surface->level : 1;
    size_t bytes = (size_t)width * height * 16;
    float *numbers = malloc(bytes);
    if (!numbers)
        return D3D9_OUT_OF_MEMORY;
    enum triptych_result result = triptych_read_surface_numbers(device, surface, numbers, bytes);
    for (uint32_t y = 0; !result && y < r->height; y++)
        for (uint32_t x = 0; x < r->width; x++) {
            const float *texel = numbers + ((size_t)(r->y + y) * width + r->x + x) * 4;
            uint64_t word = 0;
            for (unsigned c = 0; c < 4; c++)
                word |= encode(&format->channel[c], texel[c]);
            memcpy((char *)data + y * pitch + (size_t)x * format->bytes, &word,
                   format->bytes < 8 ? format->bytes : 8);
        }
    free(numbers);
    return d3d9_renderer_result(result);
}

int32_t d3d9_renderer_write(triptych_device *device, const struct triptych_surface *surface,
                            const struct d3d9_format *format, const struct triptych_rectangle *r,
                            const void *data, size_t pitch)
{
    (void)format;
    const struct triptych_box box = {r->x, r->y, 0, r->width, r->height, 1};
    return d3d9_renderer_result(triptych_texture_update(device, surface->texture, surface->slice,
                                                        surface->level, &box, data, pitch, 0));
}

int32_t d3d9_renderer_fill(triptych_device *device, const struct triptych_surface *surface,
                           const struct d3d9_format *format, const struct triptych_rectangle *r,
                           const float color[4])
{
    size_t pitch = (size_t)r->width * format->bytes;
    char *data = malloc(pitch * r->height);
    if (!data)
        return D3D9_OUT_OF_MEMORY;
    uint64_t word = 0;
    for (unsigned c = 0; c < 4; c++)
        word |= encode(&format->channel[c], color[c]);
    for (size_t i = 0; i < (size_t)r->width * r->height; i++)
        memcpy(data + i * format->bytes, &word, format->bytes < 8 ? format->bytes : 8);
    int32_t result = d3d9_renderer_write(device, surface, format, r, data, pitch);
    free(data);
    return result;
}
