/* Routines of the unit blit: their owner, and their calls.
 *
 * The renderer decides which pixels an operation reads and writes, and whether it is needed at all.
 * spec/blit/ defines its results, and the device's engine computes them. Routines are found before work is
 * given to threads, since a build can fail; any thread runs them. */
#ifndef RENDER_BLIT_BLIT_H
#define RENDER_BLIT_BLIT_H

#include "base/error.h"
#include "contract/engine.h"

/* The owner of routines: a device's cache. */
struct blits {
    void *owner;
    const struct routine *(*acquire)(void *owner, const union key *key, struct error *error);
    void (*release)(void *owner, const struct routine *routine);
};

/* The routine of a key, to be released; null with the reason. */
static inline const struct routine *blit_acquire(const struct blits *blits, struct blit_key key,
                                                 struct error *error)
{
    const union key whole = {.blit = key};
    return blits->acquire(blits->owner, &whole, error);
}

/* Null is allowed. */
static inline void blit_release(const struct blits *blits, const struct routine *routine)
{
    if (routine)
        blits->release(blits->owner, routine);
}

/* Runs a routine for `count` elements, a multiple of LANES_MAXIMUM. `index` and `out` are 64-byte aligned. */
static inline void blit_run(const struct routine *routine, const struct blit_job *job, const void *index,
                            void *out, uint32_t count)
{
    const struct blit_arguments call = {job, index, out, count};
    routine_run(routine, &call, count);
}

#endif
