/* Buffers: vertices or indices, whose bytes the application may change.
 *
 * Queued draws point into the storage of a buffer. A buffer remembers the bytes that they may read, its used
 * bytes, with the epoch of the device in which a draw was last queued (render/device/device.h). Storage whose
 * used bytes change is replaced, and kept until the draws are rendered: see render/device/buffer.c. */
#ifndef RENDER_STATE_RESOURCE_H
#define RENDER_STATE_RESOURCE_H

#include "base/error.h"
#include "triptych.h"

#include <stdbool.h>

/* The smallest and largest index of a range of an index buffer, remembered because scanning it for every draw
 * of the same mesh would cost more than drawing it. */
struct index_range {
    uint32_t first, count; /* in indices */
    uint32_t bits;         /* 8, 16 or 32; 0: nothing remembered here */
    uint32_t version;      /* the buffer's */
    uint32_t minimum, maximum;
};

enum { INDEX_RANGES = 64 };

/* Bytes `begin` to `end` - 1. */
struct buffer_span {
    size_t begin, end;
};

struct triptych_buffer {
    struct triptych_buffer *next; /* of the device's */
    uint8_t *data;                /* 64-byte aligned: an extent (memory/extent.h) */
    size_t bytes;
    uint64_t epoch;          /* the device's, when a draw was last queued that may read it */
    struct buffer_span used; /* what such draws read */
    bool is_mapped;
    enum triptych_map map_mode; /* valid while it is mapped, like its span */
    struct buffer_span mapped;
    uint32_t version;                       /* increases with each change of its bytes */
    uint32_t recorded;                      /* its number while calls are recorded */
    struct index_range range[INDEX_RANGES]; /* direct-mapped by a hash of the range */
};

/* Copies, or zeros if `data` is null; null when memory is short. */
struct triptych_buffer *buffer_create(const void *data, size_t bytes);
void buffer_destroy(struct triptych_buffer *buffer);

/* Makes the used bytes include a span. */
static inline void buffer_add_used(struct triptych_buffer *buffer, struct buffer_span span)
{
    buffer->used.begin = span.begin < buffer->used.begin ? span.begin : buffer->used.begin;
    buffer->used.end = span.end > buffer->used.end ? span.end : buffer->used.end;
}

/* Returns true if some byte of a span is used. */
static inline bool buffer_span_is_used(const struct triptych_buffer *buffer, struct buffer_span span)
{
    return span.begin < buffer->used.end && span.end > buffer->used.begin;
}

/* Sets all bytes to 0 but those of the span, which may keep any values. */
void buffer_clear_outside(struct triptych_buffer *buffer, struct buffer_span span);
/* The bytes of a span are about to change. */
void buffer_touch(struct triptych_buffer *buffer, struct buffer_span span);

/* The extremes of indices first to first + count - 1, which must lie in the buffer; count > 0, bits 8, 16 or
 * 32. */
const struct index_range *buffer_index_range(struct triptych_buffer *buffer, uint32_t bits, uint32_t first,
                                             uint32_t count);
/* The same of any memory, without remembering them. */
struct index_range buffer_scan_indices(const void *indices, uint32_t bits, uint32_t count);

#endif
