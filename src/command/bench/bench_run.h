/* One engine measured on one stream. */
#ifndef COMMAND_BENCH_BENCH_RUN_H
#define COMMAND_BENCH_BENCH_RUN_H

#include "shader/shader.h"
#include "command/bench/execution.h"
#include "command/bench/interval.h"
#include "command/bench/summary.h"
#include "command/support/session.h"

enum { REPETITIONS_MAXIMUM = 1000 };

enum bench_column {
#define COLUMN(name, heading, decimals, meaning) COLUMN_##name,
#include "command/bench/bench.def"
#undef COLUMN
    BENCH_COLUMNS
};

/* The quantities measured in each repetition. */
enum measure { MEASURE_FRAME_MS, MEASURE_VERTEX_NS, MEASURE_PIXEL_NS, MEASURE_COUNT };

/* A routine the engine built. */
struct build {
    unsigned unit;         /* enum unit */
    double us, code_bytes; /* code_bytes is 0 for engines that generate none */
    double parts, spills;  /* instructions or fragments; values that went to memory */
    double fused, carried; /* of operation fragments, as the interface has them */
    bool by_operation;     /* stitched from operation fragments */
    unsigned lanes;        /* of the routine */
    const char *instruction_set;
    double run_ns, elements;        /* of all calls, where they are measured */
    char shader[SHADER_NAME_BYTES]; /* empty: none */
    const char *model;
    unsigned slots;                /* instruction slots of the shader */
    uint64_t hash;                 /* of its tokens: what it is */
    double patches, waits, copies; /* of code with addresses, as the interface has them */
};

struct bench_run {
    unsigned engine; /* number of triptych_engine_name() */
    struct session session;
    unsigned repetitions;
    double *samples[MEASURE_COUNT]; /* REPETITIONS_MAXIMUM each, in order of time */
    double spent, last;             /* seconds: all measured repetitions, the last one */
    uint64_t hits, misses;          /* of the routine cache, in all measured repetitions */
    uint64_t draws;                 /* of all repetitions, and those before them */
    double value[BENCH_COLUMNS];    /* when finished */
    struct interval slower;         /* when rated: frame times against the fastest run of the stream */
    struct execution execution;     /* when finished */
    size_t build_count;
    struct build *builds; /* when finished */
};

/* Opens a session. Plays the first frames of the stream until `seconds` have passed or all are played, to
 * build routines and fill caches. With `measure` the calls of the routines are timed. Returns 0, or
 * STATUS_BAD after a message. */
int bench_run_start(const struct command *self, const struct stream *stream, unsigned engine,
                    unsigned threads, const struct setting_values *settings, bool measure, double seconds,
                    struct bench_run *run);

/* Plays `frames` frames, evenly spread over the stream, again and again for a tenth of a second at least, and
 * records one sample of each measure. If interrupted (interrupt.h), it records none. */
int bench_run_repeat(const struct command *self, unsigned frames, struct bench_run *run);

/* Reads the engine's counters and routines, closes the session and computes the columns except speed-ups. */
int bench_run_finish(const struct command *self, struct bench_run *run);

/* Compares a finished run with two others, which may be the same: the speed-ups are against `baseline`. */
int bench_run_rate(const struct command *self, const struct bench_run *baseline,
                   const struct bench_run *fastest, struct bench_run *run);

/* Frees all that the run holds, at any time. */
void bench_run_free(struct bench_run *run);

#endif
