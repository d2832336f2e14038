#include "render/draw/transient.h"

#include "base/minmax.h"
#include "machine/prefetch.h"

#include <stdlib.h>
#include <string.h>

int transient_create(struct transient *transient, struct error *error)
{
    if (!transient->memory)
        transient->memory = aligned_alloc(64, 2 * (size_t)TRANSIENT_BYTES);
    if (!transient->memory)
        return error_set(error, "out of memory for immediate vertices");
    if (!transient->buffer.data)
        transient->buffer.data = transient->memory;
    transient->buffer.bytes = TRANSIENT_BYTES;
    return 0;
}

void transient_destroy(struct transient *transient)
{
    free(transient->memory);
    transient->memory = NULL;
}

static size_t aligned(size_t position)
{
    return (position + TRANSIENT_ALIGNMENT - 1) & ~(size_t)(TRANSIENT_ALIGNMENT - 1);
}

/* Bytes that a draw takes at most: its vertices begin at a multiple of the stride, its indices aligned. After
 * them at least TRANSIENT_ALIGNMENT bytes are left in the half, more than routines read (FETCH_OVERREAD). */
static size_t most_bytes(const struct immediate *immediate)
{
    return immediate->vertex_bytes + immediate->index_bytes + immediate->stride + 2 * TRANSIENT_ALIGNMENT;
}

bool transient_may_fit(const struct immediate *immediate)
{
    return immediate->vertex_bytes <= TRANSIENT_BYTES && immediate->index_bytes <= TRANSIENT_BYTES &&
           most_bytes(immediate) <= TRANSIENT_BYTES;
}

bool transient_fits(const struct transient *transient, const struct immediate *immediate)
{
    return transient->used + most_bytes(immediate) <= TRANSIENT_BYTES;
}

size_t transient_next(const struct transient *transient)
{
    return aligned(transient->used);
}

/* The cache of the core that rendered the old contents may still hold the lines. */
enum { BYTES_AHEAD = 1024 };

static const void *copy(struct transient *transient, size_t position, const void *from, size_t bytes)
{
    uint8_t *to = transient->buffer.data + position;
    memcpy(to, from, bytes);
    prefetch_to_write(to + BYTES_AHEAD, min_size(bytes, BYTES_AHEAD));
    transient->used = position + bytes;
    return to;
}

uint32_t transient_place(struct transient *transient, const struct immediate *immediate,
                         struct state_stream *stream, const void **indices)
{
    if (immediate->moves || stream->offset > transient->used)
        stream->offset = aligned(transient->used);
    uint32_t filled = transient->used > stream->offset ? (uint32_t)(transient->used - stream->offset) : 0;
    uint32_t first = (filled + immediate->stride - 1) / immediate->stride;
    copy(transient, stream->offset + (size_t)first * immediate->stride, immediate->vertices,
         immediate->vertex_bytes);
    *indices = NULL;
    if (immediate->indices)
        *indices = copy(transient, aligned(transient->used), immediate->indices, immediate->index_bytes);
    return first;
}

void transient_reset(struct transient *transient)
{
    transient->used = 0;
}

void transient_exchange(struct transient *transient)
{
    bool second = transient->memory && transient->buffer.data != transient->memory;
    if (transient->memory)
        transient->buffer.data = transient->memory + (second ? 0 : TRANSIENT_BYTES);
    transient_reset(transient);
}
