/* The arena of a round: one region for triangle records and bins, addressed by 32-bit byte offsets; 0 is
 * reserved. Threads take blocks of it and divide them without synchronisation. All of it is freed together,
 * after the tiles have been rendered. It never grows: when it is full, everything complete is rendered and
 * the rest starts again. */
#ifndef RENDER_GEOMETRY_ARENA_H
#define RENDER_GEOMETRY_ARENA_H

#include "base/error.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

enum { ARENA_BYTES = 64 << 20, ARENA_BLOCK = 256 << 10, ARENA_ALIGNMENT = 64 };

struct arena {
    uint8_t *base;
    uint32_t capacity; /* bytes */
    bool shared;       /* other threads read and write in it, too */
    _Atomic uint32_t used;
};

/* An arena of `bytes`: ARENA_BYTES, or less in tests of a full arena. Too few bytes may not suffice for
 * one group of triangles on a large target. Returns 0, or -1 with the reason when the system refuses the
 * memory. */
int arena_create(struct arena *arena, uint32_t bytes, struct error *error);
void arena_destroy(struct arena *arena);
void arena_reset(struct arena *arena);

/* Takes `bytes`, a multiple of ARENA_ALIGNMENT, off the arena: their offset, or 0 when fewer are left. Called
 * by any thread. */
uint32_t arena_take(struct arena *arena, uint32_t bytes);

#endif
