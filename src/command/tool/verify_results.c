#include "command/tool/verify_results.h"
#include "command/bench/machine.h"
#include "triptych.h"

#include <stdio.h>
#include <string.h>

enum { SHARD_TEXT = 32 };

/* --- Writing -------------------------------------------------------------------------------------------- */

/* The fields that determine the results. */
static void add_campaign(const struct verify_results *results, cJSON *json)
{
    char shard[SHARD_TEXT];
    if (shard_is_part(&results->shard)) {
        snprintf(shard, sizeof shard, "%u/%u", results->shard.index, results->shard.count);
        cJSON_AddStringToObject(json, "shard", shard);
    }
    cJSON *inputs = cJSON_AddArrayToObject(json, "inputs");
    for (int i = 0; i < results->operands->count; i++)
        cJSON_AddItemToArray(inputs, cJSON_CreateString(results->operands->value[i]));
    cJSON *threads = cJSON_AddArrayToObject(json, "threads");
    for (unsigned i = 0; i < results->threads->count; i++)
        cJSON_AddItemToArray(threads, cJSON_CreateNumber(results->threads->index[i]));
    cJSON *renderer = cJSON_AddArrayToObject(json, "settings");
    for (unsigned i = 0; i < results->renderer->count; i++) {
        char text[SETTING_TEXT];
        setting_write(&results->renderer->values[i], text);
        cJSON_AddItemToArray(renderer, cJSON_CreateString(text));
    }
    if (results->frames)
        cJSON_AddNumberToObject(json, "frames", results->frames);
    else
        cJSON_AddStringToObject(json, "frames", "all");
    cJSON_AddNumberToObject(json, "shuffle", results->shuffle);
    if (results->golden->folder) {
        cJSON_AddStringToObject(json, "golden", results->golden->folder);
        cJSON_AddNumberToObject(json, "tolerance", results->golden->tolerance);
    }
}

static void add_engines(const struct verify_results *results, cJSON *json)
{
    cJSON *engines = cJSON_AddArrayToObject(json, "engines");
    for (unsigned i = 0; i < results->engines->count; i++) {
        cJSON *engine = cJSON_CreateObject();
        cJSON_AddStringToObject(engine, "engine", triptych_engine_name(results->engines->index[i]));
        execution_json(&results->executions[i], engine);
        execution_json_units(&results->executions[i], engine);
        cJSON_AddItemToArray(engines, engine);
    }
}

void verify_results_verdict(cJSON *json, enum verify_verdict verdict)
{
    if (verdict == VERIFY_UNKNOWN)
        cJSON_AddNullToObject(json, "identical");
    else
        cJSON_AddBoolToObject(json, "identical", verdict == VERIFY_IDENTICAL);
}

static cJSON *make_json(const struct verify_results *results, enum verify_verdict verdict)
{
    struct machine machine = machine_describe();
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "command", "verify");
    cJSON_AddItemToObject(json, "machine", machine_json(&machine));
    verify_results_verdict(json, verdict);
    add_campaign(results, json);
    add_engines(results, json);
    return json;
}

int verify_results_keep(const struct verify_results *results, enum verify_verdict verdict)
{
    if (!results->resume)
        return STATUS_OK;
    cJSON *json = make_json(results, verdict);
    cJSON_AddItemReferenceToObject(json, "streams", results->streams);
    int status = json_write(results->self, json, results->resume);
    cJSON_Delete(json);
    return status;
}

int verify_results_write(const struct verify_results *results, enum verify_verdict verdict,
                         const char *interrupted)
{
    cJSON *json = make_json(results, verdict);
    int status = STATUS_OK;
    if (interrupted)
        cJSON_AddStringToObject(json, "interrupted", interrupted);
    cJSON_AddItemReferenceToObject(json, "streams", results->streams);
    if (results->resume)
        status = json_write(results->self, json, results->resume);
    if (results->path && !status)
        status = json_write(results->self, json, results->path);
    cJSON_Delete(json);
    return status;
}

