/* Lookup of routines, and their builds. */
#include "render/cache/cache_part.h"

#include "base/clock.h"
#include "render/tile/hidden.h"

#include "machine/code.h"
#include "debug/debug.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

enum { FIRST_BUCKETS = 64 };

struct cache *cache_create(const struct engine *engine, struct code_arena *arena, size_t budget,
                           struct error *error)
{
    struct cache *cache = calloc(1, sizeof *cache);
    struct cache_entry **bucket = calloc(FIRST_BUCKETS, sizeof *bucket);
    if (!cache || !bucket) {
        free(cache);
        free(bucket);
        error_set(error, "out of memory for the routine cache");
        return NULL;
    }
    pthread_mutex_init(&cache->lock, NULL);
    cache->engine = engine;
    cache->arena = arena;
    cache->budget = budget;
    cache->has_labels = engine->label && engine->label(engine, UNIT_SETUP, NULL, NULL, NULL);
    cache->bucket = bucket;
    cache->bucket_count = FIRST_BUCKETS;
    cache->random = 1;
    list_initialize(&cache->idle);
    list_initialize(&cache->numbered);
    return cache;
}

void cache_measure(struct cache *cache)
{
    cache->measures = true;
}

void cache_debug(struct cache *cache, unsigned listeners)
{
    cache->listeners = listeners;
}

void cache_debug_error(struct cache *cache, struct error *error)
{
    pthread_mutex_lock(&cache->lock);
    *error = cache->debug_error;
    pthread_mutex_unlock(&cache->lock);
}

/* Notifies the listeners of code of an entry, whose routine has its number. Their record may be null. */
static struct debug_record *tell(struct cache *cache, const struct cache_entry *entry,
                                 const struct routine *routine, const char *suffix)
{
    struct debug_code code = {.code = routine->code};
    struct debug_record *record = NULL;
    if (!cache->listeners || !routine->engine->describe || !routine->code)
        return NULL;
    int length =
        snprintf(code.name, sizeof code.name, "triptych_%s_%u_%s_%016" PRIx64 "%s", unit_name[entry->unit],
                 entry->routine->number, routine->engine->name, entry->hash, suffix);
    for (int i = 0; i < length; i++)
        if (code.name[i] == '-')
            code.name[i] = '_';
    if (!routine->engine->describe(routine, &code, &cache->debug_error))
        record = debug_add(cache->listeners, &code, &cache->debug_error);
    debug_code_free(&code);
    return record;
}

/* Where the pointer to the entry is, or would be. */
static struct cache_entry **find(struct cache *cache, enum unit unit, const struct packed_key *key,
                                 uint64_t hash)
{
    struct cache_entry **at = bucket_of(cache, hash);
    while (*at && !((*at)->hash == hash && (*at)->unit == unit && key_equal(&(*at)->key, key)))
        at = &(*at)->chain;
    return at;
}

static void count_in(uint32_t classes[CACHE_CLASSES], uint64_t value)
{
    unsigned width = value ? 64 - (unsigned)__builtin_clzll(value) : 0;
    classes[width < CACHE_CLASSES ? width : CACHE_CLASSES - 1]++;
}

static void count_added(struct cache *cache, const struct cache_entry *entry)
{
    struct cache_unit *unit = &cache->statistics.unit[entry->unit];
    const struct routine *routine = entry->routine;
    cache->statistics.bytes += entry->price;
    cache->statistics.routines++;
    unit->bytes += entry->price;
    unit->routines++;
    unit->build_ns += routine->build_ns;
    count_in(unit->build_us, routine->build_ns / 1000);
    count_in(unit->code_bytes, routine->code_bytes);
}

void cache_destroy(struct cache *cache)
{
    if (!cache)
        return;
    cache_evict_idle(cache);
    pthread_mutex_destroy(&cache->lock);
    free(cache->bucket);
    free(cache);
}

/* Doubles the table; when memory is short chains get longer instead. */
static void grow(struct cache *cache)
{
    size_t count = cache->bucket_count * 2;
    struct cache_entry **bucket = calloc(count, sizeof *bucket);
    if (!bucket)
        return;
    for (size_t i = 0; i < cache->bucket_count; i++)
        for (struct cache_entry *entry = cache->bucket[i], *next; entry; entry = next) {
            next = entry->chain;
            struct cache_entry **at = bucket + (entry->hash & (count - 1));
            entry->chain = *at;
            *at = entry;
        }
    free(cache->bucket);
    cache->bucket = bucket;
    cache->bucket_count = count;
}

/* Returns true if the last build found no hole in the arena but may find one now, because routines were
 * evicted. */
