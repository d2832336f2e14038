/* The merging of results: the parts of `triptych merge` that differ by command.
 *
 * The merged results do not depend on the order of the inputs. Values that the campaign determines equal
 * those of one run: counts are added, entries are in the order of "inputs". Values that a machine
 * determines, such as times, are kept for each shard in "shards". The normal form, --canonical, has only
 * the former, so the normal forms of one run and of its shards are equal byte for byte. */
#ifndef COMMAND_MERGE_MERGE_H
#define COMMAND_MERGE_MERGE_H

#include "command/results/results.h"

struct merge {
    const struct command *self;
    struct results *input;
    unsigned inputs;
    struct ranges done, missing, twice; /* units: in any input; in none; in several */
    const cJSON *shards;                /* of all inputs, in order */
    bool canonical;
};

/* Adds the results to the report, after its machine and the fields that determine the results. Returns 0; or
 * STATUS_DIFFERENT after printing a contradiction between inputs; or STATUS_BAD after printing the reason. */
int merge_counts(const struct merge *merge, cJSON *report);
int merge_entries(const struct merge *merge, cJSON *report);

/* Adds the "engines" of verify, with what each of them executed. */
void merge_executions(const struct merge *merge, cJSON *report);

/* Adds the "builds" of bench: summaries of the routines of all streams, if the entries have the routines. */
void merge_builds(const struct merge *merge, cJSON *entries, cJSON *report);

#endif
