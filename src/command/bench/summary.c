#include "command/bench/summary.h"

#include <math.h>
#include <stdlib.h>

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double middle(const double *sorted, size_t count)
{
    return (sorted[(count - 1) / 2] + sorted[count / 2]) / 2;
}

/* The distances grow to both sides of the median, so the smallest ones are merged from its place outwards
 * until the middle one, or two, have been met. */
static double median_distance(const double *sorted, size_t count, double median)
{
    size_t above = 0;
    while (above < count && sorted[above] < median)
        above++;
    size_t below = above;
    double last = 0, before_last = 0;
    for (size_t i = 0; i <= count / 2; i++) {
        double down = below > 0 ? median - sorted[below - 1] : INFINITY;
        double up = above < count ? sorted[above] - median : INFINITY;
        before_last = last;
        last = fmin(down, up);
        if (down < up)
            below--;
        else
            above++;
    }
    return count % 2 ? last : (before_last + last) / 2;
}

/* The nearest rank. */
static double percentile(const double *sorted, size_t count, size_t percent)
{
    return sorted[(count * percent + 99) / 100 - 1];
}

struct summary summary_of(double *values, size_t count)
{
    if (!count)
        return (struct summary){0};
    qsort(values, count, sizeof *values, ascending);
    double median = middle(values, count);
    return (struct summary){
        .count = count,
        .median = median,
        .least = values[0],
        .most = values[count - 1],
        .deviation = median_distance(values, count, median),
        .p10 = percentile(values, count, 10),
        .p90 = percentile(values, count, 90),
        .p99 = percentile(values, count, 99),
    };
}

double summary_window(const double *values, size_t count, size_t width)
{
    double most = 0;
    for (size_t end = 1; end <= count; end++) {
        double sum = 0;
        for (size_t i = end > width ? end - width : 0; i < end; i++)
            sum += values[i];
        most = fmax(most, sum);
    }
    return most;
}
