#define _GNU_SOURCE
#include "command/simulate/simulate.h"

#include "base/clock.h"
#include "command/simulate/attach.h"
#include "command/simulate/model.h"
#include "command/support/interrupt.h"
#include "command/support/session.h"
#include "command/support/table.h"

#include <sched.h>
#include <stdlib.h>

static const char *const part_name[TIMELINE_KINDS] = {
    [TIMELINE_SUBMIT] = "submit", [TIMELINE_CUT] = "cut",     [TIMELINE_GEOMETRY] = "geometry",
    [TIMELINE_LINK] = "link",     [TIMELINE_TILES] = "tiles", [TIMELINE_MOVE] = "move"};

/* Of a stream and an engine. Times are means of the frames. */
struct simulation {
    const struct command *self;
    const struct stream *stream;
    const struct simulate_settings *settings;
    struct handover costs;
    unsigned engine, frames;
    struct timeline *samples; /* of a frame, one for each repetition */
    double *drawn_ns;         /* of a frame, one for each repetition */
    double one_thread;        /* the simulated frame of one thread */
};

/* --- Measuring ------------------------------------------------------------------------------------------ */

static void add_mean(struct model_time *sum, const struct model_time *time, unsigned frames)
{
    sum->frame += time->frame / frames;
    sum->busy += time->busy / frames;
    for (int kind = 0; kind < TIMELINE_KINDS; kind++)
        sum->part[kind] += time->part[kind] / frames;
}

static unsigned frame_number(const struct simulation *simulation, unsigned i)
{
    return session_spread(i, simulation->frames, simulation->stream->frame_count);
}

/* Draws the frame, recording the tasks. */
static int record(const struct simulation *simulation, struct session *session, unsigned frame,
                  struct timeline *timeline)
{
    if (session_seek(simulation->self, session, frame))
        return STATUS_BAD;
    simulate_attach(session->device, timeline);
    timeline_restart(timeline);
    int status = session_play(simulation->self, session, frame);
    timeline_end(timeline);
    simulate_attach(session->device, NULL);
    return status;
}

