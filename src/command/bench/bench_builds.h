/* `triptych bench --builds` and `--code`: the cost of building all routines of the streams, and what their
 * code consists of. */
#ifndef COMMAND_BENCH_BENCH_BUILDS_H
#define COMMAND_BENCH_BENCH_BUILDS_H

#include "command/support/choose.h"

/* Prints the build times of each engine by unit, and of the sets of three routines that draws need. Each
 * routine is built `rounds` times. `json` may be null. Returns 0, or STATUS_BAD after a message. */
int bench_builds(const struct command *self, char **paths, unsigned count, const struct choice *engines,
                 unsigned rounds, const char *json);

/* Builds the routines with each engine, and prints the means of their instructions, memory operands and
 * spills by engine and unit (bench_code.c). `json`, which may be null, receives a row for each routine.
 * Returns 0, or STATUS_BAD after a message. */
int bench_code(const struct command *self, char **paths, unsigned count, const struct choice *engines,
               const char *json);

#endif
