#include "render/tile/span.h"

#include <string.h>

void tile_begin_spans(struct tile_spans *spans)
{
    spans->count = spans->marked_count = 0;
    memset(spans->marked, 0, sizeof spans->marked);
}

static uint32_t count_whole(const struct entry *entries, uint32_t count)
{
    uint32_t whole = 0;
    for (uint32_t i = 0; i < count; i++)
        whole += entries[i].coverage == UINT16_MAX;
    return whole;
}

/* An entry is written to both lists, and one of them goes on: whether a block is whole is hard to predict. */
uint32_t tile_take_spans(struct entry *entries, uint32_t *count, uint32_t least, struct entry *to)
{
    uint32_t whole = count_whole(entries, *count), taken = 0, left = 0;
    if (whole < least)
        return whole;
    for (uint32_t i = 0; i < *count; i++) {
        const struct entry entry = entries[i];
        uint32_t is_whole = entry.coverage == UINT16_MAX;
        to[taken] = entries[left] = entry;
        taken += is_whole;
        left += !is_whole;
    }
    *count = left;
    return whole;
}

bool tile_spans_meet(struct tile_spans *spans, const struct entry *entries, uint32_t count, uint32_t added)
{
    uint64_t met = 0;
    for (; spans->marked_count < count; spans->marked_count++) {
        unsigned block = entries[spans->marked_count].block;
        spans->marked[block / 64] |= 1ull << block % 64;
    }
    for (uint32_t i = 0; i < added; i++) {
        unsigned block = spans->entry[spans->count + i].block;
        met |= spans->marked[block / 64] & 1ull << block % 64;
    }
    return met;
}
