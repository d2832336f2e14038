#include "render/device/routines.h"

#include "render/device/derived.h"

enum { HELD_RECENTLY = 8 };

void device_routines_initialize(struct device_routines *routines)
{
    routines->held = routines->rows[0];
    routines->count = 0;
}

/* Uses one that was held recently for the key, if there is one. */
static bool use_held(struct device_routines *routines, enum unit unit, const union key *key,
                     const struct routine *routine[UNIT_COUNT])
{
    uint32_t end = routines->count, begin = end > HELD_RECENTLY ? end - HELD_RECENTLY : 0;
    for (uint32_t i = end; i-- > begin;) {
        const struct routine *held = routines->held[i].routine;
        if (held->unit == unit && device_same_key(unit, &held->key, key)) {
            routine[unit] = held;
            routines->in_use[unit] = i;
            return true;
        }
    }
    return false;
}

void device_routines_hold(struct device_routines *routines, enum unit unit, const struct routine *held,
                          const struct routine *routine[UNIT_COUNT])
{
    routines->held[routines->count] = (struct held){held, 0};
    routine[unit] = held;
    routines->in_use[unit] = routines->count++;
}

void device_routines_keep(struct device_routines *routines, const struct routine *held)
{
    routines->held[routines->count++] = (struct held){held, 0};
}

void device_routines_let_go(struct device_routines *routines, struct cache *cache, uint32_t count,
                            const struct routine *routine[UNIT_COUNT])
{
    for (uint32_t i = count; i < routines->count; i++) {
        cache_add_hits(cache, routines->held[i].routine, routines->held[i].hits);
        cache_let_go(cache, routines->held[i].routine);
    }
    routines->count = count;
    cache_trim(cache);
    for (int unit = 0; unit < UNIT_COUNT; unit++)
        if (routines->in_use[unit] >= count)
            routine[unit] = NULL;
}

int device_routines_use(struct device_routines *routines, struct cache *cache,
                        const union key key[UNIT_COUNT], const struct routine *routine[UNIT_COUNT],
                        struct error *error)
{
    uint32_t before = routines->count;
    for (int unit = 0; unit < UNIT_COUNT; unit++) {
        if (!cache_has_labels(cache) && (routine[unit] || use_held(routines, unit, &key[unit], routine))) {
            routines->held[routines->in_use[unit]].hits++;
            continue;
        }
        const struct routine *found = cache_acquire(cache, unit, &key[unit], error);
        if (!found) {
            device_routines_let_go(routines, cache, before, routine);
            return -1;
        }
        if (found == routine[unit])
            cache_let_go(cache, found);
        else
            device_routines_hold(routines, unit, found, routine);
    }
    return (int)(routines->count - before);
}

void device_routines_count_hits(struct device_routines *routines, struct cache *cache)
{
    for (uint32_t i = 0; i < routines->count; i++) {
        cache_add_hits(cache, routines->held[i].routine, routines->held[i].hits);
        routines->held[i].hits = 0;
    }
}

struct held *device_routines_exchange(struct device_routines *routines)
{
    struct held *held = routines->held;
    routines->held = held == routines->rows[0] ? routines->rows[1] : routines->rows[0];
    routines->count = 0;
    return held;
}
