/* The measurements: the renderers, and the samples of all passes for each workload and renderer. */
#ifndef BENCH_PEERS_DRIVE_H
#define BENCH_PEERS_DRIVE_H

#include "peer.h"
#include "command/bench/machine.h"

#include <stdio.h>
#include <sys/types.h>

enum { RENDERERS_MAXIMUM = 32, PASSES_MAXIMUM = 64, NAME_BYTES = 48, REASON_BYTES = 256 };

enum cores { ONE, ALL };
/* An engine of Triptych; another renderer; a renderer for only some of the workloads, which has its own
 * means. */
enum side { ENGINE, PEER, SPECIAL };

struct renderer {
    char name[NAME_BYTES]; /* without the suffix for all cores */
    enum side side;
    enum cores cores;
    char *command[32]; /* the first is null if the renderer is missing, for which `reason` has the reason */
    char text[1024];   /* the characters of the command's words */
    char description[REASON_BYTES], reason[REASON_BYTES];
    pid_t process;
    FILE *to, *from;
};

enum clocks { TIME, WORK, CLOCKS }; /* wall time, processor time */

enum agreement { UNKNOWN, IDENTICAL, SIMILAR, DIFFERENT };

/* The results of a renderer on a workload. All times in milliseconds are those of a layer, or of a frame if
 * the workload's rate is MS. */
struct cell {
    bool measured, less;       /* `less`: with fewer layers a frame */
    bool absent;               /* the renderer does not support the workload */
    char reason[REASON_BYTES]; /* the reason, if it was not measured */
    unsigned count;
    double ms[CLOCKS][PASSES_MAXIMUM], spent;
    double cold[CLOCKS], build_us;
    enum agreement agreement;
    double share; /* of pixels whose difference from the reference exceeds the workload's tolerance */
};

struct run {
    struct machine machine;
    unsigned renderer_count, passes;
    struct renderer renderers[RENDERERS_MAXIMUM];
    unsigned count; /* of the selected workloads */
    const struct workload *workloads[64];
    struct cell (*cells)[RENDERERS_MAXIMUM]; /* by workload */
    double seconds, budget;                  /* of a sample; of all passes of a renderer on a workload */
    int reference;                           /* the renderer with whose pictures others are compared */
    const char *folder;                      /* for pictures */
    const char *engine;                      /* the engine that is compared with peers */
    enum clocks clock;                       /* of the table for one core */
    bool bad;                                /* a renderer failed or a picture differs */
};

/* Starts the renderers, and ends them. Renderers that do not start become missing ones. */
void run_start(struct run *run);
void run_end(struct run *run);
/* Measures all workloads. */
void run_measure(struct run *run);

/* Write the tables as text, and all measurements as JSON. Return 0, or -1 if the file cannot be written. */
int report_text(const struct run *run, FILE *file);
int report_json(const struct run *run, const char *path);
/* Writes the columns stream, engine and speedup (the ratio to llvmpipe) for bench/peers/chart.gnuplot. */
int report_csv(const struct run *run, const char *path);

/* The rates of the machine, from limits.c, in billions a second; 0: not known. */
struct limits {
    double sums_avx2, sums_avx512;                  /* multiply-adds of one number */
    double store_first, store_second, store_memory; /* bytes */
    double gather_first, gather_second;             /* of 64 bits */
};
const struct limits *limits_measured(void);

#endif
