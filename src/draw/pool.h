/* A pool of threads that run one task at a time, each as one of several workers, and a task in the background.
 *
 * Rounds. Who calls pool_run runs the task, and whoever of the other workers gets there before it has ended runs it too;
 * then all that began are waited for. Nobody waits for a worker that comes too late: a round costs its caller little
 * more than the task when the others sleep. So tasks share out their work by themselves, by atomic counters, and nothing
 * is left to do where a call of the task ends. How many threads are asked, and whether those that sleep are woken, is
 * the caller's choice, because waking one costs as much as drawing something small; more can be asked in the middle of
 * the round.
 *
 * The background. One worker runs a task that has rounds of its own while the device's thread does something else,
 * until that thread waits for it, and is one of the workers in these rounds meanwhile.
 *
 * Waiting. Who waits looks for some microseconds, because the next round is mostly that near, then sleeps on a
 * semaphore of his own. Nobody takes a lock. Who wakes others wakes two, and each of them two more, so that it takes few
 * steps however many there are.
 *
 * The device's thread is worker 0. Tasks run in the floating-point environment of the numeric contract, whatever
 * the caller's is. */
#ifndef DRAW_POOL_H
#define DRAW_POOL_H

#include "base/error.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

struct pool;

typedef void pool_task(void *user, unsigned worker);

/* What may refuse: as pthread_create; tests replace it. */
typedef int pool_create_thread(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);

enum { POOL_THREADS_MAXIMUM = 256 };

/* A pool of up to `threads` workers, the device's thread included; 0: as many as processors the process may run on.
 * When the system refuses threads there are fewer. `create` may be null: pthread_create. Null with the reason
 * when memory is short. */
struct pool *pool_create(unsigned threads, pool_create_thread *create, struct error *error);
/* Nothing runs in the background. */
void pool_destroy(struct pool *pool);

unsigned pool_workers(const struct pool *pool);

/* From now on tasks run on no more than so many; 0: on all. Nothing runs in the background. */
void pool_limit(struct pool *pool, unsigned workers);
/* How many may run one. */
unsigned pool_limited(const struct pool *pool);

/* Who is asked to take part in a round. */
enum pool_call {
    POOL_ALONE, /* nobody */
    POOL_AWAKE, /* who waits and does not sleep yet */
    POOL_ALL    /* who sleeps is woken */
};

/* Runs task(user, worker) as that worker, which the caller is, and as up to workers - 1 others (clamped to the limit);
 * returns when all that began have ended. */
void pool_run(struct pool *pool, unsigned worker, unsigned workers, enum pool_call call, pool_task *task,
              void *user);

/* From within the task of pool_run, by the worker that called it: asks up to workers - 1 others in all, those that sleep
 * too. */
void pool_call(struct pool *pool, unsigned workers);

/* Runs task(user, worker) as another worker, which may call pool_run, until pool_wait. There are others, within the limit.
 */
void pool_start(struct pool *pool, pool_task *task, void *user);
/* Returns when it has ended, at once if there is none, and helps until then. */
void pool_wait(struct pool *pool);

/* How often a worker that slept was woken, since the pool was made. */
uint64_t pool_wakes(const struct pool *pool);

#endif
