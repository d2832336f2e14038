/* Large blocks of one size that are reused. They return to the system when the library is unloaded.
 *
 * A new block is zero and its pages are not yet in memory, so a block may be far larger than the part that is
 * used (calloc would clear all of it when malloc reuses freed memory). A block that is returned keeps its
 * contents until it is used again. Thread-safe. */
#ifndef BASE_SLAB_H
#define BASE_SLAB_H

#include <pthread.h>
#include <stddef.h>

struct slab_link;

struct slab {
    pthread_mutex_t lock;
    size_t bytes; /* of a block */
    struct slab_link *free;
};

/* The initial value of a slab with blocks of that size. */
#define SLAB(size)                                                                                           \
    {                                                                                                        \
        .lock = PTHREAD_MUTEX_INITIALIZER, .bytes = (size)                                                   \
    }

/* A block, aligned to 16 bytes. Null when memory is refused. */
void *slab_take(struct slab *slab);

/* Returns a block that slab_take returned; null is allowed. */
void slab_give(struct slab *slab, void *block);

/* Returns the blocks that are not in use to the system. */
void slab_clear(struct slab *slab);

/* At file scope: clears the slab when the library is unloaded or the process ends. */
#define SLAB_CLEAR_AT_UNLOAD(slab)                                                                           \
    __attribute__((destructor)) static void clear_at_unload(void)                                            \
    {                                                                                                        \
        slab_clear(&slab);                                                                                   \
    }

#endif
