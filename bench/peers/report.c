/* Tables of what was measured. A value is a rate, or a time where the workload tells that; a ratio is one of speeds, so
 * that more is better for both. Ratios are taken pass by pass, between samples of the same pass, and are told as the
 * median with the least and the most. */
#include "drive.h"
#include "tool/sample.h"

#include <cjson/cJSON.h>
#include <fnmatch.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const units[] = {"Mpix/s", "Mtri/s", "kdraw/s", "ms"};

struct ratio {
    double median, least, most; /* 0: not known */
};

static enum clocks clock_for(const struct run *run, enum cores cores)
{
    return cores == ONE ? run->clock : TIME;
}

static int find(const struct run *run, const char *name, enum cores cores)
{
    for (unsigned i = 0; i < run->renderer_count; i++)
        if (run->renderers[i].cores == cores && !strcmp(run->renderers[i].name, name))
            return (int)i;
    return -1;
}

static double median_ms(const struct cell *cell, enum clocks clock)
{
    double sorted[PASSES_MAXIMUM];
    if (!cell->measured || !cell->count)
        return 0;
    memcpy(sorted, cell->ms[clock], cell->count * sizeof *sorted);
    return summarize(sorted, cell->count).median;
}

static double value_of(const struct workload *workload, const struct cell *cell, enum clocks clock)
{
    double ms = median_ms(cell, clock);
    return workload->rate == MS || ms <= 0 ? ms : workload->amount / ms;
}

/* How many times as fast the first is as the second. */
static struct ratio compare(const struct cell *first, const struct cell *second, enum clocks a, enum clocks b)
{
    double ratios[PASSES_MAXIMUM];
    unsigned count = first->count < second->count ? first->count : second->count;
    if (!first->measured || !second->measured || !count)
        return (struct ratio){0};
    for (unsigned i = 0; i < count; i++)
        ratios[i] = second->ms[b][i] / first->ms[a][i];
    struct summary summary = summarize(ratios, count);
    return (struct ratio){summary.median, summary.least, summary.most};
}

static struct ratio between(const struct run *run, unsigned w, int first, int second)
{
    if (first < 0 || second < 0)
        return (struct ratio){0};
    enum clocks clock = clock_for(run, run->renderers[first].cores);
    return compare(&run->cells[w][first], &run->cells[w][second], clock, clock);
}

/* From one core to all, by the wall's clock. */
static struct ratio speed_up(const struct run *run, unsigned w, unsigned all)
{
    int one = find(run, run->renderers[all].name, ONE);
    return one < 0 ? (struct ratio){0} : compare(&run->cells[w][all], &run->cells[w][one], TIME, TIME);
}

/* Seconds of a unit at least, by the slowest of the resources. */
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

/* Faster than pixels can be written: the work is put off, to whoever looks at it. */
static bool put_off(const struct workload *workload, const struct cell *cell, enum clocks clock)
{
    double ms = median_ms(cell, clock);
    return workload->rate == MS && ms > 0 && ms * 1e-3 < bound_seconds(workload) * workload->amount * 1e3;
}

/* The fastest peer of a workload that does the work. */
static int best_peer(const struct run *run, unsigned w, enum cores cores)
{
    int best = -1;
    double least = INFINITY;
    for (unsigned i = 0; i < run->renderer_count; i++) {
        double ms = median_ms(&run->cells[w][i], clock_for(run, cores));
        if (run->renderers[i].side == PEER && run->renderers[i].cores == cores && ms > 0 && ms < least &&
            run->cells[w][i].agreement != DIFFERENT &&
            !put_off(run->workloads[w], &run->cells[w][i], clock_for(run, cores))) {
            least = ms;
            best = (int)i;
        }
    }
    return best;
}

/* The share of what the machine could do at most, in percent. */
static double share_of_limit(const struct workload *workload, const struct cell *cell, enum clocks clock)
{
    double ms = median_ms(cell, clock), bound = bound_seconds(workload);
    return ms > 0 && workload->rate != MS ? 100 * bound * workload->amount * 1e3 / (ms * 1e-3) : 0;
}

/* --- Text ------------------------------------------------------------------------------------------------------------ */

