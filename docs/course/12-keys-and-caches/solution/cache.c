#include "state.h"

#include <string.h>

enum { ROOM_MAXIMUM = 64 };

/* The routines of the cache, the next to be replaced first. */
struct cache {
    struct key key[ROOM_MAXIMUM];
    size_t filled;
};

static size_t find(const struct cache *cache, const struct key *key)
{
    size_t at = 0;
    while (at < cache->filled && memcmp(cache->key + at, key, sizeof *key))
        at++;
    return at;
}

static void remove_at(struct cache *cache, size_t at)
{
    cache->filled--;
    memmove(cache->key + at, cache->key + at + 1, (cache->filled - at) * sizeof *cache->key);
}

static void append(struct cache *cache, const struct key *key)
{
    cache->key[cache->filled++] = *key;
}

size_t misses_fifo(const struct key *draws, size_t count, size_t room)
{
    struct cache cache = {.filled = 0};
    size_t misses = 0;
    for (size_t i = 0; i < count; i++) {
        if (find(&cache, draws + i) < cache.filled)
            continue;
        misses++;
        if (cache.filled == room)
            remove_at(&cache, 0);
        append(&cache, draws + i);
    }
    return misses;
}

/* A routine that is used moves to the end. */
size_t misses_lru(const struct key *draws, size_t count, size_t room)
{
    struct cache cache = {.filled = 0};
    size_t misses = 0;
    for (size_t i = 0; i < count; i++) {
        size_t at = find(&cache, draws + i);
        if (at < cache.filled)
            remove_at(&cache, at);
        else if (++misses && cache.filled == room)
            remove_at(&cache, 0);
        append(&cache, draws + i);
    }
    return misses;
}
