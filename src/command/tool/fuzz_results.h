/* The results of `triptych fuzz` as JSON: written at the end and, with --resume, while it draws; and read
 * again to continue. */
#ifndef COMMAND_TOOL_FUZZ_RESULTS_H
#define COMMAND_TOOL_FUZZ_RESULTS_H

#include "command/fuzz/campaign.h"
#include "command/support/command.h"
#include "command/support/shard.h"

/* The campaign that the results are of. */
struct fuzz_results {
    uint64_t seed, first, count; /* of the whole campaign */
    struct shard shard;
    const struct campaign_options *options; /* engines, threads and settings of the renderer */
};

/* Writes the file atomically. Returns 0, or STATUS_BAD after printing the reason. */
int fuzz_results_write(const struct command *self, const struct fuzz_results *results,
                       const struct campaign *campaign, const char *path);

/* Reads the results of the same campaign and shard; *earlier is zero if there is no file. Returns 0, or
 * STATUS_BAD after printing the reason. */
int fuzz_results_read(const struct command *self, const struct fuzz_results *results, const char *path,
                      struct campaign *earlier);

#endif
