/* `triptych bench --cold`: the cost of the first frames of a new device. */
#ifndef COMMAND_BENCH_BENCH_COLD_H
#define COMMAND_BENCH_BENCH_COLD_H

#include "command/support/choose.h"

/* Prints the cost of the first `frames` frames (0: all) of each stream on each engine, relative to the same
 * frames with all routines built. `json` may be null. Returns 0, or STATUS_BAD after a message. */
int bench_cold(const struct command *self, char **paths, unsigned count, const struct choice *engines,
               unsigned threads, unsigned repetitions, unsigned frames, const char *json);

#endif
