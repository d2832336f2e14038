#include "emu/batch/scratch.h"

#include "contract/binding.h"
#include "emu/batch/schedule.h"

#include <pthread.h>
#include <stdlib.h>

/* With four lanes, a schedule may exceed SCRATCH_LIMIT: it has at most one group for each instruction and
 * variable, and two gaps for alignment. */
enum {
    ALIGNMENT = 64,
    FOUR_LANES_BYTES = (IR_CAPACITY + VARIABLES) * GROUP_BYTES + 2 * ALIGNMENT,
    BLOCK_BYTES = (FOUR_LANES_BYTES + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT
};

_Static_assert((int)BLOCK_BYTES >= (int)SCRATCH_LIMIT, "a block has room for any schedule");

/* A free block is linked by its first bytes. */
struct block {
    struct block *next;
};

static struct {
    pthread_mutex_t lock;
    pthread_cond_t given;
    struct block *free;
    unsigned routines;
    unsigned blocks;
} scratch = {.lock = PTHREAD_MUTEX_INITIALIZER, .given = PTHREAD_COND_INITIALIZER};

/* With the lock held: makes a free block. */
static bool add_block(void)
{
    struct block *block = aligned_alloc(ALIGNMENT, BLOCK_BYTES);
    if (!block)
        return false;
    block->next = scratch.free;
    scratch.free = block;
    scratch.blocks++;
    return true;
}

bool batch_scratch_hold(void)
{
    pthread_mutex_lock(&scratch.lock);
    bool held = scratch.blocks || add_block();
    scratch.routines += held;
    pthread_mutex_unlock(&scratch.lock);
    return held;
}

void batch_scratch_release(void)
{
    pthread_mutex_lock(&scratch.lock);
    scratch.routines--;
    while (!scratch.routines && scratch.free) {
        struct block *block = scratch.free;
        scratch.free = block->next;
        scratch.blocks--;
        free(block);
    }
    pthread_mutex_unlock(&scratch.lock);
}

uint8_t *batch_scratch_take(void)
{
    pthread_mutex_lock(&scratch.lock);
    while (!scratch.free && !add_block())
        pthread_cond_wait(&scratch.given, &scratch.lock);
    struct block *block = scratch.free;
    scratch.free = block->next;
    pthread_mutex_unlock(&scratch.lock);
    return (uint8_t *)block;
}

void batch_scratch_give(uint8_t *memory)
{
    struct block *block = (struct block *)(void *)memory;
    pthread_mutex_lock(&scratch.lock);
    block->next = scratch.free;
    scratch.free = block;
    pthread_cond_signal(&scratch.given);
    pthread_mutex_unlock(&scratch.lock);
}
