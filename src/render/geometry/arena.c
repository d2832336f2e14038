#include "render/geometry/arena.h"

#include <stddef.h>
#include <sys/mman.h>

int arena_create(struct arena *arena, uint32_t bytes, struct error *error)
{
    int flags = MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE;
    void *base = mmap(NULL, bytes, PROT_READ | PROT_WRITE, flags, -1, 0);
    if (base == MAP_FAILED)
        return error_set(error, "out of memory for the triangle arena (%u KiB)", bytes >> 10);
    arena->base = base;
    arena->capacity = bytes;
    arena->shared = false;
    arena_reset(arena);
    return 0;
}

void arena_destroy(struct arena *arena)
{
    if (arena->base)
        munmap(arena->base, arena->capacity);
    arena->base = NULL;
}

void arena_reset(struct arena *arena)
{
    atomic_store_explicit(&arena->used, ARENA_ALIGNMENT, memory_order_relaxed);
}

uint32_t arena_take(struct arena *arena, uint32_t bytes)
{
    uint32_t used = atomic_load_explicit(&arena->used, memory_order_relaxed);
    do
        if (bytes > arena->capacity - used)
            return 0;
    while (!atomic_compare_exchange_weak_explicit(&arena->used, &used, used + bytes, memory_order_relaxed,
                                                  memory_order_relaxed));
    return used;
}
