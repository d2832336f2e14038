/* Repeated measurements of one quantity, and what is reported of them.
 *
 * The median and the median absolute deviation: neither moves when a few measurements are disturbed by
 * whatever else the machine does. */
#ifndef TOOL_SAMPLE_H
#define TOOL_SAMPLE_H

#include <stddef.h>

struct summary {
    size_t count; /* 0: all others are 0 */
    double median, least, most, deviation, p10, p90, p99;
};

/* Sorts `values`. The median of an even number is the mean of the middle two; p99 is the smallest value that
 * at least 99 of 100 do not exceed (nearest rank), p10 and p90 likewise; deviation is the median of |value -
 * median|. */
struct summary summarize(double *values, size_t count);

#endif