static int simulate_frame(const struct simulation *simulation, struct session *session, unsigned frame,
                          unsigned threads, struct model_time *time)
{
    const unsigned repetitions = simulation->settings->repetitions;
    struct error error = {""};
    int status = STATUS_OK;
    for (unsigned n = 0; n < repetitions && !status; n++) {
        simulation->samples[n].threads = threads;
        status = record(simulation, session, frame, simulation->samples + n);
    }
    if (!status && !timeline_take_medians(simulation->samples, repetitions))
        status = tool_fail(simulation->self, "no memory for a record of tasks");
    if (!status && model_run(simulation->samples, threads, &simulation->costs, time, &error))
        status = tool_fail(simulation->self, "%s", error.text);
    return status;
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static int measure_frame(const struct simulation *simulation, struct session *session, unsigned frame,
                         struct model_time *time)
{
    const unsigned repetitions = simulation->settings->repetitions;
    double *ns = simulation->drawn_ns;
    int status = STATUS_OK;
    for (unsigned n = 0; n < repetitions && !status; n++) {
        status = session_seek(simulation->self, session, frame);
        uint64_t begin = clock_ns();
        if (!status)
            status = session_play(simulation->self, session, frame);
        ns[n] = (double)(clock_ns() - begin);
    }
    qsort(ns, repetitions, sizeof *ns, compare);
    *time = (struct model_time){.frame = ns[repetitions / 2]};
    return status;
}

/* All frames: with `simulated` threads, or drawn with those of the device. The first time builds routines and
 * makes memory present. */
static int play_frames(const struct simulation *simulation, struct session *session, unsigned simulated,
                       struct model_time *mean)
{
    int status = STATUS_OK;
    *mean = (struct model_time){0};
    simulation->samples->threads = simulated;
    for (unsigned i = 0; i < simulation->frames && !status; i++)
        status = simulated ? record(simulation, session, frame_number(simulation, i), simulation->samples)
                           : session_play(simulation->self, session, frame_number(simulation, i));
    for (unsigned i = 0; i < simulation->frames && !status && !interrupt_signal(); i++) {
        struct model_time time = {0};
        unsigned frame = frame_number(simulation, i);
        status = simulated ? simulate_frame(simulation, session, frame, simulated, &time)
                           : measure_frame(simulation, session, frame, &time);
        add_mean(mean, &time, simulation->frames);
    }
    return status;
}

static int play(const struct simulation *simulation, unsigned threads, unsigned simulated,
                struct model_time *mean)
{
    struct session session = {0};
    int status = session_open(simulation->self, simulation->stream, simulation->engine, threads,
                              &simulation->settings->values, &session);
    if (!status)
        status = play_frames(simulation, &session, simulated, mean);
    session_close(&session);
    return status;
}

/* --- Reporting ------------------------------------------------------------------------------------------ */

static unsigned processors(void)
{
    cpu_set_t set;
    return sched_getaffinity(0, sizeof set, &set) ? 1 : (unsigned)CPU_COUNT(&set);
}

static void begin_table(struct table *table)
{
    table_column(table, "stream", TABLE_LEFT);
    table_column(table, "engine", TABLE_LEFT);
    table_column(table, "threads", TABLE_RIGHT);
    table_column(table, "ms/frame", TABLE_RIGHT);
    table_column(table, "speed-up", TABLE_RIGHT);
    table_column(table, "used %", TABLE_RIGHT);
    for (int kind = 0; kind < TIMELINE_KINDS; kind++) {
        char heading[TABLE_HEADING];
        snprintf(heading, sizeof heading, "%s %%", part_name[kind]);
        table_column(table, heading, TABLE_RIGHT);
    }
    table_column(table, "measured", TABLE_RIGHT);
    table_column(table, "model/measured", TABLE_RIGHT);
}

static double ratio(double a, double b)
{
    return b > 0 ? a / b : 0;
}

static void print_row(struct table *table, const struct simulation *simulation, const char *name,
                      unsigned threads, const struct model_time *time, double measured)
{
    table_cell(table, "%s", name);
    table_cell(table, "%s", triptych_engine_name(simulation->engine));
    table_cell(table, "%u", threads);
    table_cell(table, "%.3f", time->frame / 1e6);
    table_cell(table, "%.2f", ratio(simulation->one_thread, time->frame));
    table_cell(table, "%.1f", 100 * ratio(time->busy, time->frame * threads));
    for (int kind = 0; kind < TIMELINE_KINDS; kind++)
        table_cell(table, "%.1f", 100 * ratio(time->part[kind], time->frame));
    if (measured > 0)
        table_cell(table, "%.3f", measured / 1e6);
    else
        table_cell(table, "-");
    if (measured > 0)
        table_cell(table, "%.3f", time->frame / measured);
    else
        table_cell(table, "-");
}

static cJSON *json_row(const struct simulation *simulation, const char *name, unsigned threads,
                       const struct model_time *time, double measured)
{
    char key[32];
    cJSON *row = cJSON_CreateObject();
    cJSON_AddStringToObject(row, "stream", name);
    cJSON_AddStringToObject(row, "engine", triptych_engine_name(simulation->engine));
    cJSON_AddNumberToObject(row, "threads", threads);
    cJSON_AddNumberToObject(row, "frame_ns", time->frame);
    cJSON_AddNumberToObject(row, "speedup", ratio(simulation->one_thread, time->frame));
    cJSON_AddNumberToObject(row, "efficiency", ratio(time->busy, time->frame * threads));
    for (int kind = 0; kind < TIMELINE_KINDS; kind++) {
        snprintf(key, sizeof key, "%s_ns", part_name[kind]);
        cJSON_AddNumberToObject(row, key, time->part[kind]);
    }
    if (measured > 0)
        cJSON_AddNumberToObject(row, "measured_ns", measured);
    return row;
}

static int simulate_row(struct simulation *simulation, unsigned threads, struct table *table, cJSON *rows)
{
    char name[64];
    struct model_time time, real = {0};
    tool_path_stem(simulation->stream->path, name, sizeof name);
    tool_progress("%s: %s, threads: %u", name, triptych_engine_name(simulation->engine), threads);
    int status = play(simulation, 1, threads, &time);
    if (!status && threads <= processors())
        status = play(simulation, threads, 0, &real);
    if (status || interrupt_signal())
        return status;
    if (threads == 1)
        simulation->one_thread = time.frame;
    print_row(table, simulation, name, threads, &time, real.frame);
    cJSON_AddItemToArray(rows, json_row(simulation, name, threads, &time, real.frame));
    return tool_report_is_complete() ? STATUS_OK : tool_fail(simulation->self, "no memory for the report");
}

static int simulate_stream(struct simulation *simulation, const struct choice *engines, struct table *table,
                           cJSON *rows)
{
    const struct simulate_settings *settings = simulation->settings;
    int status = STATUS_OK;
    simulation->frames = simulation->stream->frame_count;
    if (settings->frames && settings->frames < simulation->frames)
        simulation->frames = settings->frames;
    for (unsigned i = 0; i < engines->count; i++) {
        simulation->engine = engines->index[i];
        for (unsigned threads = 1; threads <= settings->threads && !status && !interrupt_signal();
             threads *= 2)
            status = simulate_row(simulation, threads, table, rows);
    }
    return status;
}

static cJSON *json_handover(const struct handover *costs)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddNumberToObject(json, "enter_ns", costs->enter_ns);
    cJSON_AddNumberToObject(json, "wake_ns", costs->wake_ns);
    cJSON_AddNumberToObject(json, "leave_ns", costs->leave_ns);
    cJSON_AddNumberToObject(json, "take_ns", costs->take_ns);
    cJSON_AddNumberToObject(json, "poll_ns", costs->poll_ns);
    return json;
}