static void print_value(FILE *file, double value)
{
    if (value <= 0)
        fprintf(file, " %11s", "-");
    else
        fprintf(file, " %11.*f",
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
            fprintf(file, " %11.11s", run->renderers[i].name);
    fputc('\n', file);
    for (unsigned w = 0; w < run->count; w++) {
        const struct workload *workload = run->workloads[w];
        fprintf(file, "%-25s %-7s", workload->name, units[workload->rate]);
        for (unsigned i = 0; i < run->renderer_count; i++)
            if (shown(run, i, cores))
                print_value(file, value_of(workload, &run->cells[w][i], clock_for(run, cores)));
        for (unsigned i = 0; i < run->renderer_count; i++)
            if (shown(run, i, cores) && put_off(workload, &run->cells[w][i], clock_for(run, cores)))
                fprintf(file, "  (%s puts it off)", run->renderers[i].name);
        fputc('\n', file);
    }
}

static void print_ratios(FILE *file, const struct run *run, enum cores cores)
{
    int engine = find(run, run->engine, cores), stitch = find(run, "stitch", cores);
    int llvmpipe = find(run, "llvmpipe", cores), emulate = find(run, "emulate", cores);
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
        int best = best_peer(run, w, cores);
        fprintf(file, "%-25s", workload->name);
        print_ratio(file, between(run, w, engine, llvmpipe));
        print_ratio(file, between(run, w, engine, best));
        fprintf(file, "%-11s", best < 0 ? "" : run->renderers[best].name);
        print_ratio(file, between(run, w, stitch, llvmpipe));
        print_ratio(file, between(run, w, engine, emulate));
        if (cores == ONE)
            print_ratio(file, between(run, w, emulate, find(run, "softpipe", ONE)));
        for (unsigned i = 0; i < run->renderer_count; i++)
            if (shown(run, i, cores) && run->renderers[i].side == SPECIAL)
                print_ratio(file, between(run, w, engine, (int)i));
        double share = engine < 0 || cores != ONE
                           ? 0
                           : share_of_limit(workload, &run->cells[w][engine], clock_for(run, cores));
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
                print_ratio(file, speed_up(run, w, i));
        fputc('\n', file);
    }
}

static void print_cold(FILE *file, const struct run *run)
{
    fprintf(file,
            "\nFrom a state never seen to the first pixel, ms more than once it was seen, one core; and "
            "microseconds that the engine took from keys to code\n%-25s",
            "");
    for (unsigned i = 0; i < run->renderer_count; i++)
        if (shown(run, i, ONE))
            fprintf(file, " %11.11s", run->renderers[i].name);
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
            run->reference < 0 ? "nobody" : run->renderers[run->reference].name, counts[IDENTICAL],
            counts[SIMILAR], counts[DIFFERENT] + counts[UNKNOWN], failed);
}

/* --- Means ------------------------------------------------------------------------------------------------------------- */

/* Geometric means of ratios over workloads of some groups, and how many of them are below 1. */
struct mean {
    const char *name, *text, *against;
    double value;
    unsigned count, behind;
    char names[512]; /* of those that are behind */
};

static void mean_add(struct mean *mean, struct ratio ratio, const char *name)
{
    if (ratio.median <= 0)
        return;
    mean->value += log(ratio.median);
    mean->count++;
    if (ratio.median >= 1)
        return;
    mean->behind++;
    size_t used = strlen(mean->names);
    snprintf(mean->names + used, sizeof mean->names - used, " %s", name);
}

static double mean_value(const struct mean *mean)
{
    return mean->count ? exp(mean->value / mean->count) : 0;
}

enum { MEANS_MAXIMUM = 64 };

struct pair {
    const char *first, *second; /* second null: the best peer */
    enum cores cores;
    unsigned groups; /* bits */
    const char *text;
};

static struct mean mean_of(const struct run *run, const struct pair *pair)
{
    struct mean mean = {.text = pair->text, .name = pair->first, .against = pair->second};
    int first = find(run, pair->first, pair->cores);
    for (unsigned w = 0; w < run->count; w++) {
        int second = pair->second ? find(run, pair->second, pair->cores) : best_peer(run, w, pair->cores);
        if (pair->groups >> run->workloads[w]->group & 1)
            mean_add(&mean, between(run, w, first, second), run->workloads[w]->name);
    }
    return mean;
}