static bool make_room(struct cache *cache)
{
    size_t wanted = cache->arena ? code_refused(cache->arena) : 0;
    if (!wanted)
        return false;
    do
        if (!cache_evict_one(cache))
            return false;
    while (code_statistics(cache->arena).largest_free < wanted);
    return true;
}

static struct routine *try_build(struct cache *cache, enum unit unit, const union key *key,
                                 struct error *error)
{
    uint64_t start = clock_ns();
    errno = 0;
    struct routine *routine = engine_build(cache->engine, cache->arena, unit, key, error);
    if (routine)
        routine->build_ns = clock_ns() - start;
    return routine;
}

/* Otherwise memory is short: the last attempt has the memory of all idle routines. */
static struct routine *build(struct cache *cache, enum unit unit, const union key *key, struct error *error)
{
    struct routine *routine;
    do {
        struct error first = {{0}};
        routine = try_build(cache, unit, key, &first);
    } while (!routine && make_room(cache));
    if (routine)
        return routine;
    cache_evict_idle(cache);
    return try_build(cache, unit, key, error);
}

/* The number that element counts are padded to a multiple of, for routines that do not specify one. */
static uint32_t padded_to(const struct engine *engine)
{
    return engine->width && engine->width < LANES_MAXIMUM ? (uint32_t)engine->width : LANES_MAXIMUM;
}

/* Finds a routine in the table. */
struct label {
    struct packed_key packed; /* the packed key, or the engine's label */
    uint64_t hash, key_hash;
};

static struct cache_entry *insert(struct cache *cache, enum unit unit, const union key *key,
                                  const struct label *label, struct error *error)
{
    struct cache_entry *entry = calloc(1, sizeof *entry);
    if (!entry) {
        error_set(error, "out of memory for a %s routine", unit_name[unit]);
        return NULL;
    }
    entry->routine = build(cache, unit, key, error);
    if (!entry->routine) {
        free(entry);
        return NULL;
    }
    entry->routine->number = ++cache->next_number;
    if (!entry->routine->lanes)
        entry->routine->lanes = padded_to(entry->routine->engine);
    entry->routine->hits = 0;
    entry->routine->entry = entry;
    if (unit == UNIT_PIXEL) {
        unsigned traits = hidden_traits(&key->pixel);
        entry->routine->traits = (uint16_t)(cache->engine->observes ? traits & PIXEL_WRITES_DEPTH : traits);
        entry->routine->depth_plane = layout_of_pixel(&key->pixel).depth;
        entry->routine->span_blocks = entry->span_blocks;
        entry->routine->joined_blocks = &entry->joined_blocks;
    }
    entry->routine->time = cache->measures ? &entry->time : NULL;
    entry->unit = unit;
    entry->key = label->packed;
    entry->hash = label->hash;
    entry->key_hash = label->key_hash;
    entry->price =
        entry->routine->code_bytes + entry->routine->data_bytes + sizeof *entry + sizeof *entry->routine;
    if (cache->statistics.routines >= cache->bucket_count)
        grow(cache);
    struct cache_entry **at = bucket_of(cache, label->hash);
    entry->chain = *at;
    *at = entry;
    list_insert_after(cache->numbered.previous, &entry->numbered);
    count_added(cache, entry);
    entry->record = tell(cache, entry, entry->routine, "");
    return entry;
}

static void count_hits(struct cache *cache, struct cache_entry *entry, uint64_t hits)
{
    cache->statistics.hits += hits;
    cache->statistics.unit[entry->unit].hits += hits;
    entry->routine->hits += hits;
}

static int make_label(const struct cache *cache, enum unit unit, const union key *key, struct label *label,
                      struct error *error)
{
    label->packed = key_pack(unit, key);
    label->hash = label->key_hash = key_hash(unit, &label->packed);
    if (!cache->has_labels)
        return 0;
    if (cache->engine->label(cache->engine, unit, key, &label->packed, error) < 0)
        return -1;
    label->hash = key_hash(unit, &label->packed);
    return 0;
}

static bool has_key(struct cache *cache, enum unit unit, uint64_t key_hash)
{
    for (struct link *link = cache->numbered.next; link != &cache->numbered; link = link->next) {
        const struct cache_entry *entry = ENTRY_OF(link, numbered);
        if (entry->unit == unit && entry->key_hash == key_hash)
            return true;
    }
    return false;
}

