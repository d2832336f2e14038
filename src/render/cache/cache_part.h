/* Shared by lookup (cache.c) and eviction (evict.c): three structures over the same entries, which are hash
 * buckets for lookup, a list by number for reports, and a list of the idle entries, which are not in use, for
 * eviction. */
#ifndef RENDER_CACHE_CACHE_PART_H
#define RENDER_CACHE_CACHE_PART_H

#include "render/cache/cache.h"

#include <pthread.h>

struct link {
    struct link *previous, *next;
};

struct cache_entry {
    struct link idle;     /* while there are no references */
    struct link numbered; /* on cache.numbered */
    struct cache_entry *chain;
    struct packed_key key; /* the label by which it is found: the packed key, unless the engine has others */
    uint64_t hash;         /* of the label */
    uint64_t key_hash;     /* of the packed key */
    size_t price;
    uint32_t references;
    enum unit unit;
    struct routine *routine;
    struct routine_time time;
    uint32_t span_blocks[SPAN_COUNT];
    uint32_t joined_blocks;
    struct debug_record *record; /* null: no listener was notified */
    struct debug_record *second; /* the same of the routine's second code */
};

struct cache {
    pthread_mutex_t lock;
    const struct engine *engine;
    struct code_arena *arena;
    size_t budget;
    bool measures, has_labels;
    enum setting_replace policy;
    uint64_t random;
    unsigned listeners;
    struct error debug_error;
    uint32_t next_number;
    struct link idle; /* last used first */
    size_t idle_count;
    struct link numbered;        /* oldest first */
    struct cache_entry **bucket; /* bucket_count of them, a power of two */
    size_t bucket_count;
    struct cache_statistics statistics;
};

#define ENTRY_OF(link, member)                                                                               \
    ((struct cache_entry *)(void *)((char *)(link)-offsetof(struct cache_entry, member)))

static inline void list_initialize(struct link *list)
{
    list->previous = list->next = list;
}

static inline void list_remove(struct link *link)
{
    link->previous->next = link->next;
    link->next->previous = link->previous;
}

static inline void list_insert_after(struct link *place, struct link *link)
{
    link->previous = place;
    link->next = place->next;
    place->next->previous = link;
    place->next = link;
}

static inline struct cache_entry **bucket_of(struct cache *cache, uint64_t hash)
{
    return cache->bucket + (hash & (cache->bucket_count - 1));
}

static inline void add_idle(struct cache *cache, struct cache_entry *entry)
{
    list_insert_after(&cache->idle, &entry->idle);
    cache->idle_count++;
}

static inline void remove_idle(struct cache *cache, struct cache_entry *entry)
{
    list_remove(&entry->idle);
    cache->idle_count--;
}

/* Evicts a routine that is idle, if there is one. Returns false if there is none. */
bool cache_evict_one(struct cache *cache);
void cache_evict_idle(struct cache *cache);
void cache_evict_to_budget(struct cache *cache);

#endif
