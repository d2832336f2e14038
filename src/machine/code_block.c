#define _GNU_SOURCE /* MAP_ANONYMOUS */
#include "machine/code_block.h"

#include <sys/mman.h>
#include <unistd.h>

static uint32_t list_of(uint32_t count)
{
    return 31 - (uint32_t)__builtin_clz(count);
}

static void mark(struct code_blocks *blocks, uint32_t first, uint32_t count, bool is_free)
{
    struct code_unit *head = &blocks->units[first], *tail = &blocks->units[first + count - 1];
    head->free = tail->free = is_free;
    head->count = tail->count = count;
}

static void link_free(struct code_blocks *blocks, uint32_t first, uint32_t count)
{
    mark(blocks, first, count, true);
    uint32_t list = list_of(count), next = blocks->lists[list];
    blocks->units[first].next = next;
    blocks->units[first].previous = CODE_NO_BLOCK;
    if (next != CODE_NO_BLOCK)
        blocks->units[next].previous = first;
    blocks->lists[list] = first;
    blocks->nonempty |= 1u << list;
    blocks->free++;
}

static void unlink_free(struct code_blocks *blocks, uint32_t first)
{
    struct code_unit *block = &blocks->units[first];
    uint32_t list = list_of(block->count);
    if (block->next != CODE_NO_BLOCK)
        blocks->units[block->next].previous = block->previous;
    if (block->previous != CODE_NO_BLOCK)
        blocks->units[block->previous].next = block->next;
    else
        blocks->lists[list] = block->next;
    if (blocks->lists[list] == CODE_NO_BLOCK)
        blocks->nonempty &= ~(1u << list);
    blocks->free--;
}

uint32_t code_blocks_find(const struct code_blocks *blocks, uint32_t count)
{
    uint32_t list = list_of(count), best = CODE_NO_BLOCK, best_count = UINT32_MAX;
    for (uint32_t block = blocks->lists[list]; block != CODE_NO_BLOCK; block = blocks->units[block].next) {
        uint32_t size = blocks->units[block].count;
        if (size >= count && size < best_count) {
            best = block;
            best_count = size;
        }
        if (size == count)
            return block;
    }
    uint32_t larger = blocks->nonempty & ~((2u << list) - 1);
    return best != CODE_NO_BLOCK || !larger ? best : blocks->lists[__builtin_ctz(larger)];
}

void code_blocks_take(struct code_blocks *blocks, uint32_t first, uint32_t count)
{
    uint32_t whole = blocks->units[first].count;
    unlink_free(blocks, first);
    if (whole > count)
        link_free(blocks, first + count, whole - count);
    mark(blocks, first, count, false);
    blocks->used += count;
    if (blocks->peak < blocks->used)
        blocks->peak = blocks->used;
}

void code_blocks_release(struct code_blocks *blocks, uint32_t first, uint32_t count)
{
    blocks->used -= count;
    if (blocks->units[first + count].free) {
        uint32_t after = first + count;
        count += blocks->units[after].count;
        unlink_free(blocks, after);
    }
    if (blocks->units[first - 1].free) {
        uint32_t before = first - blocks->units[first - 1].count;
        count += blocks->units[before].count;
        first = before;
        unlink_free(blocks, before);
    }
    link_free(blocks, first, count);
}

/* A mapping, because calloc clears memory that it gives again. A second device of a process would then touch
 * all pages of its array. The array ends where a page without access begins. Another such page is before it.
 */
static struct code_unit *map_units(struct code_blocks *blocks, size_t bytes)
{
    size_t page = (size_t)sysconf(_SC_PAGESIZE), room = (bytes + page - 1) / page * page;
    uint8_t *base = mmap(NULL, room + 2 * page, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (base == MAP_FAILED)
        return NULL;
    blocks->map = base;
    blocks->mapped = room + 2 * page;
    if (mprotect(base + page, room, PROT_READ | PROT_WRITE)) {
        code_blocks_destroy(blocks);
        return NULL;
    }
    return (struct code_unit *)(void *)(base + page + room - bytes);
}

int code_blocks_create(struct code_blocks *blocks, uint32_t count)
{
    enum { SENTINELS = 2 };
    *blocks = (struct code_blocks){0};
    blocks->units = map_units(blocks, ((size_t)count + SENTINELS) * sizeof *blocks->units);
    if (!blocks->units)
        return -1;
    link_free(blocks, CODE_FIRST_UNIT, count);
    return 0;
}

void code_blocks_destroy(struct code_blocks *blocks)
{
    if (blocks->map)
        munmap(blocks->map, blocks->mapped);
    blocks->map = NULL;
    blocks->units = NULL;
}

void code_blocks_shrink(struct code_blocks *blocks, uint32_t first, uint32_t count)
{
    uint32_t whole = blocks->units[first].count;
    if (count == whole)
        return;
    mark(blocks, first, count, false);
    code_blocks_release(blocks, first + count, whole - count);
}

uint32_t code_blocks_find_tighter(const struct code_blocks *blocks, uint32_t first, uint32_t count)
{
    const struct code_unit *units = blocks->units;
    uint32_t after = first + units[first].count;
    uint32_t here = units[first].count + (units[after].free ? units[after].count : 0);
    uint32_t hole = code_blocks_find(blocks, count);
    return hole != after && hole != CODE_NO_BLOCK && units[hole].count < here ? hole : CODE_NO_BLOCK;
}

uint32_t code_blocks_largest(const struct code_blocks *blocks)
{
    uint32_t largest = 0;
    if (blocks->nonempty)
        for (uint32_t block = blocks->lists[list_of(blocks->nonempty)]; block != CODE_NO_BLOCK;
             block = blocks->units[block].next)
            if (largest < blocks->units[block].count)
                largest = blocks->units[block].count;
    return largest;
}
