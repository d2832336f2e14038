#include "command/bench/interval.h"

#include "command/bench/summary.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

enum { EXACT_MAXIMUM = 50, STATISTIC_CAPACITY = EXACT_MAXIMUM * EXACT_MAXIMUM / 2 + 1 };

static const double tail = 0.025;              /* on each side */
static const double normal_deviate = 1.959964; /* of the same tail */

const char interval_method[] = "95 % (Mann-Whitney)";

/* Orders of a_count + b_count values are equally probable without a difference. The number of orders in which
 * u pairs have the value of `a` below that of `b` is the coefficient of q^u in the product, for i from 1 to
 * a_count, of (1 - q^(b_count + i)) / (1 - q^i). Returns the greatest k for which fewer than k pairs have at
 * most the probability `tail`. */
static size_t exact_rank(size_t a_count, size_t b_count)
{
    double orders[STATISTIC_CAPACITY] = {1}, all = 1, below = 0;
    size_t most = a_count * b_count / 2, rank = 0;
    for (size_t i = 1; i <= a_count; i++) {
        for (size_t u = most + 1; u-- > b_count + i;)
            orders[u] -= orders[u - b_count - i];
        for (size_t u = i; u <= most; u++)
            orders[u] += orders[u - i];
        all *= (double)(b_count + i) / (double)i;
    }
    while (rank <= most && (below += orders[rank]) <= tail * all)
        rank++;
    return rank;
}

/* The mean and the deviation of the number of such pairs. */
static size_t normal_rank(double a_count, double b_count)
{
    double mean = a_count * b_count / 2, deviation = sqrt(a_count * b_count * (a_count + b_count + 1) / 12);
    return (size_t)fmax(mean - normal_deviate * deviation, 0);
}

size_t interval_rank(size_t a_count, size_t b_count)
{
    if (a_count <= EXACT_MAXIMUM && b_count <= EXACT_MAXIMUM)
        return exact_rank(a_count, b_count);
    return normal_rank((double)a_count, (double)b_count);
}

static bool are_positive(const double *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!(values[i] > 0 && isfinite(values[i])))
            return false;
    return count > 0;
}

int interval_of(const double *a, size_t a_count, const double *b, size_t b_count, struct interval *interval)
{
    *interval = (struct interval){0};
    if (!are_positive(a, a_count) || !are_positive(b, b_count))
        return 0;
    size_t pairs = a_count * b_count, rank = interval_rank(a_count, b_count);
    double *quotients =
        a_count <= SIZE_MAX / sizeof *quotients / b_count ? malloc(pairs * sizeof *quotients) : NULL;
    if (!quotients)
        return -1;
    for (size_t i = 0; i < pairs; i++)
        quotients[i] = a[i / b_count] / b[i % b_count];
    interval->times = summary_of(quotients, pairs).median;
    if (rank) {
        interval->low = quotients[rank - 1];
        interval->high = quotients[pairs - rank];
    }
    free(quotients);
    return 0;
}

bool interval_shows_difference(const struct interval *interval)
{
    return interval->low > 1 || (interval->low > 0 && interval->high < 1);
}

const char *interval_verdict(const struct interval *interval, const char *less, const char *greater)
{
    if (!(interval->times > 0))
        return "-";
    if (!(interval->low > 0))
        return "too few runs";
    if (!interval_shows_difference(interval))
        return "no difference shown";
    return interval->low > 1 ? greater : less;
}
