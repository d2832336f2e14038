/* A repetition opens a new device and plays the first frames of the stream in order, then again several
 * times. The first time of each frame is divided by the median of its later times; "worst" is the largest
 * quotient of the frames. The first frame of a device also touches memory for the first time, whatever the
 * engine.
 *
 * Two clocks: wall time, and the processor time of the thread that draws. Other work on a busy machine
 * changes the second clock less. It excludes background threads and other rendering threads. Engines take
 * turns; the results are medians over the repetitions. If interrupted, the command reports the repetitions
 * that all engines have done. */
#include "command/bench/bench_builds.h"

#include "base/clock.h"
#include "command/bench/execution.h"
#include "command/bench/machine.h"
#include "command/bench/summary.h"
#include "command/support/interrupt.h"
#include "command/support/json.h"
#include "command/support/session.h"
#include "command/support/table.h"
#include "triptych.h"

#include <stdlib.h>

enum { PASSES = 5 }; /* the first one is cold */

enum clock { CLOCK_WALL, CLOCK_THREAD, CLOCKS };

/* Of one engine by one clock, a value for each repetition: milliseconds of a warm frame, and quotients. */
struct cold {
    double *warm, *first, *worst;
};

struct settings {
    unsigned threads, repetitions, frames;
    struct setting_values values; /* of the renderer */
};

/* Where results go: a printed table and an array of JSON. */
struct output {
    struct table table;
    cJSON *rows;
};

static double now_ms(enum clock clock)
{
    return clock_seconds_of(clock == CLOCK_WALL ? CLOCK_MONOTONIC : CLOCK_THREAD_CPUTIME_ID) * 1e3;
}

/* A frame's time in a pass. */
static double *time_of(double *ms, unsigned frame, enum clock clock, unsigned pass)
{
    return ms + (frame * CLOCKS + clock) * PASSES + pass;
}

static int play_passes(const struct command *self, struct session *session, unsigned frames, double *ms)
{
    for (unsigned pass = 0; pass < PASSES; pass++)
        for (unsigned i = 0; i < frames && !interrupt_signal(); i++) {
            double start[CLOCKS];
            for (int clock = 0; clock < CLOCKS; clock++)
                start[clock] = now_ms(clock);
            if (session_play(self, session, i))
                return STATUS_BAD;
            for (int clock = 0; clock < CLOCKS; clock++)
                *time_of(ms, i, clock, pass) = now_ms(clock) - start[clock];
        }
    return STATUS_OK;
}

static void note(unsigned frames, double *ms, enum clock clock, unsigned repetition, struct cold *cold)
{
    double all = 0;
    for (unsigned i = 0; i < frames; i++) {
        double warm = summary_of(time_of(ms, i, clock, 1), PASSES - 1).median;
        double quotient = *time_of(ms, i, clock, 0) / warm;
        all += warm;
        if (!i)
            cold->first[repetition] = cold->worst[repetition] = quotient;
        if (cold->worst[repetition] < quotient)
            cold->worst[repetition] = quotient;
    }
    cold->warm[repetition] = all / frames;
}

static int repeat(const struct command *self, const struct stream *stream, unsigned engine,
                  const struct settings *settings, double *ms, unsigned repetition, struct cold cold[CLOCKS],
                  struct execution *execution)
{
    struct session session = {0};
    int status = session_open(self, stream, engine, settings->threads, &settings->values, &session);
    if (!status)
        status = play_passes(self, &session, settings->frames, ms);
    if (!status)
        execution_add_device(execution, session.device);
    session_close(&session);
    for (int clock = 0; clock < CLOCKS && !status && !interrupt_signal(); clock++)
        note(settings->frames, ms, clock, repetition, &cold[clock]);
    return status;
}

/* Adds the medians over the repetitions of an engine to the table and to the JSON. */
static void report(struct cold cold[CLOCKS], unsigned repetitions, struct table *table, cJSON *row)
{
    static const char *const names[CLOCKS][3] = {{"wall_warm_ms", "wall_first", "wall_worst"},
                                                 {"thread_warm_ms", "thread_first", "thread_worst"}};
    for (int clock = 0; clock < CLOCKS; clock++) {
        double *const values[] = {cold[clock].warm, cold[clock].first, cold[clock].worst};
        for (int i = 0; i < 3; i++) {
            double median = summary_of(values[i], repetitions).median;
            table_cell(table, i ? "%.2f" : "%.3f", median);
            cJSON_AddNumberToObject(row, names[clock][i], median);
        }
    }
}

