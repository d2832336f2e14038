/* The measurements of `triptych bench` that draw no pictures or only the first ones: --builds, --parts,
 * --code and --cold. */
#ifndef COMMAND_BENCH_BENCH_BUILDS_H
#define COMMAND_BENCH_BENCH_BUILDS_H

#include "command/support/choose.h"

/* Prints the build times of each engine by unit, of the sets of three routines that draws need, and of the
 * bursts of ten routines in first frames. Each routine is built `rounds` times. `json` may be null. Returns
 * 0, or STATUS_BAD after a message. */
int bench_builds(const struct command *self, char **paths, unsigned count, const struct choice *engines,
                 unsigned rounds, const char *json);

/* Prints the cost of the first `frames` frames (0: all) of each stream on each engine, relative to the same
 * frames with all routines built. `json` may be null. Returns 0, or STATUS_BAD after a message. */
int bench_cold(const struct command *self, char **paths, unsigned count, const struct choice *engines,
               unsigned threads, struct setting_values values, unsigned repetitions, unsigned frames,
               const char *json);

/* Builds the routines with each engine, and prints the means of their instructions, memory operands and
 * spills by engine and unit (bench_code.c). `json`, which may be null, receives a row for each routine.
 * Returns 0, or STATUS_BAD after a message. */
int bench_code(const struct command *self, char **paths, unsigned count, const struct choice *engines,
               const char *json);

/* Prints the time of each part of a build, and what each pass removes, for the specializer's engines. Each
 * routine is built `rounds` times. If the engines are `named`, all must be the specializer's. `json` may be
 * null. Returns 0, or STATUS_BAD after a message. */
int bench_parts(const struct command *self, char **paths, unsigned count, bool named, struct choice *engines,
                unsigned rounds, const char *json);

#endif
