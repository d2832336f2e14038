/* Work in the background: one thread of the process, for which jobs wait in a queue of bounded length.
 *
 * The thread is made when somebody may have work for it, and is gone when nobody may have any more: no thread outlives its
 * users. Where the system refuses it, or the queue is full, a job is simply not accepted. After a fork the child has
 * no thread and an empty queue; forking waits for the job that is being done. */
#ifndef TIERED_BACKGROUND_H
#define TIERED_BACKGROUND_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>

enum { BACKGROUND_QUEUE = 4096 };

enum job_state {
    JOB_IDLE,   /* not accepted, or not yet asked for */
    JOB_QUEUED, /* or being done */
    JOB_DONE
};

/* Zero but for `work` is one that is idle. It stays where it is until it is cancelled or done. */
struct background_job {
    void (*work)(struct background_job *);
    _Atomic(enum job_state) state;
    struct background_job *previous, *next;
};

/* One more, and one less, who may have jobs; of who ends none may be left. */
void background_begin(void);
void background_end(void);

/* Queues an idle job, unless there is no thread or no room: then it stays idle. */
void background_ask(struct background_job *job);

/* Whether an idle job had a chance; the answer may be old. */
bool background_accepts(void);

/* Returns when the job is not queued and not being done: taken back if it had not begun. */
void background_cancel(struct background_job *job);

/* Returns when the job is not queued and not being done: done if it was queued. */
void background_wait(struct background_job *job);

/* What may refuse, for tests: as pthread_create; null is pthread_create. */
typedef int background_create_thread(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
void background_create_with(background_create_thread *create);

#endif
