/* `triptych bench`: measures engines on the same streams, in one process.
 *
 * A repetition plays the same frames with every engine. The engines take turns, repetition by repetition, so
 * that other work, heat and changes of the clock frequency affect all of them equally. Each engine has one
 * device from warm-up to end, as an application would. Pictures are not read back.
 *
 * An engine stops early if its next repetition would exceed its share of seconds, but not before
 * REPETITIONS_MINIMUM: the emulator is slow, and a median needs several values. Every second round is in the
 * opposite order, so that a machine that steadily gets slower or faster does so for all engines.
 *
 * If interrupted (interrupt.h), the command reports the streams that are done, and the one at hand if each
 * engine has REPETITIONS_MINIMUM. */
#include "command/bench/bench_builds.h"
#include "command/bench/bench_compare.h"
#include "command/bench/bench_report.h"
#include "command/bench/bench_shaders.h"
#include "command/bench/chart.h"
#include "engines/specialize/passes/pass.h"
#include "command/bench/machine.h"
#include "command/count/count.h"
#include "command/simulate/simulate.h"
#include "command/support/choose.h"
#include "command/support/interrupt.h"
#include "command/support/json.h"
#include "command/support/option.h"
#include "command/support/shared.h"
#include "command/store/store.h"
#include "command/timing/timing.h"
#include "triptych.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { REPETITIONS_MINIMUM = 3, FRAMES_MAXIMUM = 65536, SECONDS_MAXIMUM = 86400 };

static const double warm_up_share = 0.1; /* of an engine's seconds */

struct settings {
    const char *engines, *json, *csv, *chart, *shard, *resume;
    unsigned threads, repetitions, frames; /* frames 0: all */
    double seconds;
    bool shaders;    /* a table of each shader */
    bool builds;     /* routines are built, no picture is drawn */
    bool parts;      /* routines are built, and the parts of each build measured */
    bool code;       /* routines are built, and their instructions counted */
    bool cold;       /* frames whose routines are not built yet */
    bool stages;     /* the time and the work of each stage */
    bool curve;      /* with fewer threads, too */
    bool tasks;      /* more threads are simulated */
    bool counts;     /* what frames need of the cache and of tiers */
    unsigned budget; /* KiB of the cache; 0: the usual */
    bool no_cache;
    struct variation variation;
    struct option_given set;
    unsigned precision;
    bool compare; /* the operands are two files of earlier results */
};

static bool goes_on(const struct bench_run *run, const struct settings *settings)
{
    return run->repetitions < settings->repetitions &&
           (run->repetitions < REPETITIONS_MINIMUM || run->spent + run->last <= settings->seconds);
}

static int start_runs(const struct command *self, const struct stream *stream, const struct choice *engines,
                      const struct settings *settings, struct bench_stream *result)
{
    const struct setting_values values = choose_settings(&settings->set);
    result->runs = calloc(engines->count, sizeof *result->runs);
    if (!result->runs)
        return tool_fail(self, "no memory for %u engines", engines->count);
    for (; result->run_count < engines->count && !interrupt_signal(); result->run_count++) {
        const char *name = triptych_engine_name(engines->index[result->run_count]);
        tool_progress("%s: %s, warming up", result->name, name);
        if (!strcmp(name, "emulate"))
            result->baseline = result->run_count;
        struct bench_run *run = result->runs + result->run_count;
        if (bench_run_start(self, stream, engines->index[result->run_count], settings->threads, &values,
                            settings->shaders, settings->seconds * warm_up_share, run))
            return bench_run_free(run), STATUS_BAD;
    }
    return STATUS_OK;
}

static int repeat_all(const struct command *self, const struct settings *settings,
                      struct bench_stream *result)
{
    bool going_on = true;
    for (unsigned round = 0; going_on; round++) {
        going_on = false;
        for (unsigned i = 0; i < result->run_count && !interrupt_signal(); i++) {
            struct bench_run *run = result->runs + (round % 2 ? result->run_count - 1 - i : i);
            if (!goes_on(run, settings))
                continue;
            going_on = true;
            tool_progress("%s: %s, run %u", result->name, triptych_engine_name(run->engine),
                          run->repetitions + 1);
            if (bench_run_repeat(self, result->frames, run))
                return STATUS_BAD;
        }
    }
    return STATUS_OK;
}

/* Returns true if an interrupted stream can be reported. */
static bool is_enough(const struct bench_stream *result, unsigned engines)
{
    bool enough = result->run_count == engines;
    for (unsigned i = 0; i < result->run_count; i++)
        enough = enough && result->runs[i].repetitions >= REPETITIONS_MINIMUM;
    return enough;
}

