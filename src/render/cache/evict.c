/* Eviction: which idle routine, and how many of them. */
#include "render/cache/cache_part.h"

#include "debug/debug.h"

#include <errno.h>
#include <stdlib.h>

void cache_evict_by(struct cache *cache, enum setting_replace policy)
{
    cache->policy = policy;
}

static struct cache_entry *first_built(struct cache *cache)
{
    struct link *link = cache->numbered.next;
    while (ENTRY_OF(link, numbered)->references)
        link = link->next;
    return ENTRY_OF(link, numbered);
}

/* Knuth's linear congruential generator; its high bits are used. */
static struct cache_entry *random_idle(struct cache *cache)
{
    cache->random = cache->random * 6364136223846793005u + 1442695040888963407u;
    struct link *link = cache->idle.next;
    for (uint64_t skip = (cache->random >> 33) % cache->idle_count; skip; skip--)
        link = link->next;
    return ENTRY_OF(link, idle);
}

/* The idle routine to evict; there is one. */
static struct cache_entry *victim(struct cache *cache)
{
    switch (cache->policy) {
    case SETTING_replace_fifo: return first_built(cache);
    case SETTING_replace_random: return random_idle(cache);
    case SETTING_replace_lru: break;
    }
    return ENTRY_OF(cache->idle.previous, idle);
}

static void count_removed(struct cache *cache, const struct cache_entry *entry)
{
    struct cache_unit *unit = &cache->statistics.unit[entry->unit];
    cache->statistics.bytes -= entry->price;
    cache->statistics.routines--;
    cache->statistics.evictions++;
    unit->bytes -= entry->price;
    unit->routines--;
    unit->evictions++;
}

bool cache_evict_one(struct cache *cache)
{
    if (!cache->idle_count)
        return false;
    int reason = errno; /* of a failure for which this makes room */
    struct cache_entry *entry = victim(cache);
    struct cache_entry **at = bucket_of(cache, entry->hash);
    while (*at != entry)
        at = &(*at)->chain;
    *at = entry->chain;
    remove_idle(cache, entry);
    list_remove(&entry->numbered);
    count_removed(cache, entry);
    debug_remove(entry->record);
    debug_remove(entry->second);
    cache->engine->free(cache->arena, entry->routine);
    free(entry);
    errno = reason;
    return true;
}

void cache_evict_idle(struct cache *cache)
{
    while (cache_evict_one(cache))
        ;
}

void cache_evict_to_budget(struct cache *cache)
{
    while (cache->statistics.bytes > cache->budget && cache->statistics.routines > 1 &&
           cache_evict_one(cache))
        ;
}
