/* Pixels, samples, and the stored contents of targets and textures. */
#include "api/api.h"

enum triptych_result triptych_read_color(triptych_device *device, uint32_t *rgba)
{
    struct error *error = api_begin_with(device, rgba, "image");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return api_finish(device, device_read_target(device, 0, rgba, error));
}

enum triptych_result triptych_read_target(triptych_device *device, unsigned t, uint32_t *rgba)
{
    struct error *error = api_begin_with(device, rgba, "image");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return api_finish(device, device_read_target(device, t, rgba, error));
}

enum triptych_result triptych_read_target_numbers(triptych_device *device, unsigned t, float *rgba)
{
    struct error *error = api_begin_with(device, rgba, "image");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return api_finish(device, device_read_target_numbers(device, t, rgba, error));
}

enum triptych_result triptych_read_surface(triptych_device *device, const struct triptych_surface *surface,
                                           uint32_t *rgba)
{
    struct error *error = api_begin_with_both(device, surface, "surface", rgba, "image");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return api_finish(device, device_read_surface(device, surface, rgba, error));
}

enum triptych_result triptych_read_surface_numbers(triptych_device *device,
                                                   const struct triptych_surface *surface, float *rgba)
{
    struct error *error = api_begin_with_both(device, surface, "surface", rgba, "image");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return api_finish(device, device_read_surface_numbers(device, surface, rgba, error));
}

enum triptych_result triptych_read_depth(triptych_device *device, float *depth)
{
    struct error *error = api_begin_with(device, depth, "image");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return api_finish(device, device_read_depth(device, depth, error));
}

enum triptych_result triptych_read_stencil(triptych_device *device, uint8_t *stencil)
{
    struct error *error = api_begin_with(device, stencil, "image");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return api_finish(device, device_read_stencil(device, stencil, error));
}

enum triptych_result triptych_read_sample(triptych_device *device, unsigned sample, uint32_t *rgba,
                                          float *depth, uint8_t *stencil)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return api_finish(device, device_read_sample(device, sample, rgba, depth, stencil, error));
}

/* --- Contents ------------------------------------------------------------------------------------------- */

size_t triptych_contents_bytes(const triptych_device *device)
{
    return device ? device_contents_bytes(device) : 0;
}

enum triptych_result triptych_read_contents(triptych_device *device, void *data)
{
    struct error *error = api_begin_with(device, data, "data");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return api_finish(device, device_read_contents(device, data, error));
}

enum triptych_result triptych_write_contents(triptych_device *device, const void *data, size_t bytes)
{
    struct error *error = api_begin_with(device, data, "data");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_write_contents(device, data, bytes, error);
    if (result == TRIPTYCH_OK)
        record_contents(device, data, bytes);
    return api_finish(device, result);
}

size_t triptych_texture_texel_bytes(const triptych_texture *texture)
{
    return texture ? texture_texel_bytes(texture) : 0;
}

enum triptych_result triptych_texture_read_texels(triptych_device *device, triptych_texture *texture,
                                                  void *data)
{
    if (!api_begin_with_both(device, texture, "texture", data, "data"))
        return TRIPTYCH_BAD_ARGUMENT;
    device_read_texels(device, texture, data);
    return TRIPTYCH_OK;
}

enum triptych_result triptych_texture_write_texels(triptych_device *device, triptych_texture *texture,
                                                   const void *data, size_t bytes)
{
    struct error *error = api_begin_with_both(device, texture, "texture", data, "data");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_write_texels(device, texture, data, bytes, error);
    if (result == TRIPTYCH_OK)
        record_texels(device, texture, data, bytes);
    return api_finish(device, result);
}

/* --- The target ----------------------------------------------------------------------------------------- */

void triptych_get_target(const triptych_device *device, struct triptych_target_description *description)
{
    if (!description)
        return;
    *description = (struct triptych_target_description){0};
    if (device && device->binding.target.width)
        target_describe(&device->binding.target, description);
}

void triptych_target_size(const triptych_device *device, unsigned *width, unsigned *height)
{
    if (width)
        *width = device ? device->binding.target.width : 0;
    if (height)
        *height = device ? device->binding.target.height : 0;
}
