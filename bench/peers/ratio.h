/* Rates, times and ratios of the measurements. A ratio is the speed of the first renderer divided by that of
 * the second; above 1 the first is faster. It is computed for each pass, and stored as median, minimum and
 * maximum. */
#ifndef BENCH_PEERS_RATIO_H
#define BENCH_PEERS_RATIO_H

#include "drive.h"

/* By enum rate: "Mpix/s", "Mtri/s", "kdraw/s", "ms". */
extern const char *const ratio_unit[];

struct ratio {
    double median, least, most; /* 0: not known */
};

/* The clock of the reported times: the run's for one core, wall time for all. */
enum clocks ratio_clock(const struct run *run, enum cores cores);

/* The number of the renderer with that name and cores; -1 if the run has none. */
int ratio_find(const struct run *run, const char *name, enum cores cores);

/* The median time in milliseconds; 0 if not measured. */
double ratio_median_ms(const struct cell *cell, enum clocks clock);

/* The workload's rate, or its time in milliseconds where enum rate is MS; 0 if not measured. */
double ratio_value(const struct workload *workload, const struct cell *cell, enum clocks clock);

/* The ratio of the speed of renderer `first` to that of `second` on workload `w`; either may be -1. */
struct ratio ratio_between(const struct run *run, unsigned w, int first, int second);

/* The ratio of the speed of renderer `all`, on all cores, to that of the same renderer on one core, by wall
 * time. */
struct ratio ratio_speed_up(const struct run *run, unsigned w, unsigned all);

/* Returns true if the workload ends before its pixels can have been written: the renderer defers the work. */
bool ratio_is_deferred(const struct workload *workload, const struct cell *cell, enum clocks clock);

/* The fastest peer whose picture agrees and that does not defer the work; -1 if there is none. */
int ratio_best_peer(const struct run *run, unsigned w, enum cores cores);

/* The percentage of the machine's limit (limits.c) that a renderer reaches; 0 if the workload has none. */
double ratio_of_limit(const struct workload *workload, const struct cell *cell, enum clocks clock);

#endif
