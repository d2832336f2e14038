/* A pool of threads that run one task at a time, each as one of several workers, and a task in the
 * background.
 *
 * Rounds. The caller of pool_run runs the task, and so does every worker that joins before the task has
 * ended. The round ends when all workers that joined have returned; late workers are ignored. So a round
 * costs its caller little more than the task when the other threads sleep. Tasks divide their work among the
 * workers themselves, with atomic counters, and all work is done when a call of the task returns. The caller
 * chooses how many threads are invited and whether sleeping ones are woken, because waking a thread takes
 * about as long as a small draw. More threads can be invited in the middle of a round.
 *
 * The background. One worker runs a task that has rounds of its own, while the device's thread does something
 * else. When the device's thread waits for that task, it joins these rounds as a worker.
 *
 * Waiting. A waiting thread polls for some microseconds, because the next round usually follows soon, and
 * then sleeps on its own semaphore. There are no locks. A thread wakes two others, and each of them two more,
 * so that waking n threads takes about log n steps.
 *
 * The device's thread is worker 0. Tasks run in the floating-point environment of the numeric contract. */
#ifndef RENDER_QUEUE_POOL_H
#define RENDER_QUEUE_POOL_H

#include "base/error.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

struct pool;

typedef void pool_task(void *user, unsigned worker);

/* The function that creates threads and may fail: pthread_create, or a replacement in tests. */
typedef int pool_create_thread(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);

enum { POOL_THREADS_MAXIMUM = 256 };

/* The number of times that a waiting thread polls before it sleeps, where each thread has a processor: a
 * few tens of microseconds at most, about the time that a sleeping thread needs to wake up. */
enum { POOL_LOOKS = 1000 };

/* A pool of up to `threads` workers, including the device's thread; 0: one for each processor that the
 * process may run on. It has fewer when the system refuses threads. `create` may be null: pthread_create.
 * Null with the reason when memory is short. */
struct pool *pool_create(unsigned threads, pool_create_thread *create, struct error *error);
/* Nothing runs in the background. */
void pool_destroy(struct pool *pool);

unsigned pool_workers(const struct pool *pool);

/* From now on tasks run on at most `workers` workers; 0: on all. Nothing may run in the background. */
void pool_limit(struct pool *pool, unsigned workers);
/* The number of workers that may run a task. */
unsigned pool_limited(const struct pool *pool);

/* The threads that are invited to a round. */
enum pool_call {
    POOL_ALONE, /* none */
    POOL_AWAKE, /* those that poll */
    POOL_ALL    /* all; sleeping ones are woken */
};

/* Runs task(user, worker) as this worker and as up to workers - 1 others (clamped to the limit). Returns
 * when all that have joined have returned. */
void pool_run(struct pool *pool, unsigned worker, unsigned workers, enum pool_call call, pool_task *task,
              void *user);

/* Called within the task of pool_run, by the worker that called pool_run: invites up to workers - 1 others
 * in all, and wakes those that sleep. */
void pool_call(struct pool *pool, unsigned workers);

/* Runs task(user, worker) as another worker until pool_wait. That worker may call pool_run. The limit must
 * allow other workers. */
void pool_start(struct pool *pool, pool_task *task, void *user);
/* Returns true while the background task runs. */
bool pool_is_busy(const struct pool *pool);
/* Helps until the background task has ended; returns immediately if there is none. */
void pool_wait(struct pool *pool);

/* The number of times that a sleeping worker was woken, since the pool was created. For tests: the number of
 * wake-ups. */
uint64_t pool_wakes(const struct pool *pool);

#endif
