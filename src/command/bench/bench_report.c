#include "command/bench/bench_report.h"
#include "command/bench/bench_shaders.h"
#include "base/file.h"
#include "base/memory_file.h"
#include "contract/key.h"
#include "command/support/choose.h"
#include "command/support/interrupt.h"
#include "command/support/json.h"
#include "command/support/table.h"
#include "triptych.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *name, *heading;
    int decimals;
} columns[BENCH_COLUMNS] = {
#define COLUMN(name, heading, decimals, meaning) {#name, heading, decimals},
#include "command/bench/bench.def"
#undef COLUMN
};

enum { SHARD_NAME = 32 };

/* A quotient; 0 is one that was not computed. */
static void print_value(struct table *table, int decimals, double value)
{
    if (value > 0)
        table_cell(table, "%.*f", decimals, value);
    else
        table_cell(table, "-");
}

void bench_print_machine(const struct bench *bench)
{
    const struct machine *machine = &bench->machine;
    printf("%s, %u cores, %s\n%s, commit %s, %s\n", machine->model, machine->cores, machine->kernel,
           machine->compiler, machine->commit, machine->date);
}

/* How many times the fastest engine's frame time each other one needs, and if that difference is shown. */
static void print_order(const struct bench_stream *stream)
{
    struct table table = {0};
    printf("times the frame time of %s, with an interval of %s\n",
           triptych_engine_name(stream->runs[stream->fastest].engine), interval_method);
    table_column(&table, "engine", TABLE_LEFT);
    table_column(&table, "times", TABLE_RIGHT);
    table_column(&table, "low", TABLE_RIGHT);
    table_column(&table, "high", TABLE_RIGHT);
    table_column(&table, "difference", TABLE_LEFT);
    for (unsigned i = 0; i < stream->run_count; i++) {
        const struct bench_run *run = stream->runs + i;
        if (i == stream->fastest)
            continue;
        table_cell(&table, "%s", triptych_engine_name(run->engine));
        print_value(&table, 2, run->slower.times);
        print_value(&table, 2, run->slower.low);
        print_value(&table, 2, run->slower.high);
        table_cell(&table, "%s", interval_verdict(&run->slower, "faster", "slower"));
    }
    table_print(&table, 2, stdout);
}

void bench_print_stream(const struct bench *bench, const struct bench_stream *stream)
{
    struct table table = {0};
    char lanes[EXECUTION_TEXT];
    printf("\n%s: %u x %u, frames a run: %u, threads: %u%s\n", stream->name, stream->width, stream->height,
           stream->frames, bench->threads, stream->interrupted ? ", interrupted" : "");
    table_column(&table, "engine", TABLE_LEFT);
    table_column(&table, "lanes", TABLE_LEFT);
    table_column(&table, "set", TABLE_LEFT);
    for (int i = 0; i < BENCH_COLUMNS; i++)
        if (columns[i].heading[0])
            table_column(&table, columns[i].heading, TABLE_RIGHT);
    for (unsigned i = 0; i < stream->run_count; i++) {
        const struct execution *execution = &stream->runs[i].execution;
        table_cell(&table, "%s", triptych_engine_name(stream->runs[i].engine));
        table_cell(&table, "%s", execution_lanes(execution, lanes));
        table_cell(&table, "%s", execution_set(execution));
        for (int j = 0; j < BENCH_COLUMNS; j++)
            if (columns[j].heading[0] && j < COLUMN_speedup_vertex)
                table_cell(&table, "%.*f", columns[j].decimals, stream->runs[i].value[j]);
            else if (columns[j].heading[0])
                print_value(&table, columns[j].decimals, stream->runs[i].value[j]);
    }
    table_print(&table, 2, stdout);
    if (stream->run_count > 1)
        print_order(stream);
}

