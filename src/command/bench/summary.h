/* Repeated measurements of one quantity, summarized.
 *
 * The median and the median absolute deviation hardly move when other work disturbs a few measurements. */
#ifndef COMMAND_BENCH_SUMMARY_H
#define COMMAND_BENCH_SUMMARY_H

#include <stddef.h>

struct summary {
    size_t count; /* 0: all others are 0 */
    double median, least, most, deviation, p10, p90, p99;
};

/* Sorts `values`. The median of an even count is the mean of the middle two. p10, p90 and p99 are the
 * smallest values that at least 10, 90 and 99 of 100 do not exceed (nearest rank). deviation is the median of
 * |value - median|. */
struct summary summary_of(double *values, size_t count);

/* Returns the largest sum of `width` consecutive values, or of all if there are fewer. None is negative. */
double summary_window(const double *values, size_t count, size_t width);

#endif
