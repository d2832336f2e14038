/* Results with entries: those of all inputs in the order of "inputs". Those of verify are joined. */
#include "command/merge/merge.h"
#include "command/bench/execution.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LIST_CAPACITY = 4096 };

/* The fields of an entry that the campaign determines, and those of its engines; null after the last. */
static const struct kept {
    const char *command, *entry[10], *engine[4];
} kept[] = {
    {"bench",
     {"number", "stream", "path", "width", "height", "frames", "engines"},
     {"engine", "lanes", "instruction_set"}},
    {"claims", {"number", "id", "verdict"}, {NULL}},
};

/* The n-th complete entry of the input with that number, from 0; null if there is none. */
static const cJSON *find_entry(const struct results *input, int64_t number, unsigned n)
{
    const cJSON *entry;
    cJSON_ArrayForEach(entry, cJSON_GetObjectItemCaseSensitive(input->json, input->kind->entries))
    {
        if (results_complete(entry) && results_number(input, entry) == number && !n--)
            return entry;
    }
    return NULL;
}

/* --- The normal form ------------------------------------------------------------------------------------ */

static cJSON *keep_fields(const cJSON *object, const char *const fields[])
{
    cJSON *json = cJSON_CreateObject();
    for (; *fields; fields++) {
        const cJSON *value = cJSON_GetObjectItemCaseSensitive(object, *fields);
        if (value)
            cJSON_AddItemToObject(json, *fields, cJSON_Duplicate(value, true));
    }
    return json;
}

static cJSON *keep_entry(const struct kept *row, const cJSON *entry)
{
    cJSON *json = keep_fields(entry, row->entry), *engines = cJSON_CreateArray();
    const cJSON *engine;
    cJSON_ArrayForEach(engine, cJSON_GetObjectItemCaseSensitive(entry, "engines"))
    {
        cJSON_AddItemToArray(engines, keep_fields(engine, row->engine));
    }
    if (!cJSON_ReplaceItemInObjectCaseSensitive(json, "engines", engines))
        cJSON_Delete(engines);
    return json;
}

static cJSON *copy_entry(const struct merge *merge, const cJSON *entry)
{
    for (size_t i = 0; i < sizeof kept / sizeof *kept && merge->canonical; i++)
        if (!strcmp(kept[i].command, merge->input->kind->command))
            return keep_entry(&kept[i], entry);
    return cJSON_Duplicate(entry, true);
}

/* --- Verify --------------------------------------------------------------------------------------------- */

static void add_lanes(struct execution *execution, const cJSON *engine)
{
    struct execution other = {.instruction_set = results_text(engine, "instruction_set")};
    execution_units(engine, other.lanes);
    execution_add_all(execution, &other);
}

void merge_executions(const struct merge *merge, cJSON *report)
{
    cJSON *engines = cJSON_AddArrayToObject(report, "engines");
    const cJSON *first = cJSON_GetObjectItemCaseSensitive(merge->input->json, "engines"), *engine;
    int index = 0;
    cJSON_ArrayForEach(engine, first)
    {
        struct execution execution = {0};
        for (unsigned i = 0; i < merge->inputs; i++)
            add_lanes(
                &execution,
                cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(merge->input[i].json, "engines"), index));
        cJSON *json = cJSON_CreateObject();
        cJSON_AddStringToObject(json, "engine", results_text(engine, "engine"));
        execution_json(&execution, json);
        execution_json_units(&execution, json);
        cJSON_AddItemToArray(engines, json);
        index++;
    }
}

/* The entries of one stream. */
struct parts {
    const cJSON *entry[LIST_CAPACITY];
    const char *path[LIST_CAPACITY]; /* of the input */
    unsigned count;
};

static void collect(const struct merge *merge, unsigned number, struct parts *parts)
{
    const cJSON *entry;
    parts->count = 0;
    for (unsigned i = 0; i < merge->inputs; i++)
        for (unsigned n = 0;
             (entry = find_entry(&merge->input[i], number, n)) && parts->count < LIST_CAPACITY; n++) {
            parts->path[parts->count] = merge->input[i].path;
            parts->entry[parts->count++] = entry;
        }
}

/* The reference draws the same picture everywhere. If it does not, no merged result is right. */
static int compare_parts(const struct merge *merge, const struct parts *parts)
{
    static const char *const fields[] = {"stream", "frames", "xxh3", "goldens"};
    for (unsigned i = 1; i < parts->count; i++)
        for (size_t f = 0; f < sizeof fields / sizeof *fields; f++) {
            const cJSON *a = cJSON_GetObjectItemCaseSensitive(parts->entry[0], fields[f]);
            const cJSON *b = cJSON_GetObjectItemCaseSensitive(parts->entry[i], fields[f]);
            if ((!a && !b) || cJSON_Compare(a, b, true))
                continue;
            printf("%s: the %s of emulate in %s and in %s differ\n", results_text(parts->entry[0], "stream"),
                   fields[f], parts->path[0], parts->path[i]);
            return STATUS_DIFFERENT;
        }
    (void)merge;
    return STATUS_OK;
}

/* The index of the settings that differ among those of the results. */
static int rank_settings(const cJSON *json, const cJSON *difference)
{
    const cJSON *text;
    int index = 0;
    cJSON_ArrayForEach(text, cJSON_GetObjectItemCaseSensitive(json, "settings"))
    {
        if (cJSON_IsString(text) && !strcmp(text->valuestring, results_text(difference, "settings")))
            break;
        index++;
    }
    return index;
}

