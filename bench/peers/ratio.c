#include "ratio.h"
#include "command/bench/summary.h"

#include <math.h>
#include <string.h>

const char *const ratio_unit[] = {"Mpix/s", "Mtri/s", "kdraw/s", "ms"};

enum clocks ratio_clock(const struct run *run, enum cores cores)
{
    return cores == ONE ? run->clock : TIME;
}

int ratio_find(const struct run *run, const char *name, enum cores cores)
{
    for (unsigned i = 0; i < run->renderer_count; i++)
        if (run->renderers[i].cores == cores && !strcmp(run->renderers[i].name, name))
            return (int)i;
    return -1;
}

double ratio_median_ms(const struct cell *cell, enum clocks clock)
{
    double sorted[PASSES_MAXIMUM];
    if (!cell->measured || !cell->count)
        return 0;
    memcpy(sorted, cell->ms[clock], cell->count * sizeof *sorted);
    return summary_of(sorted, cell->count).median;
}

double ratio_value(const struct workload *workload, const struct cell *cell, enum clocks clock)
{
    double ms = ratio_median_ms(cell, clock);
    return workload->rate == MS || ms <= 0 ? ms : workload->amount / ms;
}

/* Returns the ratio of the speed of `first` to that of `second`. */
static struct ratio compare(const struct cell *first, const struct cell *second, enum clocks a, enum clocks b)
{
    double ratios[PASSES_MAXIMUM];
    unsigned count = first->count < second->count ? first->count : second->count;
    if (!first->measured || !second->measured || !count)
        return (struct ratio){0};
    for (unsigned i = 0; i < count; i++)
        ratios[i] = second->ms[b][i] / first->ms[a][i];
    struct summary summary = summary_of(ratios, count);
    return (struct ratio){summary.median, summary.least, summary.most};
}

struct ratio ratio_between(const struct run *run, unsigned w, int first, int second)
{
    if (first < 0 || second < 0)
        return (struct ratio){0};
    enum clocks clock = ratio_clock(run, run->renderers[first].cores);
    return compare(&run->cells[w][first], &run->cells[w][second], clock, clock);
}

struct ratio ratio_speed_up(const struct run *run, unsigned w, unsigned all)
{
    int one = ratio_find(run, run->renderers[all].name, ONE);
    return one < 0 ? (struct ratio){0} : compare(&run->cells[w][all], &run->cells[w][one], TIME, TIME);
}

/* Returns the lower bound of a unit's time, in seconds: that of the bottleneck resource. */
static double bound_seconds(const struct workload *workload)
{
    const struct limits *limits = limits_measured();
    double sums = fmax(limits->sums_avx2, limits->sums_avx512);
    double bounds[] = {sums > 0 ? workload->sums / sums : 0,
                       limits->store_first > 0 ? workload->stored / limits->store_first : 0,
                       limits->store_memory > 0 ? workload->memory / limits->store_memory : 0,
                       limits->gather_second > 0 ? workload->gathers / limits->gather_second : 0};
    double most = 0;
    for (unsigned i = 0; i < sizeof bounds / sizeof *bounds; i++)
        most = fmax(most, bounds[i] * 1e-9);
    return most;
}

bool ratio_is_deferred(const struct workload *workload, const struct cell *cell, enum clocks clock)
{
    double ms = ratio_median_ms(cell, clock);
    return workload->rate == MS && ms > 0 && ms * 1e-3 < bound_seconds(workload) * workload->amount * 1e3;
}

int ratio_best_peer(const struct run *run, unsigned w, enum cores cores)
{
    int best = -1;
    double least = INFINITY;
    for (unsigned i = 0; i < run->renderer_count; i++) {
        double ms = ratio_median_ms(&run->cells[w][i], ratio_clock(run, cores));
        if (run->renderers[i].side == PEER && run->renderers[i].cores == cores && ms > 0 && ms < least &&
            run->cells[w][i].agreement != DIFFERENT &&
            !ratio_is_deferred(run->workloads[w], &run->cells[w][i], ratio_clock(run, cores))) {
            least = ms;
            best = (int)i;
        }
    }
    return best;
}

double ratio_of_limit(const struct workload *workload, const struct cell *cell, enum clocks clock)
{
    double ms = ratio_median_ms(cell, clock), bound = bound_seconds(workload);
    return ms > 0 && workload->rate != MS ? 100 * bound * workload->amount * 1e3 / (ms * 1e-3) : 0;
}
