/* `triptych merge`: results of the shards of a campaign become those of one run (docs/campaigns.md). */
#include "command/merge/merge.h"
#include "command/support/option.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_TEXT = 400 };

struct settings {
    const char *json;
    bool canonical;
};

/* --- Units ---------------------------------------------------------------------------------------------- */

static int gather_units(struct merge *merge)
{
    const struct results *first = &merge->input[0];
    for (unsigned i = 0; i < merge->inputs; i++) {
        ranges_common(&merge->done, &merge->input[i].done, &merge->twice);
        ranges_add_all(&merge->done, &merge->input[i].done);
    }
    if (first->count)
        ranges_missing(&merge->done, first->first, first->first + first->count - 1, &merge->missing);
    return merge->done.failed || merge->twice.failed || merge->missing.failed
               ? tool_fail(merge->self, "no memory for the units of the campaign")
               : STATUS_OK;
}

static const char *input_name(const struct merge *merge, uint64_t number)
{
    const cJSON *inputs = cJSON_GetObjectItemCaseSensitive(merge->input->json, "inputs");
    const char *name = cJSON_GetStringValue(cJSON_GetArrayItem(inputs, (int)number));
    return name ? name : "?";
}

static const char *engine_name(const struct merge *merge, unsigned index)
{
    const cJSON *engine =
        cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(merge->input->json, "engines"), (int)index);
    return cJSON_IsString(engine) ? cJSON_GetStringValue(engine) : results_text(engine, "engine");
}

/* Adds a line to the list, and prints it after the heading. */
static void add_line(cJSON *list, const char *heading, const char *text)
{
    printf("%s: %s\n", heading, text);
    cJSON_AddItemToArray(list, cJSON_CreateString(text));
}

static void list_cases(const struct ranges *units, const char *heading, cJSON *list)
{
    char text[NAME_TEXT];
    for (size_t i = 0; i < units->count; i++) {
        const struct ranges_item *item = &units->item[i];
        if (item->first == item->last)
            snprintf(text, sizeof text, "case %" PRIu64, item->first);
        else
            snprintf(text, sizeof text, "cases %" PRIu64 "-%" PRIu64, item->first, item->last);
        add_line(list, heading, text);
    }
}

/* A line for each stream or claim: with its engines, if not all of them are in the set. */
static void list_entries(const struct merge *merge, const struct ranges *units, const char *heading,
                         cJSON *list)
{
    unsigned engines = results_engine_count(merge->input);
    const char *kind = merge->input->kind->unit;
    for (uint64_t unit = 0; unit < merge->input->count; unit += engines) {
        char text[NAME_TEXT];
        int length = snprintf(text, sizeof text, "%s %.200s", kind, input_name(merge, unit / engines));
        unsigned found = 0;
        for (unsigned e = 0; e < engines; e++)
            if (ranges_has(units, unit + e) && length < NAME_TEXT)
                length += snprintf(text + length, sizeof text - (size_t)length, "%s%s",
                                   found++ ? ", " : " with ", engine_name(merge, e));
        if (found && found == engines)
            snprintf(text, sizeof text, "%s %.200s", kind, input_name(merge, unit / engines));
        if (found)
            add_line(list, heading, text);
    }
}

static void list_units(const struct merge *merge, const struct ranges *units, const char *heading,
                       cJSON *list)
{
    if (merge->input->kind->entries)
        list_entries(merge, units, heading, list);
    else
        list_cases(units, heading, list);
}

/* --- Machines ------------------------------------------------------------------------------------------- */

/* Adds the shards of an input: those that it was merged from, or itself. */
static void add_shards(const struct results *input, cJSON *shards)
{
    const cJSON *before = cJSON_GetObjectItemCaseSensitive(input->json, "shards"), *shard;
    if (cJSON_IsArray(before)) {
        cJSON_ArrayForEach(shard, before)
        {
            cJSON_AddItemToArray(shards, cJSON_Duplicate(shard, true));
        }
        return;
    }
    cJSON *json = cJSON_CreateObject();
    char *done = ranges_text(&input->done);
    if (!done || !cJSON_AddStringToObject(json, "done", done))
        tool_report_mark_incomplete();
    free(done);
    const cJSON *seconds = cJSON_GetObjectItemCaseSensitive(input->json, "seconds");
    if (!input->kind->entries && cJSON_IsNumber(seconds))
        cJSON_AddNumberToObject(json, "seconds", seconds->valuedouble);
    cJSON_AddItemToObject(json, "machine",
                          cJSON_Duplicate(cJSON_GetObjectItemCaseSensitive(input->json, "machine"), true));
    cJSON_AddItemToArray(shards, json);
}

