#include "command/timing/timing.h"

#include "base/clock.h"
#include "command/support/interrupt.h"
#include "command/support/session.h"
#include "command/support/table.h"
#include "command/timing/counters.h"

#include <stdlib.h>
#include <string.h>

/* Of the measured frames. */
struct timing {
    struct timing_counters counters;
    uint64_t frame_ns, resolve_ns;
    unsigned frames, width, height;
};

/* --- Measuring ------------------------------------------------------------------------------------------ */

static int resolve(const struct command *self, struct session *session, uint32_t *picture, size_t bytes,
                   struct timing *timing)
{
    uint64_t begin = clock_ns();
    if (triptych_read_color(session->device, picture, bytes))
        return tool_fail(self, "%s: %s", session->stream->path, triptych_error(session->device));
    timing->resolve_ns += clock_ns() - begin;
    return STATUS_OK;
}

/* Plays the frames again and again until the time is over, at least once. */
static int play(const struct command *self, struct session *session, const struct timing_settings *settings,
                unsigned frames, struct timing *timing)
{
    double end = clock_seconds() + settings->seconds;
    size_t bytes = (size_t)timing->width * timing->height * sizeof(uint32_t);
    uint32_t *picture = malloc(bytes);
    int status = picture ? STATUS_OK : tool_fail(self, "no memory for a picture of %zu bytes", bytes);
    do {
        for (unsigned i = 0; i < frames && !status; i++, timing->frames++) {
            uint64_t begin = clock_ns();
            status = session_play(self, session, session_spread(i, frames, session->stream->frame_count));
            timing->frame_ns += clock_ns() - begin;
            if (!status)
                status = resolve(self, session, picture, bytes, timing);
        }
    } while (!status && clock_seconds() < end && !interrupt_signal());
    free(picture);
    return status;
}

static int measure_session(const struct command *self, struct session *session,
                           const struct timing_settings *settings, struct timing *timing)
{
    struct timing_counters before;
    unsigned frames = session->stream->frame_count;
    if (settings->frames && settings->frames < frames)
        frames = settings->frames;
    for (unsigned i = 0; i < frames; i++)
        if (session_play(self, session, session_spread(i, frames, session->stream->frame_count)))
            return STATUS_BAD;
    triptych_target_size(session->device, &timing->width, &timing->height);
    timing_read(session->device, &before);
    if (play(self, session, settings, frames, timing))
        return STATUS_BAD;
    timing_read(session->device, &timing->counters);
    timing_subtract(&timing->counters, &before);
    return STATUS_OK;
}

static int measure(const struct command *self, const struct stream *stream, unsigned engine, unsigned threads,
                   const struct timing_settings *settings, struct timing *timing)
{
    struct session session = {0};
    *timing = (struct timing){0};
    int status = session_open_measured(self, stream, engine, threads, &settings->values, true, &session);
    if (!status)
        status = measure_session(self, &session, settings, timing);
    session_close(&session);
    return status;
}

/* --- Reporting ------------------------------------------------------------------------------------------ */

/* The time of a phase outside of these routines. Times of routines are taken within those of the phase,
 * but with other looks at the clock, so the difference may be less than 0. */
static double rest(uint64_t phase, uint64_t routines)
{
    return phase > routines ? (double)(phase - routines) : 0;
}

/* The share of the threads' time that is not used. */
static double idle(uint64_t wall, uint64_t busy, unsigned threads)
{
    double all = (double)wall * threads;
    return all > (double)busy ? (all - (double)busy) / all : 0;
}

static double ratio(double a, double b)
{
    return b > 0 ? a / b : 0;
}

static cJSON *json_row(const struct timing *t)
{
    const struct timing_counters *q = &t->counters;
    const double frames = t->frames, pixels = (double)t->width * t->height;
    const struct {
        const char *name;
        double value;
    } numbers[] = {
        {"frames", t->frames},
        {"threads", q->threads},
        {"frame_ns", (double)t->frame_ns / frames},
        {"vertex_ns", (double)q->routine_ns[UNIT_VERTEX] / frames},
        {"setup_ns", (double)q->routine_ns[UNIT_SETUP] / frames},
        {"geometry_ns",
         rest(q->geometry_ns, q->routine_ns[UNIT_VERTEX] + q->routine_ns[UNIT_SETUP]) / frames},
        {"tiles_ns", rest(q->tiles_ns, q->routine_ns[UNIT_PIXEL]) / frames},
        {"pixel_ns", (double)q->routine_ns[UNIT_PIXEL] / frames},
        {"all_ns", (double)(q->geometry_ns + q->tiles_ns) / frames},
        {"geometry_idle", idle(q->geometry_wall_ns, q->geometry_ns, q->threads)},
        {"tiles_idle", idle(q->tiles_wall_ns, q->tiles_ns, q->threads)},
        {"resolve_ns", (double)t->resolve_ns / frames},
        {"vertices_shaded", (double)q->vertices_shaded / frames},
        {"vertices_read", (double)q->vertices_read / frames},
        {"triangles_set_up", (double)q->triangles_set_up / frames},
        {"triangles_visible", (double)q->triangles_visible / frames},
        {"tile_triangles", (double)q->tile_triangles / frames},
        {"pixels_shaded", (double)q->pixels_shaded / frames},
        {"overdraw", ratio((double)q->pixels_shaded / frames, pixels)},
        {"pixel_calls", ratio((double)q->pixel_calls, (double)q->tiles)},
        {"rounds", (double)q->rounds / frames},
        {"records_bytes", (double)q->records_bytes},
    };
    cJSON *row = cJSON_CreateObject();
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        cJSON_AddNumberToObject(row, numbers[i].name, numbers[i].value);
    return row;
}