static int finish_all(const struct command *self, struct bench_stream *result)
{
    triptych_target_size(result->runs->session.device, &result->width, &result->height);
    for (unsigned i = 0; i < result->run_count; i++)
        if (bench_run_finish(self, result->runs + i))
            return STATUS_BAD;
    for (unsigned i = 0; i < result->run_count; i++)
        if (result->runs[i].value[COLUMN_frame_ms] < result->runs[result->fastest].value[COLUMN_frame_ms])
            result->fastest = i;
    for (unsigned i = 0; i < result->run_count; i++)
        if (bench_run_rate(self, result->runs + result->baseline, result->runs + result->fastest,
                           result->runs + i))
            return STATUS_BAD;
    return STATUS_OK;
}

/* The stream's name becomes a field of the CSV: what would end the field is replaced. */
static void name_stream(const char *path, char name[STREAM_NAME])
{
    tool_path_stem(path, name, STREAM_NAME);
    for (char *at = name; (at = strpbrk(at, ",\"\r\n"));)
        *at = '_';
}

/* Sets *done if the result can be reported. */
static int bench_one(const struct command *self, const char *path, const struct choice *engines,
                     const struct settings *settings, struct bench_stream *result, bool *done)
{
    result->path = path;
    name_stream(path, result->name);
    struct stream *stream = session_load(self, path);
    if (!stream)
        return STATUS_BAD;
    stream->precision = settings->precision;
    result->frames = stream->frame_count;
    if (settings->frames && settings->frames < result->frames)
        result->frames = settings->frames;
    int status = start_runs(self, stream, engines, settings, result);
    if (!status)
        status = repeat_all(self, settings, result);
    result->interrupted = interrupt_signal();
    *done = !status && (!result->interrupted || is_enough(result, engines->count));
    if (*done)
        status = finish_all(self, result);
    for (unsigned i = 0; i < result->run_count; i++)
        session_close(&result->runs[i].session);
    stream_free(stream);
    return status;
}

static void free_stream(struct bench_stream *stream)
{
    for (unsigned i = 0; i < stream->run_count; i++)
        bench_run_free(stream->runs + i);
    free(stream->runs);
    *stream = (struct bench_stream){0};
}

/* Returns true if the shard has the stream, and the results that are continued do not. */
static bool is_selected(const struct bench_campaign *campaign, unsigned number)
{
    uint64_t first, count;
    shard_part(&campaign->shard, campaign->count, &first, &count);
    return number >= first && number - first < count && !ranges_has(&campaign->earlier.done, number);
}

static unsigned count_selected(const struct bench_campaign *campaign)
{
    unsigned count = 0;
    for (unsigned i = 0; i < campaign->count; i++)
        count += is_selected(campaign, i);
    return count;
}

/* Measures the selected streams until all are done or the command is interrupted. bench->stream_count is the
 * number of streams that are reported. The file of --resume is written after each. */
static int measure_all(const struct command *self, const struct settings *settings, struct bench *bench)
{
    const struct bench_campaign *campaign = bench->campaign;
    int status = STATUS_OK;
    for (unsigned i = 0; i < campaign->count && !status && !interrupt_signal(); i++) {
        bool done = false;
        struct bench_stream *stream = bench->streams + bench->stream_count;
        if (!is_selected(campaign, i))
            continue;
        stream->number = i;
        status = bench_one(self, campaign->inputs[i], campaign->engines, settings, stream, &done);
        tool_progress(NULL);
        if (status || !done)
            return free_stream(stream), status;
        if (!bench->stream_count++)
            bench_print_machine(bench);
        bench_print_stream(bench, stream);
        fflush(stdout);
        if (settings->resume)
            status = bench_write_json(self, bench, settings->resume);
    }
    return status;
}

static int bench_all(const struct command *self, const struct settings *settings, struct bench *bench)
{
    int status = measure_all(self, settings, bench);
    if (status || !bench->stream_count)
        return status;
    bench_print_summary(bench);
    return settings->shaders ? bench_print_shaders(self, bench) : STATUS_OK;
}

/* The last stream may have fewer runs than requested. */
static unsigned count_whole(const struct bench *bench)
{
    unsigned count = bench->stream_count;
    return count && bench->streams[count - 1].interrupted ? count - 1 : count;
}

static void free_bench(struct bench *bench)
{
    for (unsigned i = 0; i < bench->stream_count; i++)
        free_stream(bench->streams + i);
    free(bench->streams);
}