struct sorted {
    uint64_t first;
    char *text;
    cJSON *shard;
};

static int compare_sorted(const void *a, const void *b)
{
    const struct sorted *x = a, *y = b;
    return x->first != y->first ? (x->first > y->first) - (x->first < y->first) : strcmp(x->text, y->text);
}

/* By their first units, then by their text. */
static cJSON *sort_shards(cJSON *shards)
{
    int count = cJSON_GetArraySize(shards);
    struct sorted *sorted = calloc((size_t)count + 1, sizeof *sorted);
    cJSON *ordered = cJSON_CreateArray();
    if (!sorted)
        tool_report_mark_incomplete();
    for (int i = 0; i < count && sorted; i++) {
        cJSON *shard = cJSON_DetachItemFromArray(shards, 0);
        sorted[i] = (struct sorted){strtoull(results_text(shard, "done"), NULL, 10),
                                    cJSON_PrintUnformatted(shard), shard};
    }
    if (sorted && tool_report_is_complete())
        qsort(sorted, (size_t)count, sizeof *sorted, compare_sorted);
    for (int i = 0; i < count && sorted; i++) {
        cJSON_AddItemToArray(ordered, sorted[i].shard);
        cJSON_free(sorted[i].text);
    }
    free(sorted);
    cJSON_Delete(shards);
    return ordered;
}

/* The fields of the first shard's machine that all shards share. */
static cJSON *common_machine(const cJSON *shards)
{
    cJSON *common = cJSON_CreateObject();
    const cJSON *field, *shard;
    cJSON_ArrayForEach(field, cJSON_GetObjectItemCaseSensitive(cJSON_GetArrayItem(shards, 0), "machine"))
    {
        bool same = true;
        cJSON_ArrayForEach(shard, shards)
        {
            const cJSON *machine = cJSON_GetObjectItemCaseSensitive(shard, "machine");
            same &= cJSON_Compare(field, cJSON_GetObjectItemCaseSensitive(machine, field->string), true);
        }
        if (same)
            cJSON_AddItemToObject(common, field->string, cJSON_Duplicate(field, true));
    }
    return common;
}

static cJSON *machine_of(const struct merge *merge, const cJSON *shards)
{
    if (!merge->canonical)
        return common_machine(shards);
    cJSON *machine = cJSON_CreateObject();
    cJSON_AddStringToObject(
        machine, "commit",
        results_text(cJSON_GetObjectItemCaseSensitive(merge->input->json, "machine"), "commit"));
    return machine;
}

/* --- The report ----------------------------------------------------------------------------------------- */

/* The fields that all inputs share. */
static void add_campaign(const struct merge *merge, cJSON *report)
{
    const struct results *first = merge->input;
    for (const char *const *field = first->kind->same; *field; field++) {
        const cJSON *value = cJSON_GetObjectItemCaseSensitive(first->json, *field);
        if (first->kind->engines && !strcmp(*field, "engines"))
            merge_executions(merge, report);
        else if (value)
            cJSON_AddItemToObject(report, *field, cJSON_Duplicate(value, true));
    }
}

static int make_report(struct merge *merge, cJSON *report)
{
    cJSON *shards = cJSON_CreateArray();
    for (unsigned i = 0; i < merge->inputs; i++)
        add_shards(&merge->input[i], shards);
    merge->shards = shards = sort_shards(shards);
    cJSON_AddStringToObject(report, "command", merge->input->kind->command);
    cJSON_AddItemToObject(report, "machine", machine_of(merge, shards));
    add_campaign(merge, report);
    int status = merge->input->kind->entries ? merge_entries(merge, report) : merge_counts(merge, report);
    cJSON_AddBoolToObject(report, "interrupted", merge->missing.count > 0);
    merge->shards = NULL;
    if (merge->canonical)
        cJSON_Delete(shards);
    else
        cJSON_AddItemToObject(report, "shards", shards);
    return status;
}

