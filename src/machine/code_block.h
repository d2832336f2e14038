/* The allocator of the executable-code arena.
 *
 * Memory is counted in units and divided into blocks, free or used. A side array has one entry per unit. A
 * block is described by the entries of its first and last unit (boundary tags), so a released block finds
 * both neighbours in constant time, and no two free blocks are adjacent. Free blocks are in lists by the
 * logarithm of their size. The array is zero pages until used, and a zero entry means a used block, so the
 * sentinels before the first and after the last unit need no initialisation. Releasing memory needs no
 * allocation, so it cannot fail. The caller locks. */
#ifndef MACHINE_CODE_BLOCK_H
#define MACHINE_CODE_BLOCK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    CODE_NO_BLOCK = 0, /* unit 0 is the sentinel, so no block starts there */
    CODE_FIRST_UNIT = 1,
    CODE_LISTS = 32
};

struct code_unit {
    uint32_t free; /* 1 if this is an end of a free block */
    uint32_t count;
    uint32_t next; /* the next block of the list; only in a first unit */
    uint32_t previous;
};

struct code_blocks {
    struct code_unit *units;
    void *map; /* the mapping that has the units, and its bytes */
    size_t mapped;
    uint32_t lists[CODE_LISTS]; /* first units; list n has sizes 2^n to 2^(n+1) - 1 */
    uint32_t nonempty;          /* bit n: list n has a block */
    size_t used, peak;          /* units in use, and the maximum of it */
    size_t free;                /* the number of free blocks */
};

/* One free block of `count` units, from CODE_FIRST_UNIT on. Returns 0, or -1 if memory is short. */
int code_blocks_create(struct code_blocks *blocks, uint32_t count);
void code_blocks_destroy(struct code_blocks *blocks);

/* The smallest sufficient free block in the list of `count`'s own size, else any block of a larger list.
 * Returns its first unit, or CODE_NO_BLOCK. */
uint32_t code_blocks_find(const struct code_blocks *blocks, uint32_t count);

/* A free block that fits `count` units more tightly than the used block that begins at `first` together with
 * the free block after it. Returns CODE_NO_BLOCK if there is none. */
uint32_t code_blocks_find_tighter(const struct code_blocks *blocks, uint32_t first, uint32_t count);

/* Uses the first `count` units of a free block. */
void code_blocks_take(struct code_blocks *blocks, uint32_t first, uint32_t count);

/* Frees used units and merges them with free neighbours. */
void code_blocks_release(struct code_blocks *blocks, uint32_t first, uint32_t count);

/* Frees all but the first `count` units of a used block. */
void code_blocks_shrink(struct code_blocks *blocks, uint32_t first, uint32_t count);

/* The units of the largest free block, or 0. */
uint32_t code_blocks_largest(const struct code_blocks *blocks);

static inline bool code_blocks_is_used(const struct code_blocks *blocks, uint32_t first, uint32_t count)
{
    return !blocks->units[first].free && blocks->units[first].count == count;
}

#endif
