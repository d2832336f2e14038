/* `triptych bench --builds`: the cost of building all routines of the streams. */
#ifndef COMMAND_BENCH_BENCH_BUILDS_H
#define COMMAND_BENCH_BENCH_BUILDS_H

#include "command/support/choose.h"

/* Prints the build times of each engine by unit, and of the sets of three routines that draws need. Each
 * routine is built `rounds` times. `json` may be null. Returns 0, or STATUS_BAD after a message. */
int bench_builds(const struct command *self, char **paths, unsigned count, const struct choice *engines,
                 unsigned rounds, const char *json);

#endif
