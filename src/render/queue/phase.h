/* A phase: a number of tasks that the threads of the pool share out among themselves.
 *
 * The tasks of a phase are counted by one counter, or cut into parts with a counter each. In the second case
 * every thread begins with a part of its own and then helps with the others, so that threads seldom access
 * the same counter and find in their caches what they have drawn before. Runs of tasks get shorter towards
 * the end, so that threads end together.
 *
 * Waking a thread takes about as long as a small draw. So a phase with little work runs on the calling
 * thread only; one with more also invites the threads that still look for work; and sleeping threads are
 * woken only for a phase that is long enough, by an estimate made before or by the time that it has taken
 * so far. */
#ifndef RENDER_QUEUE_PHASE_H
#define RENDER_QUEUE_PHASE_H

#include "render/queue/pool.h"

#include <stdalign.h>
#include <stdatomic.h>

enum { PHASE_PARTS = 16, PHASE_TASKS_MAXIMUM = 1 << 14 };

struct phase {
    struct pool *pool;
    unsigned leader;                        /* the worker that starts phases */
    enum pool_call call;                    /* which threads are invited */
    bool alone;                             /* none is, however long it takes */
    alignas(64) _Atomic uint32_t next_task; /* of a phase with one counter */
    uint32_t tasks;                         /* of a phase in parts */
    uint32_t parts;
    struct {
        alignas(64) _Atomic uint32_t next;
    } part[PHASE_PARTS];

    /* Tests hand out tasks in a random order, to show that the image does not depend on it. */
    alignas(64) uint64_t shuffle; /* state of the random order; 0: tasks are handed out in order */
    uint16_t order[PHASE_TASKS_MAXIMUM];
};

/* Runs a phase of `tasks` tasks, estimated to take `ns` nanoseconds on one thread. The threads call
 * `task`, which takes its tasks from next_task, or from the parts. */
void phase_run(struct phase *phase, uint32_t tasks, uint64_t ns, pool_task *task, void *user);

/* The same with two lists of tasks: `parts` of them are in parts and have the random order, `others` are
 * taken from next_task. */
void phase_run_both(struct phase *phase, uint32_t parts, uint32_t others, uint64_t ns, pool_task *task,
                    void *user);

/* The same on the calling thread only. */
void phase_run_alone(struct phase *phase, uint32_t tasks, pool_task *task, void *user);

/* Cuts `tasks` tasks, estimated to take `ns`, into parts: one for each thread that may come. Precedes
 * phase_run. */
void phase_make_parts(struct phase *phase, uint32_t tasks, uint64_t ns);

/* The same for this number of threads. */
void phase_cut(struct phase *phase, uint32_t tasks, unsigned threads);

/* The threads that a phase of this estimate invites. */
enum pool_call phase_call_for(uint64_t ns);

/* A phase that invites fewer than all becomes one that does once its leader has been busy for this long. */
enum { PHASE_PATIENCE_NS = 12500 };

/* Takes a run of tasks from the parts, for worker number `worker`. Returns how many, the first in *first;
 * 0: none is left. */
uint32_t phase_take(struct phase *phase, unsigned worker, uint32_t *first);

/* The task that is handed out as number i. */
static inline uint32_t phase_task(const struct phase *phase, uint32_t i)
{
    return phase->shuffle ? phase->order[i] : i;
}

/* The time that a thread spends in a phase. The leader wakes the others if it turns out longer than
 * estimated. */
struct stint {
    uint64_t start;
    uint64_t
        work; /* done when the clock was last read, in the unit that the phase counts: pixels, primitives */
    bool may_call;
};

struct stint phase_begin_stint(const struct phase *phase, unsigned worker, uint64_t work);

/* Wakes other threads for the tasks that are left if the leader has been busy for long. `work` is what it
 * has done. */
void phase_look_at_clock(const struct phase *phase, struct stint *stint, uint32_t tasks_left, uint64_t work);

/* Nanoseconds since the stint began. */
uint64_t phase_end_stint(const struct stint *stint);

#endif
