/* Rectangles along the axes: all pixels of their bounds (render/geometry/bin_pair.h). Most are letters of a
 * few blocks. */
#include "render/raster/raster_part.h"

/* All bits of an entry, but only these lanes of the coverage. */
static inline __m128i keeping(uint32_t lanes)
{
    return _mm_insert_epi16(_mm_set1_epi32(-1), (int)lanes, offsetof(struct entry, coverage) / 2);
}

/* Lanes from column or row `start` on, and up to `last`. */
static inline __m128i keeping_from(const uint16_t from[BLOCK_SIZE + 1], int start)
{
    return keeping(from[start]);
}

static inline __m128i keeping_to(const uint16_t from[BLOCK_SIZE + 1], int last)
{
    return keeping(~(uint32_t)from[last + 1] & WHOLE_BLOCK);
}

/* The entries of a box that is not empty, and within the site: each is what its column and its row have in
 * common with all lanes, less those that are beyond a side. */
static inline struct entry *emit(const struct raster_site *site, const struct box *box, uint32_t triangle,
                                 struct entry *next)
{
    enum { WITHIN = TILE_SIZE - 1, PART = BLOCK_SIZE - 1 };
    int x0 = box_x(box->low) & WITHIN, x1 = (box_x(box->high) - 1) & WITHIN;
    int y0 = box_y(box->low) & WITHIN, y1 = (box_y(box->high) - 1) & WITHIN;
    int left = x0 / BLOCK_SIZE, right = x1 / BLOCK_SIZE, top = y0 / BLOCK_SIZE, bottom = y1 / BLOCK_SIZE;
    __m128i same = _mm_or_si128(entry_triangle(triangle), _mm_andnot_si128(keeping(0), _mm_set1_epi32(-1)));
    __m128i column[ROW_BLOCKS];
    for (int i = left; i <= right; i++)
        column[i] = _mm_or_si128(same, site->column[i]);
    column[left] = _mm_and_si128(column[left], keeping_from(columns_from, x0 & PART));
    column[right] = _mm_and_si128(column[right], keeping_to(columns_from, x1 & PART));
    for (int k = top; k <= bottom; k++) {
        __m128i rows = k == top ? keeping_from(rows_from, y0 & PART) : _mm_set1_epi32(-1);
        if (k == bottom)
            rows = _mm_and_si128(rows, keeping_to(rows_from, y1 & PART));
        for (int i = left; i <= right; i++)
            _mm_storeu_si128((__m128i *)(void *)next++,
                             _mm_and_si128(rows, _mm_or_si128(column[i], site->row[k])));
    }
    return next;
}

struct entry *raster_rectangle(const struct raster_site *site, const struct triangle_head *head,
                               uint32_t triangle, struct entry *entries)
{
    struct box box = triangle_box(head, &site->limit);
    return box_is_empty(&box) ? entries : emit(site, &box, triangle, entries);
}

uint32_t raster_rectangles(const struct raster_site *site, const uint8_t *records, const uint32_t *offset,
                           uint32_t count, struct entry *entries, uint32_t *used)
{
    struct entry *next = entries + *used;
    const struct entry *last = entries + PIXEL_ENTRIES - TILE_BLOCKS;
    uint32_t i = 0;
    for (; i < count && next <= last; i++)
        next = raster_rectangle(site, (const struct triangle_head *)(const void *)(records + offset[i]),
                                offset[i], next);
    *used = (uint32_t)(next - entries);
    return i;
}
