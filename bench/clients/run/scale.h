/* Speed on several threads: each processes an input of its own, with one kernel. */
#ifndef CLIENTS_RUN_SCALE_H
#define CLIENTS_RUN_SCALE_H

#include "bench/clients/run/work.h"

enum { SCALE_THREADS = 2 };

/* Runs `work[0]` to `work[count - 1]`, equal jobs with memory of their own, on as many threads. They begin
 * together. Returns the wall time of a run in ns for each byte of all inputs: with twice the threads, half of
 * it is perfect scaling. Each thread repeats its run until it takes about `seconds`, by `run_seconds`, the
 * time of one run; the result is the least of several such times. `kernel` is null for plain C. */
double scale_measure(struct work *const *work, unsigned count, enum way way, const struct kernel *kernel,
                     double run_seconds, double seconds);

#endif