cJSON *verify_results_add(struct verify_results *results, unsigned stream, const char *name,
                          const bool selected[CHOICE_CAPACITY])
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddNumberToObject(json, "number", stream);
    cJSON_AddStringToObject(json, "stream", name);
    cJSON_AddStringToObject(json, "path", results->operands->value[stream]);
    cJSON *engines = cJSON_AddArrayToObject(json, "engines");
    for (unsigned i = 0; i < results->engines->count; i++)
        if (selected[i])
            cJSON_AddItemToArray(engines,
                                 cJSON_CreateString(triptych_engine_name(results->engines->index[i])));
    cJSON_AddItemToArray(results->streams, json);
    return json;
}

void verify_results_difference(cJSON *differences, const char *engine, unsigned threads, const char *settings,
                               unsigned frame, const struct difference *difference, const char *text)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "engine", engine);
    cJSON_AddNumberToObject(json, "threads", threads);
    cJSON_AddStringToObject(json, "settings", settings);
    cJSON_AddNumberToObject(json, "frame", frame);
    cJSON_AddNumberToObject(json, "x", difference->x);
    cJSON_AddNumberToObject(json, "y", difference->y);
    cJSON_AddNumberToObject(json, "color_pixels", (double)difference->color_pixels);
    cJSON_AddNumberToObject(json, "depth_pixels", (double)difference->depth_pixels);
    cJSON_AddNumberToObject(json, "stencil_pixels", (double)difference->stencil_pixels);
    cJSON_AddNumberToObject(json, "number_pixels", (double)difference->number_pixels);
    cJSON_AddStringToObject(json, "what", text);
    cJSON_AddItemToArray(differences, json);
}

/* --- Continuing ----------------------------------------------------------------------------------------- */

static void read_execution(const cJSON *engine, struct execution *execution)
{
    struct execution other = {.instruction_set = results_text(engine, "instruction_set")};
    execution_units(engine, other.lanes);
    execution_add_all(execution, &other);
}

/* Takes the complete entries. Streams that differ are counted even if the comparison ended early. */
static void read_earlier(struct verify_results *results)
{
    const cJSON *json = results->earlier.json, *entry, *engine;
    unsigned i = 0;
    cJSON_ArrayForEach(entry, cJSON_GetObjectItemCaseSensitive(json, "streams"))
    {
        if (!results_complete(entry))
            continue;
        results->different += !cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(entry, "identical"));
        cJSON_AddItemToArray(results->streams, cJSON_Duplicate(entry, true));
    }
    if (!results->different && cJSON_IsFalse(cJSON_GetObjectItemCaseSensitive(json, "identical")))
        results->different = 1;
    cJSON_ArrayForEach(engine, cJSON_GetObjectItemCaseSensitive(json, "engines"))
    {
        if (i < results->engines->count)
            read_execution(engine, &results->executions[i++]);
    }
}

int verify_results_begin(struct verify_results *results)
{
    struct results fresh = {0};
    bool found;
    results->streams = results->path || results->resume ? cJSON_CreateArray() : NULL;
    if (!results->resume)
        return STATUS_OK;
    cJSON *json = make_json(results, VERIFY_UNKNOWN);
    cJSON_AddArrayToObject(json, "streams");
    int status = results_take(results->self, "this campaign", json, &fresh);
    if (!status)
        status = results_resume(results->self, results->resume, &fresh, &results->earlier, &found);
    if (!status && found)
        read_earlier(results);
    results_free(&fresh);
    return status;
}

void verify_results_free(struct verify_results *results)
{
    cJSON_Delete(results->streams);
    results_free(&results->earlier);
}

unsigned verify_results_select(const struct verify_results *results, unsigned stream,
                               bool selected[CHOICE_CAPACITY])
{
    unsigned engines = results->engines->count, found = 0;
    uint64_t first, count;
    shard_part(&results->shard, (uint64_t)results->operands->count * engines, &first, &count);
    for (unsigned i = 0; i < engines; i++) {
        uint64_t unit = (uint64_t)stream * engines + i;
        selected[i] = unit >= first && unit - first < count && !ranges_has(&results->earlier.done, unit);
        found += selected[i];
    }
    return found;
}
