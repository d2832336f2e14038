/* The whole interface between the renderer and an engine: build a routine for a unit and a key; free it.
 *
 * Engines know nothing of the renderer but this file, key.h, job.h and call.h; they never include one
 * another. */
#ifndef DRAW_ENGINE_H
#define DRAW_ENGINE_H

#include "base/error.h"
#include "draw/call.h"
#include "draw/key.h"

#include <time.h>

struct routine;
struct cache_entry; /* draw/cache.c */
struct code_arena;  /* base/code.h */
struct debug_code;  /* debug/code.h */

/* `call` is the unit's call structure. Routines may run on many threads at once; they set FTZ and DAZ with
 * all exceptions masked and round to nearest on entry, and restore the caller's MXCSR. */
typedef void routine_function(const void *call, const struct routine *routine);

/* What the calls of a routine took, where that is asked for; added to by any thread. */
struct routine_time {
    uint64_t ns;
    uint64_t elements; /* vertices, triangles or covered pixels */
};

/* A built routine. The engine that built it fills all but the cache's fields. */
struct routine {
    routine_function *run;
    const struct engine *engine;
    enum unit unit;
    union key key;
    const void *code; /* executable bytes, null when the engine generates none */
    uint32_t code_bytes;
    uint32_t constant_bytes; /* of code_bytes, how many are data behind the code */
    uint32_t parts;          /* instructions emitted (specialize), fragments joined (stitch) */
    uint32_t spills;
    uint32_t fused, carried; /* operation fragments: of two operations or more; operands found in registers */
    uint32_t data_bytes;     /* held besides the code: what an interpreter works from */
    const char *granularity; /* stitch: "stage" or "operation", what its fragments are; null elsewhere */
    uint64_t build_ns;       /* set by the cache around build() */
    uint32_t lanes;          /* calls have a multiple of so many; 0 when it is built: the engine's width, or
                                LANES_MAXIMUM where that is not less or none, set by the cache */
    uint32_t number;         /* identity in dumps and reports, from 1, set by the cache */
    uint64_t hits;           /* set by the cache */
    struct routine_time *time; /* set by the cache; null: not measured */
    struct cache_entry *entry; /* the cache's own */
    uint16_t traits;           /* of a pixel routine (draw/hidden.h), set by the cache */
    uint16_t depth_plane;      /* the byte offset of depth's plane in its records, likewise */
};

/* Runs the routine; `elements` are counted if it is measured. */
static inline void routine_run(const struct routine *routine, const void *call, uint64_t elements)
{
    struct timespec begin, end;
    if (!routine->time) {
        routine->run(call, routine);
        return;
    }
    clock_gettime(CLOCK_MONOTONIC, &begin);
    routine->run(call, routine);
    clock_gettime(CLOCK_MONOTONIC, &end);
    int64_t ns = (end.tv_sec - begin.tv_sec) * 1000000000ll + end.tv_nsec - begin.tv_nsec;
    __atomic_fetch_add(&routine->time->ns, (uint64_t)ns, __ATOMIC_RELAXED);
    __atomic_fetch_add(&routine->time->elements, elements, __ATOMIC_RELAXED);
}

/* No routine's code and data are larger; engines refuse to build it. */
enum { ROUTINE_BYTES_MAXIMUM = 8 << 20 };

struct engine {
    const char *name;        /* as in --engine: "emulate", "stitch", "stitch-operation", "specialize" ... */
    const char *description; /* one line */
    int width;               /* lanes W of its routines; 0: chosen for each of them */
    int without_arena;       /* generates no code, or has it elsewhere */
    int on_request;          /* runs where it is named; left out of what is done with every engine */

    /* Null when the engine can run here, else one line that says why not, the calling thread's until it asks again.
     */
    const char *(*unavailable)(void);

    /* Builds the routine for a normalised key; null with the reason in error. `arena` is where code lives; an
     * engine without generated code ignores it. Thread-safe. */
    struct routine *(*build)(struct code_arena *arena, enum unit unit, const union key *key,
                             struct error *error);

    /* Frees a routine that no thread runs. */
    void (*free)(struct code_arena *arena, struct routine *routine);

    /* What debuggers and profilers may know of a routine's code, all but its name, found by building it once more: so
     * routines cost nothing more when nobody asks. 0, or -1 with the reason; null for engines without such code. */
    int (*describe)(const struct routine *routine, struct debug_code *code, struct error *error);
};

#endif
