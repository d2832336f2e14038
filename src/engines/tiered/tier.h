/* Inside of the tiered engines: the options, a routine with its tiers, and its heat. */
#ifndef ENGINES_TIERED_TIER_H
#define ENGINES_TIERED_TIER_H

#include "engines/tiered/background.h"
#include "engines/tiered/tiered.h"

enum { TIERS = ROUTINE_TIERS, KEEP_ALL = 0 };

/* Numbers of a tier; the last number that is given holds for all tiers after it. No number: none is given. */
struct tier_numbers {
    unsigned count;
    uint64_t at[TIERS];
};

struct tiered_options {
    unsigned count; /* of tiers */
    const struct engine *tier[TIERS];
    struct tier_numbers runs, elements; /* in a tier before the next one; neither is given: none */
    size_t keep;                        /* bytes of later tiers' code, or KEEP_ALL */
    uint64_t hysteresis;
    bool waits;
};

struct tiered {
    struct routine routine; /* first: the engine interface's pointer is this structure's */
    struct routine_tiers tiers;
    struct background_job job;
    struct code_arena *arena;
    struct routine *tier[TIERS];       /* set by the background thread before `current` */
    atomic_uint current, highest;      /* the tier that runs; the last tier that can be built */
    atomic_uint inside[TIERS];         /* threads that run a tier, if code may be dropped */
    uint64_t base_runs, base_elements; /* of the current tier when it became current */
    uint64_t dropped;                  /* the heat when its code was dropped, at least 1; 0: never */
    uint64_t patience;                 /* thresholds are multiplied by 1 more than this */
    const struct program *program;     /* held; or null */
    /* On the list of the routines with later tiers (heat.c). */
    struct tiered *previous, *next;
    uint64_t heat, seen; /* runs, older ones count less; the runs that are included */
};

static inline struct tiered *tiered_of(const struct routine *routine)
{
    return (struct tiered *)(uintptr_t)routine;
}

static inline const struct tiered_options *tiered_options_of(const struct tiered *tiered)
{
    return (const struct tiered_options *)tiered->routine.engine->options;
}

/* --- heat.c --------------------------------------------------------------------------------------------- */

/* Counts a run of a tier. Any thread. */
void tiered_count(struct tiered *tiered, unsigned tier, const void *arguments);

/* Returns true if the current tier, which is `tier`, has been used enough for the next one. */
bool tiered_has_earned(const struct tiered *tiered, unsigned tier);

/* Makes a tier that is built the current one. In the background thread. */
void tiered_raise(struct tiered *tiered, unsigned tier);

/* Drops code of later tiers, of the coldest routines first, until those of this engine and arena keep to the
 * budget. `newest` has just been raised. In the background thread. */
void tiered_drop_coldest(struct tiered *newest);

/* Removes a routine that is to be freed from the list. */
void tiered_forget(struct tiered *tiered);

#endif
