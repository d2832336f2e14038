#include "peer.h"

#include <string.h>

const struct workload workloads[] = {
#define WORKLOAD(name, kind, rate, amount, full, less, group, tolerance, stored, memory, gathers, sums,      \
                 text)                                                                                       \
    {#name, kind, rate, amount, full, less, group, tolerance, stored, memory, gathers, sums, text},
#include "workload.def"
#undef WORKLOAD
};

const unsigned workload_count = sizeof workloads / sizeof *workloads;

const struct workload *workload_find(const char *name)
{
    for (unsigned i = 0; i < workload_count; i++)
        if (!strcmp(workloads[i].name, name))
            return workloads + i;
    return NULL;
}
