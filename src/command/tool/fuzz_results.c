#include "command/tool/fuzz_results.h"
#include "command/bench/machine.h"
#include "command/results/results.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- Writing -------------------------------------------------------------------------------------------- */

static void add_settings(cJSON *json, const struct setting_values *values)
{
    char text[SETTING_TEXT];
    cJSON_AddStringToObject(json, "settings", setting_write(values, text));
}

static cJSON *json_finding(const struct campaign_finding *found)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddNumberToObject(json, "case", (double)found->number);
    cJSON_AddStringToObject(json, "outcome", outcome_name[found->finding.outcome]);
    if (found->finding.engine) {
        cJSON_AddStringToObject(json, "engine", found->finding.engine->name);
        cJSON_AddNumberToObject(json, "threads", found->finding.threads);
    }
    add_settings(json, &found->finding.settings);
    cJSON_AddStringToObject(json, "what", found->finding.what);
    return json;
}

/* The fields that determine the results. */
static void add_campaign(cJSON *json, const struct fuzz_results *results)
{
    const struct runner_options *run = &results->options->run;
    char shard[32];
    cJSON_AddNumberToObject(json, "seed", (double)results->seed);
    cJSON_AddNumberToObject(json, "first", (double)results->first);
    cJSON_AddNumberToObject(json, "count", (double)results->count);
    if (shard_is_part(&results->shard)) {
        snprintf(shard, sizeof shard, "%u/%u", results->shard.index, results->shard.count);
        cJSON_AddStringToObject(json, "shard", shard);
    }
    cJSON *engines = cJSON_AddArrayToObject(json, "engines");
    for (unsigned i = 0; i < run->engines; i++)
        cJSON_AddItemToArray(engines, cJSON_CreateString(run->engine[i]->name));
    cJSON *threads = cJSON_AddArrayToObject(json, "threads");
    for (unsigned i = 0; i < run->threads; i++)
        cJSON_AddItemToArray(threads, cJSON_CreateNumber(run->thread[i]));
    if (results->options->vary)
        cJSON_AddStringToObject(json, "settings", "random");
    else
        add_settings(json, &results->options->settings);
}

static void add_results(cJSON *json, const struct campaign *campaign)
{
    char *done = ranges_text(&campaign->done);
    cJSON_AddNumberToObject(json, "seconds", campaign->seconds);
    cJSON_AddNumberToObject(json, "pixels", (double)campaign->pixels);
    cJSON_AddNumberToObject(json, "cases", (double)campaign->cases);
    for (unsigned o = 0; o < OUTCOME_COUNT; o++)
        cJSON_AddNumberToObject(json, outcome_name[o], (double)campaign->outcomes[o]);
    cJSON_AddBoolToObject(json, "interrupted", campaign->interrupted);
    if (!done || !cJSON_AddStringToObject(json, "done", done))
        tool_report_mark_incomplete();
    free(done);
    cJSON *findings = cJSON_AddArrayToObject(json, "findings");
    for (unsigned i = 0; i < campaign->findings; i++)
        cJSON_AddItemToArray(findings, json_finding(&campaign->finding[i]));
}

static cJSON *make_json(const struct fuzz_results *results, const struct campaign *campaign)
{
    struct machine machine = machine_describe();
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "command", "fuzz");
    cJSON_AddItemToObject(json, "machine", machine_json(&machine));
    add_campaign(json, results);
    add_results(json, campaign);
    return json;
}

int fuzz_results_write(const struct command *self, const struct fuzz_results *results,
                       const struct campaign *campaign, const char *path)
{
    cJSON *json = make_json(results, campaign);
    int status = json_write(self, json, path);
    cJSON_Delete(json);
    return status;
}

/* --- Reading -------------------------------------------------------------------------------------------- */

static const struct engine *find_engine(const struct runner_options *run, const char *name)
{
    for (unsigned i = 0; i < run->engines; i++)
        if (!strcmp(run->engine[i]->name, name))
            return run->engine[i];
    return NULL;
}

static void read_finding(const cJSON *json, const struct runner_options *run, struct campaign_finding *found)
{
    *found = (struct campaign_finding){.number = (uint64_t)results_value(json, "case")};
    found->finding.engine = find_engine(run, results_text(json, "engine"));
    found->finding.threads = found->finding.engine ? (unsigned)results_value(json, "threads") : 0;
    setting_read(results_text(json, "settings"), &found->finding.settings, NULL);
    snprintf(found->finding.what, sizeof found->finding.what, "%.*s",
             (int)strcspn(results_text(json, "what"), "\n"), results_text(json, "what"));
    for (unsigned o = 0; o < OUTCOME_COUNT; o++)
        if (!strcmp(outcome_name[o], results_text(json, "outcome")))
            found->finding.outcome = o;
}

static void read_campaign(const struct results *file, const struct runner_options *run,
                          struct campaign *campaign)
{
    const cJSON *finding;
    campaign->cases = (uint64_t)results_value(file->json, "cases");
    campaign->pixels = (uint64_t)results_value(file->json, "pixels");
    campaign->seconds = results_value(file->json, "seconds");
    for (unsigned o = 0; o < OUTCOME_COUNT; o++)
        campaign->outcomes[o] = (uint64_t)results_value(file->json, outcome_name[o]);
    ranges_add_all(&campaign->done, &file->done);
    cJSON_ArrayForEach(finding, cJSON_GetObjectItemCaseSensitive(file->json, "findings"))
    {
        if (campaign->findings < CAMPAIGN_FINDINGS)
            read_finding(finding, run, &campaign->finding[campaign->findings++]);
    }
}

int fuzz_results_read(const struct command *self, const struct fuzz_results *results, const char *path,
                      struct campaign *earlier)
{
    static const struct campaign nothing;
    struct results fresh = {0}, file = {0};
    bool found;
    int status = results_take(self, "this campaign", make_json(results, &nothing), &fresh);
    if (!status)
        status = results_resume(self, path, &fresh, &file, &found);
    if (!status && found)
        read_campaign(&file, &results->options->run, earlier);
    if (!status && earlier->done.failed)
        status = tool_fail(self, "no memory for %s", path);
    results_free(&fresh);
    results_free(&file);
    return status;
}