static void print_speedups(const struct bench *bench)
{
    struct table table = {0};
    const struct bench_stream *first = bench->streams;
    printf("\ntimes the speed of %s, by whole frames\n",
           triptych_engine_name(first->runs[first->baseline].engine));
    table_column(&table, "stream", TABLE_LEFT);
    double logarithms[CHOICE_CAPACITY] = {0};
    for (unsigned j = 0; j < first->run_count; j++)
        table_column(&table, triptych_engine_name(first->runs[j].engine), TABLE_RIGHT);
    for (unsigned i = 0; i < bench->stream_count; i++) {
        table_cell(&table, "%s", bench->streams[i].name);
        for (unsigned j = 0; j < first->run_count; j++) {
            double speedup = bench->streams[i].runs[j].value[COLUMN_speedup];
            table_cell(&table, "%.2f", speedup);
            logarithms[j] += log(speedup);
        }
    }
    table_cell(&table, "geometric mean");
    for (unsigned j = 0; j < first->run_count; j++)
        table_cell(&table, "%.2f", exp(logarithms[j] / bench->stream_count));
    table_print(&table, 2, stdout);
}

/* Build times and sizes of one engine's routines for one unit, over all streams. */
struct unit_summary {
    struct summary us, bytes;
    size_t by_operation; /* how many were stitched from operation fragments */
};

static size_t count_builds(const struct bench *bench, unsigned run)
{
    size_t count = 0;
    for (unsigned i = 0; i < bench->stream_count; i++)
        count += bench->streams[i].runs[run].build_count;
    return count;
}

/* The routines of an engine for a unit, of all streams. The arrays must be freed. Returns false, and marks
 * the report incomplete, if memory is short. */
static bool collect_unit(const struct bench *bench, unsigned run, struct bench_routines *routines)
{
    size_t all = count_builds(bench, run);
    routines->us = calloc(all + 1, sizeof *routines->us);
    routines->bytes = calloc(all + 1, sizeof *routines->bytes);
    if (!routines->us || !routines->bytes)
        return tool_report_mark_incomplete(), false;
    for (unsigned i = 0; i < bench->stream_count; i++)
        for (size_t j = 0; j < bench->streams[i].runs[run].build_count; j++) {
            const struct build *build = bench->streams[i].runs[run].builds + j;
            if (build->unit != routines->unit)
                continue;
            routines->us[routines->routines++] = build->us;
            routines->by_operation += build->by_operation;
            if (build->code_bytes > 0)
                routines->bytes[routines->coded++] = build->code_bytes;
        }
    return true;
}

static struct unit_summary summarize_unit(const struct bench *bench, unsigned run, unsigned unit)
{
    struct bench_routines routines = {.unit = unit};
    struct unit_summary summary = {0};
    if (collect_unit(bench, run, &routines))
        summary = (struct unit_summary){summary_of(routines.us, routines.routines),
                                        summary_of(routines.bytes, routines.coded), routines.by_operation};
    free(routines.us);
    free(routines.bytes);
    return summary;
}

static void print_builds(const struct bench *bench)
{
    struct table table = {0};
    puts("\nbuilding routines, all streams");
    table_column(&table, "engine", TABLE_LEFT);
    table_column(&table, "unit", TABLE_LEFT);
    static const char *const headings[] = {
        "routines", "by operation", "build us: min", "p10", "median", "p90",
        "p99",      "max",          "bytes: median", "min", "max"};
    for (size_t i = 0; i < sizeof headings / sizeof *headings; i++)
        table_column(&table, headings[i], TABLE_RIGHT);
    for (unsigned run = 0; run < bench->streams->run_count; run++)
        for (unsigned unit = 0; unit < UNIT_COUNT; unit++) {
            struct unit_summary summary = summarize_unit(bench, run, unit);
            table_cell(&table, "%s", triptych_engine_name(bench->streams->runs[run].engine));
            table_cell(&table, "%s", unit_name[unit]);
            table_cell(&table, "%zu", summary.us.count);
            table_cell(&table, "%zu", summary.by_operation);
            table_cell(&table, "%.1f", summary.us.least);
            table_cell(&table, "%.1f", summary.us.p10);
            table_cell(&table, "%.1f", summary.us.median);
            table_cell(&table, "%.1f", summary.us.p90);
            table_cell(&table, "%.1f", summary.us.p99);
            table_cell(&table, "%.1f", summary.us.most);
            table_cell(&table, "%.0f", summary.bytes.median);
            table_cell(&table, "%.0f", summary.bytes.least);
            table_cell(&table, "%.0f", summary.bytes.most);
        }
    table_print(&table, 2, stdout);
}

