/* `triptych bench --builds`: what making routines costs, cold, over all states of the streams. */
#ifndef TOOL_BENCH_BUILDS_H
#define TOOL_BENCH_BUILDS_H

#include "tool/choose.h"

/* Prints, by engine, how long its routines take by unit, and the sets of three that draws need. `rounds` is how often
 * each routine is built; `json` may be null. Returns 0, or STATUS_BAD after telling why. */
int bench_builds(const struct command *self, char **paths, unsigned count, const struct choice *engines,
                 unsigned rounds, const char *json);

#endif
