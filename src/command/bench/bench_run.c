#include "command/bench/bench_run.h"
#include "base/clock.h"
#include "contract/key.h"
#include "shader/program/program.h"
#include "command/support/interrupt.h"

#include <stdlib.h>
#include <string.h>

/* Seconds. A shorter repetition would measure the caches that the engine before it left. */
static const double shortest_repetition = 0.1;

int bench_run_start(const struct command *self, const struct stream *stream, unsigned engine,
                    unsigned threads, const struct setting_values *settings, bool measure, double seconds,
                    struct bench_run *run)
{
    *run = (struct bench_run){.engine = engine};
    for (int i = 0; i < MEASURE_COUNT; i++)
        if (!(run->samples[i] = malloc(REPETITIONS_MAXIMUM * sizeof *run->samples[i])))
            return tool_fail(self, "no memory for %d repetitions", REPETITIONS_MAXIMUM);
    if (session_open_measured(self, stream, engine, threads, settings, measure, &run->session))
        return STATUS_BAD;
    double end = clock_seconds() + seconds;
    unsigned frames = stream->frame_count;
    for (unsigned i = 0; i < frames && (i == 0 || clock_seconds() < end) && !interrupt_signal(); i++)
        if (session_play(self, &run->session, i))
            return STATUS_BAD;
    return STATUS_OK;
}

static double per(uint64_t total, uint64_t count)
{
    return count ? (double)total / (double)count : 0;
}

/* Adds the time of the frame. The states that it begins with are set before. */
static int play_frame(const struct command *self, struct bench_run *run, unsigned frame, double *seconds)
{
    if (session_seek(self, &run->session, frame))
        return STATUS_BAD;
    double start = clock_seconds();
    int status = session_play(self, &run->session, frame);
    *seconds += clock_seconds() - start;
    return status;
}

int bench_run_repeat(const struct command *self, unsigned frames, struct bench_run *run)
{
    struct triptych_statistics before, after;
    unsigned played = 0, all = run->session.stream->frame_count;
    triptych_get_statistics(run->session.device, &before);
    double start = clock_seconds(), seconds = 0;
    do {
        for (unsigned i = 0; i < frames; i++)
            if (interrupt_signal())
                return STATUS_OK;
            else if (play_frame(self, run, session_spread(i, frames, all), &seconds))
                return STATUS_BAD;
        played += frames;
        run->last = clock_seconds() - start;
    } while (run->last < shortest_repetition);
    triptych_get_statistics(run->session.device, &after);

    run->spent += run->last;
    unsigned at = run->repetitions++;
    run->samples[MEASURE_FRAME_MS][at] = seconds * 1e3 / played;
    run->samples[MEASURE_VERTEX_NS][at] =
        per(after.vertex_ns - before.vertex_ns, after.vertices_shaded - before.vertices_shaded);
    run->samples[MEASURE_PIXEL_NS][at] =
        per(after.pixel_ns - before.pixel_ns, after.pixels_shaded - before.pixels_shaded);
    run->hits += after.cache_hits - before.cache_hits;
    run->misses += after.cache_misses - before.cache_misses;
    return STATUS_OK;
}

static enum unit unit_of(const char *name)
{
    enum unit unit = 0;
    while (unit + 1 < UNIT_ALL && strcmp(unit_name[unit], name))
        unit++;
    return unit;
}

static struct build build_of(const struct triptych_routine_info *info)
{
    const struct program *program = info->shader ? program_find(info->shader) : NULL;
    struct build build = {.unit = unit_of(info->unit),
                          .us = (double)info->build_ns / 1e3,
                          .code_bytes = info->code_bytes,
                          .parts = info->parts,
                          .spills = info->spills,
                          .fused = info->fused,
                          .carried = info->carried,
                          .by_operation = info->granularity && !strcmp(info->granularity, "operation"),
                          .lanes = info->lanes,
                          .instruction_set = info->instruction_set,
                          .run_ns = (double)info->run_ns,
                          .elements = (double)info->elements,
                          .patches = (double)info->patches,
                          .waits = (double)info->waits,
                          .copies = info->copies};
    if (!program)
        return build;
    memcpy(build.shader, program->name, sizeof build.shader);
    build.model = program->model->name;
    build.slots = program->slots;
    build.hash = program->hash;
    return build;
}

