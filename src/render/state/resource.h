/* Buffers: what the application hands over once and never changes. Recorded draws point into them: they
 * are rendered before a buffer goes. */
#ifndef RENDER_STATE_RESOURCE_H
#define RENDER_STATE_RESOURCE_H

#include "base/error.h"
#include "triptych.h"

/* The smallest and largest index of a range of an index buffer, remembered because scanning it for every draw
 * of the same mesh would cost more than drawing it. */
struct index_range {
    uint32_t first, count; /* in indices */
    uint32_t bits;         /* 8, 16 or 32; 0: nothing remembered here */
    uint32_t minimum, maximum;
};

enum { INDEX_RANGES = 64 };

struct triptych_buffer {
    struct triptych_buffer *next; /* of the device's */
    uint8_t *data;                /* 64-byte aligned */
    size_t bytes;
    uint32_t recorded;                      /* its number while calls are recorded */
    struct index_range range[INDEX_RANGES]; /* direct-mapped by a hash of the range */
};

/* Copies; null when memory is short. */
struct triptych_buffer *buffer_create(const void *data, size_t bytes);
void buffer_destroy(struct triptych_buffer *buffer);

/* The extremes of indices first to first + count - 1, which must lie in the buffer; count > 0, bits 8, 16 or
 * 32. */
const struct index_range *buffer_index_range(struct triptych_buffer *buffer, uint32_t bits, uint32_t first,
                                             uint32_t count);

#endif