/* The place of a difference in the report of one run: by frame, engine, number of threads and settings. */
static double rank_difference(const struct merge *merge, const cJSON *difference)
{
    const cJSON *json = merge->input->json, *thread;
    int engine = results_engine(cJSON_GetObjectItemCaseSensitive(json, "engines"),
                                results_text(difference, "engine")),
        index = 0;
    cJSON_ArrayForEach(thread, cJSON_GetObjectItemCaseSensitive(json, "threads"))
    {
        if (thread->valuedouble == results_value(difference, "threads"))
            break;
        index++;
    }
    return ((results_value(difference, "frame") * 64 + engine) * 64 + index) * 64 +
           rank_settings(json, difference);
}

/* Adds all differences of the parts, the least rank first. */
static cJSON *merge_differences(const struct merge *merge, const struct parts *parts)
{
    cJSON *all = cJSON_CreateArray();
    for (unsigned i = 0; i < parts->count; i++) {
        const cJSON *difference;
        cJSON_ArrayForEach(difference, cJSON_GetObjectItemCaseSensitive(parts->entry[i], "differences"))
        {
            int at = 0;
            const cJSON *other;
            cJSON_ArrayForEach(other, all)
            {
                if (rank_difference(merge, other) > rank_difference(merge, difference))
                    break;
                at++;
            }
            cJSON_InsertItemInArray(all, at, cJSON_Duplicate(difference, true));
        }
    }
    return all;
}

/* The names of all engines of the parts, in the order of "engines". */
static cJSON *merge_engines(const struct merge *merge, unsigned number)
{
    cJSON *names = cJSON_CreateArray();
    const cJSON *engine;
    unsigned count = results_engine_count(merge->input);
    uint64_t unit = (uint64_t)number * count;
    cJSON_ArrayForEach(engine, cJSON_GetObjectItemCaseSensitive(merge->input->json, "engines"))
    {
        if (ranges_has(&merge->done, unit++))
            cJSON_AddItemToArray(names, cJSON_CreateString(results_text(engine, "engine")));
    }
    return names;
}

/* The configurations that were compared, and the reference. */
static double count_configurations(const struct parts *parts)
{
    double count = 1;
    for (unsigned i = 0; i < parts->count; i++)
        count += results_value(parts->entry[i], "configurations") - 1;
    return count;
}

static bool are_identical(const struct parts *parts)
{
    bool identical = true;
    for (unsigned i = 0; i < parts->count; i++)
        identical &= cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(parts->entry[i], "identical"));
    return identical;
}

/* Adds the entry of a stream of verify: those of the inputs, each with some engines, as one. Adds none if no
 * input has a complete one. The same results as merge_entries. */
static int merge_verified(const struct merge *merge, unsigned number, cJSON *entries)
{
    static struct parts parts;
    collect(merge, number, &parts);
    if (!parts.count)
        return STATUS_OK;
    if (compare_parts(merge, &parts))
        return STATUS_DIFFERENT;
    cJSON *entry = cJSON_Duplicate(parts.entry[0], true);
    cJSON_ReplaceItemInObjectCaseSensitive(entry, "engines", merge_engines(merge, number));
    cJSON_ReplaceItemInObjectCaseSensitive(entry, "configurations",
                                           cJSON_CreateNumber(count_configurations(&parts)));
    cJSON_ReplaceItemInObjectCaseSensitive(entry, "identical", cJSON_CreateBool(are_identical(&parts)));
    cJSON_ReplaceItemInObjectCaseSensitive(entry, "differences", merge_differences(merge, &parts));
    cJSON_AddItemToArray(entries, entry);
    return STATUS_OK;
}

/* --- All ------------------------------------------------------------------------------------------------ */

static int add_entry(const struct merge *merge, unsigned number, cJSON *entries)
{
    const cJSON *entry;
    if (merge->input->kind->engines)
        return merge_verified(merge, number, entries);
    for (unsigned i = 0; i < merge->inputs; i++)
        if ((entry = find_entry(&merge->input[i], number, 0)))
            return cJSON_AddItemToArray(entries, copy_entry(merge, entry)), STATUS_OK;
    return STATUS_OK;
}

/* "identical" of verify: it is false if any input has found a difference. */
static void add_identical(const struct merge *merge, cJSON *report)
{
    bool any = false, identical = true;
    for (unsigned i = 0; i < merge->inputs; i++) {
        const cJSON *value = cJSON_GetObjectItemCaseSensitive(merge->input[i].json, "identical");
        any |= cJSON_IsBool(value);
        identical &= !cJSON_IsFalse(value);
    }
    if (any)
        cJSON_AddBoolToObject(report, "identical", identical);
}

int merge_entries(const struct merge *merge, cJSON *report)
{
    unsigned count = (unsigned)(merge->input->count / results_engine_count(merge->input));
    add_identical(merge, report);
    cJSON *entries = cJSON_AddArrayToObject(report, merge->input->kind->entries);
    for (unsigned number = 0; number < count; number++)
        if (add_entry(merge, number, entries))
            return STATUS_DIFFERENT;
    if (!strcmp(merge->input->kind->command, "bench") && !merge->canonical)
        merge_builds(merge, entries, report);
    return STATUS_OK;
}
