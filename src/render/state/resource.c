#include "render/state/resource.h"

#include "contract/job.h"
#include "memory/extent.h"

#include <stdlib.h>
#include <string.h>

_Static_assert((int)EXTENT_READABLE >= (int)FETCH_OVERREAD, "routines may read after the last attribute");

struct triptych_buffer *buffer_create(const void *data, size_t bytes)
{
    struct triptych_buffer *buffer = calloc(1, sizeof *buffer);
    if (!buffer)
        return NULL;
    buffer->epoch = UINT64_MAX;
    buffer->bytes = bytes;
    buffer->data = extent_allocate(bytes);
    if (!buffer->data) {
        free(buffer);
        return NULL;
    }
    if (data)
        memcpy(buffer->data, data, bytes);
    else
        buffer_clear_outside(buffer, (struct buffer_span){0, 0});
    return buffer;
}

void buffer_destroy(struct triptych_buffer *buffer)
{
    extent_free(buffer->data);
    free(buffer);
}

/* --- Changes --- */

/* Only the bytes of the extent that may differ from 0 are written. */
void buffer_clear_outside(struct triptych_buffer *buffer, struct buffer_span span)
{
    struct extent *extent = extent_of(buffer->data);
    size_t begin = span.begin < extent->end ? span.begin : extent->end;
    if (begin > extent->begin)
        memset(buffer->data + extent->begin, 0, begin - extent->begin);
    size_t end = span.end > extent->begin ? span.end : extent->begin;
    if (extent->end > end)
        memset(buffer->data + end, 0, extent->end - end);
    extent->begin = span.begin;
    extent->end = span.end;
    buffer->version++;
}

void buffer_touch(struct triptych_buffer *buffer, struct buffer_span span)
{
    struct extent *extent = extent_of(buffer->data);
    bool clear = extent->begin == extent->end;
    extent->begin = clear || span.begin < extent->begin ? span.begin : extent->begin;
    extent->end = clear || span.end > extent->end ? span.end : extent->end;
    buffer->version++;
}

/* --- Indices --- */

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

struct index_range buffer_scan_indices(const void *indices, uint32_t bits, uint32_t count)
{
    struct index_range range = {.count = count, .bits = bits, .minimum = UINT32_MAX};
    if (bits == 8)
        scan_8(&range, indices);
    else if (bits == 16)
        scan_16(&range, indices);
    else
        scan_32(&range, indices);
    return range;
}

const struct index_range *buffer_index_range(struct triptych_buffer *buffer, uint32_t bits, uint32_t first,
                                             uint32_t count)
{
    uint32_t hash = (first * 0x9e3779b1u ^ count * 0x85ebca77u) >> 16;
    struct index_range *range = buffer->range + hash % INDEX_RANGES;
    bool is_changing = buffer->is_mapped && buffer->map_mode != TRIPTYCH_MAP_READ;
    if (range->bits == bits && range->first == first && range->count == count &&
        range->version == buffer->version && !is_changing)
        return range;
    *range = buffer_scan_indices(buffer->data + (size_t)first * (bits / 8), bits, count);
    range->first = first;
    range->version = buffer->version;
    return range;
}
