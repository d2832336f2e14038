#include "bench/clients/run/scale.h"

#include "base/clock.h"

#include <pthread.h>

enum { REPETITIONS = 5 };

struct runner {
    struct work *work;
    enum way way;
    const struct kernel *kernel;
    unsigned runs;
    pthread_barrier_t *start, *end;
};

static void *run(void *argument)
{
    const struct runner *runner = argument;
    pthread_barrier_wait(runner->start);
    for (unsigned i = 0; i < runner->runs; i++)
        runner->work->run(runner->work, runner->way, runner->kernel);
    pthread_barrier_wait(runner->end);
    return NULL;
}

/* Returns the seconds from the start of the first thread to the end of the last. */
static double run_together(const struct runner *runner, unsigned count)
{
    pthread_barrier_t start, end;
    pthread_t thread[SCALE_THREADS];
    struct runner runners[SCALE_THREADS];
    if (pthread_barrier_init(&start, NULL, count + 1) || pthread_barrier_init(&end, NULL, count + 1))
        work_fail("no barrier for threads");
    for (unsigned i = 0; i < count; i++) {
        runners[i] = runner[i];
        runners[i].start = &start;
        runners[i].end = &end;
        if (pthread_create(&thread[i], NULL, run, &runners[i]))
            work_fail("a thread does not start");
    }
    double begin = clock_seconds();
    pthread_barrier_wait(&start);
    pthread_barrier_wait(&end);
    double seconds = clock_seconds() - begin;
    for (unsigned i = 0; i < count; i++)
        pthread_join(thread[i], NULL);
    pthread_barrier_destroy(&start);
    pthread_barrier_destroy(&end);
    return seconds;
}

double scale_measure(struct work *const *work, unsigned count, enum way way, const struct kernel *kernel,
                     double run_seconds, double seconds)
{
    const unsigned runs = run_seconds < seconds ? (unsigned)(seconds / run_seconds) + 1 : 1;
    struct runner runner[SCALE_THREADS];
    double least = 1e30;
    for (unsigned i = 0; i < count; i++)
        runner[i] = (struct runner){.work = work[i], .way = way, .kernel = kernel, .runs = runs};
    for (int n = 0; n < REPETITIONS; n++) {
        double time = run_together(runner, count);
        least = time < least ? time : least;
    }
    return least * 1e9 / runs / count / (double)work[0]->bytes;
}
