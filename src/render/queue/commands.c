#include "render/queue/commands.h"

#include <stdlib.h>
#include <string.h>

static size_t round_up(size_t bytes)
{
    return (bytes + 63) & ~(size_t)63;
}

void *queue_allocate(size_t bytes)
{
    size_t rounded = round_up(bytes);
    void *memory = aligned_alloc(64, rounded);
    return memory ? memset(memory, 0, rounded) : NULL;
}

/* Jobs are written before they are read. They are 4 MiB, whose pages most programs never touch. */
static int create_buffer(struct queue_buffer *buffer)
{
    buffer->command = queue_allocate(QUEUE_COMMANDS * sizeof *buffer->command);
    buffer->job = aligned_alloc(64, round_up(QUEUE_COMMANDS * sizeof *buffer->job));
    return buffer->command && buffer->job ? 0 : -1;
}

int queue_commands_create(struct queue_commands *commands, bool two_buffers)
{
    if (create_buffer(&commands->other))
        return -1;
    queue_commands_exchange(commands);
    return two_buffers ? create_buffer(&commands->other) : 0;
}

void queue_commands_destroy(struct queue_commands *commands)
{
    free(commands->other.command);
    free(commands->other.job);
    free(commands->command);
    free(commands->job);
}

void queue_commands_exchange(struct queue_commands *commands)
{
    struct queue_buffer filled = {commands->command, commands->job};
    commands->command = commands->other.command;
    commands->job = commands->other.job;
    commands->other = filled;
    commands->count = commands->jobs = 0;
}
