/* What was drawn: pixels, samples, and the contents of targets and textures as they are stored. */
#include "api/api.h"

enum triptych_result triptych_read_color(triptych_device *device, uint32_t *rgba)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!rgba)
        return api_null_argument(device, "image");
    struct error error;
    error_clear(&error);
    return api_finish(device, device_read_target(device, 0, rgba, &error), &error);
}

enum triptych_result triptych_read_target(triptych_device *device, unsigned t, uint32_t *rgba)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!rgba)
        return api_null_argument(device, "image");
    struct error error;
    error_clear(&error);
    return api_finish(device, device_read_target(device, t, rgba, &error), &error);
}

enum triptych_result triptych_read_target_numbers(triptych_device *device, unsigned t, float *rgba)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!rgba)
        return api_null_argument(device, "image");
    struct error error;
    error_clear(&error);
    return api_finish(device, device_read_target_numbers(device, t, rgba, &error), &error);
}

enum triptych_result triptych_read_surface(triptych_device *device, const struct triptych_surface *surface,
                                           uint32_t *rgba)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!surface || !rgba)
        return api_null_argument(device, surface ? "image" : "surface");
    struct error error;
    error_clear(&error);
    return api_finish(device, device_read_surface(device, surface, rgba, &error), &error);
}

enum triptych_result triptych_read_surface_numbers(triptych_device *device,
                                                   const struct triptych_surface *surface, float *rgba)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!surface || !rgba)
        return api_null_argument(device, surface ? "image" : "surface");
    struct error error;
    error_clear(&error);
    return api_finish(device, device_read_surface_numbers(device, surface, rgba, &error), &error);
}

enum triptych_result triptych_read_depth(triptych_device *device, float *depth)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!depth)
        return api_null_argument(device, "image");
    struct error error;
    error_clear(&error);
    return api_finish(device, device_read_depth(device, depth, &error), &error);
}

enum triptych_result triptych_read_stencil(triptych_device *device, uint8_t *stencil)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!stencil)
        return api_null_argument(device, "image");
    struct error error;
    error_clear(&error);
    return api_finish(device, device_read_stencil(device, stencil, &error), &error);
}

enum triptych_result triptych_read_sample(triptych_device *device, unsigned sample, uint32_t *rgba,
                                          float *depth, uint8_t *stencil)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    struct error error;
    error_clear(&error);
    return api_finish(device, device_read_sample(device, sample, rgba, depth, stencil, &error), &error);
}

/* --- Contents ---------------------------------------------------------------------------------------------
 */

size_t triptych_contents_bytes(const triptych_device *device)
{
    return device ? device_contents_bytes(device) : 0;
}

enum triptych_result triptych_read_contents(triptych_device *device, void *data)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!data)
        return api_null_argument(device, "data");
    struct error error;
    error_clear(&error);
    return api_finish(device, device_read_contents(device, data, &error), &error);
}

enum triptych_result triptych_write_contents(triptych_device *device, const void *data, size_t bytes)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!data)
        return api_null_argument(device, "data");
    struct error error;
    error_clear(&error);
    enum triptych_result result = device_write_contents(device, data, bytes, &error);
    if (result == TRIPTYCH_OK)
        record_contents(device, data, bytes);
    return api_finish(device, result, &error);
}

size_t triptych_texture_texel_bytes(const triptych_texture *texture)
{
    return texture ? texture_texel_bytes(texture) : 0;
}

enum triptych_result triptych_texture_read_texels(triptych_device *device, triptych_texture *texture,
                                                  void *data)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!texture || !data)
        return api_null_argument(device, texture ? "data" : "texture");
    device_read_texels(device, texture, data);
    return TRIPTYCH_OK;
}

enum triptych_result triptych_texture_write_texels(triptych_device *device, triptych_texture *texture,
                                                   const void *data, size_t bytes)
{
    if (!device)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!texture || !data)
        return api_null_argument(device, texture ? "data" : "texture");
    struct error error;
    error_clear(&error);
    enum triptych_result result = device_write_texels(device, texture, data, bytes, &error);
    if (result == TRIPTYCH_OK)
        record_texels(device, texture, data, bytes);
    return api_finish(device, result, &error);
}

/* --- The target -------------------------------------------------------------------------------------------
 */

void triptych_get_target(const triptych_device *device, struct triptych_target_description *description)
{
    if (!description)
        return;
    *description = (struct triptych_target_description){0};
    if (device && device->target.width)
        target_describe(&device->target, description);
}

void triptych_target_size(const triptych_device *device, unsigned *width, unsigned *height)
{
    if (width)
        *width = device ? device->target.width : 0;
    if (height)
        *height = device ? device->target.height : 0;
}
