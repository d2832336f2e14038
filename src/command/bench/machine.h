/* The computer, compiler and commit of a measurement. */
#ifndef COMMAND_BENCH_MACHINE_H
#define COMMAND_BENCH_MACHINE_H

#include <cjson/cJSON.h>

struct machine {
    char model[64];   /* of the processor */
    unsigned cores;   /* that this process may run on */
    char kernel[160]; /* name, release, architecture */
    const char *compiler;
    const char *commit; /* of the sources, "-dirty" when they differ from it */
    char date[32];      /* ISO 8601, UTC */
};

struct machine machine_describe(void);

/* The same as a JSON object; null when memory ran out. */
cJSON *machine_json(const struct machine *machine);

#endif
