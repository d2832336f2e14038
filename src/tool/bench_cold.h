/* `triptych bench --cold`: what the first sight of a stream costs, frame by frame. */
#ifndef TOOL_BENCH_COLD_H
#define TOOL_BENCH_COLD_H

#include "tool/choose.h"

/* Prints, by stream and engine, how much longer the first `frames` frames (0: all) take when their routines are not there
 * yet. Returns 0, or
 * STATUS_BAD after telling why. */
int bench_cold(const struct command *self, char **paths, unsigned count, const struct choice *engines,
               unsigned threads, unsigned repetitions, unsigned frames);

#endif
