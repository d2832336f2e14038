/* Results of fuzz: counts are added, findings are in the order of their cases. */
#include "command/merge/merge.h"

#include <stdio.h>
#include <stdlib.h>

static double add(const struct merge *merge, const char *field)
{
    double sum = 0;
    for (unsigned i = 0; i < merge->inputs; i++)
        sum += results_value(merge->input[i].json, field);
    return sum;
}

static int compare_findings(const void *a, const void *b)
{
    double x = results_value(*(cJSON *const *)a, "case"), y = results_value(*(cJSON *const *)b, "case");
    return (x > y) - (x < y);
}

static unsigned count_findings(const struct merge *merge)
{
    unsigned count = 0;
    for (unsigned i = 0; i < merge->inputs; i++)
        count +=
            (unsigned)cJSON_GetArraySize(cJSON_GetObjectItemCaseSensitive(merge->input[i].json, "findings"));
    return count;
}

static void print_finding(const struct merge *merge, const cJSON *finding)
{
    const char *engine = results_text(finding, "engine");
    printf("seed %.0f case %.0f: %s", results_value(merge->input->json, "seed"),
           results_value(finding, "case"), results_text(finding, "outcome"));
    if (*engine)
        printf(": %s with %.0f thread%s%s%s", engine, results_value(finding, "threads"),
               results_value(finding, "threads") == 1 ? "" : "s",
               *results_text(finding, "settings") ? " and " : "", results_text(finding, "settings"));
    printf(": %s\n", results_text(finding, "what"));
}

static cJSON *merge_findings(const struct merge *merge)
{
    unsigned count = 0;
    const cJSON *finding;
    cJSON *findings = cJSON_CreateArray();
    const cJSON **list = malloc((count_findings(merge) + 1) * sizeof *list);
    if (!list)
        return tool_report_mark_incomplete(), findings;
    for (unsigned i = 0; i < merge->inputs; i++) {
        cJSON_ArrayForEach(finding, cJSON_GetObjectItemCaseSensitive(merge->input[i].json, "findings"))
        {
            list[count++] = finding;
        }
    }
    qsort(list, count, sizeof *list, compare_findings);
    for (unsigned i = 0; i < count; i++) {
        print_finding(merge, list[i]);
        cJSON_AddItemToArray(findings, cJSON_Duplicate(list[i], true));
    }
    free(list);
    return findings;
}

/* The shards are in order, so the sum is the same for every order of the inputs. */
static double add_seconds(const struct merge *merge)
{
    double sum = 0;
    const cJSON *shard;
    cJSON_ArrayForEach(shard, merge->shards)
    {
        sum += results_value(shard, "seconds");
    }
    return sum;
}

int merge_counts(const struct merge *merge, cJSON *report)
{
    char *done = ranges_text(&merge->done);
    if (!merge->canonical)
        cJSON_AddNumberToObject(report, "seconds", add_seconds(merge));
    cJSON_AddNumberToObject(report, "pixels", add(merge, "pixels"));
    cJSON_AddNumberToObject(report, "cases", add(merge, "cases"));
    for (int i = 0; results_outcomes[i]; i++)
        cJSON_AddNumberToObject(report, results_outcomes[i], add(merge, results_outcomes[i]));
    if (!done || !cJSON_AddStringToObject(report, "done", done))
        tool_report_mark_incomplete();
    free(done);
    cJSON_AddItemToObject(report, "findings", merge_findings(merge));
    return STATUS_OK;
}
