/* Geometric means of ratios over groups of workloads. Workloads with hidden layers have a mean of their own,
 * because some renderers draw only the last layer. */
#ifndef BENCH_PEERS_MEAN_H
#define BENCH_PEERS_MEAN_H

#include "drive.h"

enum { MEANS_MAXIMUM = 64 };

struct mean {
    const char *name,
        *against; /* renderers; against null: the best peer of each workload, or the same on one core */
    const char *group, *text; /* the workloads, as one word and as a description */
    enum cores cores;
    double value;
    unsigned count, slower; /* the number of workloads, and of those with a ratio below 1 */
    char names[512];        /* of the workloads below 1 */
};

/* Computes all means, including those without workloads, and returns their number. */
unsigned mean_all(const struct run *run, struct mean means[MEANS_MAXIMUM]);

#endif
