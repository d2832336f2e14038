/* Storage of resources: what draws read is kept until they are rendered.
 *
 * Storage that is replaced or destroyed is retired: it moves to a list of its queue, whose extents are
 * reused when the draws of the queue are rendered. The texels of a texture that queued draws read move
 * before they change, unless queued commands write them, too: then these are rendered first. If much
 * storage is retired, rendering starts, so that the memory is bounded. */
#include "render/device/device_part.h"

/* Retired storage of one queue, and storage that is kept for reuse: enough for all that is retired, if it is
 * not small. */
enum { RETIRED_BYTES = 16 << 20, SPARE_BYTES = 16 << 20, SPARE_EXTENTS = 256 };

/* The largest texture whose texels move. A copy of a larger one may take longer than the draws. */
enum { MOVED_BYTES = 64 << 20 };

void *device_new_storage(struct triptych_device *device, size_t bytes)
{
    void *storage = extents_take(&device->resources.spare, bytes);
    if (!storage)
        storage = extent_allocate(bytes);
    if (!storage && device->resources.spare.count) {
        extents_free(&device->resources.spare);
        storage = extent_allocate(bytes);
    }
    return storage;
}

void device_retire(struct triptych_device *device, void *storage, uint64_t epoch)
{
    if (epoch == device->epoch)
        extents_add(&device->resources.retired, storage);
    else if (device_epoch_is_queued(device, epoch))
        extents_add(&device->rendered.retired, storage);
    else
        extent_free(storage);
}

void device_reuse_storage(struct triptych_device *device, struct extents *retired)
{
    extents_move(&device->resources.spare, retired);
    extents_trim(&device->resources.spare, SPARE_EXTENTS, SPARE_BYTES);
}

void device_change_texture(struct triptych_device *device, struct triptych_texture *texture,
                           struct texture_span lost)
{
    size_t bytes = extent_of(texture->texels)->bytes;
    device_store_surfaces(device, texture);
    if (!device_uses(device, texture))
        return;
    bool moves = !device_epoch_is_queued(device, texture->written) && bytes <= MOVED_BYTES;
    void *texels = moves ? device_new_storage(device, bytes) : NULL;
    if (!texels) {
        device_finish(device);
        return;
    }
    device_retire(device, texture_move(texture, texels, lost), texture->epoch);
    texture->epoch = UINT64_MAX;
    device_state_changed(device, PARTS(TEXTURES));
    device_limit_retired(device);
}

void device_limit_retired(struct triptych_device *device)
{
    if (device->resources.retired.bytes > RETIRED_BYTES)
        device_start(device);
}

void device_free_storage(struct triptych_device *device)
{
    extents_free(&device->resources.retired);
    extents_free(&device->rendered.retired);
    extents_free(&device->resources.spare);
}
