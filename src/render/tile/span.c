#include "render/tile/span.h"

#include <emmintrin.h>
#include <string.h>

void tile_begin_spans(struct tile_spans *spans)
{
    spans->count = spans->marked_count = 0;
    memset(spans->marked, 0, sizeof spans->marked);
}

/* Of four entries, -1 for each whole block. The third words have the coverage below, and the block above. */
static inline __m128i four_whole(const struct entry *entry)
{
    const __m128i *at = (const __m128i *)(const void *)entry, block = _mm_set1_epi32((int)0xffff0000);
    __m128i low = _mm_unpackhi_epi32(_mm_loadu_si128(at), _mm_loadu_si128(at + 1));
    __m128i high = _mm_unpackhi_epi32(_mm_loadu_si128(at + 2), _mm_loadu_si128(at + 3));
    __m128i words = _mm_or_si128(_mm_unpacklo_epi64(low, high), block);
    return _mm_cmpeq_epi32(words, _mm_set1_epi32(-1));
}

static uint32_t count_whole(const struct entry *entries, uint32_t count)
{
    __m128i fours = _mm_setzero_si128();
    uint32_t i = 0;
    for (; i + 4 <= count; i += 4)
        fours = _mm_sub_epi32(fours, four_whole(entries + i));
    fours = _mm_add_epi32(fours, _mm_unpackhi_epi64(fours, fours));
    uint32_t whole = (uint32_t)_mm_cvtsi128_si32(_mm_add_epi32(fours, _mm_shuffle_epi32(fours, 1)));
    for (; i < count; i++)
        whole += entries[i].coverage == UINT16_MAX;
    return whole;
}

/* An entry is written to both lists, and one of them goes on: whether a block is whole is hard to predict. */
uint32_t tile_take_spans(struct entry *entries, uint32_t *count, uint32_t least, struct entry *to)
{
    const struct entry *at = entries, *end = entries + *count;
    const uint32_t whole = count_whole(entries, *count);
    struct entry *left = entries;
    if (whole < least)
        return whole;
    for (; at < end; at++) {
        const __m128i entry = _mm_loadu_si128((const __m128i *)(const void *)at);
        size_t is_part = at->coverage < UINT16_MAX;
        _mm_storeu_si128((__m128i *)(void *)to, entry);
        _mm_storeu_si128((__m128i *)(void *)left, entry);
        left += is_part;
        to += 1 - is_part;
    }
    *count = (uint32_t)(left - entries);
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