static const char notes[] =
    "Each engine draws each stream: first a warm-up of up to a tenth of the seconds, then runs. Runs end\n"
    "when the repetitions are done or the next run would exceed the seconds; there are at least 3. A run\n"
    "plays the frames, and repeats them until it has taken a tenth of a second. The report has medians,\n"
    "min, max and the median absolute deviation (mad). ns/vertex is geometry time per shaded vertex,\n"
    "ns/pixel is tile time per shaded pixel, both summed over threads. ms/frame is wall time, without the\n"
    "states that a frame begins with, which are set before. \"x\" columns: times the speed of emulate or,\n"
    "without it, of the first engine.\n"
    "low and high are an interval of 95 % (Mann-Whitney), over the quotients of each run of one engine and\n"
    "each run of the other. If it contains 1, no difference is shown. It covers changes during this "
    "command;\n"
    "between two commands a machine can change more.\n"
    "With --builds, each repetition builds every routine that the streams' draws need once. The report has\n"
    "the medians for single routines, for the three routines of a draw, and for bursts: the most for ten\n"
    "routines that the first frame of a stream needs one after the other.\n"
    "With --parts, the report has the time of each part of a build by the specializer, over all routines, "
    "and\n"
    "of each pass its runs, the instructions that it removed and those left after its first run.\n"
    "With --code, the report has the instructions of the routines, those that read and write memory, and "
    "those\n"
    "that do so in the stack frame; the file of --json has them for each routine.\n"
    "SIGINT or SIGTERM ends it with a report of the finished part, in the files too, and status 130 or 143.\n"
    "A shard has some of the streams. With --shard or --resume, the JSON has the routines themselves and "
    "not\n"
    "\"builds\", their summary over all streams: triptych merge adds it.";

/* Writes the files of whole results, or of a part. */
static int write_files(const struct command *self, const struct settings *settings, const struct bench *bench)
{
    int status = STATUS_OK;
    if (settings->resume)
        status = bench_write_json(self, bench, settings->resume);
    if (!status && settings->json)
        status = bench_write_json(self, bench, settings->json);
    if (!status && settings->csv)
        status = bench_write_csv(self, bench, settings->csv);
    return status ? status : chart_write(self, bench, settings->chart);
}

/* Reads the shard and the results to continue. */
static int begin_campaign(const struct command *self, const struct settings *settings,
                          struct bench_campaign *campaign)
{
    struct results fresh = {0};
    bool found;
    if (shard_read(self, settings->shard, &campaign->shard))
        return STATUS_BAD;
    campaign->parts = shard_is_part(&campaign->shard) || settings->resume;
    if (!settings->resume)
        return STATUS_OK;
    int status = results_take(self, "this campaign", bench_json_empty(campaign), &fresh);
    if (!status)
        status = results_resume(self, settings->resume, &fresh, &campaign->earlier, &found);
    results_free(&fresh);
    return status;
}

static int measure_campaign(const struct command *self, const struct settings *settings,
                            const struct bench_campaign *campaign)
{
    struct bench bench = {machine_describe(), campaign, settings->threads, settings->shaders, 0, NULL};
    unsigned count = count_selected(campaign);
    bench.streams = calloc(count + 1, sizeof *bench.streams);
    if (!bench.streams)
        return tool_fail(self, "no memory for %u streams", count);
    int status = bench_all(self, settings, &bench);
    if (!status)
        status = write_files(self, settings, &bench);
    if (!status && interrupt_signal()) {
        printf("\ninterrupted by %s: %u of %u streams\n", interrupt_name(), count_whole(&bench), count);
        status = interrupt_status();
    }
    free_bench(&bench);
    return status;
}

/* The usual measurement: every engine in turns. */
static int bench_frames(const struct command *self, const struct operands *operands,
                        const struct choice *engines, const struct settings *settings)
{
    struct bench_campaign campaign = {.inputs = operands->value,
                                      .count = (unsigned)operands->count,
                                      .engines = engines,
                                      .threads = settings->threads,
                                      .settings = choose_settings(&settings->set),
                                      .repetitions = settings->repetitions,
                                      .frames = settings->frames,
                                      .seconds = settings->seconds};
    int status = begin_campaign(self, settings, &campaign);
    if (!status)
        status = measure_campaign(self, settings, &campaign);
    results_free(&campaign.earlier);
    return status;
}

