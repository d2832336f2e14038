#define _GNU_SOURCE
#include "command/simulate/handover.h"

#include "base/clock.h"
#include "render/queue/pool.h"

#include <emmintrin.h>
#include <sched.h>
#include <stdalign.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <time.h>

enum {
    SAMPLES = 301,
    TAKES = 1 << 16,       /* of both threads */
    PATIENCE_NS = 20000000 /* for a thread that does not come: the machine has other work */
};

/* One phase of two threads. */
struct trial {
    alignas(64) _Atomic uint64_t entered; /* when the other thread began; 0: not yet */
    alignas(64) _Atomic uint64_t left;    /* when it ended */
    alignas(64) _Atomic uint32_t counter;
    uint32_t takes;
    _Atomic uint64_t take_ns; /* of both threads */
};

static void take_all(struct trial *trial)
{
    uint64_t begin = clock_ns();
    while (atomic_fetch_add(&trial->counter, 1) < trial->takes)
        ;
    atomic_fetch_add(&trial->take_ns, clock_ns() - begin);
}

/* The leader waits for the other thread before both take. */
static void trial_task(void *user, unsigned worker)
{
    struct trial *trial = user;
    uint64_t begin = clock_ns();
    if (worker)
        trial->entered = begin;
    while (!trial->entered && clock_ns() - begin < PATIENCE_NS)
        _mm_pause();
    if (trial->takes)
        take_all(trial);
    if (worker)
        trial->left = clock_ns();
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *samples, unsigned count)
{
    qsort(samples, count, sizeof *samples, compare);
    return count ? samples[count / 2] : 0;
}

static void pause_for(long ns)
{
    nanosleep(&(struct timespec){.tv_nsec = ns}, NULL);
}

/* Returns false if the other thread did not come. */
static bool run_trial(struct pool *pool, struct trial *trial, double *enter, double *leave)
{
    uint64_t begin = clock_ns();
    pool_run(pool, 0, 2, POOL_ALL, trial_task, trial);
    uint64_t end = clock_ns();
    if (!trial->entered)
        return false;
    *enter = trial->entered > begin ? (double)(trial->entered - begin) : 0;
    *leave = end > trial->left ? (double)(end - trial->left) : 0;
    return true;
}

/* The medians of many phases, each after a pause of `pause_ns`; 0: the other thread still polls. */
static void measure_entry(struct pool *pool, long pause_ns, double *enter_ns, double *leave_ns)
{
    double enter[SAMPLES], leave[SAMPLES];
    unsigned count = 0;
    for (unsigned i = 0; i < SAMPLES; i++) {
        struct trial trial = {0};
        if (pause_ns)
            pause_for(pause_ns);
        count += run_trial(pool, &trial, enter + count, leave + count);
    }
    *enter_ns = median(enter, count);
    *leave_ns = median(leave, count);
}

static double measure_take(struct pool *pool)
{
    double samples[SAMPLES / 10], unused;
    unsigned count = 0;
    for (unsigned i = 0; i < SAMPLES / 10; i++) {
        struct trial trial = {.takes = TAKES};
        if (run_trial(pool, &trial, &unused, &unused))
            samples[count++] = (double)trial.take_ns / 2 / TAKES;
    }
    return median(samples, count);
}

/* Loops of the pool's waiting threads take as long as these. */
static double measure_polling(void)
{
    uint64_t begin = clock_ns();
    _Atomic uint64_t gate = 0;
    for (unsigned i = 0; i < POOL_LOOKS && !gate; i++)
        _mm_pause();
    return (double)(clock_ns() - begin);
}

int handover_measure(struct handover *costs, struct error *error)
{
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) || CPU_COUNT(&set) < 2)
        return error_set(error, "costs of handing over work: this process has one processor, expected two"),
               -1;
    struct pool *pool = pool_create(2, NULL, error);
    if (!pool)
        return -1;
    double unused;
    pool_limit(pool, 2);
    measure_entry(pool, 0, &costs->enter_ns, &costs->leave_ns);
    measure_entry(pool, 300000, &costs->wake_ns, &unused);
    costs->take_ns = measure_take(pool);
    costs->poll_ns = measure_polling();
    pool_destroy(pool);
    return 0;
}
