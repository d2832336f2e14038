/* Shards: parts of a campaign for several machines.
 *
 * A campaign is a list of units of work: random cases, streams, frames. Shard I of N, with I from 1 to N, has
 * consecutive units. The shards of all I together have every unit once, and their numbers of units differ by
 * one at most. */
#ifndef COMMAND_SUPPORT_SHARD_H
#define COMMAND_SUPPORT_SHARD_H

#include "command/support/command.h"
#include "command/support/tool.h"

#include <stdint.h>

enum { SHARD_MAXIMUM = 1000000 };

struct shard {
    unsigned index; /* from 1 */
    unsigned count;
};

/* const char *: the argument of shard_read. */
#define OPTION_SHARD(structure, member)                                                                      \
    {                                                                                                        \
        "shard", "I/N|auto",                                                                                 \
            "only part I, from 1, of N equal parts, or that of this Slurm array task or MPI rank",           \
            OPTION_IS_TEXT(structure, member)                                                                \
    }

/* const char *: the file of results that are continued and kept up to date; null: none. */
#define OPTION_RESUME(structure, member)                                                                     \
    {                                                                                                        \
        "resume", "FILE", "continue the results in FILE, if it exists, and write it while the command runs", \
            OPTION_IS_FILE(structure, member), .extension = "json"                                           \
    }

/* Reads "I/N", or "auto". Null is the whole campaign, 1/1: the environment is not read.
 *
 * "auto" multiplies two parts, if both are present: the task of a Slurm array (SLURM_ARRAY_TASK_ID), and the
 * rank of a launcher: OMPI_COMM_WORLD_RANK and _SIZE, PMI_RANK and PMI_SIZE, PMIX_RANK and PMIX_SIZE, or
 * SLURM_PROCID and SLURM_STEP_NUM_TASKS. SLURM_NTASKS is not the size: a batch script has it too, with the
 * rank 0, although it runs once. Of an array of A tasks with R ranks each, rank r of task a has part
 * (a - 1) R + r + 1 of A R, with a from 1 and r from 0.
 *
 * Returns 0, or STATUS_BAD after printing the reason: for "auto", that there is neither, or that the array
 * has tasks with irregular numbers or fewer than all of them. */
int shard_read(const struct command *self, const char *text, struct shard *shard);

/* The units of a shard, from *first on. The campaign has the units 0 to all - 1, at most 2^44. */
void shard_part(const struct shard *shard, uint64_t all, uint64_t *first, uint64_t *count);

/* Returns true if the shard is not the whole campaign. */
static inline bool shard_is_part(const struct shard *shard)
{
    return shard->count > 1;
}

#endif
