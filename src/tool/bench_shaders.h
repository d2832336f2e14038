/* What `triptych bench --shaders` finds: each shader with each engine, and shaders by their length. */
#ifndef TOOL_BENCH_SHADERS_H
#define TOOL_BENCH_SHADERS_H

#include "tool/bench_report.h"
#include "tool/json.h"

/* Prints both tables. Returns 0, or STATUS_BAD after telling why. */
int bench_print_shaders(const struct command *self, const struct bench *bench);

/* An array of all shaders with each engine's figures, for the JSON; null when memory is short. */
cJSON *bench_json_shaders(const struct bench *bench);

#endif
