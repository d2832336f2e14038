#define _GNU_SOURCE
#include "render/queue/pool.h"

#include "machine/mxcsr.h"
#include "machine/thread.h"

#include <emmintrin.h>
#include <errno.h>
#include <sched.h>
#include <semaphore.h>
#include <stdalign.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 64 };

/* The gate of the rounds, in one word: the round's number, how many more may enter, how many are inside. */
enum { PLACE_SHIFT = 16, ROUND_SHIFT = 32 };
#define PLACES ((uint64_t)0xffff << PLACE_SHIFT)
#define INSIDE ((uint64_t)0xffff)

struct pool_worker {
    alignas(LINE) _Atomic bool asleep; /* or about to be; the thread that clears it posts `wake` */
    sem_t wake;
    struct pool *pool;
    unsigned number;
    uint32_t round; /* the last that it took part in */
    pthread_t thread;
};

/* A condition that a worker waits for. */
typedef bool pool_condition(const struct pool *pool, const struct pool_worker *self);

struct pool {
    alignas(LINE) _Atomic uint64_t gate; /* polled by threads that look for work */

    /* The round; written while no worker is inside and none may enter. */
    alignas(LINE) pool_task *task;
    void *user;
    _Atomic unsigned leader;  /* the worker whose round it is */
    bool open;                /* or was; the leader's */
    _Atomic bool waking;      /* sleeping threads are to be woken */
    _Atomic unsigned to_wake; /* the next worker to be looked at for that */

    alignas(LINE) _Atomic bool started; /* the task in the background, and has not ended */
    pool_task *background;
    void *background_user;

    alignas(LINE) _Atomic bool leaving;
    _Atomic unsigned limit;
    unsigned workers;
    unsigned looks;
    _Atomic uint64_t wakes;
    struct pool_worker worker[]; /* worker 0 is the device's thread */
};

/* The worker that runs what is started. */
enum { BACKGROUND_WORKER = 1 };

static void run_in_contract(pool_task *task, void *user, unsigned worker)
{
    unsigned saved = mxcsr_enter();
    task(user, worker);
    mxcsr_leave(saved);
}

/* --- Sleeping and waking ---
 *
 * A thread that goes to sleep sets its flag and then checks its condition once more. A thread that wakes
 * others changes the condition and then checks their flags. All threads observe both orders (sequential
 * consistency), so at least one of the two finds the other. */

static void sleep_until_woken(struct pool_worker *self)
{
    while (sem_wait(&self->wake) && errno == EINTR)
        ;
}

static void wait_for(struct pool *pool, struct pool_worker *self, pool_condition *met)
{
    for (unsigned i = 0; i < pool->looks; i++) {
        if (met(pool, self))
            return;
        _mm_pause();
    }
    for (;;) {
        self->asleep = true;
        bool is_met = met(pool, self);
        /* A thread that was woken meanwhile consumes the post. */
        if (!is_met || !atomic_exchange(&self->asleep, false))
            sleep_until_woken(self);
        if (is_met)
            return;
    }
}

static bool wake(struct pool *pool, unsigned number)
{
    struct pool_worker *worker = pool->worker + number;
    if (!worker->asleep || !atomic_exchange(&worker->asleep, false))
        return false;
    atomic_fetch_add_explicit(&pool->wakes, 1, memory_order_relaxed);
    sem_post(&worker->wake);
    return true;
}

/* Wakes two that sleep, if the round has places for them. */
static void wake_two(struct pool *pool)
{
    for (int woken = 0; woken < 2 && pool->waking && pool->gate & PLACES;) {
        unsigned number = atomic_fetch_add(&pool->to_wake, 1);
        if (number >= pool->limit)
            return;
        woken += wake(pool, number);
    }
}

/* --- Rounds --- */

static uint32_t round_of(uint64_t gate)
{
    return (uint32_t)(gate >> ROUND_SHIFT);
}

/* Returns true if there is a round that the worker may enter and has not entered. */
static bool may_enter(const struct pool *pool, const struct pool_worker *self)
{
    uint64_t gate = pool->gate;
    return gate & PLACES && round_of(gate) != self->round && self->number < pool->limit;
}

static bool enter(struct pool *pool, struct pool_worker *self)
{
    uint64_t gate = pool->gate;
    do
        if (!(gate & PLACES) || round_of(gate) == self->round || self->number >= pool->limit)
            return false;
    while (!atomic_compare_exchange_weak(&pool->gate, &gate, gate - ((uint64_t)1 << PLACE_SHIFT) + 1));
    self->round = round_of(gate);
    return true;
}

static void leave(struct pool *pool)
{
    unsigned leader = pool->leader; /* another's, once the last has left */
    uint64_t gate = atomic_fetch_sub(&pool->gate, 1) - 1;
    if (!(gate & (PLACES | INSIDE)))
        wake(pool, leader);
}

static void take_part(struct pool *pool, struct pool_worker *self)
{
    if (!enter(pool, self))
        return;
    wake_two(pool);
    run_in_contract(pool->task, pool->user, self->number);
    leave(pool);
}

