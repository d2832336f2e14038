/* Contents of the target and of textures as they are stored, for captures that begin late
 * (render/target/contents.c). */
#include "render/device/device_part.h"

#include <limits.h>

size_t device_contents_bytes(const struct triptych_device *device)
{
    struct triptych_target_description description;
    if (!device->binding.target->width)
        return 0;
    target_describe(device->binding.target, &description);
    return target_contents_bytes(&description);
}

enum triptych_result device_read_contents(struct triptych_device *device, void *data, size_t bytes,
                                          struct error *error)
{
    enum triptych_result result = device_has_target(device, error);
    if (result == TRIPTYCH_OK)
        result = device_check_room("contents", bytes, device_contents_bytes(device), error);
    if (result != TRIPTYCH_OK)
        return result;
    device_finish_target(device);
    target_read_contents(device->binding.target, data);
    return TRIPTYCH_OK;
}

enum triptych_result device_write_contents(struct triptych_device *device, const void *data, size_t bytes,
                                           struct error *error)
{
    enum triptych_result result = device_has_target(device, error);
    if (result != TRIPTYCH_OK)
        return result;
    if (bytes != device_contents_bytes(device)) {
        error_set(error, "contents of %zu bytes: expected %zu", bytes, device_contents_bytes(device));
        return TRIPTYCH_BAD_ARGUMENT;
    }
    device_finish_target(device);
    target_write_contents(device->binding.target, data);
    device_note_drawn(device, UINT_MAX);
    return TRIPTYCH_OK;
}

void device_read_texels(struct triptych_device *device, struct triptych_texture *texture, void *data)
{
    device_store_texture(device, texture);
    texture_read_texels(texture, data);
}

enum triptych_result device_write_texels(struct triptych_device *device, struct triptych_texture *texture,
                                         const void *data, size_t bytes, struct error *error)
{
    if (bytes != texture_texel_bytes(texture)) {
        error_set(error, "texels of %zu bytes: expected %zu", bytes, texture_texel_bytes(texture));
        return TRIPTYCH_BAD_ARGUMENT;
    }
    device_change_texture(device, texture, (struct texture_span){0, texture_storage_bytes(texture)});
    texture_write_texels(texture, data);
    device_load_texture(device, texture, 0, TEXTURE_LEVELS);
    return TRIPTYCH_OK;
}
