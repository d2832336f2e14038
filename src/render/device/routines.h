/* Routines that queued draws use. Each is held once for all draws that use it between two renderings, not
 * once for each draw; while it is held, the cache does not evict it. */
#ifndef RENDER_DEVICE_ROUTINES_H
#define RENDER_DEVICE_ROUTINES_H

#include "render/cache/cache.h"
#include "render/queue/commands.h"

struct held {
    const struct routine *routine;
    uint64_t hits; /* of draws for which the cache was not searched */
};

struct device_routines {
    struct held *held; /* one of the two rows of `rows` */
    uint32_t count;
    uint32_t *in_use; /* which of them the draw's routines are: DRAW_ROUTINES of its source's */
    unsigned always;  /* how many draws had a span reading from the first draw on */
    struct held rows[2][(QUEUE_COMMANDS + 1) * DRAW_ROUTINES]; /* and those of a draw before it is queued */
};

/* Starts with an empty row, and places of a draw's routines. */
void device_routines_initialize(struct device_routines *routines, uint32_t in_use[DRAW_ROUTINES]);

/* Makes `routine`, the draw's, those of the keys. With `spans`, a pixel routine that may have span readings
 * has one: each in turn, or the widest whose counted blocks are enough; and, if its triangles may be joined
 * and enough of their blocks are counted, the reading for joined rectangles. Returns how many of them the
 * cache was searched for, or -1 with the reason, and then no more are held than before. */
int device_routines_use(struct device_routines *routines, struct cache *cache,
                        const union key key[UNIT_COUNT], enum setting_spans spans, bool joins,
                        const struct routine *routine[DRAW_ROUTINES], struct error *error);

/* Holds a routine that the caller has acquired or retained, and makes it number `number` of the draw's. */
void device_routines_hold(struct device_routines *routines, unsigned number, const struct routine *held,
                          const struct routine *routine[DRAW_ROUTINES]);

/* Holds a routine of another command, which the caller has acquired or retained. A command has at most
 * DRAW_ROUTINES. */
void device_routines_keep(struct device_routines *routines, const struct routine *held);

/* Releases those that were held last, down to `count`. */
void device_routines_let_go(struct device_routines *routines, struct cache *cache, uint32_t count,
                            const struct routine *routine[DRAW_ROUTINES]);

/* Reports hits to the cache that it has not counted. */
void device_routines_count_hits(struct device_routines *routines, struct cache *cache);

/* Empties the row in use without releasing its routines, and returns it; the other row is in use from now
 * on. */
struct held *device_routines_exchange(struct device_routines *routines);

#endif