static int read_builds(const struct command *self, struct bench_run *run)
{
    struct triptych_routine_info info;
    struct triptych_statistics statistics;
    unsigned count = 0;
    while (triptych_get_routine(run->session.device, count, &info))
        count++;
    run->builds = calloc(count + 1, sizeof *run->builds);
    if (!run->builds)
        return tool_fail(self, "no memory for %u routines", count);
    for (; run->build_count < count && triptych_get_routine(run->session.device, run->build_count, &info);
         run->build_count++)
        run->builds[run->build_count] = build_of(&info);
    execution_add_device(&run->execution, run->session.device);
    triptych_get_statistics(run->session.device, &statistics);
    run->draws = statistics.draws;
    return STATUS_OK;
}

static int summarize_builds(const struct command *self, struct bench_run *run)
{
    size_t coded = 0;
    double *us = malloc((run->build_count + 1) * 2 * sizeof *us);
    if (!us)
        return tool_fail(self, "no memory for %zu routines", run->build_count);
    double *bytes = us + run->build_count;
    for (size_t i = 0; i < run->build_count; i++) {
        us[i] = run->builds[i].us;
        if (run->builds[i].code_bytes > 0)
            bytes[coded++] = run->builds[i].code_bytes;
    }
    struct summary times = summary_of(us, run->build_count), sizes = summary_of(bytes, coded);
    run->value[COLUMN_routines] = (double)run->build_count;
    run->value[COLUMN_build_us] = times.median;
    run->value[COLUMN_build_us_p99] = times.p99;
    run->value[COLUMN_code_bytes] = sizes.median;
    free(us);
    return STATUS_OK;
}

/* The columns of a measure are consecutive: median, least, most, deviation. The samples keep their order. */
static void summarize_measure(struct bench_run *run, enum measure measure, enum bench_column first)
{
    double sorted[REPETITIONS_MAXIMUM], *column = run->value + first;
    memcpy(sorted, run->samples[measure], run->repetitions * sizeof *sorted);
    struct summary summary = summary_of(sorted, run->repetitions);
    column[0] = summary.median;
    column[1] = summary.least;
    column[2] = summary.most;
    column[3] = summary.deviation;
}

int bench_run_finish(const struct command *self, struct bench_run *run)
{
    if (read_builds(self, run) || summarize_builds(self, run))
        return STATUS_BAD;
    session_close(&run->session);

    run->value[COLUMN_repetitions] = run->repetitions;
    run->value[COLUMN_hit_rate] = 100 * per(run->hits, run->hits + run->misses);
    summarize_measure(run, MEASURE_FRAME_MS, COLUMN_frame_ms);
    summarize_measure(run, MEASURE_VERTEX_NS, COLUMN_vertex_ns);
    summarize_measure(run, MEASURE_PIXEL_NS, COLUMN_pixel_ns);
    if (run->value[COLUMN_frame_ms] > 0)
        run->value[COLUMN_frames_per_second] = 1e3 / run->value[COLUMN_frame_ms];
    return STATUS_OK;
}

static void rate(const struct bench_run *baseline, struct bench_run *run, enum bench_column speedup,
                 enum bench_column measured)
{
    if (run->value[measured] > 0)
        run->value[speedup] = baseline->value[measured] / run->value[measured];
}

static int compare(const struct bench_run *a, const struct bench_run *b, struct interval *interval)
{
    return interval_of(a->samples[MEASURE_FRAME_MS], a->repetitions, b->samples[MEASURE_FRAME_MS],
                       b->repetitions, interval);
}

int bench_run_rate(const struct command *self, const struct bench_run *baseline,
                   const struct bench_run *fastest, struct bench_run *run)
{
    struct interval faster;
    if (compare(baseline, run, &faster) || compare(run, fastest, &run->slower))
        return tool_fail(self, "no memory to compare %u runs with %u", run->repetitions,
                         baseline->repetitions);
    run->value[COLUMN_speedup_low] = faster.low;
    run->value[COLUMN_speedup_high] = faster.high;
    rate(baseline, run, COLUMN_speedup_vertex, COLUMN_vertex_ns);
    rate(baseline, run, COLUMN_speedup_pixel, COLUMN_pixel_ns);
    rate(baseline, run, COLUMN_speedup, COLUMN_frame_ms);
    return STATUS_OK;
}

void bench_run_free(struct bench_run *run)
{
    session_close(&run->session);
    for (int i = 0; i < MEASURE_COUNT; i++)
        free(run->samples[i]);
    free(run->builds);
    *run = (struct bench_run){0};
}