static void begin_table(struct table *table)
{
    static const char *const names[] = {"vertex %",  "setup %",    "geometry %", "raster %",
                                        "pixel %",   "resolve %",  "idle %",     "shaded/read",
                                        "tiles/tri", "calls/tile", "overdraw",   "records KiB"};
    table_column(table, "stream", TABLE_LEFT);
    table_column(table, "engine", TABLE_LEFT);
    table_column(table, "threads", TABLE_RIGHT);
    table_column(table, "ms/frame", TABLE_RIGHT);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        table_column(table, names[i], TABLE_RIGHT);
}

static void print_row(struct table *table, const struct timing *t, const cJSON *row)
{
    static const char *const stages[] = {"vertex_ns", "setup_ns", "geometry_ns",
                                         "tiles_ns",  "pixel_ns", "resolve_ns"};
    enum { STAGES = sizeof stages / sizeof *stages };
    const struct timing_counters *q = &t->counters;
    double value[STAGES], all = 0;
    for (int i = 0; i < STAGES; i++)
        all += value[i] = cJSON_GetObjectItem(row, stages[i])->valuedouble;
    table_cell(table, "%u", q->threads);
    table_cell(table, "%.3f", (double)t->frame_ns / t->frames / 1e6);
    for (int i = 0; i < STAGES; i++)
        table_cell(table, "%.1f", 100 * ratio(value[i], all));
    table_cell(table, "%.1f",
               100 * idle(q->geometry_wall_ns + q->tiles_wall_ns, q->geometry_ns + q->tiles_ns, q->threads));
    table_cell(table, "%.3f", ratio((double)q->vertices_shaded, (double)q->vertices_read));
    table_cell(table, "%.2f", ratio((double)q->tile_triangles, (double)q->triangles_visible));
    table_cell(table, "%.2f", ratio((double)q->pixel_calls, (double)q->tiles));
    table_cell(table, "%.2f", cJSON_GetObjectItem(row, "overdraw")->valuedouble);
    table_cell(table, "%.0f", (double)q->records_bytes / 1024);
}

static int measure_engine(const struct command *self, const struct stream *stream, unsigned engine,
                          unsigned threads, const struct timing_settings *settings, struct table *table,
                          cJSON *rows)
{
    char name[64];
    struct timing timing;
    tool_path_stem(stream->path, name, sizeof name);
    tool_progress("%s: %s, threads: %u", name, triptych_engine_name(engine), threads);
    int status = measure(self, stream, engine, threads, settings, &timing);
    cJSON *row = status ? NULL : json_row(&timing);
    if (!row || !tool_report_is_complete())
        return cJSON_Delete(row), status ? status : tool_fail(self, "no memory for the report");
    cJSON_AddStringToObject(row, "stream", name);
    cJSON_AddStringToObject(row, "engine", triptych_engine_name(engine));
    table_cell(table, "%s", name);
    table_cell(table, "%s", triptych_engine_name(engine));
    print_row(table, &timing, row);
    cJSON_AddItemToArray(rows, row);
    return STATUS_OK;
}

/* The number of threads that follows in the curve: twice as many, up to those of the settings. */
static unsigned more_threads(unsigned threads, const struct timing_settings *settings)
{
    unsigned most = settings->threads;
    return threads >= most ? most + 1 : 2 * threads < most ? 2 * threads : most;
}

static int measure_stream(const struct command *self, const struct stream *stream,
                          const struct choice *engines, const struct timing_settings *settings,
                          struct table *table, cJSON *rows)
{
    int status = STATUS_OK;
    for (unsigned i = 0; i < engines->count; i++)
        for (unsigned threads = settings->curve ? 1 : settings->threads;
             threads <= settings->threads && !status && !interrupt_signal();
             threads = more_threads(threads, settings))
            status = measure_engine(self, stream, engines->index[i], threads, settings, table, rows);
    return status;
}

int timing_run(const struct command *self, char **paths, unsigned count, const struct choice *engines,
               const struct timing_settings *settings, cJSON *report)
{
    struct table table = {0};
    cJSON *rows = cJSON_CreateArray();
    int status = STATUS_OK;
    begin_table(&table);
    for (unsigned i = 0; i < count && !status && !interrupt_signal(); i++) {
        struct stream *stream = session_load(self, paths[i]);
        status = stream ? measure_stream(self, stream, engines, settings, &table, rows) : STATUS_BAD;
        stream_free(stream);
    }
    tool_progress(NULL);
    table_print(&table, 0, stdout);
    if (report)
        cJSON_AddItemToObject(report, "stages", rows);
    else
        cJSON_Delete(rows);
    return status;
}
