/* `triptych bench --compare`: two files that --json wrote, stream by stream and engine by engine. */
#ifndef COMMAND_BENCH_BENCH_COMPARE_H
#define COMMAND_BENCH_BENCH_COMPARE_H

#include "command/support/tool.h"

/* Prints how many times the values of the first file are those of the second, with intervals (interval.h).
 * Writes the same as JSON if the path is given. Returns the exit status. */
int bench_compare(const struct command *self, char *const paths[2], const char *json);

#endif
