/* The parts of the engine that observes: geometry, from vertices to the records of primitives
 * (watch_geometry.c), pixels, and the engine itself (watch.c). */
#ifndef COMMAND_INSPECT_WATCH_PART_H
#define COMMAND_INSPECT_WATCH_PART_H

#include "command/inspect/watch.h"

enum { WATCH_ALIGNMENT = 64, WATCH_SCRATCH_BYTES = SETUP_CAPACITY * 1024 };

/* The primitive of a setup call, and where its records begin. */
struct watch_placed {
    const uint8_t *address;
    uint32_t instance, primitive;
    uint32_t vertices, vertex[TOUCH_VERTICES];
    bool clipped;
};

struct watch {
    struct engine engine;
    struct triptych_device *device;
    int32_t x, y; /* the pixel; x < 0: none */
    uint32_t *count;
    enum watch_what what;
    struct watch_owner *owner;
    uint32_t draw;

    /* Geometry of the draw. */
    const struct job *job;                     /* of the instance */
    uint32_t instances;                        /* that have begun */
    uint32_t vertices, vertex[TOUCH_VERTICES]; /* of the primitive */
    bool in_tiles;                             /* the records of the round are complete */
    struct watch_placed *placed;               /* of the round, by address */
    uint32_t placed_count, placed_capacity;
    alignas(WATCH_ALIGNMENT) uint8_t scratch[WATCH_SCRATCH_BYTES]; /* records without culling */
    struct entry_list entries;

    /* Results of the draw. */
    uint64_t triangles_before;
    struct watch_counts counts;
    struct touch *touch;
    uint32_t touch_count, touch_capacity;
    bool incomplete, starved;

    struct sight sight;
};

/* A routine of the watch's engine. */
struct watched {
    struct routine routine;
    struct routine *inner;    /* the emulator's */
    struct routine *unculled; /* setup: the same without culling; null if nothing is culled */
    const struct program *program;
    struct triangle_layout layout;
};

/* The watch and the whole of a routine. */
static inline struct watch *watch_of(const struct routine *routine)
{
    return (struct watch *)(uintptr_t)routine->engine->options;
}

static inline const struct watched *watch_routine(const struct routine *routine)
{
    return (const struct watched *)(const void *)routine;
}

/* Adds a touch of the draw. Null after TOUCHES_MAXIMUM, or when there is no memory. */
struct touch *watch_new_touch(struct watch *watch, const struct watch_placed *placed, enum touch_kind kind);

/* The primitive of a record, or null if it was not noted. */
const struct watch_placed *watch_find_placed(const struct watch *watch, const uint8_t *record);

/* Functions of the routines. */
void watch_vertices(const void *arguments, const struct routine *routine);
void watch_setup(const void *arguments, const struct routine *routine);

#endif
