/* How many times the values of one sample are those of another, with an interval of 95 % confidence: the test
 * of Mann and Whitney (1947), turned into an interval as Hodges and Lehmann (1963) do.
 *
 * Each value of `a` is divided by each value of `b`. The result is the median of these quotients. The
 * interval is from the quotient of rank k from below to that of rank k from above. Mann and Whitney's
 * two-sided test of level 5 % finds a difference exactly if 1 is outside of it. k depends only on the numbers
 * of values, so nothing is random. No distribution is assumed, and a few disturbed values hardly change the
 * result. */
#ifndef COMMAND_BENCH_INTERVAL_H
#define COMMAND_BENCH_INTERVAL_H

#include <stdbool.h>
#include <stddef.h>

struct interval {
    double times;     /* 0: a sample has no values, or one that is not positive */
    double low, high; /* 0: there are too few values for this confidence, at least 4 and 4, or 3 and 5 */
};

/* The method as reports name it. */
extern const char interval_method[];

/* Computes the interval for positive values. Returns 0, or -1 if memory is short. */
int interval_of(const double *a, size_t a_count, const double *b, size_t b_count, struct interval *interval);

/* For tests: the rank k; 0: there is none. It is that of the exact distribution for up to 50 values each, of
 * the normal one for more. */
size_t interval_rank(size_t a_count, size_t b_count);

/* Returns true if the interval excludes 1. */
bool interval_shows_difference(const struct interval *interval);

/* Returns `less` or `greater` for what the values of the first sample are, "no difference shown", or "too few
 * runs"; "-" without a result. */
const char *interval_verdict(const struct interval *interval, const char *less, const char *greater);

#endif
