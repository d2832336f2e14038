#include "engines/tiered/background.h"
#include "machine/thread.h"

#include <signal.h>
#include <stddef.h>

/* `life` protects the creation and end of the thread, `lock` the queue. `life` is locked before `lock`. */
static struct background {
    pthread_mutex_t life, lock;
    pthread_cond_t work; /* the queue is not empty, or `leaving` is set */
    pthread_cond_t done; /* the running job is done */
    unsigned users;
    pthread_t thread;
    atomic_bool exists; /* the thread; changed under both locks */
    bool leaving, waits;
    struct background_job *first, *last, *running;
    atomic_uint queued;
    background_create_thread *create;
} background = {
    .life = PTHREAD_MUTEX_INITIALIZER,
    .lock = PTHREAD_MUTEX_INITIALIZER,
    .work = PTHREAD_COND_INITIALIZER,
    .done = PTHREAD_COND_INITIALIZER,
};

static struct background *const b = &background;

/* --- The queue, under its lock
 * --------------------------------------------------------------------------------- */

static void append(struct background_job *job)
{
    job->previous = b->last;
    job->next = NULL;
    if (b->last)
        b->last->next = job;
    else
        b->first = job;
    b->last = job;
    b->queued++;
}

static void unlink_job(struct background_job *job)
{
    if (job->previous)
        job->previous->next = job->next;
    else
        b->first = job->next;
    if (job->next)
        job->next->previous = job->previous;
    else
        b->last = job->previous;
    b->queued--;
}

static void set_state(struct background_job *job, enum job_state state)
{
    atomic_store_explicit(&job->state, state, memory_order_release);
}

static enum job_state state_of(struct background_job *job)
{
    return atomic_load_explicit(&job->state, memory_order_acquire);
}

/* --- The thread
 * ------------------------------------------------------------------------------------------------ */

static struct background_job *next_job(void)
{
    while (!b->first && !b->leaving) {
        b->waits = true;
        pthread_cond_wait(&b->work, &b->lock);
        b->waits = false;
    }
    struct background_job *job = b->leaving ? NULL : b->first;
    if (job)
        unlink_job(job);
    return b->running = job;
}

static void *work(void *unused)
{
    (void)unused;
    pthread_mutex_lock(&b->lock);
    for (struct background_job *job; (job = next_job());) {
        pthread_mutex_unlock(&b->lock);
        job->work(job);
        pthread_mutex_lock(&b->lock);
        set_state(job, JOB_DONE);
        b->running = NULL;
        pthread_cond_broadcast(&b->done);
    }
    pthread_mutex_unlock(&b->lock);
    return NULL;
}

/* All signals are blocked: they belong to the threads of the application. */
static void start(void)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    background_create_thread *create = b->create ? b->create : pthread_create;
    bool exists = !create(&b->thread, thread_attributes(), work, NULL);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    pthread_mutex_lock(&b->lock);
    b->exists = exists;
    pthread_mutex_unlock(&b->lock);
}

static void stop(void)
{
    pthread_mutex_lock(&b->lock);
    b->exists = false;
    b->leaving = true;
    pthread_cond_signal(&b->work);
    pthread_mutex_unlock(&b->lock);
    pthread_join(b->thread, NULL);
    b->leaving = false;
}

/* --- Forking
 * ---------------------------------------------------------------------------------------------------- */

static void before_fork(void)
{
    pthread_mutex_lock(&b->life);
    pthread_mutex_lock(&b->lock);
    while (b->running)
        pthread_cond_wait(&b->done, &b->lock);
}

static void after_fork_in_parent(void)
{
    pthread_mutex_unlock(&b->lock);
    pthread_mutex_unlock(&b->life);
}

static void after_fork_in_child(void)
{
    while (b->first) {
        set_state(b->first, JOB_IDLE);
        unlink_job(b->first);
    }
    b->exists = b->waits = false;
    pthread_cond_init(&b->work, NULL);
    pthread_cond_init(&b->done, NULL);
    after_fork_in_parent();
}

static void watch_forks(void)
{
    pthread_atfork(before_fork, after_fork_in_parent, after_fork_in_child);
}

/* --- For users
 * ---------------------------------------------------------------------------------------------------- */

void background_begin(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, watch_forks);
    pthread_mutex_lock(&b->life);
    b->users++;
    if (!b->exists)
        start();
    pthread_mutex_unlock(&b->life);
}

void background_end(void)
{
    pthread_mutex_lock(&b->life);
    if (!--b->users && b->exists)
        stop();
    pthread_mutex_unlock(&b->life);
}

bool background_accepts(void)
{
    return b->exists && b->queued < BACKGROUND_QUEUE;
}

void background_request(struct background_job *job)
{
    pthread_mutex_lock(&b->lock);
    if (background_accepts() && state_of(job) != JOB_QUEUED) {
        set_state(job, JOB_QUEUED);
        append(job);
        if (b->waits)
            pthread_cond_signal(&b->work);
    }
    pthread_mutex_unlock(&b->lock);
}

void background_cancel(struct background_job *job)
{
    pthread_mutex_lock(&b->lock);
    if (state_of(job) == JOB_QUEUED && b->running != job) {
        unlink_job(job);
        set_state(job, JOB_IDLE);
    }
    while (b->running == job)
        pthread_cond_wait(&b->done, &b->lock);
    pthread_mutex_unlock(&b->lock);
}

void background_wait(struct background_job *job)
{
    if (state_of(job) != JOB_QUEUED)
        return;
    pthread_mutex_lock(&b->lock);
    while (state_of(job) == JOB_QUEUED)
        pthread_cond_wait(&b->done, &b->lock);
    pthread_mutex_unlock(&b->lock);
}

void background_lock(void)
{
    pthread_mutex_lock(&b->lock);
}

void background_unlock(void)
{
    pthread_mutex_unlock(&b->lock);
}

void background_create_with(background_create_thread *create)
{
    pthread_mutex_lock(&b->life);
    b->create = create;
    pthread_mutex_unlock(&b->life);
}