/* Results that summarize all streams cannot be made from parts. */
static int check_parts(const struct command *self, const struct settings *settings)
{
    const struct {
        bool given;
        const char *name;
    } whole[] = {
        {settings->compare, "compare"}, {settings->builds, "builds"},      {settings->cold, "cold"},
        {settings->shaders, "shaders"}, {settings->code, "code"},          {settings->parts, "parts"},
        {settings->counts, "counts"},   {settings->stages, "stages"},      {settings->tasks, "tasks"},
        {settings->csv != NULL, "csv"}, {settings->chart != NULL, "chart"}};
    if (!settings->shard && !settings->resume)
        return STATUS_OK;
    for (size_t i = 0; i < sizeof whole / sizeof *whole; i++)
        if (whole[i].given)
            return tool_fail(self, "--%s and --%s are both given, expected one of them", whole[i].name,
                             settings->shard ? "shard" : "resume");
    return STATUS_OK;
}

/* Writes and frees the report of a command that ended with `status`. Returns the exit status. */
static int end_report(const struct command *self, const struct settings *settings, cJSON *report, int status)
{
    if (interrupt_signal())
        cJSON_AddStringToObject(report, "interrupted", interrupt_name());
    if (!status && settings->json)
        status = json_write(self, report, settings->json);
    cJSON_Delete(report);
    return status || !interrupt_signal() ? status : interrupt_status();
}

static int bench_counts(const struct command *self, const struct operands *operands,
                        const struct choice *engines, const struct settings *settings)
{
    const struct count_settings counts = {settings->threads, settings->frames, settings->budget,
                                          choose_settings(&settings->set)};
    struct machine machine = machine_describe();
    cJSON *report = cJSON_CreateObject();
    cJSON_AddItemToObject(report, "machine", machine_json(&machine));
    int status = count_all(self, operands->value, (unsigned)operands->count, engines, &counts, report);
    return end_report(self, settings, report, status);
}

static int bench_stages(const struct command *self, const struct operands *operands,
                        const struct choice *engines, const struct settings *settings)
{
    const struct timing_settings timing = {settings->threads, settings->frames, settings->curve,
                                           settings->seconds, choose_settings(&settings->set)};
    struct machine machine = machine_describe();
    char text[SETTING_TEXT];
    cJSON *report = cJSON_CreateObject();
    cJSON_AddItemToObject(report, "machine", machine_json(&machine));
    cJSON_AddNumberToObject(report, "threads", settings->threads);
    cJSON_AddStringToObject(report, "settings", setting_write(&timing.values, text));
    int status = timing_run(self, operands->value, (unsigned)operands->count, engines, &timing, report);
    return end_report(self, settings, report, status);
}

static int bench_tasks(const struct command *self, const struct operands *operands,
                       const struct choice *engines, const struct settings *settings)
{
    enum { SIMULATED = 128 };
    const struct simulate_settings tasks = {settings->threads > 1 ? settings->threads : SIMULATED,
                                            settings->frames, settings->repetitions,
                                            choose_settings(&settings->set)};
    if (tasks.values.of[SETTING_queue] == SETTING_queue_priority)
        return tool_fail(self, "--tasks with queue=priority, expected a queue whose rounds do not overlap");
    struct machine machine = machine_describe();
    cJSON *report = cJSON_CreateObject();
    cJSON_AddItemToObject(report, "machine", machine_json(&machine));
    int status = simulate_run(self, operands->value, (unsigned)operands->count, engines, &tasks, report);
    return end_report(self, settings, report, status);
}

static int run(const struct command *self, void *data, const struct operands *operands)
{
    const struct settings *settings = data;
    struct choice engines;
    unsigned count = (unsigned)operands->count;
    store_off |= settings->no_cache;
    if (check_parts(self, settings))
        return STATUS_BAD;
    if (settings->curve && !settings->stages)
        return tool_fail(self, "--curve is given without --stages, expected both");
    if (settings->budget && !settings->counts)
        return tool_fail(self, "--budget is given without --counts, expected both");
    if (settings->compare && count != 2)
        return tool_fail(self, "--compare has %u operands, expected two files that --json wrote", count);
    if (settings->compare)
        return bench_compare(self, operands->value, settings->json);
    if (choose_engines(self, settings->engines, &engines) ||
        choose_variants(self, &settings->variation, &engines) || chart_check(self, settings->chart) ||
        tool_check_output(self, settings->json) || tool_check_output(self, settings->csv) ||
        tool_check_output(self, settings->resume))
        return STATUS_BAD;
    interrupt_defer();
    if (settings->builds)
        return bench_builds(self, operands->value, count, &engines, settings->repetitions, settings->json);
    if (settings->parts)
        return bench_parts(self, operands->value, count, settings->engines, &engines, settings->repetitions,
                           settings->json);
    if (settings->code)
        return bench_code(self, operands->value, count, &engines, settings->json);
    if (settings->stages)
        return bench_stages(self, operands, &engines, settings);
    if (settings->tasks)
        return bench_tasks(self, operands, &engines, settings);
    if (settings->counts)
        return bench_counts(self, operands, &engines, settings);
    if (settings->cold)
        return bench_cold(self, operands->value, count, &engines, settings->threads,
                          choose_settings(&settings->set), settings->repetitions, settings->frames,
                          settings->json);
    return bench_frames(self, operands, &engines, settings);
}

