#include "render/raster/raster_eight.h"

/* Lanes whose first and last pixels are in the same tile along an axis. */
EIGHT_INLINE __m256i is_alone(__m256i tile, struct range r)
{
    const __m256i last = _mm256_sub_epi32(r.end, _mm256_set1_epi32(1));
    return _mm256_cmpeq_epi32(tile, _mm256_srai_epi32(last, TILE_BITS));
}

EIGHT_INLINE __m256i place(const struct raster_window *window, const struct corners *v)
{
    const struct rectangle *limit = &window->limit;
    const struct range x = cut(range_of(v->x), limit->x0, limit->x1);
    const struct range y = cut(range_of(v->y), limit->y0, limit->y1);
    const __m256i column = _mm256_srai_epi32(x.first, TILE_BITS), row = _mm256_srai_epi32(y.first, TILE_BITS);
    const __m256i number =
        _mm256_add_epi32(column, _mm256_mullo_epi32(row, _mm256_set1_epi32(window->columns)));
    const __m256i some =
        _mm256_and_si256(_mm256_cmpgt_epi32(x.end, x.first), _mm256_cmpgt_epi32(y.end, y.first));
    const __m256i large = _mm256_and_si256(exceeds(x, window->extent), exceeds(y, window->extent));
    const __m256i alone = _mm256_andnot_si256(large, _mm256_and_si256(is_alone(column, x), is_alone(row, y)));
    const __m256i tile = _mm256_blendv_epi8(_mm256_set1_epi32(RASTER_TILES), number, alone);
    return _mm256_blendv_epi8(_mm256_set1_epi32(RASTER_NOWHERE), tile, some);
}

EIGHT void raster_place_eight(const struct raster_window *window, const uint8_t *records, uint32_t *offset,
                              uint32_t count, int32_t *tile)
{
    for (uint32_t i = count; i % LANES; i++)
        offset[i] = offset[count - 1];
    for (uint32_t i = 0; i < count; i += LANES) {
        const struct corners v = load(records, offset + i);
        _mm256_storeu_si256((__m256i *)(void *)(tile + i), place(window, &v));
    }
}
