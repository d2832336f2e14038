/* The summaries of routines that bench makes over all streams: made again from the routines of each entry. */
#include "command/bench/bench_report.h"
#include "command/merge/merge.h"

#include <stdlib.h>
#include <string.h>

static const cJSON *find_named(const cJSON *array, const char *field, const char *name)
{
    const cJSON *element;
    cJSON_ArrayForEach(element, array)
    {
        if (!strcmp(results_text(element, field), name))
            return element;
    }
    return NULL;
}

/* The engine's routines for a unit in an entry; null if the entry does not have them. */
static const cJSON *find_part(const cJSON *entry, const struct bench_routines *routines)
{
    const cJSON *engine =
        find_named(cJSON_GetObjectItemCaseSensitive(entry, "engines"), "engine", routines->engine);
    return find_named(cJSON_GetObjectItemCaseSensitive(engine, "builds"), "unit", unit_name[routines->unit]);
}

/* Appends the numbers of an array. */
static bool append(const cJSON *array, double **values, size_t *count)
{
    const cJSON *element;
    size_t more = (size_t)cJSON_GetArraySize(array);
    double *grown = realloc(*values, (*count + more + 1) * sizeof *grown);
    if (!grown)
        return false;
    *values = grown;
    cJSON_ArrayForEach(element, array)
    {
        if (cJSON_IsNumber(element))
            grown[(*count)++] = element->valuedouble;
    }
    return true;
}

static bool add_entry(const cJSON *entry, struct bench_routines *routines)
{
    const cJSON *part = find_part(entry, routines);
    const cJSON *engine =
        find_named(cJSON_GetObjectItemCaseSensitive(entry, "engines"), "engine", routines->engine);
    struct execution execution = {.instruction_set = results_text(engine, "instruction_set")};
    execution_units(engine, execution.lanes);
    execution_add_all(&routines->execution, &execution);
    routines->by_operation += (size_t)results_value(part, "by_operation");
    return append(cJSON_GetObjectItemCaseSensitive(part, "us"), &routines->us, &routines->routines) &&
           append(cJSON_GetObjectItemCaseSensitive(part, "bytes"), &routines->bytes, &routines->coded);
}

static void add_builds(const cJSON *entries, const char *engine, unsigned unit, cJSON *builds)
{
    struct bench_routines routines = {.engine = engine, .unit = unit};
    const cJSON *entry;
    bool complete = true;
    cJSON_ArrayForEach(entry, entries)
    {
        complete = complete && add_entry(entry, &routines);
    }
    if (complete)
        cJSON_AddItemToArray(builds, bench_json_routines(&routines));
    else
        tool_report_mark_incomplete();
    free(routines.us);
    free(routines.bytes);
}

/* Returns true if each engine of each entry has its routines. */
static bool have_parts(const cJSON *entries)
{
    const cJSON *entry, *engine;
    cJSON_ArrayForEach(entry, entries)
    {
        cJSON_ArrayForEach(engine, cJSON_GetObjectItemCaseSensitive(entry, "engines"))
        {
            if (!cJSON_IsArray(cJSON_GetObjectItemCaseSensitive(engine, "builds")))
                return false;
        }
    }
    return cJSON_GetArraySize(entries) > 0;
}

/* Results of all streams have the summaries, and not the routines, as those of one run. */
static void remove_parts(cJSON *entries)
{
    cJSON *entry, *engine;
    cJSON_ArrayForEach(entry, entries)
    {
        cJSON_ArrayForEach(engine, cJSON_GetObjectItemCaseSensitive(entry, "engines"))
        {
            cJSON_DeleteItemFromObjectCaseSensitive(engine, "builds");
            cJSON_DeleteItemFromObjectCaseSensitive(engine, "unit_lanes");
        }
    }
}

void merge_builds(const struct merge *merge, cJSON *entries, cJSON *report)
{
    const cJSON *first = merge->input->json, *engine,
                *own = cJSON_GetObjectItemCaseSensitive(first, "builds");
    if (merge->missing.count)
        return;
    if (!have_parts(entries)) {
        if (merge->inputs == 1 && own)
            cJSON_AddItemToObject(report, "builds", cJSON_Duplicate(own, true));
        return;
    }
    cJSON *builds = cJSON_AddArrayToObject(report, "builds");
    cJSON_ArrayForEach(engine, cJSON_GetObjectItemCaseSensitive(first, "engines"))
    {
        for (unsigned unit = 0; unit < UNIT_COUNT; unit++)
            if (cJSON_IsString(engine))
                add_builds(entries, cJSON_GetStringValue(engine), unit, builds);
    }
    remove_parts(entries);
}
