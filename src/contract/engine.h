/* The interface between the renderer and an engine: build a routine for a unit and a key, and free it.
 *
 * An engine includes only contract/ and the folders below it. It includes neither the renderer nor, except
 * for tiered, another engine. */
#ifndef CONTRACT_ENGINE_H
#define CONTRACT_ENGINE_H

#include "base/clock.h"
#include "base/error.h"
#include "contract/arguments.h"
#include "contract/key.h"

#include <stdbool.h>

struct routine;
struct engine;
struct cache_entry; /* render/cache/cache_part.h */
struct code_arena;  /* machine/code.h */
struct debug_code;  /* debug/code.h */

/* `arguments` is the unit's structure of contract/arguments.h. Several threads may run a routine at the same
 * time. A routine sets FTZ, DAZ, round to nearest and masks all exceptions on entry, and restores the
 * caller's MXCSR. */
typedef void routine_function(const void *arguments, const struct routine *routine);

/* The total time of a routine's runs, when it is measured. Any thread adds to it. */
struct routine_time {
    uint64_t ns;
    uint64_t elements; /* vertices, triangles or covered pixels */
};

/* The history of code that contains addresses (engines/specialize/pointers.h). Any thread that runs it
 * changes these numbers. */
struct routine_patches {
    uint64_t writes; /* how often addresses were written to a copy */
    uint64_t waits;  /* how often a thread waited for a copy */
    uint64_t copies; /* of the code */
};

/* The history of a routine whose engine tracks constants of shaders (engines/specialize/track.h). The thread
 * that records draws changes these numbers. */
struct routine_tracking {
    uint64_t draws;
    uint64_t burnt_draws; /* of them with code that contains values of constants */
    uint64_t compared;    /* words that were compared with those of the draw before, and by guards */
    uint64_t guards;      /* comparisons of a draw's constants with those in the code of a variant */
    uint64_t failures;    /* how often the guard of the variant in use failed */
    uint32_t words;       /* of constants that are tracked */
    uint32_t variants;
    uint32_t burnt;   /* words in the code of all variants */
    uint32_t refused; /* variants for which there was no memory, or that are beyond the limit */
    size_t bytes;     /* of all variants */
};

/* The history of a pixel routine that may get a second code (engines/specialize/sixteen.h). Any thread that
 * runs it adds to `blocks`. The thread that records draws calls `select` when there are enough. */
struct routine_second {
    uint32_t blocks;               /* drawn without the second code, in calls for which it may be faster */
    uint32_t least;                /* that are enough */
    uint32_t runs;                 /* calls with the second code */
    bool is_decided;               /* the second code exists, or is not built */
    size_t bytes;                  /* of the second code */
    const struct routine *routine; /* the second code, as a routine of the same key; null: there is none */
};

/* The counts of one tier of a tiered routine. */
struct routine_tier {
    const char *engine;
    uint64_t runs;
    uint64_t elements; /* vertices, triangles, or blocks of pixels */
    uint64_t build_ns; /* of all builds of this tier */
    uint32_t builds, drops;
    uint32_t code_bytes; /* of the code that exists */
};

/* The tiers of a routine, from the slowest to the fastest. They change while the routine is in use;
 * read their numbers atomically. */
enum { ROUTINE_TIERS = 4 };
struct routine_tiers {
    uint32_t count;
    uint32_t current; /* the one that runs */
    struct routine_tier tier[ROUTINE_TIERS];
};

/* A built routine. The engine fills all fields except the cache's. */
struct routine {
    routine_function *run;
    const struct engine *engine; /* the one whose `build` made it */
    enum unit unit;
    union key key;
    const void *code; /* executable bytes; null when the engine generates none */
    uint32_t code_bytes;
    uint32_t constant_bytes; /* the part of code_bytes, at its end, that is data */
    uint32_t parts;          /* instructions emitted (specialize), fragments joined (stitch) */
    uint32_t spills;
    uint32_t fused;                    /* operation fragments that do two or more operations */
    uint32_t carried;                  /* operands of operation fragments that are already in a register */
    uint32_t data_bytes;               /* memory besides the code, for example an interpreter's schedule */
    const struct routine_tiers *tiers; /* of a tiered routine, until it is freed; null elsewhere */
    const char *granularity; /* stitch: "stage" or "operation", the kind of its fragments; null elsewhere */
    const struct routine_patches *patches;   /* null: its code never changes */
    const struct routine_tracking *tracking; /* null: no constants are tracked */
    struct routine_second *second;           /* null: there is no second code */
    uint64_t build_ns;                       /* set by the cache around build() */
    uint32_t lanes;  /* Element counts are padded to a multiple of this. build() leaves 0 for the engine's
                                width; the cache sets that, or LANES_MAXIMUM if it is 0 or larger. */
    uint32_t number; /* identity in dumps and reports, from 1; set by the cache */
    uint64_t hits;   /* set by the cache */
    struct routine_time *time; /* set by the cache; null: not measured */
    struct cache_entry *entry; /* the cache's own */
    bool takes_tiles;          /* of a span reading: it can draw a tile by the entries of its first row */
    uint16_t traits;           /* of a pixel routine (render/tile/hidden.h), set by the cache */
    uint16_t depth_plane;      /* byte offset of depth's plane in the triangle records, set by the cache */
    uint32_t *span_blocks;     /* of a pixel routine: SPAN_COUNT numbers, how many blocks each span reading
                                  would have drawn (render/tile/span.h), added to by any thread; set by the
                                  cache */
    uint32_t *joined_blocks;   /* the same of the reading for joined rectangles: one number */
};

