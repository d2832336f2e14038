/* Commands that are queued, with room for their jobs, in one or two buffers: with two, one is filled while
 * the commands of the other are rendered in the background. */
#ifndef RENDER_QUEUE_COMMANDS_H
#define RENDER_QUEUE_COMMANDS_H

#include "render/draw/command.h"

#include <stdbool.h>

enum { QUEUE_COMMANDS = 1024 }; /* capacity of a buffer */

struct queue_buffer {
    struct command *command; /* QUEUE_COMMANDS of them */
    struct job *job;         /* as many: each draw needs at most one */
};

struct queue_commands {
    struct command *command; /* the buffer that is filled */
    struct job *job;
    uint32_t count, jobs;      /* how many are filled in */
    struct queue_buffer other; /* null pointers: there is only one buffer */
};

/* Both work on a structure of zeros. Returns 0, or -1 when memory is short; free it in either case. */
int queue_commands_create(struct queue_commands *commands, bool two_buffers);
void queue_commands_destroy(struct queue_commands *commands);

/* Empties the buffer. With two of them the other one, which must be free, is filled from now on. */
void queue_commands_exchange(struct queue_commands *commands);

/* Memory of zeros, aligned to a cache line; null when memory is short. queue_free frees it, and null is
 * allowed. */
void *queue_allocate(size_t bytes);
void queue_free(void *block);

#endif
