/* The keys of a stream's draws: distinct routines, and the distinct sets of three that draws need. */
#ifndef TOOL_KEYS_H
#define TOOL_KEYS_H

#include "draw/key.h"
#include "stream/stream.h"

#include <stdbool.h>

struct key_found {
    enum unit unit;
    union key key;
    struct packed_key packed;
    const struct program *program; /* held, since keys have its number alone; or null */
};

struct key_set {
    uint32_t routine[UNIT_COUNT]; /* numbers of what was found */
};

/* An open hash table of numbers of what is in an array. */
struct key_index {
    uint32_t *slot;
    size_t slots;
};

/* Zero is empty. */
struct keys {
    struct key_found *found;
    struct key_set *set;
    size_t count, sets;
    struct key_index routines, draws;
    bool failed; /* memory was refused */
};

/* Adds what the draws of all frames need; none is drawn. `stop`, asked before each frame, may be null. Returns 0, or -1
 * with the reason. */
int keys_collect(struct keys *keys, const struct stream *stream, int (*stop)(void), struct error *error);

void keys_free(struct keys *keys);

#endif