void bench_print_summary(const struct bench *bench)
{
    print_speedups(bench);
    print_builds(bench);
}

/* The times and sizes of all routines, by unit, to be summarized with those of other streams. */
static cJSON *json_parts(const struct bench_run *run)
{
    cJSON *json = cJSON_CreateArray();
    for (unsigned unit = 0; unit < UNIT_COUNT; unit++) {
        unsigned by_operation = 0;
        cJSON *part = cJSON_CreateObject();
        cJSON_AddStringToObject(part, "unit", unit_name[unit]);
        cJSON *us = cJSON_AddArrayToObject(part, "us"), *bytes = cJSON_AddArrayToObject(part, "bytes");
        for (size_t i = 0; i < run->build_count; i++) {
            const struct build *build = run->builds + i;
            if (build->unit != unit)
                continue;
            by_operation += build->by_operation;
            cJSON_AddItemToArray(us, cJSON_CreateNumber(build->us));
            if (build->code_bytes > 0)
                cJSON_AddItemToArray(bytes, cJSON_CreateNumber(build->code_bytes));
        }
        cJSON_AddNumberToObject(part, "by_operation", by_operation);
        cJSON_AddItemToArray(json, part);
    }
    return json;
}

/* A unit's code with addresses in it: routines, copies, and how often addresses were written. */
static cJSON *json_patched(const struct bench_run *run, unsigned unit)
{
    double routines = 0, copies = 0, patches = 0, waits = 0;
    for (size_t i = 0; i < run->build_count; i++) {
        const struct build *build = run->builds + i;
        if (build->unit != unit || !build->copies)
            continue;
        routines++;
        copies += build->copies;
        patches += build->patches;
        waits += build->waits;
    }
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "unit", unit_name[unit]);
    cJSON_AddNumberToObject(json, "routines", routines);
    cJSON_AddNumberToObject(json, "copies", copies);
    cJSON_AddNumberToObject(json, "draws", (double)run->draws);
    cJSON_AddNumberToObject(json, "patches", patches);
    cJSON_AddNumberToObject(json, "waits", waits);
    return json;
}

static void json_addresses(const struct bench_run *run, cJSON *json)
{
    bool any = false;
    for (size_t i = 0; i < run->build_count; i++)
        any |= run->builds[i].copies > 0;
    if (!any)
        return;
    cJSON *addresses = cJSON_AddArrayToObject(json, "addresses");
    for (unsigned unit = 0; unit < UNIT_COUNT; unit++)
        cJSON_AddItemToArray(addresses, json_patched(run, unit));
}

static cJSON *json_run(const struct bench_run *run, bool parts)
{
    static const char *const names[MEASURE_COUNT] = {
        [MEASURE_FRAME_MS] = "frame_ms", [MEASURE_VERTEX_NS] = "vertex_ns", [MEASURE_PIXEL_NS] = "pixel_ns"};
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "engine", triptych_engine_name(run->engine));
    execution_json(&run->execution, json);
    for (int i = 0; i < BENCH_COLUMNS; i++)
        cJSON_AddNumberToObject(json, columns[i].name, run->value[i]);
    cJSON_AddNumberToObject(json, "slower", run->slower.times);
    cJSON_AddNumberToObject(json, "slower_low", run->slower.low);
    cJSON_AddNumberToObject(json, "slower_high", run->slower.high);
    cJSON_AddBoolToObject(json, "difference_shown", interval_shows_difference(&run->slower));
    json_addresses(run, json);
    cJSON *samples = cJSON_AddObjectToObject(json, "samples");
    for (int i = 0; i < MEASURE_COUNT; i++)
        cJSON_AddItemToObject(samples, names[i],
                              cJSON_CreateDoubleArray(run->samples[i], (int)run->repetitions));
    if (parts) {
        execution_json_units(&run->execution, json);
        cJSON_AddItemToObject(json, "builds", json_parts(run));
    }
    return json;
}

