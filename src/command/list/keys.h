/* The keys of a stream's draws: the distinct routines, and the distinct sets of three routines (vertex,
 * setup, pixel). */
#ifndef COMMAND_LIST_KEYS_H
#define COMMAND_LIST_KEYS_H

#include "base/hash.h"
#include "command/stream/stream.h"
#include "contract/key.h"

#include <stdbool.h>

struct key_found {
    enum unit unit;
    union key key;
    struct packed_key packed;
    const struct program *program; /* held, because a key has only its number; or null */
};

struct key_set {
    uint32_t routine[UNIT_COUNT]; /* indices into keys.found */
};

/* Zero is empty. */
struct keys {
    struct key_found *found;
    struct key_set *set;
    size_t count, sets;                /* each at most 2^32 - 1 */
    struct hash_table routines, draws; /* of `found` and of `set` */
    bool failed;                       /* memory was refused */
};

/* Adds the keys of the draws of all frames. Nothing is drawn. If `stop` is not null, it is called before each
 * frame and ends the collection by returning non-zero. Returns 0, or -1 with the reason. */
int keys_collect(struct keys *keys, const struct stream *stream, int (*stop)(void), struct error *error);

/* As keys_collect, for the first frame only. */
int keys_collect_first(struct keys *keys, const struct stream *stream, struct error *error);

/* Returns the index of the routine in keys->found; or keys->count if there is none. */
size_t keys_index(const struct keys *keys, const struct key_found *routine);

void keys_free(struct keys *keys);

#endif