static int write_summary(const struct merge *merge, const char *path, cJSON *missing, cJSON *twice)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "command", "merge");
    cJSON_AddStringToObject(json, "results", merge->input->kind->command);
    cJSON_AddNumberToObject(json, "inputs", merge->inputs);
    cJSON_AddNumberToObject(json, "units", (double)merge->input->count);
    cJSON_AddNumberToObject(json, "done", (double)ranges_size(&merge->done));
    cJSON_AddItemToObject(json, "missing", missing);
    cJSON_AddItemToObject(json, "twice", twice);
    int status = path ? json_write(merge->self, json, path) : STATUS_OK;
    cJSON_Delete(json);
    return status;
}

/* Reports units that are missing or there twice. Results with units that are there twice are not written,
 * because a count cannot be divided. */
static int write_all(const struct merge *merge, const struct settings *settings, const char *output,
                     const cJSON *report)
{
    cJSON *missing = cJSON_CreateArray(), *twice = cJSON_CreateArray();
    list_units(merge, &merge->missing, "missing", missing);
    list_units(merge, &merge->twice, "twice", twice);
    int status = merge->twice.count ? STATUS_OK : json_write(merge->self, report, output);
    if (write_summary(merge, settings->json, missing, twice) || status)
        return STATUS_BAD;
    printf("%u results of %s: %" PRIu64 " of %" PRIu64 " units%s\n", merge->inputs,
           merge->input->kind->command, ranges_size(&merge->done), merge->input->count,
           merge->twice.count ? ", some of them twice: nothing is written" : "");
    return merge->missing.count || merge->twice.count ? STATUS_DIFFERENT : STATUS_OK;
}

static int load_all(struct merge *merge, char *const paths[], unsigned count)
{
    merge->input = calloc(count, sizeof *merge->input);
    if (!merge->input)
        return tool_fail(merge->self, "no memory for %u files", count);
    for (int status = STATUS_OK; merge->inputs < count;) {
        struct results *input = &merge->input[merge->inputs];
        status = results_load(merge->self, paths[merge->inputs++], input);
        if (status || results_match(merge->self, merge->input, input))
            return STATUS_BAD;
    }
    return gather_units(merge);
}

static void free_all(struct merge *merge)
{
    for (unsigned i = 0; i < merge->inputs; i++)
        results_free(&merge->input[i]);
    free(merge->input);
    ranges_free(&merge->done);
    ranges_free(&merge->missing);
    ranges_free(&merge->twice);
}

static int run(const struct command *self, void *data, const struct operands *operands)
{
    const struct settings *settings = data;
    const char *output = operands->value[0];
    struct merge merge = {.self = self, .canonical = settings->canonical};
    if (tool_check_output(self, output) || tool_check_output(self, settings->json))
        return STATUS_BAD;
    int status = load_all(&merge, operands->value + 1, (unsigned)operands->count - 1);
    cJSON *report = cJSON_CreateObject();
    if (!status && !merge.twice.count)
        status = make_report(&merge, report);
    if (!status)
        status = write_all(&merge, settings, output, report);
    cJSON_Delete(report);
    free_all(&merge);
    return status;
}

static const char notes[] =
    "The inputs are files of --json or --resume of triptych fuzz, verify, bench or claims, or of triptych\n"
    "merge, in any order. Inputs of different campaigns are refused. Units of work that no input has, or "
    "that\n"
    "several have, are printed, and the exit status is 1. If several have one, OUTPUT is not written.";

static const struct option options[] = {
    {"canonical", NULL, "leave out times and machines: the normal form, equal for one run and its shards",
     OPTION_IS_FLAG(struct settings, canonical)},
    {"json", "FILE", "write the units that are missing or there twice", OPTION_IS_FILE(struct settings, json),
     .extension = "json"},
    {0},
};

static const struct operand operands[] = {
    {"OUTPUT", "the merged results", .kind = OPERAND_OUTPUT, .extension = "json"},
    {"INPUT", "results of a shard", .kind = OPERAND_INPUT, .extension = "json", .repeated = true},
    {0},
};

const struct command command_merge = {
    .name = "merge",
    .summary = "join the results of a campaign's shards",
    .options = options,
    .operands = operands,
    .notes = notes,
    .settings_bytes = sizeof(struct settings),
    .run = run,
};