static cJSON *json_stream(const struct bench_stream *stream, bool parts)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddNumberToObject(json, "number", stream->number);
    cJSON_AddStringToObject(json, "stream", stream->name);
    cJSON_AddStringToObject(json, "path", stream->path);
    cJSON_AddNumberToObject(json, "width", stream->width);
    cJSON_AddNumberToObject(json, "height", stream->height);
    cJSON_AddNumberToObject(json, "frames", stream->frames);
    if (stream->interrupted)
        cJSON_AddBoolToObject(json, "interrupted", true);
    cJSON_AddStringToObject(json, "fastest", triptych_engine_name(stream->runs[stream->fastest].engine));
    cJSON *runs = cJSON_AddArrayToObject(json, "engines");
    for (unsigned i = 0; i < stream->run_count; i++)
        cJSON_AddItemToArray(runs, json_run(stream->runs + i, parts));
    return json;
}

static cJSON *json_summary(const struct summary *summary)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddNumberToObject(json, "median", summary->median);
    cJSON_AddNumberToObject(json, "min", summary->least);
    cJSON_AddNumberToObject(json, "max", summary->most);
    cJSON_AddNumberToObject(json, "deviation", summary->deviation);
    cJSON_AddNumberToObject(json, "p10", summary->p10);
    cJSON_AddNumberToObject(json, "p90", summary->p90);
    cJSON_AddNumberToObject(json, "p99", summary->p99);
    return json;
}

cJSON *bench_json_routines(const struct bench_routines *routines)
{
    const struct summary us = summary_of(routines->us, routines->routines);
    const struct summary bytes = summary_of(routines->bytes, routines->coded);
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "engine", routines->engine);
    cJSON_AddStringToObject(json, "unit", unit_name[routines->unit]);
    execution_json(&routines->execution, json);
    cJSON_AddNumberToObject(json, "routines", (double)routines->routines);
    cJSON_AddNumberToObject(json, "by_operation", (double)routines->by_operation);
    cJSON_AddItemToObject(json, "build_us", json_summary(&us));
    cJSON_AddItemToObject(json, "code_bytes", json_summary(&bytes));
    return json;
}

static void add_builds(cJSON *builds, const struct bench *bench, unsigned run, unsigned unit)
{
    struct bench_routines routines = {.engine = triptych_engine_name(bench->streams->runs[run].engine),
                                      .unit = unit};
    for (unsigned i = 0; i < bench->stream_count; i++)
        execution_add_all(&routines.execution, &bench->streams[i].runs[run].execution);
    if (collect_unit(bench, run, &routines))
        cJSON_AddItemToArray(builds, bench_json_routines(&routines));
    free(routines.us);
    free(routines.bytes);
}

/* --- JSON ----------------------------------------------------------------------------------------------- */

static void add_campaign(cJSON *json, const struct bench_campaign *campaign)
{
    char shard[SHARD_NAME], settings[SETTING_TEXT];
    if (shard_is_part(&campaign->shard)) {
        snprintf(shard, sizeof shard, "%u/%u", campaign->shard.index, campaign->shard.count);
        cJSON_AddStringToObject(json, "shard", shard);
    }
    cJSON *inputs = cJSON_AddArrayToObject(json, "inputs");
    for (unsigned i = 0; i < campaign->count; i++)
        cJSON_AddItemToArray(inputs, cJSON_CreateString(campaign->inputs[i]));
    cJSON *engines = cJSON_AddArrayToObject(json, "engines");
    for (unsigned i = 0; i < campaign->engines->count; i++)
        cJSON_AddItemToArray(engines, cJSON_CreateString(triptych_engine_name(campaign->engines->index[i])));
    cJSON_AddStringToObject(json, "settings", setting_write(&campaign->settings, settings));
    cJSON_AddNumberToObject(json, "repetitions", campaign->repetitions);
    cJSON_AddNumberToObject(json, "seconds", campaign->seconds);
    if (campaign->frames)
        cJSON_AddNumberToObject(json, "frames", campaign->frames);
}

