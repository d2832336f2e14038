/* The results of `triptych bench` as tables, as JSON and as CSV. All three read the columns of bench.def. */
#ifndef COMMAND_BENCH_BENCH_REPORT_H
#define COMMAND_BENCH_BENCH_REPORT_H

#include "command/bench/bench_run.h"
#include "command/bench/machine.h"

enum { STREAM_NAME = 64 };

struct bench_stream {
    char name[STREAM_NAME];
    const char *path;
    unsigned width, height; /* of the target at the end */
    unsigned frames;        /* played in a repetition */
    unsigned run_count, baseline, fastest;
    bool interrupted; /* it has fewer runs than requested */
    struct bench_run *runs;
};

struct bench {
    struct machine machine;
    unsigned threads;
    bool shaders; /* the calls of routines were measured */
    unsigned stream_count;
    struct bench_stream *streams;
};

void bench_print_machine(const struct bench *bench);
void bench_print_stream(const struct bench *bench, const struct bench_stream *stream);

/* The speed-ups of all streams side by side, and the routines of all streams by engine and unit. */
void bench_print_summary(const struct bench *bench);

/* Both write the whole file or none. They return 0, or STATUS_BAD after a message. */
int bench_write_json(const struct command *self, const struct bench *bench, const char *path);
int bench_write_csv(const struct command *self, const struct bench *bench, const char *path);

#endif
