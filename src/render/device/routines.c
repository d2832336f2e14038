#include "render/device/routines.h"

#include "render/device/derived.h"
#include "render/tile/hidden.h"
#include "render/tile/span.h"

enum { HELD_RECENTLY = 32 };

void device_routines_initialize(struct device_routines *routines, uint32_t in_use[DRAW_ROUTINES])
{
    routines->in_use = in_use;
    routines->held = routines->rows[0];
    routines->count = routines->always = 0;
}

/* Uses one that was held recently for the key, if there is one. */
static bool use_held(struct device_routines *routines, unsigned number, enum unit unit, const union key *key,
                     const struct routine *routine[DRAW_ROUTINES])
{
    uint32_t end = routines->count, begin = end > HELD_RECENTLY ? end - HELD_RECENTLY : 0;
    for (uint32_t i = end; i-- > begin;) {
        const struct routine *held = routines->held[i].routine;
        if (held->unit == unit && device_same_key(unit, &held->key, key)) {
            routine[number] = held;
            routines->in_use[number] = i;
            return true;
        }
    }
    return false;
}

void device_routines_hold(struct device_routines *routines, unsigned number, const struct routine *held,
                          const struct routine *routine[DRAW_ROUTINES])
{
    routines->held[routines->count] = (struct held){held, 0};
    routine[number] = held;
    routines->in_use[number] = routines->count++;
}

void device_routines_keep(struct device_routines *routines, const struct routine *held)
{
    routines->held[routines->count++] = (struct held){held, 0};
}

void device_routines_let_go(struct device_routines *routines, struct cache *cache, uint32_t count,
                            const struct routine *routine[DRAW_ROUTINES])
{
    for (uint32_t i = count; i < routines->count; i++) {
        cache_add_hits(cache, routines->held[i].routine, routines->held[i].hits);
        cache_let_go(cache, routines->held[i].routine);
    }
    routines->count = count;
    cache_trim(cache);
    for (int number = 0; number < DRAW_ROUTINES; number++)
        if (routines->in_use[number] >= count)
            routine[number] = NULL;
}

/* Makes routine `number` that of the key. Returns 0, or -1 with the reason. */
static int use(struct device_routines *routines, struct cache *cache, unsigned number, enum unit unit,
               const union key *key, const struct routine *routine[DRAW_ROUTINES], struct error *error)
{
    if (!cache_has_labels(cache) && (routine[number] || use_held(routines, number, unit, key, routine))) {
        routines->held[routines->in_use[number]].hits++;
        return 0;
    }
    const struct routine *found = cache_acquire(cache, unit, key, error);
    if (!found)
        return -1;
    if (found == routine[number])
        cache_let_go(cache, found);
    else
        device_routines_hold(routines, number, found, routine);
    return 0;
}

/* The span reading that a draw of the pixel routine takes. */
static enum span wanted_span(struct device_routines *routines, enum setting_spans spans,
                             const struct routine *pixel)
{
    const unsigned narrowest = span_narrowest(&pixel->key.pixel);
    unsigned span = span_widest(&pixel->key.pixel);
    if (spans == SETTING_spans_off || !(pixel->traits & PIXEL_SPANS))
        return SPAN_NONE;
    if (spans == SETTING_spans_always)
        return (enum span)(narrowest + routines->always++ % (span - narrowest + 1));
    while (span && __atomic_load_n(pixel->span_blocks + span, __ATOMIC_RELAXED) < SPAN_WARMTH)
        span--;
    return (enum span)span;
}

/* A span reading of the draw's pixel routine, or none. */
static int use_spans(struct device_routines *routines, struct cache *cache, const union key *pixel,
                     enum setting_spans spans, const struct routine *routine[DRAW_ROUTINES],
                     struct error *error)
{
    const enum span span = wanted_span(routines, spans, routine[UNIT_PIXEL]);
    union key key;
    if (routine[ROUTINE_SPAN] && routine[ROUTINE_SPAN]->key.pixel.span != span)
        routine[ROUTINE_SPAN] = NULL;
    if (!span)
        return 0;
    key.pixel = pixel->pixel;
    key.pixel.span = span;
    return use(routines, cache, ROUTINE_SPAN, UNIT_PIXEL, &key, routine, error);
}

static bool wants_joined(enum setting_spans spans, const struct routine *pixel)
{
    if (spans == SETTING_spans_off || !(pixel->traits & PIXEL_SPANS))
        return false;
    return spans == SETTING_spans_always ||
           __atomic_load_n(pixel->joined_blocks, __ATOMIC_RELAXED) >= SPAN_WARMTH;
}

/* The reading of the draw's pixel routine for joined rectangles, or none. */
static int use_joined(struct device_routines *routines, struct cache *cache, const union key *pixel,
                      enum setting_spans spans, const struct routine *routine[DRAW_ROUTINES],
                      struct error *error)
{
    union key key;
    if (!wants_joined(spans, routine[UNIT_PIXEL])) {
        routine[ROUTINE_JOINED] = NULL;
        return 0;
    }
    key.pixel = pixel->pixel;
    key.pixel.joined = 1;
    return use(routines, cache, ROUTINE_JOINED, UNIT_PIXEL, &key, routine, error);
}

int device_routines_use(struct device_routines *routines, struct cache *cache,
                        const union key key[UNIT_COUNT], enum setting_spans spans, bool joins,
                        const struct routine *routine[DRAW_ROUTINES], struct error *error)
{
    uint32_t before = routines->count;
    int failed = 0;
    for (unsigned unit = 0; unit < UNIT_COUNT && !failed; unit++)
        failed = use(routines, cache, unit, (enum unit)unit, &key[unit], routine, error);
    if (!failed)
        failed = use_spans(routines, cache, &key[UNIT_PIXEL], spans, routine, error);
    if (!failed)
        failed =
            use_joined(routines, cache, &key[UNIT_PIXEL], joins ? spans : SETTING_spans_off, routine, error);
    if (!failed)
        return (int)(routines->count - before);
    device_routines_let_go(routines, cache, before, routine);
    return -1;
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
