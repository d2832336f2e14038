/* The routine cache: one routine per unit and key; when there is no more room, those leave that were not used for the
 * longest time.
 *
 * Exact: entries are found by hash and compared by unit and packed key, byte for byte. Safe while routines
 * run: an acquired routine is counted, and what is in use is never evicted. Room is of two kinds. The budget: routines
 * that are not in use leave until all together cost no more, or one is left, whatever its price; what is in use may
 * cost more than the budget, and its owner finds out (cache_is_crowded). The arena: when a routine finds no hole there,
 * others leave until it does. So a build fails for want of room only if what is in use has all of the arena.
 *
 * A routine's price is its code and its entry, so that engines without code are bounded too.
 *
 * Thread-safe; building happens under the cache's lock, so a key is built once however many threads ask for
 * it. */
#ifndef DRAW_CACHE_H
#define DRAW_CACHE_H

#include "draw/engine.h"

#include <stdbool.h>

struct cache;

struct cache_statistics {
    uint64_t hits, misses, evictions;
    size_t bytes;    /* of the routines in the table */
    size_t routines; /* in the table */
};

/* A cache of `engine`'s routines, whose code lives in `arena` (null when the engine needs none). */
struct cache *cache_create(const struct engine *engine, struct code_arena *arena, size_t budget,
                           struct error *error);
/* From now on the calls of routines that are built are measured. */
void cache_measure(struct cache *cache);
/* From now on those listeners (debug/debug.h) are told of routines that are built, and when they are gone. */
void cache_debug(struct cache *cache, unsigned listeners);

/* Frees all routines; none may be in use. Null is allowed. */
void cache_destroy(struct cache *cache);

/* The routine for a normalised key, found or built; to be released. Null with the reason, and errno ENOMEM if that was
 * memory, when it cannot be built, even after everything that is not in use has been evicted. */
const struct routine *cache_acquire(struct cache *cache, enum unit unit, const union key *key,
                                    struct error *error);
/* The same routine once more, for somebody else: cannot fail. */
void cache_retain(struct cache *cache, const struct routine *routine);
void cache_release(struct cache *cache, const struct routine *routine);
/* As if a routine that is in use had been found so many times more. */
void cache_add_hits(struct cache *cache, const struct routine *routine, uint64_t hits);

/* Whether the routines cost twice the budget, which those in use must be to blame for: time to release some. */
bool cache_is_crowded(struct cache *cache);

/* The first reason why a listener was not told of something; empty when there is none. */
void cache_debug_error(struct cache *cache, struct error *error);

struct cache_statistics cache_statistics(struct cache *cache);

/* Copies the i-th routine in the table in order of number; returns 0 past the last. */
int cache_get(struct cache *cache, size_t i, struct routine *routine);

#endif
