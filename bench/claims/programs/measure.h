/* Times of loops in the programs of bench/claims/programs. */
#ifndef CLAIMS_PROGRAMS_MEASURE_H
#define CLAIMS_PROGRAMS_MEASURE_H

#include <time.h>

/* Processor time of this thread, in ns. */
static inline double measure_now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e9 * (double)time.tv_sec + (double)time.tv_nsec;
}

/* The least of several times of `loop(data)`, in ns: a disturbance only makes a loop slower. */
static inline double measure_least(void (*loop)(void *), void *data)
{
    double least = 1e30;
    for (int attempt = 0; attempt < 9; attempt++) {
        double start = measure_now();
        loop(data);
        double time = measure_now() - start;
        if (time < least)
            least = time;
    }
    return least;
}

#endif
