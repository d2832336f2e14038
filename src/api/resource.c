/* Targets, buffers, textures and images. */
#include "api/api.h"

enum triptych_result triptych_set_target(triptych_device *device, unsigned width, unsigned height)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    struct triptych_target_description description = {.width = width, .height = height};
    enum triptych_result result = device_set_target(device, &description, error);
    if (result == TRIPTYCH_OK)
        record_target(device, &description);
    return api_finish(device, result);
}

enum triptych_result triptych_set_target_description(triptych_device *device,
                                                     const struct triptych_target_description *description)
{
    struct error *error = api_begin_with(device, description, "description");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_set_target(device, description, error);
    if (result == TRIPTYCH_OK)
        record_target(device, description);
    return api_finish(device, result);
}

enum triptych_result triptych_buffer_create(triptych_device *device, const void *data, size_t bytes,
                                            triptych_buffer **buffer)
{
    struct error *error = api_begin_with(device, buffer, "buffer");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_buffer_create(device, data, bytes, buffer, error);
    if (result == TRIPTYCH_OK)
        record_new_buffer(device, *buffer);
    return api_finish(device, result);
}

enum triptych_result triptych_buffer_update(triptych_device *device, triptych_buffer *buffer, size_t offset,
                                            const void *data, size_t bytes)
{
    struct error *error = api_begin_with_both(device, buffer, "buffer", data || !bytes, "data");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_buffer_update(device, buffer, offset, data, bytes, error);
    if (result == TRIPTYCH_OK && bytes)
        record_write(device, buffer, (struct buffer_span){offset, offset + bytes});
    return api_finish(device, result);
}

enum triptych_result triptych_buffer_map(triptych_device *device, triptych_buffer *buffer, size_t offset,
                                         size_t bytes, enum triptych_map mode, void **data)
{
    struct error *error = api_begin_with_both(device, buffer, "buffer", data, "data");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_buffer_map(device, buffer, offset, bytes, mode, data, error);
    if (result == TRIPTYCH_OK && mode == TRIPTYCH_MAP_DISCARD)
        record_discard(device, buffer);
    return api_finish(device, result);
}

enum triptych_result triptych_buffer_unmap(triptych_device *device, triptych_buffer *buffer)
{
    struct error *error = api_begin_with(device, buffer, "buffer");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_buffer_unmap(device, buffer, error);
    if (result == TRIPTYCH_OK)
        record_mapped(device, buffer);
    return api_finish(device, result);
}

enum triptych_result triptych_buffer_destroy(triptych_device *device, triptych_buffer *buffer)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!buffer)
        return TRIPTYCH_OK;
    record_end_buffer(device, buffer);
    return api_finish(device, device_buffer_destroy(device, buffer, error));
}

enum triptych_result triptych_texture_create(triptych_device *device, const void *rgba, unsigned width,
                                             unsigned height, triptych_texture **texture)
{
    struct error *error = api_begin_with_both(device, rgba, "rgba", texture, "texture");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    const struct triptych_texture_description description = {
        TRIPTYCH_TEXTURE_2D, TRIPTYCH_SURFACE_A8B8G8R8, width, height, 1, 1};
    enum triptych_result result = device_texture_create(device, &description, texture, error);
    if (result == TRIPTYCH_OK)
        result = device_texture_update(device, *texture, 0, 0, NULL, rgba, 4 * (size_t)width, 0, error);
    if (result == TRIPTYCH_OK) {
        record_new_texture(device, *texture);
        record_update(device, *texture, 0, 0, NULL, rgba, 4 * (size_t)width, 0);
    }
    return api_finish(device, result);
}

enum triptych_result triptych_texture_define(triptych_device *device,
                                             const struct triptych_texture_description *description,
                                             triptych_texture **texture)
{
    struct error *error = api_begin_with_both(device, description, "description", texture, "texture");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_texture_create(device, description, texture, error);
    if (result == TRIPTYCH_OK)
        record_new_texture(device, *texture);
    return api_finish(device, result);
}

enum triptych_result triptych_texture_update(triptych_device *device, triptych_texture *texture,
                                             unsigned face, unsigned level, const struct triptych_box *box,
                                             const void *data, size_t row_pitch, size_t slice_pitch)
{
    struct error *error = api_begin_with_both(device, texture, "texture", data, "data");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result =
        device_texture_update(device, texture, face, level, box, data, row_pitch, slice_pitch, error);
    if (result == TRIPTYCH_OK)
        record_update(device, texture, face, level, box, data, row_pitch, slice_pitch);
    return api_finish(device, result);
}

enum triptych_result triptych_texture_generate_mips(triptych_device *device, triptych_texture *texture)
{
    struct error *error = api_begin_with(device, texture, "texture");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_texture_generate_mips(device, texture, error);
    if (result == TRIPTYCH_OK)
        record_call(device, &(struct call){.type = CALL_MIPS, .resource = texture->recorded});
    return api_finish(device, result);
}

enum triptych_result triptych_texture_destroy(triptych_device *device, triptych_texture *texture)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!texture)
        return TRIPTYCH_OK;
    record_end_texture(device, texture);
    return api_finish(device, device_texture_destroy(device, texture, error));
}

enum triptych_result triptych_image_create(triptych_device *device,
                                           const struct triptych_image_description *description,
                                           triptych_image **image)
{
    struct error *error = api_begin_with_both(device, description, "description", image, "image");
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    enum triptych_result result = device_image_create(device, description, image, error);
    if (result == TRIPTYCH_OK)
        record_new_image(device, *image);
    return api_finish(device, result);
}

enum triptych_result triptych_image_destroy(triptych_device *device, triptych_image *image)
{
    struct error *error = api_begin(device);
    if (!error)
        return TRIPTYCH_BAD_ARGUMENT;
    if (!image)
        return TRIPTYCH_OK;
    record_end_image(device, image);
    return api_finish(device, device_image_destroy(device, image, error));
}