static const struct settings defaults = {.threads = 1, .repetitions = 15, .seconds = 10};

static const struct option options[] = {
    {"engines", "LIST", "engines, separated by commas; all that can run here",
     OPTION_IS_LIST(struct settings, engines), .words = triptych_engine_name},
    OPTIONS_OF_VARIATION(struct settings, variation),
    {"threads", "N", "rendering threads of each device; 1", OPTION_IS_NUMBER(struct settings, threads),
     .least = 1, .most = 256},
    OPTION_SET(struct settings, set),
    OPTION_PRECISION(struct settings, precision),
    {"repetitions", "N", "runs measured at most; 15", OPTION_IS_NUMBER(struct settings, repetitions),
     .least = REPETITIONS_MINIMUM, .most = REPETITIONS_MAXIMUM},
    {"seconds", "S", "time of an engine on a stream; 10", OPTION_IS_SECONDS(struct settings, seconds),
     .most = SECONDS_MAXIMUM},
    {"frames", "N", "frames of a run, spread over the stream; all", OPTION_IS_NUMBER(struct settings, frames),
     .least = 1, .most = FRAMES_MAXIMUM},
    {"shaders", NULL, "measure each routine's calls, with tables by shader and by length",
     OPTION_IS_FLAG(struct settings, shaders)},
    {"builds", NULL, "measure instead the time to build the streams' routines",
     OPTION_IS_FLAG(struct settings, builds)},
    {"parts", NULL, "measure instead the parts of a build: recording, each pass, allocation, code",
     OPTION_IS_FLAG(struct settings, parts)},
    {"code", NULL, "count instead the instructions and memory operands of the streams' routines",
     OPTION_IS_FLAG(struct settings, code)},
    {"cold", NULL, "measure instead the first frames of a new device", OPTION_IS_FLAG(struct settings, cold)},
    {"stages", NULL, "measure instead the time of each stage, idle threads, and the work of stages",
     OPTION_IS_FLAG(struct settings, stages)},
    {"curve", NULL, "with --stages, also with 1, 2, 4 and so on up to --threads threads",
     OPTION_IS_FLAG(struct settings, curve)},
    {"tasks", NULL, "simulate instead 1, 2, 4 and so on up to --threads threads; 128",
     OPTION_IS_FLAG(struct settings, tasks)},
    {"counts", NULL, "count instead keys, hits, misses, evictions, builds, states a frame and runs of tiers",
     OPTION_IS_FLAG(struct settings, counts)},
    {"budget", "KIB", "with --counts, the budget of the cache; 16 MiB",
     OPTION_IS_NUMBER(struct settings, budget), .least = 1, .most = 1 << 20},
    {"json", "FILE", "write everything, each run included", OPTION_IS_FILE(struct settings, json),
     .extension = "json"},
    {"csv", "FILE", "write a row per stream and engine", OPTION_IS_FILE(struct settings, csv),
     .extension = "csv"},
    {"chart", "FILE", "draw the speed-ups with gnuplot: .svg or .png, several with commas",
     OPTION_IS_FILE(struct settings, chart), .extension = "svg png"},
    {"compare", NULL, "measure nothing, compare two files of --json: A.json B.json",
     OPTION_IS_FLAG(struct settings, compare)},
    OPTION_SHARD(struct settings, shard),
    OPTION_RESUME(struct settings, resume),
    OPTION_NO_CACHE(struct settings, no_cache),
    {0},
};

static const struct operand operands[] = {
    {"STREAM", "a draw stream; with --compare, a file of --json", .kind = OPERAND_INPUT,
     .extension = "tri trib json", .repeated = true},
    {0},
};

const struct command command_bench = {
    .name = "bench",
    .summary = "measure the engines against each other",
    .options = options,
    .operands = operands,
    .notes = notes,
    .defaults = &defaults,
    .settings_bytes = sizeof defaults,
    .run = run,
};
