/* Pixels, samples, and the stored contents of targets and textures. */
#include "api/api.h"

/* Ends a function that reads pixels: a recording counts them. */
static enum triptych_result finish_reading(triptych_device *device, enum triptych_result result)
{
    if (result == TRIPTYCH_OK)
        record_wait(device);
    return api_finish(device, result);
}

enum triptych_result triptych_read_color(triptych_device *device, uint32_t *rgba, size_t bytes)
{
    struct error *error = api_begin_with(device, rgba, "rgba");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return finish_reading(device, device_read_target(device, 0, rgba, bytes, error));
}

enum triptych_result triptych_read_target(triptych_device *device, unsigned t, uint32_t *rgba, size_t bytes)
{
    struct error *error = api_begin_with(device, rgba, "rgba");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return finish_reading(device, device_read_target(device, t, rgba, bytes, error));
}

enum triptych_result triptych_read_target_numbers(triptych_device *device, unsigned t, float *rgba,
                                                  size_t bytes)
{
    struct error *error = api_begin_with(device, rgba, "rgba");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return finish_reading(device, device_read_target_numbers(device, t, rgba, bytes, error));
}

enum triptych_result triptych_read_surface(triptych_device *device, const struct triptych_surface *surface,
                                           uint32_t *rgba, size_t bytes)
{
    struct error *error = api_begin_with_both(device, surface, "surface", rgba, "rgba");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return finish_reading(device, device_read_surface(device, surface, rgba, bytes, error));
}

enum triptych_result triptych_read_surface_numbers(triptych_device *device,
                                                   const struct triptych_surface *surface, float *rgba,
                                                   size_t bytes)
{
    struct error *error = api_begin_with_both(device, surface, "surface", rgba, "rgba");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return finish_reading(device, device_read_surface_numbers(device, surface, rgba, bytes, error));
}

enum triptych_result triptych_read_rectangle(triptych_device *device, const struct triptych_surface *surface,
                                             const struct triptych_rectangle *part,
                                             enum triptych_surface_format format, void *data, ptrdiff_t pitch)
{
    struct error *error = api_begin_with_both(device, surface, "surface", data, "data");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return finish_reading(device, device_read_rectangle(device, surface, part, format, data, pitch, error));
}

enum triptych_result triptych_read_depth(triptych_device *device, float *depth, size_t bytes)
{
    struct error *error = api_begin_with(device, depth, "depth");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return finish_reading(device, device_read_depth(device, depth, bytes, error));
}

enum triptych_result triptych_read_stencil(triptych_device *device, uint8_t *stencil, size_t bytes)
{
    struct error *error = api_begin_with(device, stencil, "stencil");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return finish_reading(device, device_read_stencil(device, stencil, bytes, error));
}

enum triptych_result triptych_read_sample(triptych_device *device, unsigned sample, uint32_t *rgba,
                                          size_t rgba_bytes, float *depth, size_t depth_bytes,
                                          uint8_t *stencil, size_t stencil_bytes)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    const struct sample_images images = {rgba, rgba_bytes, depth, depth_bytes, stencil, stencil_bytes};
    return finish_reading(device, device_read_sample(device, sample, &images, error));
}

/* --- Contents ------------------------------------------------------------------------------------------- */

size_t triptych_contents_bytes(const triptych_device *device)
{
    return device ? device_contents_bytes(device) : 0;
}

enum triptych_result triptych_read_contents(triptych_device *device, void *data, size_t bytes)
{
    struct error *error = api_begin_with(device, data, "data");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return finish_reading(device, device_read_contents(device, data, bytes, error));
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
                                                  void *data, size_t bytes)
{
    struct error *error = api_begin_with_both(device, texture, "texture", data, "data");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_check_room("texels", bytes, texture_texel_bytes(texture), error);
    if (result == TRIPTYCH_OK)
        device_read_texels(device, texture, data);
    return api_finish(device, result);
}

enum triptych_result triptych_texture_read(triptych_device *device, triptych_texture *texture, unsigned face,
                                           unsigned level, const struct triptych_box *box, void *data,
                                           size_t row_pitch, size_t slice_pitch)
{
    struct error *error = api_begin_with_both(device, texture, "texture", data, "data");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    return api_finish(
        device, device_texture_read(device, texture, face, level, box, data, row_pitch, slice_pitch, error));
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
    if (device && device->binding.target->width)
        target_describe(device->binding.target, description);
}

void triptych_target_size(const triptych_device *device, unsigned *width, unsigned *height)
{
    if (width)
        *width = device ? device->binding.target->width : 0;
    if (height)
        *height = device ? device->binding.target->height : 0;
}
