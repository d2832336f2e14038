/* The speed-ups of `triptych bench` as grouped bars with their intervals: a group for each stream, a bar for
 * each engine. gnuplot draws them; it must be in PATH when the command runs. */
#ifndef COMMAND_BENCH_CHART_H
#define COMMAND_BENCH_CHART_H

#include "command/bench/bench_report.h"

/* Checks before the measurement that the charts can be drawn. `paths` is a list of files, separated by
 * commas, whose names end with .svg or .png; null is none. Returns 0, or STATUS_BAD after printing the
 * reason. */
int chart_check(const struct command *self, const char *paths);

/* Draws every chart of the list. Each file is written whole or not at all. Returns 0, or STATUS_BAD after
 * printing the reason. */
int chart_write(const struct command *self, const struct bench *bench, const char *paths);

#endif
