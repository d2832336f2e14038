#include "render/queue/commands.h"

#include <stdlib.h>

enum { LINE = 64 };

static size_t round_up(size_t bytes)
{
    return (bytes + LINE - 1) & ~(size_t)(LINE - 1);
}

/* Most programs never access most of the memory. Where calloc gets new pages from the system, it does not
 * clear them, so those are never present. The word in front of the block is the address that free needs. */
void *queue_allocate(size_t bytes)
{
    uint8_t *memory = calloc(1, bytes + LINE + sizeof(void *));
    if (!memory)
        return NULL;
    uintptr_t first = (uintptr_t)memory + sizeof(void *);
    void **block = (void **)((first + LINE - 1) & -(uintptr_t)LINE);
    block[-1] = memory;
    return block;
}

void queue_free(void *block)
{
    if (block)
        free(((void **)block)[-1]);
}

/* Jobs are written before they are read. They are 4 MiB, whose pages most programs never touch. */
static int create_buffer(struct queue_buffer *buffer)
{
    buffer->command = queue_allocate(QUEUE_COMMANDS * sizeof *buffer->command);
    buffer->job = aligned_alloc(LINE, round_up(QUEUE_COMMANDS * sizeof *buffer->job));
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
    queue_free(commands->other.command);
    free(commands->other.job);
    queue_free(commands->command);
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