static void report_all(const struct choice *engines, unsigned repetitions, struct cold (*cold)[CLOCKS],
                       const struct execution *executions, const char *name, struct output *output)
{
    for (unsigned i = 0; i < engines->count; i++) {
        cJSON *row = cJSON_CreateObject();
        cJSON_AddNumberToObject(row, "repetitions", repetitions);
        const char *engine = triptych_engine_name(engines->index[i]);
        table_cell(&output->table, "%s", name);
        table_cell(&output->table, "%s", engine);
        cJSON_AddStringToObject(row, "stream", name);
        cJSON_AddStringToObject(row, "engine", engine);
        execution_json(&executions[i], row);
        report(cold[i], repetitions, &output->table, row);
        cJSON_AddItemToArray(output->rows, row);
    }
}

static int measure(const struct command *self, const struct stream *stream, const struct choice *engines,
                   const struct settings *settings, struct output *output)
{
    char name[64];
    struct cold cold[CHOICE_CAPACITY][CLOCKS];
    struct execution executions[CHOICE_CAPACITY] = {0};
    const unsigned repetitions = settings->repetitions;
    double *ms = calloc((size_t)settings->frames * CLOCKS * PASSES, sizeof *ms);
    double *values = calloc((size_t)engines->count * CLOCKS * 3 * repetitions, sizeof *values), *at = values;
    int status = ms && values ? STATUS_OK : tool_fail(self, "no memory for %u repetitions", repetitions);
    for (unsigned i = 0; i < engines->count * CLOCKS && !status; i++, at += 3 * repetitions)
        cold[i / CLOCKS][i % CLOCKS] = (struct cold){at, at + repetitions, at + 2 * repetitions};
    tool_path_stem(stream->path, name, sizeof name);
    unsigned done = 0;
    while (done < repetitions && !status && !interrupt_signal()) {
        for (unsigned i = 0; i < engines->count && !status; i++) {
            tool_progress("%s: %s, run %u", name, triptych_engine_name(engines->index[i]), done + 1);
            status = repeat(self, stream, engines->index[i], settings, ms, done, cold[i], &executions[i]);
        }
        done += !interrupt_signal();
    }
    tool_progress(NULL);
    if (!status && done)
        report_all(engines, done, cold, executions, name, output);
    free(ms);
    free(values);
    return status;
}

static void begin_table(struct table *table)
{
    table_column(table, "stream", TABLE_LEFT);
    table_column(table, "engine", TABLE_LEFT);
    table_column(table, "wall: warm ms", TABLE_RIGHT);
    table_column(table, "first", TABLE_RIGHT);
    table_column(table, "worst", TABLE_RIGHT);
    table_column(table, "thread: warm ms", TABLE_RIGHT);
    table_column(table, "first", TABLE_RIGHT);
    table_column(table, "worst", TABLE_RIGHT);
}

int bench_cold(const struct command *self, char **paths, unsigned count, const struct choice *engines,
               unsigned threads, struct setting_values values, unsigned repetitions, unsigned frames,
               const char *json)
{
    char text[SETTING_TEXT];
    struct output output = {.rows = cJSON_CreateArray()};
    int status = STATUS_OK;
    begin_table(&output.table);
    for (unsigned i = 0; i < count && !status && !interrupt_signal(); i++) {
        struct stream *stream = session_load(self, paths[i]);
        if (!stream)
            return cJSON_Delete(output.rows), STATUS_BAD;
        struct settings settings = {threads, repetitions, stream->frame_count, values};
        if (frames && frames < settings.frames)
            settings.frames = frames;
        status = measure(self, stream, engines, &settings, &output);
        stream_free(stream);
    }
    table_print(&output.table, 0, stdout);
    cJSON *report = cJSON_CreateObject();
    struct machine machine = machine_describe();
    cJSON_AddItemToObject(report, "machine", machine_json(&machine));
    cJSON_AddNumberToObject(report, "threads", threads);
    cJSON_AddStringToObject(report, "settings", setting_write(&values, text));
    cJSON_AddItemToObject(report, "cold", output.rows);
    if (interrupt_signal())
        cJSON_AddStringToObject(report, "interrupted", interrupt_name());
    if (!status && json)
        status = json_write(self, report, json);
    cJSON_Delete(report);
    if (!status && interrupt_signal()) {
        printf("\ninterrupted by %s\n", interrupt_name());
        status = interrupt_status();
    }
    return status;
}