static bool everybody_left(const struct pool *pool, const struct pool_worker *self)
{
    (void)self;
    return !(pool->gate & INSIDE);
}

/* The number of workers besides the caller in a round of `workers`. */
static unsigned others(const struct pool *pool, unsigned workers)
{
    unsigned limit = pool->limit;
    workers = workers < limit ? workers : limit;
    return workers ? workers - 1 : 0;
}

/* From now on `places` workers may join the round. */
static void open_round(struct pool *pool, uint64_t places)
{
    struct pool_worker *self = pool->worker + pool->leader;
    pool->open = true;
    pool->to_wake = 0;
    self->round = round_of(pool->gate) + 1;
    pool->gate = (uint64_t)self->round << ROUND_SHIFT | places << PLACE_SHIFT;
}

void pool_call(struct pool *pool, unsigned workers)
{
    uint64_t places = others(pool, workers);
    if (!places || pool->waking)
        return;
    pool->waking = true;
    if (!pool->open)
        open_round(pool, places);
    wake_two(pool);
}

/* A round for the caller only does not write the gate, which other threads poll. */
void pool_run(struct pool *pool, unsigned worker, unsigned workers, enum pool_call call, pool_task *task,
              void *user)
{
    uint64_t places = others(pool, workers);
    pool->task = task;
    pool->user = user;
    pool->leader = worker;
    pool->open = false;
    pool->waking = false;
    if (call == POOL_ALL)
        pool_call(pool, workers);
    else if (call == POOL_AWAKE && places)
        open_round(pool, places);
    run_in_contract(task, user, worker);
    if (!pool->open)
        return;
    atomic_fetch_and(&pool->gate, ~PLACES);
    wait_for(pool, pool->worker + worker, everybody_left);
}

/* --- The background --- */

static bool helps_or_ends(const struct pool *pool, const struct pool_worker *self)
{
    return !pool->started || may_enter(pool, self);
}

void pool_start(struct pool *pool, pool_task *task, void *user)
{
    pool->background = task;
    pool->background_user = user;
    pool->started = true;
    wake(pool, BACKGROUND_WORKER);
}

bool pool_is_busy(const struct pool *pool)
{
    return pool->started;
}

void pool_wait(struct pool *pool)
{
    struct pool_worker *self = pool->worker;
    while (pool->started) {
        wait_for(pool, self, helps_or_ends);
        take_part(pool, self);
    }
}

static bool is_started(const struct pool *pool, const struct pool_worker *self)
{
    return self->number == BACKGROUND_WORKER && pool->started;
}

static void run_background(struct pool *pool, const struct pool_worker *self)
{
    run_in_contract(pool->background, pool->background_user, self->number);
    pool->started = false;
    wake(pool, 0);
}

/* --- Workers --- */

static bool is_wanted(const struct pool *pool, const struct pool_worker *self)
{
    return pool->leaving || is_started(pool, self) || may_enter(pool, self);
}

static void *work(void *argument)
{
    struct pool_worker *self = argument;
    struct pool *pool = self->pool;
    for (;;) {
        wait_for(pool, self, is_wanted);
        if (is_started(pool, self))
            run_background(pool, self);
        else if (pool->leaving)
            return NULL;
        else
            take_part(pool, self);
    }
}

static unsigned processors(void)
{
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set))
        return 1;
    return (unsigned)CPU_COUNT(&set);
}

static void create_worker(struct pool *pool, unsigned number)
{
    struct pool_worker *worker = pool->worker + number;
    worker->pool = pool;
    worker->number = number;
    sem_init(&worker->wake, 0, 0);
}

/* Workers find what the pool is made with from the beginning, but for how many of them there will be. */
struct pool *pool_create(unsigned threads, pool_create_thread *create, struct error *error)
{
    if (!threads)
        threads = processors();
    if (threads > POOL_THREADS_MAXIMUM)
        threads = POOL_THREADS_MAXIMUM;
    size_t bytes = sizeof(struct pool) + threads * sizeof(struct pool_worker);
    struct pool *pool = aligned_alloc(LINE, bytes);
    if (!pool) {
        error_set(error, "out of memory for %u threads", threads);
        return NULL;
    }
    memset(pool, 0, bytes);
    pool->looks = threads <= processors() ? POOL_LOOKS : 0;
    pool->limit = 1;
    for (unsigned i = 0; i < threads; i++)
        create_worker(pool, i);
    if (!create)
        create = pthread_create;
    for (pool->workers = 1; pool->workers < threads; pool->workers++) {
        struct pool_worker *worker = pool->worker + pool->workers;
        if (create(&worker->thread, thread_attributes(), work, worker))
            break;
    }
    pool->limit = pool->workers;
    return pool;
}

void pool_destroy(struct pool *pool)
{
    if (!pool)
        return;
    pool->leaving = true;
    for (unsigned i = 1; i < pool->workers; i++)
        wake(pool, i);
    for (unsigned i = 1; i < pool->workers; i++)
        pthread_join(pool->worker[i].thread, NULL);
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

unsigned pool_limited(const struct pool *pool)
{
    return pool->limit;
}

uint64_t pool_wakes(const struct pool *pool)
{
    return pool->wakes;
}
