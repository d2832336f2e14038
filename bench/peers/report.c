/* The tables of the measurements, as text. A value is a rate, or a time in milliseconds, by the workload. */
#include "drive.h"
#include "mean.h"
#include "ratio.h"
#include "command/bench/summary.h"

#include <string.h>

static void print_value(FILE *file, double value)
{
    if (value <= 0)
        fprintf(file, " %14s", "-");
    else
        fprintf(file, " %14.*f",
                value < 0.1   ? 4
                : value < 1   ? 3
                : value < 10  ? 2
                : value < 100 ? 1
                              : 0,
                value);
}

static void print_ratio(FILE *file, struct ratio ratio)
{
    char range[32];
    if (ratio.median <= 0) {
        fprintf(file, " %7s %-13s", "-", "");
        return;
    }
    snprintf(range, sizeof range, "[%.3g %.3g]", ratio.least, ratio.most);
    fprintf(file, " %7.3g %-13s", ratio.median, range);
}

static void print_head(FILE *file, const struct run *run)
{
    const struct machine *machine = &run->machine;
    const struct limits *limits = limits_measured();
    fprintf(file, "%s, %u cores, %s, %s, commit %s, %s\n", machine->model, machine->cores, machine->kernel,
            machine->compiler, machine->commit, machine->date);
    fprintf(file,
            "Target 1024 x 1024, RGBA8 and 24 bits of depth; %u passes of at least %g s, %g s a renderer and "
            "workload.\n\n",
            run->passes, run->seconds, run->budget);
    for (unsigned i = 0; i < run->renderer_count; i++) {
        const struct renderer *renderer = run->renderers + i;
        fprintf(file, "%-18s %-9s %s%s\n", renderer->name, renderer->cores == ONE ? "one core" : "all cores",
                renderer->to || *renderer->description ? "" : "MISSING: ",
                *renderer->description ? renderer->description : renderer->reason);
    }
    fprintf(
        file,
        "\nOne core at most: %.0f (AVX2) and %.0f (AVX-512) thousand million multiply-adds a second; stores "
        "of "
        "%.0f, %.0f and\n%.0f GB/s in the first and second level's cache and memory; %.2f and %.2f thousand "
        "million gathers of 64 bits.\n",
        limits->sums_avx2, limits->sums_avx512, limits->store_first, limits->store_second,
        limits->store_memory, limits->gather_first, limits->gather_second);
}

static bool shown(const struct run *run, unsigned i, enum cores cores)
{
    return run->renderers[i].cores == cores && *run->renderers[i].description;
}

static void print_values(FILE *file, const struct run *run, enum cores cores)
{
    fprintf(file, "\n%s: %s\n%-25s %-7s", cores == ONE ? "One core" : "All cores",
            cores == ONE && run->clock == WORK ? "by the processor's time" : "by the wall's time", "", "");
    for (unsigned i = 0; i < run->renderer_count; i++)
        if (shown(run, i, cores))
            fprintf(file, " %14.14s", run->renderers[i].name);
    fputc('\n', file);
    for (unsigned w = 0; w < run->count; w++) {
        const struct workload *workload = run->workloads[w];
        fprintf(file, "%-25s %-7s", workload->name, ratio_unit[workload->rate]);
        for (unsigned i = 0; i < run->renderer_count; i++)
            if (shown(run, i, cores))
                print_value(file, ratio_value(workload, &run->cells[w][i], ratio_clock(run, cores)));
        for (unsigned i = 0; i < run->renderer_count; i++)
            if (shown(run, i, cores) &&
                ratio_is_deferred(workload, &run->cells[w][i], ratio_clock(run, cores)))
                fprintf(file, "  (%s defers it)", run->renderers[i].name);
        fputc('\n', file);
    }
}

static void print_ratios(FILE *file, const struct run *run, enum cores cores)
{
    int engine = ratio_find(run, run->engine, cores), stitch = ratio_find(run, "stitch", cores);
    int llvmpipe = ratio_find(run, "llvmpipe", cores), emulate = ratio_find(run, "emulate", cores);
    fprintf(file, "\n%s: times the speed, median [least most]\n%-25s %-21s %-32s %-21s %-21s",
            cores == ONE ? "One core" : "All cores", "", " against llvmpipe", " against the best peer",
            " stitch and llvmpipe", " against emulate");
    if (cores == ONE)
        fprintf(file, " %-21s", " emulate and softpipe");
    for (unsigned i = 0; i < run->renderer_count; i++)
        if (shown(run, i, cores) && run->renderers[i].side == SPECIAL)
            fprintf(file, "  against %-12s", run->renderers[i].name);
    fprintf(file, cores == ONE ? " %% of limit\n" : "\n");
    for (unsigned w = 0; w < run->count; w++) {
        const struct workload *workload = run->workloads[w];
        int best = ratio_best_peer(run, w, cores);
        fprintf(file, "%-25s", workload->name);
        print_ratio(file, ratio_between(run, w, engine, llvmpipe));
        print_ratio(file, ratio_between(run, w, engine, best));
        fprintf(file, "%-11s", best < 0 ? "" : run->renderers[best].name);
        print_ratio(file, ratio_between(run, w, stitch, llvmpipe));
        print_ratio(file, ratio_between(run, w, engine, emulate));
        if (cores == ONE)
            print_ratio(file, ratio_between(run, w, emulate, ratio_find(run, "softpipe", ONE)));
        for (unsigned i = 0; i < run->renderer_count; i++)
            if (shown(run, i, cores) && run->renderers[i].side == SPECIAL)
                print_ratio(file, ratio_between(run, w, engine, (int)i));
        double share = engine < 0 || cores != ONE
                           ? 0
                           : ratio_of_limit(workload, &run->cells[w][engine], ratio_clock(run, cores));
        if (share > 0)
            fprintf(file, " %6.1f", share);
        fputc('\n', file);
    }
}

