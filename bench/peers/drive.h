/* The measurements: renderers, and for each workload and renderer the samples of all passes. */
#ifndef BENCH_PEERS_DRIVE_H
#define BENCH_PEERS_DRIVE_H

#include "peer.h"
#include "command/bench/machine.h"

#include <stdio.h>
#include <sys/types.h>

enum { RENDERERS_MAXIMUM = 32, PASSES_MAXIMUM = 64, NAME_BYTES = 48, REASON_BYTES = 256 };

enum cores { ONE, ALL };
/* Triptych's; another renderer; one that is made for a part of the workloads, and compared with by itself. */
enum side { ENGINE, PEER, SPECIAL };

struct renderer {
    char name[NAME_BYTES]; /* without the cores */
    enum side side;
    enum cores cores;
    char *command[32]; /* null: none here, with a `reason` */
    char text[1024];   /* of the command's words */
    char description[REASON_BYTES], reason[REASON_BYTES];
    pid_t process;
    FILE *to, *from;
};

enum clocks { TIME, WORK, CLOCKS }; /* of the wall, of the processor */

enum agreement { UNKNOWN, IDENTICAL, SIMILAR, DIFFERENT };

/* A renderer on a workload. All milliseconds are of a layer, or of a frame where the workload's rate is
 * MS. */
struct cell {
    bool measured, less;       /* fewer layers a frame */
    bool absent;               /* the renderer has no part in the workload */
    char reason[REASON_BYTES]; /* why not measured */
    unsigned count;
    double ms[CLOCKS][PASSES_MAXIMUM], spent;
    double cold[CLOCKS], build_us;
    enum agreement agreement;
    double share; /* of pixels that are farther from the reference's than the workload tolerates */
};

struct run {
    struct machine machine;
    unsigned renderer_count, passes;
    struct renderer renderers[RENDERERS_MAXIMUM];
    unsigned count; /* of workloads chosen */
    const struct workload *workloads[64];
    struct cell (*cells)[RENDERERS_MAXIMUM]; /* by workload */
    double seconds, budget; /* of a sample; of a renderer on a workload, after which no pass begins */
    int reference;          /* the renderer whose pictures are compared with */
    const char *folder;     /* where pictures go */
    const char *engine;     /* the one that is compared with peers */
    enum clocks clock;      /* of one core's table */
    bool bad;               /* something failed or differs */
};

/* Starts the renderers, and ends them. Those that do not start become ones that are not here. */
void run_start(struct run *run);
void run_end(struct run *run);
/* Measures all workloads. */
void run_measure(struct run *run);

/* The tables, and all that was measured. Returns 0, or -1 if the file cannot be written. */
int report_text(const struct run *run, FILE *file);
int report_json(const struct run *run, const char *path);
/* stream,engine,speedup against llvmpipe, for bench/chart.gnuplot. */
int report_csv(const struct run *run, const char *path);

/* The rates of the machine, from limits.c, in thousands of millions a second; 0: not known. */
struct limits {
    double sums_avx2, sums_avx512;                  /* multiply-adds of one number */
    double store_first, store_second, store_memory; /* bytes */
    double gather_first, gather_second;             /* of 64 bits */
};
const struct limits *limits_measured(void);

#endif
