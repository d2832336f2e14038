/* The results of `triptych bench --shaders`: each shader on each engine, and shaders by length. */
#ifndef COMMAND_BENCH_BENCH_SHADERS_H
#define COMMAND_BENCH_BENCH_SHADERS_H

#include "command/bench/bench_report.h"
#include "command/support/json.h"

/* Prints both tables. Returns 0, or STATUS_BAD after a message. */
int bench_print_shaders(const struct command *self, const struct bench *bench);

/* An array of all shaders with each engine's figures, for the JSON; null when memory is short. */
cJSON *bench_json_shaders(const struct bench *bench);

#endif
