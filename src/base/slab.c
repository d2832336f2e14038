#include "base/slab.h"

#include <stdint.h>
#include <sys/mman.h>

/* Lies after the block, whose contents stay as they are. */
struct slab_link {
    void *block;
    struct slab_link *next;
};

static size_t link_offset(const struct slab *slab)
{
    return (slab->bytes + 15) & ~(size_t)15;
}

static struct slab_link *link_of(const struct slab *slab, void *block)
{
    return (struct slab_link *)(void *)((uint8_t *)block + link_offset(slab));
}

static size_t block_bytes(const struct slab *slab)
{
    return link_offset(slab) + sizeof(struct slab_link);
}

static void *map_block(const struct slab *slab)
{
    void *block = mmap(NULL, block_bytes(slab), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return block == MAP_FAILED ? NULL : block;
}

void *slab_take(struct slab *slab)
{
    pthread_mutex_lock(&slab->lock);
    struct slab_link *link = slab->free;
    if (link)
        slab->free = link->next;
    pthread_mutex_unlock(&slab->lock);
    return link ? link->block : map_block(slab);
}

void slab_give(struct slab *slab, void *block)
{
    if (!block)
        return;
    struct slab_link *link = link_of(slab, block);
    link->block = block;
    pthread_mutex_lock(&slab->lock);
    link->next = slab->free;
    slab->free = link;
    pthread_mutex_unlock(&slab->lock);
}

void slab_clear(struct slab *slab)
{
    pthread_mutex_lock(&slab->lock);
    struct slab_link *link = slab->free;
    slab->free = NULL;
    pthread_mutex_unlock(&slab->lock);
    while (link) {
        struct slab_link *next = link->next;
        munmap(link->block, block_bytes(slab));
        link = next;
    }
}
