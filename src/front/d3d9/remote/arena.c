#include "arena.h"

#include <assert.h>
#include <stdbool.h>
#include <string.h>

enum { NONE = UINT32_MAX };

/* A block's header. The contents follow. */
struct header {
    uint32_t units;    /* of the block, the header included */
    uint32_t previous; /* units of the block before it; 0: it is the first */
    uint32_t is_free;
    uint32_t next, last; /* of its list, while it is free */
};

_Static_assert(sizeof(struct header) <= D3D9_ARENA_UNIT, "a header is one unit");

static struct header *header_at(const struct d3d9_arena *arena, uint32_t at)
{
    return (struct header *)(void *)(arena->base + (size_t)at * D3D9_ARENA_UNIT);
}

static unsigned list_of(uint32_t units)
{
    return 31 - (unsigned)__builtin_clz(units);
}

/* --- Lists --- */

static void insert(struct d3d9_arena *arena, uint32_t at)
{
    struct header *header = header_at(arena, at);
    uint32_t *list = &arena->free[list_of(header->units)];
    header->is_free = 1;
    header->last = NONE;
    header->next = *list;
    if (*list != NONE)
        header_at(arena, *list)->last = at;
    *list = at;
}

static void remove_from_list(struct d3d9_arena *arena, uint32_t at)
{
    struct header *header = header_at(arena, at);
    if (header->next != NONE)
        header_at(arena, header->next)->last = header->last;
    if (header->last != NONE)
        header_at(arena, header->last)->next = header->next;
    else
        arena->free[list_of(header->units)] = header->next;
    header->is_free = 0;
}

/* A free block of at least `units`; NONE if there is none. Each block of a longer list is large enough. */
static uint32_t find(const struct d3d9_arena *arena, uint32_t units)
{
    uint32_t at = arena->free[list_of(units)];
    while (at != NONE && header_at(arena, at)->units < units)
        at = header_at(arena, at)->next;
    for (unsigned list = list_of(units) + 1; at == NONE && list < D3D9_ARENA_LISTS; list++)
        at = arena->free[list];
    return at;
}

/* --- Blocks --- */

/* Writes a block's size, also to the block after it. */
static void set_size(struct d3d9_arena *arena, uint32_t at, uint32_t units)
{
    header_at(arena, at)->units = units;
    if (at + units < arena->units)
        header_at(arena, at + units)->previous = units;
}

/* Gives back what a block has beyond `units`. */
static void split(struct d3d9_arena *arena, uint32_t at, uint32_t units)
{
    uint32_t rest = header_at(arena, at)->units - units;
    if (rest < 2)
        return;
    set_size(arena, at, units);
    header_at(arena, at + units)->previous = units;
    set_size(arena, at + units, rest);
    insert(arena, at + units);
}

void d3d9_arena_create(struct d3d9_arena *arena, void *base, size_t bytes)
{
    *arena = (struct d3d9_arena){.base = base, .units = (uint32_t)(bytes / D3D9_ARENA_UNIT), .fresh = 1};
    memset(arena->free, 0xff, sizeof arena->free);
    header_at(arena, 0)->units = arena->units;
    header_at(arena, 0)->previous = 0;
    insert(arena, 0);
}

/* Makes the contents zeros. Beyond `fresh` they are, except for one header that a split has left there. */
static void clear(struct d3d9_arena *arena, uint32_t at)
{
    uint32_t first = at + 1, end = at + header_at(arena, at)->units;
    uint32_t used = end < arena->fresh ? end : arena->fresh;
    if (used > first)
        memset(header_at(arena, first), 0, (size_t)(used - first) * D3D9_ARENA_UNIT);
    if (end + 1 > arena->fresh)
        arena->fresh = end + 1;
}

void *d3d9_arena_allocate(struct d3d9_arena *arena, size_t bytes)
{
    if (bytes > (size_t)arena->units * D3D9_ARENA_UNIT)
        return NULL;
    uint32_t units = (uint32_t)((bytes + D3D9_ARENA_UNIT - 1) / D3D9_ARENA_UNIT) + 1;
    uint32_t at = find(arena, units);
    if (at == NONE)
        return NULL;
    remove_from_list(arena, at);
    split(arena, at, units);
    clear(arena, at);
    return header_at(arena, at + 1);
}

void d3d9_arena_free(struct d3d9_arena *arena, void *memory)
{
    uint32_t at = (uint32_t)(((uint8_t *)memory - arena->base) / D3D9_ARENA_UNIT) - 1;
    struct header *header = header_at(arena, at);
    assert(!header->is_free);
    uint32_t after = at + header->units, units = header->units;
    if (after < arena->units && header_at(arena, after)->is_free) {
        units += header_at(arena, after)->units;
        remove_from_list(arena, after);
    }
    if (header->previous && header_at(arena, at - header->previous)->is_free) {
        at -= header->previous;
        units += header_at(arena, at)->units;
        remove_from_list(arena, at);
    }
    set_size(arena, at, units);
    insert(arena, at);
}

size_t d3d9_arena_used(const struct d3d9_arena *arena)
{
    size_t units = 0;
    for (uint32_t at = 0; at < arena->units; at += header_at(arena, at)->units)
        units += header_at(arena, at)->is_free ? 0 : header_at(arena, at)->units;
    return units * D3D9_ARENA_UNIT;
}
