/* Background work: one thread of the process executes jobs from a queue of bounded length.
 *
 * The thread exists only while there are users. If the system refuses the thread, or if the queue is full,
 * jobs are not accepted. After a fork, the child has no thread and an empty queue; a fork waits for the
 * running job. */
#ifndef ENGINES_TIERED_BACKGROUND_H
#define ENGINES_TIERED_BACKGROUND_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>

enum { BACKGROUND_QUEUE = 4096 };

enum job_state {
    JOB_IDLE,   /* not accepted, or not requested */
    JOB_QUEUED, /* or running */
    JOB_DONE
};

/* A job that is zero except for `work` is idle. Its address must not change until it is cancelled or done. */
struct background_job {
    void (*work)(struct background_job *);
    _Atomic(enum job_state) state;
    struct background_job *previous, *next;
};

/* Adds and removes a user. A user has no jobs left when it is removed. */
void background_begin(void);
void background_end(void);

/* Queues a job that is idle or done. If there is no thread or no room, its state does not change. */
void background_request(struct background_job *job);

/* Returns true if an idle job would be accepted. The answer may be outdated. */
bool background_accepts(void);

/* Removes the job from the queue, or waits for its end if it is running. */
void background_cancel(struct background_job *job);

/* Waits until a queued job is done. */
void background_wait(struct background_job *job);

/* Lock and unlock the queue. A fork waits for the lock. For data that users share with the thread, whose jobs
 * run without the lock. */
void background_lock(void);
void background_unlock(void);

/* Replaces pthread_create, for tests; null restores it. */
typedef int background_create_thread(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
/* For tests: a thread that they start themselves. */
void background_create_with(background_create_thread *create);

#endif
