#include "command/support/shard.h"
#include "command/support/option.h"

#include <stdlib.h>
#include <string.h>

enum { NUMBER_MAXIMUM = 0x7fffffff, TEXT_CAPACITY = 32 };

/* A launcher's variables, the most specific first: MPI programs that srun starts have Slurm's too. */
static const struct launcher {
    const char *rank, *size;
} launchers[] = {
    {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
    {"PMI_RANK", "PMI_SIZE"},
    {"PMIX_RANK", "PMIX_SIZE"},
    {"SLURM_PROCID", "SLURM_STEP_NUM_TASKS"},
};

static int read_variable(const struct command *self, const char *name, unsigned least, unsigned *value)
{
    const char *text = getenv(name);
    if (text && option_read_number(text, least, NUMBER_MAXIMUM, value))
        return STATUS_OK;
    return tool_fail(self, "--shard auto: %s is \"%s\", expected a whole number from %u to %d", name,
                     text ? text : "", least, NUMBER_MAXIMUM);
}

/* The tasks of an array such as 1-16 or 0-30:2. In a list such as 1,5,7 the position of a task is unknown. */
static int read_array(const struct command *self, struct shard *shard)
{
    unsigned task, least, most, count, step = 1;
    if (read_variable(self, "SLURM_ARRAY_TASK_ID", 0, &task) ||
        read_variable(self, "SLURM_ARRAY_TASK_MIN", 0, &least) ||
        read_variable(self, "SLURM_ARRAY_TASK_MAX", least, &most) ||
        read_variable(self, "SLURM_ARRAY_TASK_COUNT", 1, &count) ||
        (getenv("SLURM_ARRAY_TASK_STEP") && read_variable(self, "SLURM_ARRAY_TASK_STEP", 1, &step)))
        return STATUS_BAD;
    if (task < least || task > most || (task - least) % step || (most - least) / step + 1 != count)
        return tool_fail(self,
                         "--shard auto: task %u of an array of %u tasks from %u to %u, expected an array "
                         "like 1-%u, or --shard I/N",
                         task, count, least, most, count);
    *shard = (struct shard){(task - least) / step + 1, count};
    return STATUS_OK;
}

static const struct launcher *find_launcher(void)
{
    for (size_t i = 0; i < sizeof launchers / sizeof *launchers; i++)
        if (getenv(launchers[i].rank) && getenv(launchers[i].size))
            return &launchers[i];
    return NULL;
}

/* Divides the part of the array among the ranks. */
static int read_rank(const struct command *self, const struct launcher *launcher, struct shard *shard)
{
    unsigned rank, size;
    if (read_variable(self, launcher->rank, 0, &rank) || read_variable(self, launcher->size, 1, &size))
        return STATUS_BAD;
    if (rank >= size)
        return tool_fail(self, "--shard auto: %s is %u, expected less than %s, which is %u", launcher->rank,
                         rank, launcher->size, size);
    uint64_t count = (uint64_t)shard->count * size;
    if (count > SHARD_MAXIMUM)
        return tool_fail(self, "--shard auto: %llu parts, expected at most %d", (unsigned long long)count,
                         SHARD_MAXIMUM);
    *shard = (struct shard){(shard->index - 1) * size + rank + 1, (unsigned)count};
    return STATUS_OK;
}

static int read_environment(const struct command *self, struct shard *shard)
{
    const struct launcher *launcher = find_launcher();
    bool array = getenv("SLURM_ARRAY_TASK_ID");
    *shard = (struct shard){1, 1};
    if (!array && !launcher)
        return tool_fail(self, "--shard auto: no SLURM_ARRAY_TASK_ID and no rank and size of an MPI launcher "
                               "in the environment, expected one of them, or --shard I/N");
    if (array && read_array(self, shard))
        return STATUS_BAD;
    return launcher ? read_rank(self, launcher, shard) : STATUS_OK;
}

static bool read_pair(const char *text, struct shard *shard)
{
    char index[TEXT_CAPACITY];
    const char *slash = strchr(text, '/');
    size_t length = slash ? (size_t)(slash - text) : 0;
    if (!slash || length >= sizeof index)
        return false;
    memcpy(index, text, length);
    index[length] = 0;
    return option_read_number(slash + 1, 1, SHARD_MAXIMUM, &shard->count) &&
           option_read_number(index, 1, shard->count, &shard->index);
}

int shard_read(const struct command *self, const char *text, struct shard *shard)
{
    *shard = (struct shard){1, 1};
    if (!text)
        return STATUS_OK;
    if (!strcmp(text, "auto"))
        return read_environment(self, shard);
    if (read_pair(text, shard))
        return STATUS_OK;
    return tool_fail(self, "--shard is \"%s\", expected auto, or I/N with I from 1 to N and N at most %d",
                     text, SHARD_MAXIMUM);
}

void shard_part(const struct shard *shard, uint64_t all, uint64_t *first, uint64_t *count)
{
    *first = all * (shard->index - 1) / shard->count;
    *count = all * shard->index / shard->count - *first;
}
