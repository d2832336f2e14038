/* A repetition opens a new device and plays the stream's first frames in order, then again several times. What a frame
 * takes the first time is compared with the median of its later times; "worst" is the largest quotient of the stream's
 * frames. The first frame of a device also has memory that nobody has touched, whatever the engine.
 *
 * Two clocks: the wall's, and the time that the thread that draws had a processor, which other work on a busy machine
 * moves less, and which knows nothing of what is done in the background (nor of other threads that draw). Engines take
 * turns; reported are medians over the repetitions. */
#include "tool/bench_cold.h"

#include "tool/interrupt.h"
#include "tool/sample.h"
#include "tool/session.h"
#include "tool/table.h"
#include "triptych.h"

#include <stdlib.h>
#include <time.h>

enum { PASSES = 5 }; /* the first of which is cold */

enum clock { CLOCK_WALL, CLOCK_THREAD, CLOCKS };

/* Of one engine by one clock, a value for each repetition: milliseconds of a warm frame, and quotients. */
struct cold {
    double *warm, *first, *worst;
};

struct settings {
    unsigned threads, repetitions, frames;
};

static double now_ms(enum clock clock)
{
    struct timespec time;
    clock_gettime(clock == CLOCK_WALL ? CLOCK_MONOTONIC : CLOCK_THREAD_CPUTIME_ID, &time);
    return (double)time.tv_sec * 1e3 + (double)time.tv_nsec * 1e-6;
}

/* A frame's time in a pass. */
static double *time_of(double *ms, unsigned frame, enum clock clock, unsigned pass)
{
    return ms + (frame * CLOCKS + clock) * PASSES + pass;
}

static int play_passes(const struct command *self, struct session *session, unsigned frames, double *ms)
{
    for (unsigned pass = 0; pass < PASSES; pass++)
        for (unsigned i = 0; i < frames; i++) {
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
        double warm = summarize(time_of(ms, i, clock, 1), PASSES - 1).median;
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
                  const struct settings *settings, double *ms, unsigned repetition, struct cold cold[CLOCKS])
{
    struct session session = {0};
    int status = session_open(self, stream, engine, settings->threads, &session);
    if (!status)
        status = play_passes(self, &session, settings->frames, ms);
    session_close(&session);
    for (int clock = 0; clock < CLOCKS && !status; clock++)
        note(settings->frames, ms, clock, repetition, &cold[clock]);
    return status;
}

static void report(const struct choice *engines, unsigned repetitions, struct cold (*cold)[CLOCKS],
                   const char *name, struct table *table)
{
    for (unsigned i = 0; i < engines->count; i++) {
        table_cell(table, "%s", name);
        table_cell(table, "%s", triptych_engine_name(engines->index[i]));
        for (int clock = 0; clock < CLOCKS; clock++) {
            table_cell(table, "%.3f", summarize(cold[i][clock].warm, repetitions).median);
            table_cell(table, "%.2f", summarize(cold[i][clock].first, repetitions).median);
            table_cell(table, "%.2f", summarize(cold[i][clock].worst, repetitions).median);
        }
    }
}

static int measure(const struct command *self, const struct stream *stream, const struct choice *engines,
                   const struct settings *settings, struct table *table)
{
    char name[64];
    struct cold cold[CHOICE_CAPACITY][CLOCKS];
    const unsigned repetitions = settings->repetitions;
    double *ms = calloc((size_t)settings->frames * CLOCKS * PASSES, sizeof *ms);
    double *values = calloc((size_t)engines->count * CLOCKS * 3 * repetitions, sizeof *values), *at = values;
    int status = ms && values ? STATUS_OK : fail(self, "no memory for %u repetitions", repetitions);
    for (unsigned i = 0; i < engines->count * CLOCKS && !status; i++, at += 3 * repetitions)
        cold[i / CLOCKS][i % CLOCKS] = (struct cold){at, at + repetitions, at + 2 * repetitions};
    path_stem(stream->path, name, sizeof name);
    for (unsigned r = 0; r < repetitions && !status && !interrupted(); r++)
        for (unsigned i = 0; i < engines->count && !status; i++) {
            progress("%s: %s, run %u", name, triptych_engine_name(engines->index[i]), r + 1);
            status = repeat(self, stream, engines->index[i], settings, ms, r, cold[i]);
        }
    progress(NULL);
    if (!status && !interrupted())
        report(engines, repetitions, cold, name, table);
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
               unsigned threads, unsigned repetitions, unsigned frames)
{
    struct table table = {0};
    int status = STATUS_OK;
    begin_table(&table);
    for (unsigned i = 0; i < count && !status && !interrupted(); i++) {
        struct stream *stream = session_load(self, paths[i]);
        if (!stream)
            return STATUS_BAD;
        struct settings settings = {threads, repetitions, stream->frame_count};
        if (frames && frames < settings.frames)
            settings.frames = frames;
        status = measure(self, stream, engines, &settings, &table);
        stream_free(stream);
    }
    table_print(&table, 0, stdout);
    return status || !interrupted() ? status : interrupt_status();
}
