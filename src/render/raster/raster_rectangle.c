/* Rectangles along the axes: all pixels of their bounds (render/geometry/bin_pair.h). Most are letters of a
 * few blocks. */
#include "render/raster/raster_part.h"

/* Functions with an argument `columns` are compiled for the numbers that letters have. */
#define FOR_COLUMNS static inline __attribute__((always_inline))

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

/* Columns and rows of blocks, and pixels within the first and the last of them. */
struct extent {
    int left, right, top, bottom;
    int from_x, to_x, from_y, to_y;
};

static inline struct extent extent_of(const struct box *box)
{
    enum { WITHIN = TILE_SIZE - 1, PART = BLOCK_SIZE - 1 };
    int x0 = box_x(box->low) & WITHIN, x1 = (box_x(box->high) - 1) & WITHIN;
    int y0 = box_y(box->low) & WITHIN, y1 = (box_y(box->high) - 1) & WITHIN;
    return (struct extent){x0 / BLOCK_SIZE, x1 / BLOCK_SIZE, y0 / BLOCK_SIZE, y1 / BLOCK_SIZE,
                           x0 & PART,       x1 & PART,       y0 & PART,       y1 & PART};
}

static inline void put(struct entry *to, __m128i column, __m128i row, __m128i lanes)
{
    _mm_storeu_si128((__m128i *)(void *)to, _mm_and_si128(lanes, _mm_or_si128(column, row)));
}

/* A row of entries. Those of a column share a place, the triangle, and the lanes between the sides. */
FOR_COLUMNS struct entry *put_row(const __m128i column[ROW_BLOCKS], __m128i row, __m128i lanes, int columns,
                                  struct entry *next)
{
    for (int i = 0; i < columns; i++)
        put(next + i, column[i], row, lanes);
    return next + columns;
}

FOR_COLUMNS struct entry *emit_columns(const struct raster_site *site, const struct extent *in, __m128i same,
                                       int columns, struct entry *next)
{
    const __m128i *from = site->column + in->left, *row = site->row + in->top, *last = site->row + in->bottom;
    __m128i column[ROW_BLOCKS];
    for (int i = 0; i < columns; i++)
        column[i] = _mm_or_si128(same, from[i]);
    column[0] = _mm_and_si128(column[0], keeping_from(columns_from, in->from_x));
    column[columns - 1] = _mm_and_si128(column[columns - 1], keeping_to(columns_from, in->to_x));
    __m128i lanes = keeping_from(rows_from, in->from_y), end = keeping_to(rows_from, in->to_y);
    for (; row < last; row++, lanes = _mm_set1_epi32(-1))
        next = put_row(column, *row, lanes, columns, next);
    return put_row(column, *last, _mm_and_si128(lanes, end), columns, next);
}

/* The entries of a box that is not empty, and within the site: each is what its column and its row have in
 * common with all lanes, less those that are beyond a side. */
static inline struct entry *emit(const struct raster_site *site, const struct box *box, uint32_t triangle,
                                 struct entry *next)
{
    __m128i same = _mm_or_si128(entry_triangle(triangle), _mm_andnot_si128(keeping(0), _mm_set1_epi32(-1)));
    struct extent in = extent_of(box);
    int columns = in.right - in.left + 1;
    switch (columns) {
    case 1: return emit_columns(site, &in, same, 1, next);
    case 2: return emit_columns(site, &in, same, 2, next);
    case 3: return emit_columns(site, &in, same, 3, next);
    case 4: return emit_columns(site, &in, same, 4, next);
    default: return emit_columns(site, &in, same, columns, next);
    }
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
