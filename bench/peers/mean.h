/* Geometric means of ratios over groups of workloads. Hidden layers are in no mean but their own, for
 * there a renderer that finds the last layer skips the work of the others. */
#ifndef BENCH_PEERS_MEAN_H
#define BENCH_PEERS_MEAN_H

#include "drive.h"

enum { MEANS_MAXIMUM = 64 };

struct mean {
    const char *name,
        *against; /* renderers; against null: the best peer of each workload, or the same on one core */
    const char *group, *text; /* which workloads: one word, and in words */
    enum cores cores;
    double value;
    unsigned count, slower; /* workloads in it; those below 1 */
    char names[512];        /* of those below 1 */
};

/* Fills means, the empty ones too, and returns their number. */
unsigned mean_all(const struct run *run, struct mean means[MEANS_MAXIMUM]);

#endif
