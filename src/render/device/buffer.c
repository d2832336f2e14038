/* Buffers that change.
 *
 * Queued draws read what a buffer contained when they were queued. A change of bytes that they may read
 * replaces the storage of the buffer by a copy; the old storage is retired (render/device/storage.c). If
 * there is no memory for a copy, the draws are rendered first. All other changes are made in place. */
#include "render/device/device_part.h"

#include <string.h>

enum triptych_result device_buffer_create(struct triptych_device *device, const void *data, size_t bytes,
                                          struct triptych_buffer **buffer, struct error *error)
{
    *buffer = NULL;
    if (!bytes || bytes > INT32_MAX) {
        error_set(error, "buffer of %zu bytes: expected 1 to 2^31 - 1", bytes);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    *buffer = buffer_create(data, bytes);
    if (!*buffer) {
        error_set(error, "out of memory for a buffer of %zu bytes", bytes);
        return TRIPTYCH_NO_MEMORY;
    }
    (*buffer)->next = device->resources.buffers;
    device->resources.buffers = *buffer;
    return TRIPTYCH_OK;
}

static enum triptych_result check_span(const struct triptych_buffer *buffer, size_t offset, size_t bytes,
                                       struct error *error)
{
    if (offset <= buffer->bytes && bytes <= buffer->bytes - offset)
        return TRIPTYCH_OK;
    error_set(error, "%zu bytes at offset %zu: expected them inside the buffer of %zu bytes", bytes, offset,
              buffer->bytes);
    return TRIPTYCH_BAD_ARGUMENT;
}

static enum triptych_result check_unmapped(const struct triptych_buffer *buffer, struct error *error)
{
    if (!buffer->is_mapped)
        return TRIPTYCH_OK;
    error_set(error, "buffer is mapped: expected triptych_buffer_unmap first");
    return TRIPTYCH_BAD_CALL;
}

/* Returns true if queued draws may read bytes of the span. */
static bool is_queued(const struct triptych_device *device, const struct triptych_buffer *buffer,
                      struct buffer_span span)
{
    return device_epoch_is_queued(device, buffer->epoch) && buffer_span_is_used(buffer, span);
}

/* Gives the buffer other storage, whose contents are any bytes. Returns the old one, which the caller
 * retires; null if memory is short. Then nothing is queued any more, and the buffer keeps its storage. */
static uint8_t *replace_storage(struct triptych_device *device, struct triptych_buffer *buffer)
{
    uint8_t *old = buffer->data, *storage = device_new_storage(device, buffer->bytes);
    if (!storage) {
        device_finish(device);
        return NULL;
    }
    buffer->data = storage;
    device_state_changed(device, CHANGE_OF_STREAM);
    return old;
}

static void retire(struct triptych_device *device, struct triptych_buffer *buffer, uint8_t *storage)
{
    device_retire(device, storage, buffer->epoch);
    buffer->epoch = UINT64_MAX;
    device_limit_retired(device);
}

/* Copies everything but a span that is about to be written. */
static void copy_outside(struct triptych_buffer *buffer, const uint8_t *old, struct buffer_span span)
{
    struct extent *to = extent_of(buffer->data);
    const struct extent *from = (const struct extent *)(const void *)old - 1;
    memcpy(buffer->data, old, span.begin);
    memcpy(buffer->data + span.end, old + span.end, buffer->bytes - span.end);
    to->begin = from->begin;
    to->end = from->end;
}

/* Makes it possible to write to the span while draws are queued. The bytes of `lost`, a part of the span, may
 * get any values. */
static void prepare_write(struct triptych_device *device, struct triptych_buffer *buffer,
                          struct buffer_span span, struct buffer_span lost)
{
    uint8_t *old = is_queued(device, buffer, span) ? replace_storage(device, buffer) : NULL;
    if (old) {
        copy_outside(buffer, old, lost);
        retire(device, buffer, old);
    }
    buffer_touch(buffer, span);
}

static void prepare_discard(struct triptych_device *device, struct triptych_buffer *buffer,
                            struct buffer_span span)
{
    struct buffer_span whole = {0, buffer->bytes};
    uint8_t *old = is_queued(device, buffer, whole) ? replace_storage(device, buffer) : NULL;
    buffer_clear_outside(buffer, span);
    if (old)
        retire(device, buffer, old);
}

enum triptych_result device_buffer_update(struct triptych_device *device, struct triptych_buffer *buffer,
                                          size_t offset, const void *data, size_t bytes, struct error *error)
{
    struct buffer_span span = {offset, offset + bytes};
    enum triptych_result result = check_span(buffer, offset, bytes, error);
    if (result == TRIPTYCH_OK)
        result = check_unmapped(buffer, error);
    if (result != TRIPTYCH_OK || !bytes)
        return result;
    prepare_write(device, buffer, span, span);
    memcpy(buffer->data + offset, data, bytes);
    return TRIPTYCH_OK;
}

static enum triptych_result check_map(const struct triptych_buffer *buffer, size_t offset, size_t bytes,
                                      enum triptych_map mode, struct error *error)
{
    if ((unsigned)mode >= TRIPTYCH_MAP_COUNT) {
        error_set(error, "mode %u of a mapping: expected 0 to %u", (unsigned)mode, TRIPTYCH_MAP_COUNT - 1);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (!bytes) {
        error_set(error, "mapping of 0 bytes: expected at least 1");
        return TRIPTYCH_BAD_ARGUMENT;
    }
    enum triptych_result result = check_span(buffer, offset, bytes, error);
    return result == TRIPTYCH_OK ? check_unmapped(buffer, error) : result;
}

enum triptych_result device_buffer_map(struct triptych_device *device, struct triptych_buffer *buffer,
                                       size_t offset, size_t bytes, enum triptych_map mode, void **data,
                                       struct error *error)
{
    struct buffer_span span = {offset, offset + bytes}, nothing = {offset, offset};
    enum triptych_result result = check_map(buffer, offset, bytes, mode, error);
    if (result != TRIPTYCH_OK)
        return result;
    if (mode == TRIPTYCH_MAP_WRITE)
        prepare_write(device, buffer, span, nothing);
    else if (mode == TRIPTYCH_MAP_DISCARD)
        prepare_discard(device, buffer, span);
    else if (mode == TRIPTYCH_MAP_NO_OVERWRITE)
        buffer_touch(buffer, span);
    buffer->is_mapped = true;
    buffer->map_mode = mode;
    buffer->mapped = span;
    device->resources.mapped++;
    *data = buffer->data + offset;
    return TRIPTYCH_OK;
}

enum triptych_result device_buffer_unmap(struct triptych_device *device, struct triptych_buffer *buffer,
                                         struct error *error)
{
    if (!buffer->is_mapped) {
        error_set(error, "buffer is not mapped: expected triptych_buffer_map first");
        return TRIPTYCH_BAD_CALL;
    }
    if (buffer->map_mode != TRIPTYCH_MAP_READ)
        buffer->version++;
    buffer->is_mapped = false;
    device->resources.mapped--;
    return TRIPTYCH_OK;
}
