#include "render/state/resource.h"

#include <stdlib.h>
#include <string.h>

enum { RESOURCE_ALIGNMENT = 64 };

static void *copy_aligned(const void *data, size_t bytes)
{
    size_t rounded = (bytes + RESOURCE_ALIGNMENT - 1) & ~(size_t)(RESOURCE_ALIGNMENT - 1);
    void *copy = aligned_alloc(RESOURCE_ALIGNMENT, rounded);
    if (copy)
        memcpy(copy, data, bytes);
    return copy;
}

struct triptych_buffer *buffer_create(const void *data, size_t bytes)
{
    struct triptych_buffer *buffer = calloc(1, sizeof *buffer);
    if (!buffer)
        return NULL;
    buffer->bytes = bytes;
    buffer->data = copy_aligned(data, bytes);
    if (!buffer->data) {
        free(buffer);
        return NULL;
    }
    return buffer;
}

void buffer_destroy(struct triptych_buffer *buffer)
{
    free(buffer->data);
    free(buffer);
}

static void scan_8(struct index_range *range, const uint8_t *index)
{
    for (uint32_t i = 0; i < range->count; i++) {
        range->minimum = index[i] < range->minimum ? index[i] : range->minimum;
        range->maximum = index[i] > range->maximum ? index[i] : range->maximum;
    }
}

static void scan_16(struct index_range *range, const uint16_t *index)
{
    for (uint32_t i = 0; i < range->count; i++) {
        range->minimum = index[i] < range->minimum ? index[i] : range->minimum;
        range->maximum = index[i] > range->maximum ? index[i] : range->maximum;
    }
}

static void scan_32(struct index_range *range, const uint32_t *index)
{
    for (uint32_t i = 0; i < range->count; i++) {
        range->minimum = index[i] < range->minimum ? index[i] : range->minimum;
        range->maximum = index[i] > range->maximum ? index[i] : range->maximum;
    }
}

const struct index_range *buffer_index_range(struct triptych_buffer *buffer, uint32_t bits, uint32_t first,
                                             uint32_t count)
{
    uint32_t hash = (first * 0x9e3779b1u ^ count * 0x85ebca77u) >> 16;
    struct index_range *range = buffer->range + hash % INDEX_RANGES;
    if (range->bits == bits && range->first == first && range->count == count)
        return range;
    *range = (struct index_range){first, count, bits, UINT32_MAX, 0};
    if (bits == 8)
        scan_8(range, buffer->data + first);
    else if (bits == 16)
        scan_16(range, (const uint16_t *)(const void *)buffer->data + first);
    else
        scan_32(range, (const uint32_t *)(const void *)buffer->data + first);
    return range;
}
