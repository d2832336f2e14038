/* All measurements as JSON, and the chart's table as CSV. */
#include "drive.h"
#include "mean.h"
#include "ratio.h"

#include <cjson/cJSON.h>
#include <string.h>

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
                            ratio_value(run->workloads[w], cell, ratio_clock(run, renderer->cores)));
    cJSON_AddBoolToObject(json, "fewer_layers", cell->less);
    cJSON_AddItemToObject(json, "wall_ms", cJSON_CreateDoubleArray(cell->ms[TIME], (int)cell->count));
    cJSON_AddItemToObject(json, "processor_ms", cJSON_CreateDoubleArray(cell->ms[WORK], (int)cell->count));
    cJSON_AddNumberToObject(json, "cold_wall_ms", cell->cold[TIME]);
    cJSON_AddNumberToObject(json, "cold_processor_ms", cell->cold[WORK]);
    if (cell->build_us >= 0)
        cJSON_AddNumberToObject(json, "build_us", cell->build_us);
    cJSON_AddStringToObject(json, "picture", agreements[cell->agreement]);
    cJSON_AddNumberToObject(json, "pixels_beyond_tolerance", cell->share);
    add_ratio(json, "against_llvmpipe",
              ratio_between(run, w, (int)i, ratio_find(run, "llvmpipe", renderer->cores)));
    add_ratio(json, "against_best_peer",
              ratio_between(run, w, (int)i, ratio_best_peer(run, w, renderer->cores)));
    for (unsigned other = 0; other < run->renderer_count; other++)
        if (run->renderers[other].side == SPECIAL && run->renderers[other].cores == renderer->cores) {
            char name[NAME_BYTES + 16];
            snprintf(name, sizeof name, "against_%s", run->renderers[other].name);
            add_ratio(json, name, ratio_between(run, w, (int)i, (int)other));
        }
    if (renderer->cores == ALL)
        add_ratio(json, "against_one_core", ratio_speed_up(run, w, i));
    else
        cJSON_AddNumberToObject(json, "percent_of_limit",
                                ratio_of_limit(run->workloads[w], cell, run->clock));
}

/* By enum group. */
static const char *const groups[] = {[CORE] = "core",           [HIDDEN] = "hidden", [TABLE] = "table",
                                     [RECTANGLE] = "rectangle", [EXTRA] = "extra",   [PAGE] = "page"};

/* An engine's description ends with ", LANES lanes, INSTRUCTION-SET" (triptych.c). */
static void add_execution(cJSON *json, const struct renderer *renderer)
{
    char lanes[32], set[32];
    const char *at = strstr(renderer->description, ", engine ");
    if (at && sscanf(at, ", engine %*[^,], %31s lanes, %31s", lanes, set) == 2) {
        cJSON_AddStringToObject(json, "lanes", lanes);
        cJSON_AddStringToObject(json, "instruction_set", set);
    }
}

static void add_limits(cJSON *json)
{
    const struct limits *limits = limits_measured();
    cJSON *object = cJSON_AddObjectToObject(json, "limits");
    cJSON_AddNumberToObject(object, "sums_avx2", limits->sums_avx2);
    cJSON_AddNumberToObject(object, "sums_avx512", limits->sums_avx512);
    cJSON_AddNumberToObject(object, "store_first", limits->store_first);
    cJSON_AddNumberToObject(object, "store_second", limits->store_second);
    cJSON_AddNumberToObject(object, "store_memory", limits->store_memory);
    cJSON_AddNumberToObject(object, "gather_first", limits->gather_first);
    cJSON_AddNumberToObject(object, "gather_second", limits->gather_second);
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
        add_execution(renderer, &run->renderers[i]);
    }
    add_limits(json);
    cJSON *list = cJSON_AddArrayToObject(json, "workloads");
    for (unsigned w = 0; w < run->count; w++) {
        cJSON *workload = add_object(list);
        cJSON_AddStringToObject(workload, "name", run->workloads[w]->name);
        cJSON_AddStringToObject(workload, "text", run->workloads[w]->text);
        cJSON_AddStringToObject(workload, "group", groups[run->workloads[w]->group]);
        cJSON_AddStringToObject(workload, "unit", ratio_unit[run->workloads[w]->rate]);
        cJSON *cells = cJSON_AddArrayToObject(workload, "results");
        for (unsigned i = 0; i < run->renderer_count; i++)
            add_cell(run, w, i, cells);
    }
    cJSON *mean_list = cJSON_AddArrayToObject(json, "geometric_means");
    unsigned count = mean_all(run, means);
    for (unsigned i = 0; i < count; i++)
        if (means[i].count) {
            cJSON *mean = add_object(mean_list);
            cJSON_AddStringToObject(mean, "renderer", means[i].name);
            if (means[i].against)
                cJSON_AddStringToObject(mean, "against", means[i].against);
            cJSON_AddStringToObject(mean, "group", means[i].group);
            cJSON_AddStringToObject(mean, "text", means[i].text);
            cJSON_AddStringToObject(mean, "cores", means[i].cores == ONE ? "one" : "all");
            cJSON_AddNumberToObject(mean, "mean", means[i].value);
            cJSON_AddNumberToObject(mean, "workloads", means[i].count);
            cJSON_AddNumberToObject(mean, "slower", means[i].slower);
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
            struct ratio ratio = ratio_between(run, w, (int)i, ratio_find(run, "llvmpipe", ONE));
            if (*run->renderers[i].description && run->renderers[i].cores == ONE && ratio.median > 0)
                fprintf(file, "%s,%s,%.4f,%.4f,%.4f\n", run->workloads[w]->name, run->renderers[i].name,
                        ratio.median, ratio.least, ratio.most);
        }
    return fclose(file) ? -1 : 0;
}
