#include "render/queue/phase.h"

#include "base/clock.h"

/* --- The order of tasks --- */

static uint32_t random_below(struct phase *phase, uint32_t bound)
{
    phase->shuffle = phase->shuffle * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)((phase->shuffle >> 32) * bound >> 32);
}

static void order_tasks(struct phase *phase, uint32_t count)
{
    if (!phase->shuffle)
        return;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t j = random_below(phase, i + 1);
        phase->order[i] = phase->order[j];
        phase->order[j] = (uint16_t)i;
    }
}

/* --- Which threads a phase invites --- */

enum {
    SHARED_NS = 10000, /* from here on a phase invites threads that look for work */
    CALL_NS = 25000    /* from here on it wakes those that sleep */
};

_Static_assert((int)PHASE_PATIENCE_NS <= (int)CALL_NS, "waking threads must be worth it for the rest");

enum pool_call phase_call_for(uint64_t ns)
{
    return ns < SHARED_NS ? POOL_ALONE : ns < CALL_NS ? POOL_AWAKE : POOL_ALL;
}

struct stint phase_begin_stint(const struct phase *phase, unsigned worker, uint64_t work)
{
    bool may_call =
        worker == phase->leader && phase->call != POOL_ALL && !phase->alone && pool_limited(phase->pool) > 1;
    return (struct stint){clock_ns(), work, may_call};
}

void phase_look_at_clock(const struct phase *phase, struct stint *stint, uint32_t tasks_left, uint64_t work)
{
    enum { WORK_BETWEEN_LOOKS = 256 }; /* reading the clock takes as long as a few pixels or primitives */
    if (!stint->may_call || !tasks_left || work - stint->work < WORK_BETWEEN_LOOKS)
        return;
    stint->work = work;
    if (clock_ns() - stint->start < PHASE_PATIENCE_NS)
        return;
    stint->may_call = false;
    pool_call(phase->pool, tasks_left + 1);
}

uint64_t phase_end_stint(const struct stint *stint)
{
    return clock_ns() - stint->start;
}

static void run(struct phase *phase, uint32_t tasks, enum pool_call call, pool_task *task, void *user)
{
    atomic_store(&phase->next_task, 0);
    phase->call = call;
    pool_run(phase->pool, phase->leader, tasks, call, task, user);
}

void phase_run(struct phase *phase, uint32_t tasks, uint64_t ns, pool_task *task, void *user)
{
    phase_run_both(phase, tasks, 0, ns, task, user);
}

void phase_run_both(struct phase *phase, uint32_t parts, uint32_t others, uint64_t ns, pool_task *task,
                    void *user)
{
    phase->alone = false;
    order_tasks(phase, parts);
    run(phase, parts + others, phase_call_for(ns), task, user);
}

void phase_run_alone(struct phase *phase, uint32_t tasks, pool_task *task, void *user)
{
    phase->alone = true;
    order_tasks(phase, tasks);
    run(phase, tasks, POOL_ALONE, task, user);
}

/* --- Parts --- */

static uint32_t part_begin(const struct phase *phase, uint32_t part)
{
    return (uint32_t)((uint64_t)phase->tasks * part / phase->parts);
}

void phase_cut(struct phase *phase, uint32_t tasks, unsigned threads)
{
    phase->tasks = tasks;
    phase->parts = threads < PHASE_PARTS ? threads : PHASE_PARTS;
    for (uint32_t i = 0; i < phase->parts; i++)
        atomic_store_explicit(&phase->part[i].next, part_begin(phase, i), memory_order_relaxed);
}

void phase_make_parts(struct phase *phase, uint32_t tasks, uint64_t ns)
{
    phase_cut(phase, tasks, phase_call_for(ns) == POOL_ALONE ? 1 : pool_limited(phase->pool));
}

/* Runs are an eighth of what is left of the part, so they get shorter towards its end. */
static uint32_t take_of_part(struct phase *phase, uint32_t part, uint32_t *first)
{
    enum { RUNS = 8, ALONE_MOST = 4 };
    _Atomic uint32_t *counter = &phase->part[part].next;
    uint32_t next = atomic_load_explicit(counter, memory_order_relaxed), count;
    do {
        uint32_t left = part_begin(phase, part + 1) - next;
        if (!left)
            return 0;
        count = left / RUNS;
        count = phase->call == POOL_ALONE && count > ALONE_MOST ? ALONE_MOST : count;
        count = count ? count : 1;
    } while (!atomic_compare_exchange_weak(counter, &next, next + count));
    *first = next;
    return count;
}

uint32_t phase_take(struct phase *phase, unsigned worker, uint32_t *first)
{
    for (uint32_t i = 0; i < phase->parts; i++) {
        uint32_t count = take_of_part(phase, (worker + i) % phase->parts, first);
        if (count)
            return count;
    }
    return 0;
}
