#define _GNU_SOURCE
#include "draw/pool.h"

#include "base/mxcsr.h"

#include <emmintrin.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

/* Rounds follow one another within microseconds while something is drawn, which a sleeping thread takes to wake
 * up: who waits looks this often first, some tens of microseconds, where there is a processor for each. */
enum { LOOKS = 1000 };

struct pool_worker {
    struct pool *pool;
    unsigned number;
    pthread_t thread;
};

struct pool {
    pthread_mutex_t lock;
    pthread_cond_t start, done;
    /* Written with the lock held only. */
    _Atomic uint64_t round;   /* of tasks; a worker has run round r when it waits for r + 1 */
    _Atomic unsigned running; /* threads that have not finished it */
    _Atomic bool leaving;
    unsigned wanted; /* workers of this round */
    unsigned looks;
    pool_task *task;
    void *user;
    unsigned workers, limit;
    struct pool_worker worker[]; /* worker 0 is the caller's thread */
};

static void run_in_contract(pool_task *task, void *user, unsigned worker)
{
    unsigned saved = mxcsr_enter();
    task(user, worker);
    mxcsr_leave(saved);
}

static void look_for_round(const struct pool *pool, uint64_t round)
{
    for (unsigned i = 0; i < pool->looks && pool->round == round && !pool->leaving; i++)
        _mm_pause();
}

static void look_for_end(const struct pool *pool)
{
    for (unsigned i = 0; i < pool->looks && pool->running; i++)
        _mm_pause();
}

/* Waits for the round after `round`; false when the pool is leaving. */
static bool next_round(struct pool *pool, uint64_t round)
{
    while (pool->round == round && !pool->leaving)
        pthread_cond_wait(&pool->start, &pool->lock);
    return !pool->leaving;
}

static void *work(void *argument)
{
    struct pool_worker *self = argument;
    struct pool *pool = self->pool;
    pthread_mutex_lock(&pool->lock);
    for (uint64_t round = 0; next_round(pool, round);) {
        round = pool->round;
        if (self->number >= pool->wanted)
            continue;
        pool_task *task = pool->task;
        void *user = pool->user;
        pthread_mutex_unlock(&pool->lock);
        run_in_contract(task, user, self->number);
        pthread_mutex_lock(&pool->lock);
        if (!--pool->running)
            pthread_cond_signal(&pool->done);
        pthread_mutex_unlock(&pool->lock);
        look_for_round(pool, round);
        pthread_mutex_lock(&pool->lock);
    }
    pthread_mutex_unlock(&pool->lock);
    return NULL;
}

static unsigned processors(void)
{
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set))
        return 1;
    return (unsigned)CPU_COUNT(&set);
}

struct pool *pool_create(unsigned threads, pool_create_thread *create, struct error *error)
{
    if (!threads)
        threads = processors();
    if (threads > POOL_THREADS_MAXIMUM)
        threads = POOL_THREADS_MAXIMUM;
    struct pool *pool = calloc(1, sizeof *pool + threads * sizeof *pool->worker);
    if (!pool) {
        error_set(error, "out of memory for %u threads", threads);
        return NULL;
    }
    pthread_mutex_init(&pool->lock, NULL);
    pthread_cond_init(&pool->start, NULL);
    pthread_cond_init(&pool->done, NULL);
    if (!create)
        create = pthread_create;
    for (pool->workers = 1; pool->workers < threads; pool->workers++) {
        struct pool_worker *worker = pool->worker + pool->workers;
        worker->pool = pool;
        worker->number = pool->workers;
        if (create(&worker->thread, NULL, work, worker))
            break;
    }
    pool->limit = pool->workers;
    pool->looks = pool->workers <= processors() ? LOOKS : 0;
    return pool;
}

void pool_destroy(struct pool *pool)
{
    if (!pool)
        return;
    pthread_mutex_lock(&pool->lock);
    pool->leaving = true;
    pthread_cond_broadcast(&pool->start);
    pthread_mutex_unlock(&pool->lock);
    for (unsigned i = 1; i < pool->workers; i++)
        pthread_join(pool->worker[i].thread, NULL);
    pthread_cond_destroy(&pool->done);
    pthread_cond_destroy(&pool->start);
    pthread_mutex_destroy(&pool->lock);
    free(pool);
}

unsigned pool_workers(const struct pool *pool)
{
    return pool->workers;
}

void pool_limit(struct pool *pool, unsigned workers)
{
    pool->limit = workers && workers < pool->workers ? workers : pool->workers;
}

void pool_run(struct pool *pool, unsigned workers, pool_task *task, void *user)
{
    if (workers > pool->limit)
        workers = pool->limit;
    if (workers > 1) {
        pthread_mutex_lock(&pool->lock);
        pool->task = task;
        pool->user = user;
        pool->wanted = workers;
        pool->running = workers - 1;
        pool->round++;
        pthread_cond_broadcast(&pool->start);
        pthread_mutex_unlock(&pool->lock);
    }
    run_in_contract(task, user, 0);
    if (workers > 1) {
        look_for_end(pool);
        pthread_mutex_lock(&pool->lock);
        while (pool->running)
            pthread_cond_wait(&pool->done, &pool->lock);
        pthread_mutex_unlock(&pool->lock);
    }
}
