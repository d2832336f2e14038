/* The results of `triptych bench` as tables, as JSON and as CSV. All three read the columns of bench.def. */
#ifndef COMMAND_BENCH_BENCH_REPORT_H
#define COMMAND_BENCH_BENCH_REPORT_H

#include "command/bench/bench_run.h"
#include "command/bench/machine.h"
#include "command/results/results.h"
#include "command/support/choose.h"
#include "command/support/shard.h"

enum { STREAM_NAME = 64 };

/* The fields that determine a measurement, and its part that this command has. */
struct bench_campaign {
    char **inputs; /* the paths of all streams */
    unsigned count;
    const struct choice *engines;
    unsigned threads, repetitions, frames; /* frames 0: all */
    struct setting_values settings;
    double seconds;
    struct shard shard;
    bool parts;             /* the results will be merged: they have every routine instead of summaries */
    struct results earlier; /* that are continued, or empty */
};

struct bench_stream {
    char name[STREAM_NAME];
    const char *path;
    unsigned number;        /* in the campaign */
    unsigned width, height; /* of the target at the end */
    unsigned frames;        /* played in a repetition */
    unsigned run_count, baseline, fastest;
    bool interrupted; /* it has fewer runs than requested */
    struct bench_run *runs;
};

struct bench {
    struct machine machine;
    const struct bench_campaign *campaign;
    unsigned threads;
    bool shaders; /* the calls of routines were measured */
    unsigned stream_count;
    struct bench_stream *streams;
};

void bench_print_machine(const struct bench *bench);
void bench_print_stream(const struct bench *bench, const struct bench_stream *stream);

/* The speed-ups of all streams side by side, and the routines of all streams by engine and unit. */
void bench_print_summary(const struct bench *bench);

/* Results without streams, which match those of the same campaign (command/results/results.h). */
cJSON *bench_json_empty(const struct bench_campaign *campaign);

/* The summary of the routines that an engine has built for a unit. bench_json_routines sorts them. */
struct bench_routines {
    const char *engine;
    unsigned unit;
    struct execution execution;
    size_t routines, coded, by_operation; /* all; with code; stitched from operation fragments */
    double *us, *bytes;                   /* build time; size, of those with code */
};
cJSON *bench_json_routines(const struct bench_routines *routines);

/* Both write the whole file or none. They return 0, or STATUS_BAD after a message. */
int bench_write_json(const struct command *self, const struct bench *bench, const char *path);
int bench_write_csv(const struct command *self, const struct bench *bench, const char *path);

#endif
