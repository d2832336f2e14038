/* Eight triangles at a time with AVX2: a lane is a triangle. */
#ifndef RENDER_RASTER_RASTER_EIGHT_H
#define RENDER_RASTER_RASTER_EIGHT_H

#include "render/raster/raster_part.h"

#include <immintrin.h>

#define EIGHT        __attribute__((target("avx2,fma")))
#define EIGHT_INLINE EIGHT static inline __attribute__((always_inline))

enum { LANES = 8 };

struct corners {
    __m256i x[3], y[3];
};

/* The columns of four rows of four words, of two such squares side by side. */
EIGHT_INLINE void turn(const __m256i row[4], __m256i *zero, __m256i *one, __m256i *two, __m256i *three)
{
    const __m256i low = _mm256_unpacklo_epi32(row[0], row[1]), high = _mm256_unpackhi_epi32(row[0], row[1]);
    const __m256i low2 = _mm256_unpacklo_epi32(row[2], row[3]), high2 = _mm256_unpackhi_epi32(row[2], row[3]);
    *zero = _mm256_unpacklo_epi64(low, low2);
    *one = _mm256_unpackhi_epi64(low, low2);
    *two = _mm256_unpacklo_epi64(high, high2);
    *three = _mm256_unpackhi_epi64(high, high2);
}

EIGHT_INLINE __m256i two_of(const uint8_t *first, const uint8_t *second)
{
    const __m128i *low = (const __m128i *)(const void *)first, *high = (const __m128i *)(const void *)second;
    return _mm256_inserti128_si256(_mm256_castsi128_si256(*low), *high, 1);
}

EIGHT_INLINE struct corners load(const uint8_t *records, const uint32_t offset[LANES])
{
    enum { SECOND = 16 };
    _Static_assert(offsetof(struct triangle_head, x) == 4 && offsetof(struct triangle_head, y) == SECOND,
                   "two vectors of four words");
    const uint8_t *r[LANES] = {records + offset[0], records + offset[1], records + offset[2],
                               records + offset[3], records + offset[4], records + offset[5],
                               records + offset[6], records + offset[7]};
    const __m256i first[4] = {two_of(r[0], r[4]), two_of(r[1], r[5]), two_of(r[2], r[6]), two_of(r[3], r[7])};
    const __m256i second[4] = {two_of(r[0] + SECOND, r[4] + SECOND), two_of(r[1] + SECOND, r[5] + SECOND),
                               two_of(r[2] + SECOND, r[6] + SECOND), two_of(r[3] + SECOND, r[7] + SECOND)};
    struct corners c;
    __m256i unused;
    turn(first, &unused, &c.x[0], &c.x[1], &c.x[2]);
    turn(second, &c.y[0], &c.y[1], &c.y[2], &unused);
    return c;
}

/* The pixels whose centres three positions may cover, along one axis. */
struct range {
    __m256i first, end;
};

EIGHT_INLINE struct range range_of(const __m256i v[3])
{
    const __m256i half = _mm256_set1_epi32(CENTRE - 1);
    const __m256i least = _mm256_min_epi32(_mm256_min_epi32(v[0], v[1]), v[2]);
    const __m256i most = _mm256_max_epi32(_mm256_max_epi32(v[0], v[1]), v[2]);
    return (struct range){_mm256_srai_epi32(_mm256_add_epi32(least, half), SUBPIXEL_BITS),
                          _mm256_srai_epi32(_mm256_add_epi32(most, half), SUBPIXEL_BITS)};
}

EIGHT_INLINE struct range cut(struct range r, int32_t first, int32_t end)
{
    return (struct range){_mm256_max_epi32(r.first, _mm256_set1_epi32(first)),
                          _mm256_min_epi32(r.end, _mm256_set1_epi32(end))};
}

/* Lanes where a range has more than `most` pixels. */
EIGHT_INLINE __m256i exceeds(struct range r, int32_t most)
{
    return _mm256_cmpgt_epi32(_mm256_sub_epi32(r.end, r.first), _mm256_set1_epi32(most));
}

EIGHT_INLINE uint32_t bits_of(__m256i lanes)
{
    return (uint32_t)_mm256_movemask_ps(_mm256_castsi256_ps(lanes));
}

#endif
