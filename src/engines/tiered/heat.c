/* The heat of routines: when a routine reaches its next tier, and which routines lose their later tiers.
 *
 * Counters are atomic and relaxed: a run that is counted late changes when a tier is built, never a picture.
 *
 * Code of later tiers is bounded only with the option keep. The routines of an engine and an arena with such
 * code are on a list, under the lock of the background queue. After each build the coldest of them return to
 * their first tier until the rest keeps to the budget. The newest routine must be hotter than those that it
 * displaces by the factor of hysteresis, else it loses its own code. Each loss of code multiplies a routine's
 * thresholds by the same factor. So two routines of nearly the same heat do not displace each other in turns.
 *
 * Code is freed when no thread is inside of it. A thread counts itself in before it reads the current tier a
 * second time (tiered.c), so a count of zero after a change of the tier remains zero. */
#include "engines/tiered/tier.h"

static uint64_t count_of(enum unit unit, const void *arguments)
{
    switch (unit) {
    case UNIT_VERTEX: return ((const struct vertex_arguments *)arguments)->count;
    case UNIT_BLIT: return ((const struct blit_arguments *)arguments)->count;
    case UNIT_SETUP: return ((const struct setup_arguments *)arguments)->count;
    default: return ((const struct pixel_arguments *)arguments)->count;
    }
}

void tiered_count(struct tiered *tiered, unsigned tier, const void *arguments)
{
    struct routine_tier *counts = tiered->tiers.tier + tier;
    __atomic_fetch_add(&counts->runs, 1, __ATOMIC_RELAXED);
    __atomic_fetch_add(&counts->elements, count_of(tiered->routine.unit, arguments), __ATOMIC_RELAXED);
}

/* --- Thresholds ----------------------------------------------------------------------------------------- */

static uint64_t number_of(const struct tier_numbers *numbers, unsigned tier)
{
    return numbers->at[tier < numbers->count ? tier : numbers->count - 1];
}

static bool is_reached(const struct tier_numbers *numbers, unsigned tier, uint64_t value, uint64_t factor)
{
    return numbers->count && value >= number_of(numbers, tier) * factor;
}

bool tiered_has_earned(const struct tiered *tiered, unsigned tier)
{
    const struct tiered_options *options = tiered_options_of(tiered);
    const struct routine_tier *counts = tiered->tiers.tier + tier;
    uint64_t factor = 1 + __atomic_load_n(&tiered->patience, __ATOMIC_RELAXED);
    if (tier >= atomic_load_explicit(&tiered->highest, memory_order_relaxed))
        return false;
    uint64_t runs = __atomic_load_n(&counts->runs, __ATOMIC_RELAXED) -
                    __atomic_load_n(&tiered->base_runs, __ATOMIC_RELAXED);
    if (!options->runs.count && !options->elements.count)
        return runs >= __atomic_load_n(&tiered->dropped, __ATOMIC_RELAXED) * factor;
    uint64_t elements = __atomic_load_n(&counts->elements, __ATOMIC_RELAXED) -
                        __atomic_load_n(&tiered->base_elements, __ATOMIC_RELAXED);
    return is_reached(&options->runs, tier, runs, factor) ||
           is_reached(&options->elements, tier, elements, factor);
}

/* Counting of a tier begins again with each stay in it. */
static void set_current(struct tiered *tiered, unsigned tier)
{
    const struct routine_tier *counts = tiered->tiers.tier + tier;
    __atomic_store_n(&tiered->base_runs, __atomic_load_n(&counts->runs, __ATOMIC_RELAXED), __ATOMIC_RELAXED);
    __atomic_store_n(&tiered->base_elements, __atomic_load_n(&counts->elements, __ATOMIC_RELAXED),
                     __ATOMIC_RELAXED);
    __atomic_store_n(&tiered->tiers.current, tier, __ATOMIC_RELAXED);
    atomic_store(&tiered->current, tier);
}

/* --- The budget ----------------------------------------------------------------------------------------- */

/* The routines that have, or had, later tiers, of all engines with keep; under background_lock(). */
static struct tiered *first;

static void link_tiered(struct tiered *tiered)
{
    tiered->previous = NULL;
    tiered->next = first;
    if (first)
        first->previous = tiered;
    first = tiered;
}

static bool is_linked(const struct tiered *tiered)
{
    return first == tiered || tiered->previous;
}

