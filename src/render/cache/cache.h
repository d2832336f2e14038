/* The routine cache: one routine for each unit and key. When there is no room, idle routines are evicted: by
 * default the least recently used ones.
 *
 * Lookup is exact: entries are found by hash and compared by unit and packed key, byte for byte. An acquired
 * routine is counted and never evicted while it is in use. Two limits apply. The budget: idle routines are
 * evicted until all routines together cost no more, or until one is left, whatever it costs. Routines in use
 * may exceed the budget; cache_is_crowded reports that. The arena: when a new routine finds no hole, idle
 * routines are evicted until it does. So a build fails for lack of room only if the routines in use fill the
 * arena.
 *
 * The cost of a routine is its code and its entry, so engines without code are bounded too.
 *
 * Thread-safe. A build holds the cache's lock, so each key is built once, even if several threads request
 * it. */
#ifndef RENDER_CACHE_CACHE_H
#define RENDER_CACHE_CACHE_H

#include "contract/engine.h"
#include "setting/setting.h"

#include <stdbool.h>

struct cache;

/* Histograms have a class for each bit width: class i counts values from 2^(i-1) to 2^i - 1, class 0
 * zeros. */
enum { CACHE_CLASSES = 24 };

/* Of one unit's routines. */
struct cache_unit {
    uint64_t hits, misses, evictions;
    size_t bytes;         /* of the routines in the table */
    size_t routines;      /* in the table */
    uint64_t lookups;     /* of cache_acquire; hits of cache_add_hits need none */
    uint64_t wrong_keys;  /* misses of a label although the key is in the table: the key lacks a field */
    uint64_t shared_keys; /* hits of a label with another key: the keys have the same recording */
    uint64_t lookup_ns, build_ns; /* all lookups, if they are measured; all builds */
    uint32_t build_us[CACHE_CLASSES], code_bytes[CACHE_CLASSES]; /* of all builds */
};

/* The first five members are the sums of the units. */
struct cache_statistics {
    uint64_t hits, misses, evictions;
    size_t bytes;
    size_t routines;
    struct cache_unit unit[UNIT_ALL];
};

/* A cache of `engine`'s routines, whose code is stored in `arena` (null when the engine needs none). */
struct cache *cache_create(const struct engine *engine, struct code_arena *arena, size_t budget,
                           struct error *error);
/* From now on the calls of routines that are built are measured, and lookups. */
void cache_measure(struct cache *cache);
/* Selects the idle routine that is evicted next (def/setting.def). A routine is used until it is released.
 * A new cache has SETTING_replace_lru. */
void cache_evict_by(struct cache *cache, enum setting_replace policy);
/* From now on these listeners (debug/debug.h) are notified of routines that are built and freed. */
void cache_debug(struct cache *cache, unsigned listeners);

/* Frees all routines; none may be in use. Null is allowed. */
void cache_destroy(struct cache *cache);

/* The routine for a normalised key, found or built; to be released. Null with the reason, and errno ENOMEM
 * if that was memory, when it cannot be built, even after everything that is not in use has been evicted. */
const struct routine *cache_acquire(struct cache *cache, enum unit unit, const union key *key,
                                    struct error *error);
/* Acquires the same routine once more, for another holder. Cannot fail. */
void cache_retain(struct cache *cache, const struct routine *routine);
void cache_release(struct cache *cache, const struct routine *routine);
/* Releases without eviction; and evicts to the budget, once for several releases, so that any of them can
 * be the one that is evicted. */
void cache_let_go(struct cache *cache, const struct routine *routine);
void cache_trim(struct cache *cache);
/* The engine has added this many bytes to a routine that is in use. */
void cache_add_bytes(struct cache *cache, const struct routine *routine, size_t bytes);
/* Counts `hits` lookups of a routine that is in use. */
void cache_add_hits(struct cache *cache, const struct routine *routine, uint64_t hits);

/* Returns true if the engine's labels are not its keys (engine.label). Then lookups are by label, and each
 * draw should look its routines up: the counts wrong_keys and shared_keys are of these lookups. */
bool cache_has_labels(const struct cache *cache);

/* Returns true if the routines cost twice the budget. Then those in use are the cause: the caller should
 * release some. */
bool cache_is_crowded(struct cache *cache);

/* The first reason why a listener could not be notified; empty when there is none. */
void cache_debug_error(struct cache *cache, struct error *error);

struct cache_statistics cache_statistics(struct cache *cache);

/* Copies the i-th routine in the table in order of number; returns false past the last. */
bool cache_get(struct cache *cache, size_t i, struct routine *routine);

#endif