static int begin(struct simulation *simulation)
{
    struct error error = {""};
    if (handover_measure(&simulation->costs, &error))
        return tool_fail(simulation->self, "%s", error.text);
    simulation->samples = calloc(simulation->settings->repetitions, sizeof *simulation->samples);
    simulation->drawn_ns = calloc(simulation->settings->repetitions, sizeof *simulation->drawn_ns);
    return simulation->samples && simulation->drawn_ns
               ? STATUS_OK
               : tool_fail(simulation->self, "no memory for the samples");
}

static void end(struct simulation *simulation)
{
    for (unsigned n = 0; n < simulation->settings->repetitions && simulation->samples; n++)
        timeline_free(simulation->samples + n);
    free(simulation->samples);
    free(simulation->drawn_ns);
}

int simulate_run(const struct command *self, char **paths, unsigned count, const struct choice *engines,
                 const struct simulate_settings *settings, cJSON *report)
{
    struct table table = {0};
    struct simulation simulation = {.self = self, .settings = settings};
    cJSON *rows = cJSON_CreateArray();
    int status = begin(&simulation);
    begin_table(&table);
    for (unsigned i = 0; i < count && !status && !interrupt_signal(); i++) {
        struct stream *stream = session_load(self, paths[i]);
        simulation.stream = stream;
        status = stream ? simulate_stream(&simulation, engines, &table, rows) : STATUS_BAD;
        stream_free(stream);
    }
    tool_progress(NULL);
    if (!status)
        printf("handover: enter %.0f ns, wake %.0f ns, leave %.0f ns, take %.0f ns, poll %.0f ns\n",
               simulation.costs.enter_ns, simulation.costs.wake_ns, simulation.costs.leave_ns,
               simulation.costs.take_ns, simulation.costs.poll_ns);
    table_print(&table, 0, stdout);
    cJSON_AddItemToObject(report, "handover", json_handover(&simulation.costs));
    cJSON_AddItemToObject(report, "tasks", rows);
    end(&simulation);
    return status;
}