static void unlink_tiered(struct tiered *tiered)
{
    if (!is_linked(tiered))
        return;
    if (tiered->previous)
        tiered->previous->next = tiered->next;
    else
        first = tiered->next;
    if (tiered->next)
        tiered->next->previous = tiered->previous;
    tiered->previous = tiered->next = NULL;
}

void tiered_raise(struct tiered *tiered, unsigned tier)
{
    set_current(tiered, tier);
    if (tiered_options_of(tiered)->keep == KEEP_ALL)
        return;
    background_lock();
    if (!is_linked(tiered))
        link_tiered(tiered);
    background_unlock();
}

void tiered_forget(struct tiered *tiered)
{
    background_lock();
    unlink_tiered(tiered);
    background_unlock();
}

/* Frees code of later tiers that is not current and that no thread runs. */
static void free_unused(struct tiered *tiered)
{
    for (unsigned i = 1; i < tiered->tiers.count; i++) {
        struct routine *routine = tiered->tier[i];
        if (!routine || i == atomic_load(&tiered->current) || atomic_load(&tiered->inside[i]))
            continue;
        tiered->tier[i] = NULL;
        __atomic_store_n(&tiered->tiers.tier[i].code_bytes, 0, __ATOMIC_RELAXED);
        routine->engine->free(tiered->arena, routine);
    }
}

/* Of the current tier: code of other tiers is freed soon. */
static size_t later_bytes(const struct tiered *tiered)
{
    unsigned tier = atomic_load(&tiered->current);
    return tier ? tiered->tier[tier]->code_bytes : 0;
}

static uint64_t all_runs(const struct tiered *tiered)
{
    uint64_t runs = 0;
    for (unsigned i = 0; i < tiered->tiers.count; i++)
        runs += __atomic_load_n(&tiered->tiers.tier[i].runs, __ATOMIC_RELAXED);
    return runs;
}

/* All routines on the list lose half of their heat whenever they have had this number of runs together. */
enum { HALF_LIFE = 4096 };

static uint64_t runs_since_halving;

static void update_heat(void)
{
    for (struct tiered *t = first; t; t = t->next) {
        uint64_t runs = all_runs(t);
        t->heat += runs - t->seen;
        runs_since_halving += runs - t->seen;
        t->seen = runs;
    }
    for (struct tiered *t = first; t && runs_since_halving >= HALF_LIFE; t = t->next)
        t->heat /= 2;
    runs_since_halving %= HALF_LIFE;
}

static bool shares(const struct tiered *a, const struct tiered *b)
{
    return a->arena == b->arena && a->routine.engine == b->routine.engine;
}

/* The coldest routine with a later tier besides `newest`; null if there is none. Adds up the bytes of all. */
static struct tiered *find_coldest(const struct tiered *newest, size_t *bytes)
{
    struct tiered *coldest = NULL;
    *bytes = 0;
    for (struct tiered *t = first; t; t = t->next) {
        if (!shares(t, newest))
            continue;
        free_unused(t);
        *bytes += later_bytes(t);
        if (t != newest && atomic_load(&t->current) && (!coldest || t->heat < coldest->heat))
            coldest = t;
    }
    return coldest;
}

/* Each drop multiplies the thresholds of a routine by the hysteresis. */
static void lose_patience(struct tiered *tiered)
{
    enum { MOST = 1000000 };
    uint64_t factor = (1 + tiered->patience) * tiered_options_of(tiered)->hysteresis;
    __atomic_store_n(&tiered->patience, (factor < MOST ? factor : MOST) - 1, __ATOMIC_RELAXED);
}

static void drop(struct tiered *tiered)
{
    unsigned tier = atomic_load(&tiered->current);
    __atomic_fetch_add(&tiered->tiers.tier[tier].drops, 1, __ATOMIC_RELAXED);
    __atomic_store_n(&tiered->dropped, tiered->heat ? tiered->heat : 1, __ATOMIC_RELAXED);
    lose_patience(tiered);
    set_current(tiered, 0);
    free_unused(tiered);
}

void tiered_drop_coldest(struct tiered *newest)
{
    const struct tiered_options *options = tiered_options_of(newest);
    size_t bytes;
    if (options->keep == KEEP_ALL)
        return;
    background_lock();
    update_heat();
    struct tiered *coldest = find_coldest(newest, &bytes);
    while (bytes > options->keep && coldest && coldest->heat * options->hysteresis <= newest->heat) {
        drop(coldest);
        coldest = find_coldest(newest, &bytes);
    }
    if (bytes > options->keep)
        drop(newest);
    background_unlock();
}