/* Runs the routine. When it is measured, adds the time and `elements` to its total. */
static inline void routine_run(const struct routine *routine, const void *arguments, uint64_t elements)
{
    if (!routine->time) {
        routine->run(arguments, routine);
        return;
    }
    uint64_t begin = clock_ns();
    routine->run(arguments, routine);
    uint64_t ns = clock_ns() - begin;
    __atomic_fetch_add(&routine->time->ns, ns, __ATOMIC_RELAXED);
    __atomic_fetch_add(&routine->time->elements, elements, __ATOMIC_RELAXED);
}

/* Returns true if the engine's `select` is to decide about the second code. */
static inline bool routine_wants_second(const struct routine *routine)
{
    const struct routine_second *second = routine->second;
    return second && !__atomic_load_n(&second->is_decided, __ATOMIC_RELAXED) &&
           __atomic_load_n(&second->blocks, __ATOMIC_RELAXED) >= second->least;
}

/* The largest code and data of one routine. Engines refuse to build a larger one. */
enum { ROUTINE_BYTES_MAXIMUM = 8 << 20 };

/* The least instruction set that has every instruction of the routine's code: "SSE2", "AVX2" or "AVX-512";
 * "SSE2" for an engine without generated code. Decodes the code each time. */
const char *routine_instruction_set(const struct routine *routine);
/* The elements that one pass of its code computes. Of a tiered routine both are the first tier's. */
uint32_t routine_lanes(const struct routine *routine);

/* Engines with the same functions differ in `width` and `options`. Each function receives the engine: as
 * `self`, or as routine->engine. */
struct engine {
    const char *name;        /* as in --engine: "emulate", "stitch", "stitch-operation", "specialize" ... */
    const char *description; /* one line */
    int width;               /* lanes W of its routines; 0: chosen for each routine */
    bool without_arena;      /* keeps no code in an arena */
    bool on_request;         /* runs only where it is named; skipped where all engines run */
    bool observes;           /* it needs all work: each batch has one primitive, hidden pixels are shaded */
    const void *options;     /* the engine's own; null when it has none */

    /* Returns null when the engine can run here, else the reason in one line. The text is valid until the
     * calling thread's next call. A null function means always available. Use engine_unavailable(). */
    const char *(*unavailable)(const struct engine *self);

    /* Builds the routine for a normalised key. Returns null with the reason in error. Code is placed in
     * `arena`; an engine without generated code ignores it. Thread-safe. Use engine_build(). */
    struct routine *(*build)(const struct engine *self, struct code_arena *arena, enum unit unit,
                             const union key *key, struct error *error);

    /* Writes the label of a unit's routine, the hash of its recording before passes, and returns 1. Returns
     * 0 if this engine's labels are the keys, or -1 with the reason. If `key` is null, it only answers 1 or
     * 0. A null function: the keys. */
    int (*label)(const struct engine *self, enum unit unit, const union key *key, struct packed_key *label,
                 struct error *error);

    /* Returns the routine for a draw with these constants of the unit's shader: `routine`, or a variant that
     * is freed with `routine` and gives the same bits for them. Blocks with one number have the same
     * constants, and no number is 0. The thread that records a device's draws calls it, at each draw with
     * constants if it tracks them (routine->tracking), and when routine_wants_second. A null function:
     * `routine`. */
    const struct routine *(*select)(const struct routine *routine, const float *constants, uint64_t number);

    /* Frees a routine that no thread runs. */
    void (*free)(struct code_arena *arena, struct routine *routine);

    /* Fills in what debuggers and profilers show of a routine's code, except its name. It builds the code a
     * second time to find this, so that routines carry no debug data when debugging is disabled. Returns 0,
     * or -1 with the reason. Null for engines without generated code. */
    int (*describe)(const struct routine *routine, struct debug_code *code, struct error *error);
};

static inline const char *engine_unavailable(const struct engine *engine)
{
    return engine->unavailable ? engine->unavailable(engine) : NULL;
}

static inline struct routine *engine_build(const struct engine *engine, struct code_arena *arena,
                                           enum unit unit, const union key *key, struct error *error)
{
    return engine->build(engine, arena, unit, key, error);
}

#endif