/* Compares what the key finds with what the label found. */
static void compare_key(struct cache *cache, enum unit unit, const struct label *label,
                        const struct cache_entry *found)
{
    struct cache_unit *counts = &cache->statistics.unit[unit];
    if (found)
        counts->shared_keys += found->key_hash != label->key_hash;
    else
        counts->wrong_keys += has_key(cache, unit, label->key_hash);
}

/* Finds the key's entry, null if there is none. */
static struct cache_entry *look_up(struct cache *cache, enum unit unit, const struct label *label)
{
    struct cache_entry *entry = *find(cache, unit, &label->packed, label->hash);
    cache->statistics.unit[unit].lookups++;
    if (cache->has_labels)
        compare_key(cache, unit, label, entry);
    return entry;
}

static struct cache_entry *use_found(struct cache *cache, struct cache_entry *entry)
{
    count_hits(cache, entry, 1);
    if (!entry->references)
        remove_idle(cache, entry);
    return entry;
}

static struct cache_entry *acquire(struct cache *cache, enum unit unit, const union key *key,
                                   struct error *error)
{
    struct cache_unit *counts = &cache->statistics.unit[unit];
    struct label label;
    uint64_t start = cache->measures ? clock_ns() : 0;
    if (make_label(cache, unit, key, &label, error))
        return NULL;
    struct cache_entry *entry = look_up(cache, unit, &label);
    counts->lookup_ns += cache->measures ? clock_ns() - start : 0;
    if (entry) {
        use_found(cache, entry);
    } else {
        cache->statistics.misses++;
        counts->misses++;
        entry = insert(cache, unit, key, &label, error);
    }
    if (entry)
        entry->references++;
    cache_evict_to_budget(cache);
    return entry;
}

const struct routine *cache_acquire(struct cache *cache, enum unit unit, const union key *key,
                                    struct error *error)
{
    pthread_mutex_lock(&cache->lock);
    struct cache_entry *entry = acquire(cache, unit, key, error);
    pthread_mutex_unlock(&cache->lock);
    return entry ? entry->routine : NULL;
}

void cache_retain(struct cache *cache, const struct routine *routine)
{
    pthread_mutex_lock(&cache->lock);
    routine->entry->references++;
    pthread_mutex_unlock(&cache->lock);
}

void cache_let_go(struct cache *cache, const struct routine *routine)
{
    pthread_mutex_lock(&cache->lock);
    struct cache_entry *entry = routine->entry;
    if (!--entry->references)
        add_idle(cache, entry);
    pthread_mutex_unlock(&cache->lock);
}

void cache_trim(struct cache *cache)
{
    pthread_mutex_lock(&cache->lock);
    cache_evict_to_budget(cache);
    pthread_mutex_unlock(&cache->lock);
}

void cache_release(struct cache *cache, const struct routine *routine)
{
    cache_let_go(cache, routine);
    cache_trim(cache);
}

void cache_add_bytes(struct cache *cache, const struct routine *routine, size_t bytes)
{
    const struct routine_second *second = routine->second;
    struct cache_entry *entry = routine->entry;
    pthread_mutex_lock(&cache->lock);
    entry->price += bytes;
    cache->statistics.bytes += bytes;
    cache->statistics.unit[routine->unit].bytes += bytes;
    if (second && second->routine && !entry->second)
        entry->second =
            tell(cache, entry, second->routine, second->routine->lanes > BLOCK_PIXELS ? "_32" : "_16");
    pthread_mutex_unlock(&cache->lock);
}

void cache_add_hits(struct cache *cache, const struct routine *routine, uint64_t hits)
{
    pthread_mutex_lock(&cache->lock);
    count_hits(cache, routine->entry, hits);
    pthread_mutex_unlock(&cache->lock);
}

bool cache_has_labels(const struct cache *cache)
{
    return cache->has_labels;
}

bool cache_is_crowded(struct cache *cache)
{
    pthread_mutex_lock(&cache->lock);
    bool crowded = cache->statistics.bytes / 2 > cache->budget;
    pthread_mutex_unlock(&cache->lock);
    return crowded;
}

struct cache_statistics cache_statistics(struct cache *cache)
{
    pthread_mutex_lock(&cache->lock);
    struct cache_statistics statistics = cache->statistics;
    pthread_mutex_unlock(&cache->lock);
    return statistics;
}

bool cache_get(struct cache *cache, size_t i, struct routine *routine)
{
    pthread_mutex_lock(&cache->lock);
    struct link *link = cache->numbered.next;
    for (; i && link != &cache->numbered; i--)
        link = link->next;
    bool found = link != &cache->numbered;
    if (found)
        *routine = *ENTRY_OF(link, numbered)->routine;
    pthread_mutex_unlock(&cache->lock);
    return found;
}