static unsigned means_of(const struct run *run, struct mean means[MEANS_MAXIMUM])
{
    enum {
        CORE_ONLY = 1 << CORE,
        FILLED = CORE_ONLY | 1 << HIDDEN,
        FIRST = FILLED | 1 << TABLE,
        RECTANGLES = 1 << RECTANGLE,
        ALL_GROUPS = FIRST | RECTANGLES | 1 << EXTRA
    };
    const struct pair pairs[] = {
        {run->engine, "llvmpipe", ONE, CORE_ONLY, "one core, fills to triangles"},
        {run->engine, "llvmpipe", ONE, FILLED, "one core, hidden layers too"},
        {run->engine, NULL, ONE, FIRST, "one core: the best peer, first table"},
        {run->engine, NULL, ONE, RECTANGLES, "one core: the best peer, rectangles"},
        {"stitch", "llvmpipe", ONE, CORE_ONLY, "one core, fills to triangles"},
        {run->engine, "stitch", ONE, CORE_ONLY, "one core, fills to triangles"},
        {run->engine, "emulate", ONE, CORE_ONLY, "one core, fills to triangles"},
        {"emulate", "softpipe", ONE, FIRST, "one core, first table"},
        {run->engine, "llvmpipe", ALL, CORE_ONLY, "all cores, fills to triangles"},
        {run->engine, NULL, ALL, FIRST, "all cores: the best peer, first table"},
        {run->engine, NULL, ALL, RECTANGLES, "all cores: the best peer, rectangles"},
    };
    unsigned count = 0;
    for (unsigned i = 0; i < sizeof pairs / sizeof *pairs; i++)
        means[count++] = mean_of(run, pairs + i);
    for (unsigned i = 0; i < run->renderer_count; i++) {
        const struct pair pair = {run->engine, run->renderers[i].name, run->renderers[i].cores, ALL_GROUPS,
                                  "on what that one takes part in"};
        if (run->renderers[i].side == SPECIAL)
            means[count++] = mean_of(run, &pair);
    }
    for (unsigned i = 0; i < run->renderer_count; i++) {
        if (!shown(run, i, ALL))
            continue;
        struct mean mean = {.name = run->renderers[i].name, .text = "all cores against one, all workloads"};
        for (unsigned w = 0; w < run->count; w++)
            if (run->workloads[w]->rate != MS)
                mean_add(&mean, speed_up(run, w, i), run->workloads[w]->name);
        means[count++] = mean;
    }
    return count;
}

static void print_means(FILE *file, const struct run *run)
{
    struct mean means[MEANS_MAXIMUM];
    unsigned count = means_of(run, means);
    fprintf(file, "\nGeometric means of the ratios: how many times as fast the first is as the second\n");
    for (unsigned i = 0; i < count; i++)
        if (means[i].count) {
            fprintf(file, "%-12s %-12s %-42s %7.2f  of %u workloads", means[i].name,
                    means[i].against ? means[i].against : "", means[i].text, mean_value(means + i),
                    means[i].count);
            fprintf(file, means[i].behind ? ", behind in %u:%s\n" : "\n", means[i].behind, means[i].names);
        }
}

/* The middle of all workloads' cold builds. */
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
        struct summary wall = summarize(ms, count), code = summarize(us, count);
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

/* --- JSON and CSV ------------------------------------------------------------------------------------------------------ */

static cJSON *add_object(cJSON *array)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddItemToArray(array, object);
    return object;
}

static void add_ratio(cJSON *object, const char *name, struct ratio ratio)
{
    if (ratio.median > 0)
        cJSON_AddItemToObject(object, name,
                              cJSON_CreateDoubleArray((double[]){ratio.median, ratio.least, ratio.most}, 3));
}

static void add_cell(const struct run *run, unsigned w, unsigned i, cJSON *array)
{
    static const char *const agreements[] = {"unknown", "identical", "similar", "different"};
    const struct cell *cell = &run->cells[w][i];
    const struct renderer *renderer = run->renderers + i;
    cJSON *json = add_object(array);
    cJSON_AddStringToObject(json, "renderer", renderer->name);
    cJSON_AddStringToObject(json, "cores", renderer->cores == ONE ? "one" : "all");
    if (!cell->measured) {
        cJSON_AddStringToObject(json, "reason",
                                cell->absent        ? "no part in this workload"
                                : *renderer->reason ? renderer->reason
                                                    : cell->reason);
        return;
    }
    cJSON_AddNumberToObject(json, "value",
                            value_of(run->workloads[w], cell, clock_for(run, renderer->cores)));
    cJSON_AddBoolToObject(json, "fewer_layers", cell->less);
    cJSON_AddItemToObject(json, "wall_ms", cJSON_CreateDoubleArray(cell->ms[TIME], (int)cell->count));
    cJSON_AddItemToObject(json, "processor_ms", cJSON_CreateDoubleArray(cell->ms[WORK], (int)cell->count));
    cJSON_AddNumberToObject(json, "cold_wall_ms", cell->cold[TIME]);
    cJSON_AddNumberToObject(json, "cold_processor_ms", cell->cold[WORK]);
    if (cell->build_us >= 0)
        cJSON_AddNumberToObject(json, "build_us", cell->build_us);
    cJSON_AddStringToObject(json, "picture", agreements[cell->agreement]);
    cJSON_AddNumberToObject(json, "pixels_beyond_tolerance", cell->share);
    add_ratio(json, "against_llvmpipe", between(run, w, (int)i, find(run, "llvmpipe", renderer->cores)));
    add_ratio(json, "against_best_peer", between(run, w, (int)i, best_peer(run, w, renderer->cores)));
    for (unsigned other = 0; other < run->renderer_count; other++)
        if (run->renderers[other].side == SPECIAL && run->renderers[other].cores == renderer->cores) {
            char name[NAME_BYTES + 16];
            snprintf(name, sizeof name, "against_%s", run->renderers[other].name);
            add_ratio(json, name, between(run, w, (int)i, (int)other));
        }
    if (renderer->cores == ALL)
        add_ratio(json, "against_one_core", speed_up(run, w, i));
    else
        cJSON_AddNumberToObject(json, "percent_of_limit",
                                share_of_limit(run->workloads[w], cell, run->clock));
}

