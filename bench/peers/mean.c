#include "mean.h"
#include "ratio.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    CORE_GROUP = 1 << CORE,
    HIDDEN_GROUP = 1 << HIDDEN,
    FIRST_TABLE = CORE_GROUP | 1 << TABLE,
    RECTANGLES = 1 << RECTANGLE,
    NOT_HIDDEN = FIRST_TABLE | RECTANGLES | 1 << EXTRA
};

static const struct selection {
    const char *name, *text;
    unsigned groups; /* bits of enum group */
} core = {"core", "fills to triangles", CORE_GROUP}, hidden = {"hidden", "hidden layers", HIDDEN_GROUP},
  first_table = {"first-table", "first table without hidden layers", FIRST_TABLE},
  rectangles = {"rectangles", "rectangles", RECTANGLES}, pages = {"pages", "pages", 1 << PAGE},
  not_hidden = {"not-hidden", "workloads of both, without hidden layers", NOT_HIDDEN},
  hidden_of_both = {"hidden", "hidden layers of both", HIDDEN_GROUP};

struct pair {
    const char *first, *second; /* second null: the best peer */
    enum cores cores;
    const struct selection *group;
};

static void mean_add(struct mean *mean, struct ratio ratio, const char *name)
{
    if (ratio.median <= 0)
        return;
    mean->value += log(ratio.median);
    mean->count++;
    if (ratio.median >= 1)
        return;
    mean->slower++;
    size_t used = strlen(mean->names);
    snprintf(mean->names + used, sizeof mean->names - used, " %s", name);
}

static void mean_finish(struct mean *mean)
{
    mean->value = mean->count ? exp(mean->value / mean->count) : 0;
}

static struct mean mean_of(const struct run *run, const struct pair *pair)
{
    struct mean mean = {.name = pair->first,
                        .against = pair->second,
                        .group = pair->group->name,
                        .text = pair->group->text,
                        .cores = pair->cores};
    int first = ratio_find(run, pair->first, pair->cores);
    for (unsigned w = 0; w < run->count; w++) {
        int second =
            pair->second ? ratio_find(run, pair->second, pair->cores) : ratio_best_peer(run, w, pair->cores);
        if (pair->group->groups >> run->workloads[w]->group & 1)
            mean_add(&mean, ratio_between(run, w, first, second), run->workloads[w]->name);
    }
    mean_finish(&mean);
    return mean;
}

/* Returns the mean speed-up of a renderer on all cores over one core, for the workloads without hidden
 * layers. */
static struct mean mean_of_cores(const struct run *run, unsigned all)
{
    struct mean mean = {.name = run->renderers[all].name,
                        .group = "cores",
                        .text = "all cores against one, without hidden layers",
                        .cores = ALL};
    for (unsigned w = 0; w < run->count; w++)
        if (run->workloads[w]->rate != MS && run->workloads[w]->group != HIDDEN)
            mean_add(&mean, ratio_speed_up(run, w, all), run->workloads[w]->name);
    mean_finish(&mean);
    return mean;
}

unsigned mean_all(const struct run *run, struct mean means[MEANS_MAXIMUM])
{
    static const char narrow[] = "specialize-avx2"; /* the engine with AVX-512 hidden */
    const struct pair pairs[] = {
        {run->engine, "llvmpipe", ONE, &core},
        {narrow, "llvmpipe", ONE, &core},
        {run->engine, "llvmpipe", ONE, &hidden},
        {run->engine, NULL, ONE, &first_table},
        {narrow, NULL, ONE, &first_table},
        {run->engine, NULL, ONE, &rectangles},
        {narrow, NULL, ONE, &rectangles},
        {"stitch", "llvmpipe", ONE, &core},
        {run->engine, "stitch", ONE, &core},
        {run->engine, "emulate", ONE, &core},
        {"emulate", "softpipe", ONE, &first_table},
        {run->engine, "llvmpipe", ALL, &core},
        {run->engine, NULL, ALL, &first_table},
        {run->engine, NULL, ALL, &rectangles},
        {run->engine, "llvmpipe", ONE, &pages},
        {run->engine, "llvmpipe-newest", ONE, &pages},
        {run->engine, NULL, ONE, &pages},
        {run->engine, "llvmpipe-newest", ONE, &core},
        {run->engine, "llvmpipe-newest", ONE, &first_table},
    };
    unsigned count = 0;
    for (unsigned i = 0; i < sizeof pairs / sizeof *pairs; i++)
        means[count++] = mean_of(run, pairs + i);
    for (unsigned i = 0; i < run->renderer_count; i++) {
        const struct renderer *renderer = run->renderers + i;
        if (renderer->side != SPECIAL)
            continue;
        means[count++] =
            mean_of(run, &(struct pair){run->engine, renderer->name, renderer->cores, &not_hidden});
        means[count++] =
            mean_of(run, &(struct pair){run->engine, renderer->name, renderer->cores, &rectangles});
        means[count++] =
            mean_of(run, &(struct pair){run->engine, renderer->name, renderer->cores, &hidden_of_both});
        means[count++] = mean_of(run, &(struct pair){run->engine, renderer->name, renderer->cores, &pages});
    }
    for (unsigned i = 0; i < run->renderer_count; i++)
        if (run->renderers[i].cores == ALL && *run->renderers[i].description)
            means[count++] = mean_of_cores(run, i);
    return count;
}
