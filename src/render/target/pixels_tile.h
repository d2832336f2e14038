/* Shared by the functions of pixels.h that find tiles. */
#ifndef RENDER_TARGET_PIXELS_TILE_H
#define RENDER_TARGET_PIXELS_TILE_H

#include "render/target/pixels.h"

#include <immintrin.h>

static inline uint32_t pixels_tile_of(const struct attachment *a, uint32_t x, uint32_t y)
{
    return y / TILE_SIZE * a->columns + x / TILE_SIZE;
}

/* The first of a tile's planes. */
static inline uint32_t *pixels_tile_words(const struct attachment *a, uint32_t tile)
{
    return tile_memory_words(a->memory, tile % a->columns, tile / a->columns, a->plane);
}

/* The words that all pixels of a tile have; null: its words in memory are valid. */
static inline const uint32_t *pixels_pending_words(const struct attachment *a, uint32_t tile)
{
    if (a->format)
        return a->color_clear[tile].pending ? a->color_clear[tile].word : NULL;
    return a->depth_clear[tile].pending ? &a->depth_clear[tile].word : NULL;
}

/* Makes a tile's words valid, with what its clear has left, and returns them. */
uint32_t *pixels_open_tile(const struct attachment *a, uint32_t tile);

/* With AVX2: the halves of two blocks, each two quads of two rows, become eight words of two rows:
 *
 *   a  00 01 10 11  02 03 12 13        first   00 01 02 03 04 05 06 07
 *   b  04 05 14 15  06 07 16 17   ->   second  10 11 12 13 14 15 16 17 */
__attribute__((target("avx2"), always_inline)) static inline void
pixels_pair_rows(const uint32_t *a, const uint32_t *b, __m256i *first, __m256i *second)
{
    const __m256i x = _mm256_load_si256((const __m256i *)(const void *)a);
    const __m256i y = _mm256_load_si256((const __m256i *)(const void *)b);
    const __m256i left = _mm256_permute2x128_si256(x, y, 0x20), right = _mm256_permute2x128_si256(x, y, 0x31);
    *first = _mm256_unpacklo_epi64(left, right);
    *second = _mm256_unpackhi_epi64(left, right);
}

#endif