static void print_speed_ups(FILE *file, const struct run *run)
{
    fprintf(file, "\nFrom one core to all, by the wall's time: times the speed, median [least most]\n%-25s",
            "");
    for (unsigned i = 0; i < run->renderer_count; i++)
        if (shown(run, i, ALL))
            fprintf(file, "  %-20s", run->renderers[i].name);
    fputc('\n', file);
    for (unsigned w = 0; w < run->count; w++) {
        fprintf(file, "%-25s", run->workloads[w]->name);
        for (unsigned i = 0; i < run->renderer_count; i++)
            if (shown(run, i, ALL))
                print_ratio(file, ratio_speed_up(run, w, i));
        fputc('\n', file);
    }
}

static void print_cold(FILE *file, const struct run *run)
{
    fprintf(file,
            "\nFrom a state never seen to the first pixel, in ms beyond the same state again, one core; and "
            "microseconds from keys to code\n%-25s",
            "");
    for (unsigned i = 0; i < run->renderer_count; i++)
        if (shown(run, i, ONE))
            fprintf(file, " %14.14s", run->renderers[i].name);
    for (unsigned i = 0; i < run->renderer_count; i++)
        if (shown(run, i, ONE) && run->renderers[i].side == ENGINE)
            fprintf(file, " %8.8s us", run->renderers[i].name);
    fputc('\n', file);
    for (unsigned w = 0; w < run->count; w++) {
        fprintf(file, "%-25s", run->workloads[w]->name);
        for (unsigned i = 0; i < run->renderer_count; i++)
            if (shown(run, i, ONE))
                print_value(file, run->cells[w][i].cold[run->clock]);
        for (unsigned i = 0; i < run->renderer_count; i++)
            if (shown(run, i, ONE) && run->renderers[i].side == ENGINE)
                print_value(file, run->cells[w][i].build_us);
        fputc('\n', file);
    }
}

static void print_pictures(FILE *file, const struct run *run)
{
    unsigned counts[DIFFERENT + 1] = {0}, failed = 0;
    fputc('\n', file);
    for (unsigned w = 0; w < run->count; w++)
        for (unsigned i = 0; i < run->renderer_count; i++) {
            const struct cell *cell = &run->cells[w][i];
            const struct renderer *renderer = run->renderers + i;
            if (!*renderer->description || cell->absent)
                continue;
            counts[cell->agreement] += cell->measured;
            failed += !cell->measured;
            if (cell->agreement == DIFFERENT)
                fprintf(file, "DIFFERENT: %s draws %s otherwise than %s: %.2f %% of the pixels\n",
                        renderer->name, run->workloads[w]->name, run->renderers[run->reference].name,
                        100 * cell->share);
            if (!cell->measured)
                fprintf(file, "FAILED: %s, %s: %s\n", renderer->name, run->workloads[w]->name, cell->reason);
        }
    fprintf(file, "Pictures, compared with those of %s: %u identical, %u similar, %u different, %u failed\n",
            run->reference < 0 ? "none" : run->renderers[run->reference].name, counts[IDENTICAL],
            counts[SIMILAR], counts[DIFFERENT] + counts[UNKNOWN], failed);
}

static void print_means(FILE *file, const struct run *run)
{
    struct mean means[MEANS_MAXIMUM];
    unsigned count = mean_all(run, means);
    fprintf(file, "\nGeometric means of the ratios: times the speed of the second renderer\n");
    for (unsigned i = 0; i < count; i++)
        if (means[i].count) {
            bool alone = !means[i].against && !strcmp(means[i].group, "cores");
            fprintf(file, "%-15s %-12s %-9s %-46s %7.2f  of %u workloads", means[i].name,
                    means[i].against ? means[i].against
                    : alone          ? ""
                                     : "best peer",
                    means[i].cores == ONE ? "one core" : "all cores", means[i].text, means[i].value,
                    means[i].count);
            fprintf(file, means[i].slower ? ", slower in %u:%s\n" : "\n", means[i].slower, means[i].names);
        }
}

/* Prints the medians of the build times of all workloads. */
static void print_builds(FILE *file, const struct run *run)
{
    for (unsigned i = 0; i < run->renderer_count; i++) {
        double ms[64], us[64];
        unsigned count = 0;
        if (!shown(run, i, ONE))
            continue;
        for (unsigned w = 0; w < run->count; w++)
            if (run->cells[w][i].measured && run->workloads[w]->rate != MS) {
                us[count] = run->cells[w][i].build_us;
                ms[count++] = run->cells[w][i].cold[run->clock];
            }
        struct summary wall = summary_of(ms, count), code = summary_of(us, count);
        if (count && run->renderers[i].side == ENGINE)
            fprintf(file, "%-18s a new state: %.3f ms to the first pixel, of it %.4f ms to code (medians)\n",
                    run->renderers[i].name, wall.median, code.median / 1e3);
        else if (count)
            fprintf(file, "%-18s a new state: %.3f ms to the first pixel (median)\n", run->renderers[i].name,
                    wall.median);
    }
}

int report_text(const struct run *run, FILE *file)
{
    print_head(file, run);
    bool all = false;
    for (unsigned i = 0; i < run->renderer_count; i++)
        all |= shown(run, i, ALL);
    for (enum cores cores = ONE; cores <= (all ? ALL : ONE); cores++) {
        print_values(file, run, cores);
        print_ratios(file, run, cores);
    }
    if (all)
        print_speed_ups(file, run);
    print_cold(file, run);
    print_means(file, run);
    print_builds(file, run);
    print_pictures(file, run);
    return ferror(file) ? -1 : 0;
}