static cJSON *json_head(const struct bench_campaign *campaign, const struct machine *machine)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "command", "bench");
    cJSON_AddItemToObject(json, "machine", machine_json(machine));
    cJSON_AddNumberToObject(json, "threads", campaign->threads);
    cJSON_AddStringToObject(json, "interval", interval_method);
    add_campaign(json, campaign);
    return json;
}

cJSON *bench_json_empty(const struct bench_campaign *campaign)
{
    const struct machine machine = machine_describe();
    cJSON *json = json_head(campaign, &machine);
    cJSON_AddArrayToObject(json, "streams");
    return json;
}

/* The streams of the results that are continued, then those of this command. */
static void add_streams(cJSON *json, const struct bench *bench)
{
    const cJSON *entry, *earlier = bench->campaign->earlier.json;
    cJSON *streams = cJSON_AddArrayToObject(json, "streams");
    cJSON_ArrayForEach(entry, cJSON_GetObjectItemCaseSensitive(earlier, "streams"))
    {
        if (results_complete(entry))
            cJSON_AddItemToArray(streams, cJSON_Duplicate(entry, true));
    }
    for (unsigned i = 0; i < bench->stream_count; i++)
        cJSON_AddItemToArray(streams, json_stream(bench->streams + i, bench->campaign->parts));
}

int bench_write_json(const struct command *self, const struct bench *bench, const char *path)
{
    cJSON *json = json_head(bench->campaign, &bench->machine);
    if (interrupt_signal())
        cJSON_AddStringToObject(json, "interrupted", interrupt_name());
    add_streams(json, bench);
    if (!bench->campaign->parts) {
        cJSON *builds = cJSON_AddArrayToObject(json, "builds");
        for (unsigned run = 0; run < bench->streams->run_count; run++)
            for (unsigned unit = 0; unit < UNIT_COUNT; unit++)
                add_builds(builds, bench, run, unit);
    }
    if (bench->shaders)
        cJSON_AddItemToObject(json, "shaders", bench_json_shaders(bench));
    int status = json_write(self, json, path);
    cJSON_Delete(json);
    return status;
}

static void write_row(FILE *out, const struct bench *bench, const struct bench_stream *stream,
                      const struct bench_run *run)
{
    char lanes[EXECUTION_TEXT];
    fprintf(out, "%s,%s,%s,%s,%u,%u", stream->name, triptych_engine_name(run->engine),
            execution_lanes(&run->execution, lanes), execution_set(&run->execution), bench->threads,
            stream->frames);
    for (int i = 0; i < BENCH_COLUMNS; i++)
        fprintf(out, ",%.6g", run->value[i]);
    fputc('\n', out);
}

int bench_write_csv(const struct command *self, const struct bench *bench, const char *path)
{
    char *text = NULL;
    size_t bytes = 0;
    FILE *out = tool_report_is_complete() ? memory_file_open() : NULL;
    if (!out)
        return tool_fail(self, "no memory for %s", path);
    fputs("stream,engine,lanes,instruction_set,threads,frames", out);
    for (int i = 0; i < BENCH_COLUMNS; i++)
        fprintf(out, ",%s", columns[i].name);
    fputc('\n', out);
    for (unsigned i = 0; i < bench->stream_count; i++)
        for (unsigned j = 0; j < bench->streams[i].run_count; j++)
            write_row(out, bench, bench->streams + i, bench->streams[i].runs + j);
    struct error error = {""};
    int bad = memory_file_close(out, &text, &bytes) ? error_set(&error, "no memory for %s", path)
                                                    : file_write(path, text, bytes, &error);
    free(text);
    return bad ? tool_fail(self, "%s", error.text) : STATUS_OK;
}
