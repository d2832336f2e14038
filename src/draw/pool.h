/* A pool of threads that runs one task at a time on several of them and waits until all are done.
 *
 * The caller's thread is one of them (worker 0). Tasks share out their work by themselves, by atomic
 * counters; they run in the floating-point environment of the numeric contract, whatever the caller's is. */
#ifndef DRAW_POOL_H
#define DRAW_POOL_H

#include "base/error.h"

#include <pthread.h>

struct pool;

typedef void pool_task(void *user, unsigned worker);

/* What may refuse: as pthread_create; tests replace it. */
typedef int pool_create_thread(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);

enum { POOL_THREADS_MAXIMUM = 256 };

/* A pool of up to `threads` workers, the caller's included; 0: as many as processors the process may run on.
 * When the system refuses threads there are fewer. `create` may be null: pthread_create. Null with the reason
 * when memory is short. */
struct pool *pool_create(unsigned threads, pool_create_thread *create, struct error *error);
void pool_destroy(struct pool *pool);

unsigned pool_workers(const struct pool *pool);

/* From now on tasks run on no more than so many; 0: on all. */
void pool_limit(struct pool *pool, unsigned workers);

/* Runs task(user, i) for workers i below `workers` (clamped to 1 and the pool's size), returns when all have.
 */
void pool_run(struct pool *pool, unsigned workers, pool_task *task, void *user);

#endif
