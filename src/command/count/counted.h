/* The counts of one stream on one engine. */
#ifndef COMMAND_COUNT_COUNTED_H
#define COMMAND_COUNT_COUNTED_H

#include "command/count/states.h"
#include "command/stream/stream.h"
#include "render/cache/cache.h"

/* The needs of a frame. */
struct count_frame {
    struct count_states_frame states;
    double ms; /* wall time */
};

/* The pixel routines that may get a second code, together (contract/engine.h). */
struct count_second {
    uint32_t routines;
    uint32_t built; /* of them with a second code */
    uint64_t blocks, runs, bytes;
};

struct counted {
    const struct stream *stream;
    const char *name;
    const struct engine *engine;
    unsigned frames;
    struct count_frame *frame;
    struct count_states states;
    struct cache_statistics cache;
    struct routine_tiers tiers;                   /* summed over the routines; count is 0 if there are none */
    struct routine_tracking tracking[UNIT_COUNT]; /* the same */
    uint32_t tracked[UNIT_COUNT];                 /* routines that track constants */
    struct count_second second;
    size_t budget; /* of the cache, in bytes; 0 becomes the usual one */
};

/* Plays the first c->frames frames and fills in the counts. `stop` is called before each frame, and ends the
 * count by returning non-zero. Returns 0, or -1 with the reason. */
int count_play(struct counted *c, unsigned threads, const struct setting_values *settings, int (*stop)(void),
               struct error *error);

#endif