static cJSON *json_of(const struct run *run)
{
    struct mean means[MEANS_MAXIMUM];
    cJSON *json = cJSON_CreateObject();
    cJSON_AddItemToObject(json, "machine", machine_json(&run->machine));
    cJSON_AddStringToObject(json, "clock_of_one_core", run->clock == WORK ? "processor" : "wall");
    cJSON *renderers = cJSON_AddArrayToObject(json, "renderers");
    for (unsigned i = 0; i < run->renderer_count; i++) {
        cJSON *renderer = add_object(renderers);
        cJSON_AddStringToObject(renderer, "name", run->renderers[i].name);
        cJSON_AddStringToObject(renderer, "cores", run->renderers[i].cores == ONE ? "one" : "all");
        cJSON_AddStringToObject(renderer, *run->renderers[i].description ? "description" : "missing",
                                *run->renderers[i].description ? run->renderers[i].description
                                                               : run->renderers[i].reason);
    }
    cJSON *list = cJSON_AddArrayToObject(json, "workloads");
    for (unsigned w = 0; w < run->count; w++) {
        cJSON *workload = add_object(list);
        cJSON_AddStringToObject(workload, "name", run->workloads[w]->name);
        cJSON_AddStringToObject(workload, "text", run->workloads[w]->text);
        cJSON_AddStringToObject(workload, "unit", units[run->workloads[w]->rate]);
        cJSON *cells = cJSON_AddArrayToObject(workload, "results");
        for (unsigned i = 0; i < run->renderer_count; i++)
            add_cell(run, w, i, cells);
    }
    cJSON *mean_list = cJSON_AddArrayToObject(json, "geometric_means");
    unsigned count = means_of(run, means);
    for (unsigned i = 0; i < count; i++)
        if (means[i].count) {
            cJSON *mean = add_object(mean_list);
            cJSON_AddStringToObject(mean, "renderer", means[i].name);
            if (means[i].against)
                cJSON_AddStringToObject(mean, "against", means[i].against);
            cJSON_AddStringToObject(mean, "text", means[i].text);
            cJSON_AddNumberToObject(mean, "mean", mean_value(means + i));
            cJSON_AddNumberToObject(mean, "workloads", means[i].count);
            cJSON_AddNumberToObject(mean, "behind", means[i].behind);
        }
    return json;
}

int report_json(const struct run *run, const char *path)
{
    cJSON *json = json_of(run);
    char *text = json ? cJSON_Print(json) : NULL;
    FILE *file = text ? fopen(path, "w") : NULL;
    int bad = !file || fprintf(file, "%s\n", text) < 0;
    bad |= file && fclose(file);
    cJSON_free(text);
    cJSON_Delete(json);
    return bad ? -1 : 0;
}

int report_csv(const struct run *run, const char *path)
{
    FILE *file = fopen(path, "w");
    if (!file)
        return -1;
    fputs("stream,engine,speedup,least,most\n", file);
    for (unsigned w = 0; w < run->count; w++)
        for (unsigned i = 0; i < run->renderer_count; i++) {
            struct ratio ratio = between(run, w, (int)i, find(run, "llvmpipe", ONE));
            if (shown(run, i, ONE) && ratio.median > 0)
                fprintf(file, "%s,%s,%.4f,%.4f,%.4f\n", run->workloads[w]->name, run->renderers[i].name,
                        ratio.median, ratio.least, ratio.most);
        }
    return fclose(file) ? -1 : 0;
}
