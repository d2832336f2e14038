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

/* The triangle and all lanes. */
static inline __m128i same_of(uint32_t triangle)
{
    return _mm_or_si128(entry_triangle(triangle), _mm_andnot_si128(keeping(0), _mm_set1_epi32(-1)));
}

/* The entries of an extent: each is what its column and its row have in common with all lanes, less those
 * that are beyond a side. */
static inline struct entry *emit(const struct raster_site *site, const struct extent *in, __m128i same,
                                 struct entry *next)
{
    int columns = in->right - in->left + 1;
    switch (columns) {
    case 1: return emit_columns(site, in, same, 1, next);
    case 2: return emit_columns(site, in, same, 2, next);
    case 3: return emit_columns(site, in, same, 3, next);
    case 4: return emit_columns(site, in, same, 4, next);
    default: return emit_columns(site, in, same, columns, next);
    }
}

struct entry *raster_rectangle(const struct raster_site *site, const struct triangle_head *head,
                               uint32_t triangle, struct entry *entries)
{
    struct box box = triangle_box(head, &site->limit);
    if (box_is_empty(&box))
        return entries;
    struct extent in = extent_of(&box);
    return emit(site, &in, same_of(triangle), entries);
}

/* --- Whole blocks apart --- */

/* The blocks of an extent that are whole; there may be none. */
static inline struct extent inner_of(const struct extent *in)
{
    enum { LAST = BLOCK_SIZE - 1 };
    return (struct extent){in->left + (in->from_x > 0),
                           in->right - (in->to_x < LAST),
                           in->top + (in->from_y > 0),
                           in->bottom - (in->to_y < LAST),
                           0,
                           LAST,
                           0,
                           LAST};
}

/* The entries of an extent that may have none. It is called for several. */
__attribute__((noinline)) static struct entry *
emit_part(const struct raster_site *site, const struct extent *part, __m128i same, struct entry *next)
{
    return part->left > part->right || part->top > part->bottom ? next : emit(site, part, same, next);
}

/* The blocks around the inner ones: whole rows above and below, then the ends of the other rows. */
static struct entry *emit_rim(const struct raster_site *site, const struct extent *in,
                              const struct extent *inner, __m128i same, struct entry *next)
{
    struct extent above = *in, below = *in, left = *inner, right = *inner;
    above.bottom = inner->top - 1, above.to_y = BLOCK_SIZE - 1;
    below.top = inner->bottom + 1, below.from_y = 0;
    left.left = in->left, left.right = inner->left - 1, left.from_x = in->from_x;
    right.left = inner->right + 1, right.right = in->right, right.to_x = in->to_x;
    next = emit_part(site, &above, same, next);
    next = emit_part(site, &below, same, next);
    next = emit_part(site, &left, same, next);
    return emit_part(site, &right, same, next);
}

uint32_t raster_divide_rectangle(const struct raster_site *site, const uint8_t *records, uint32_t offset,
                                 uint32_t least, struct entry *whole, struct entry *entries, uint32_t *count)
{
    const struct triangle_head *head = (const struct triangle_head *)(const void *)(records + offset);
    const struct box box = triangle_box(head, &site->limit);
    *count = 0;
    if (box_is_empty(&box))
        return 0;
    const struct extent in = extent_of(&box), inner = inner_of(&in);
    const __m128i same = same_of(offset);
    const int columns = inner.right - inner.left + 1, rows = inner.bottom - inner.top + 1;
    const uint32_t found = columns > 0 && rows > 0 ? (uint32_t)(columns * rows) : 0;
    struct entry *end;
    if (found && found >= least) {
        emit_part(site, &inner, same, whole);
        end = emit_rim(site, &in, &inner, same, entries);
    } else {
        end = emit_part(site, &in, same, entries);
    }
    *count = (uint32_t)(end - entries);
    return found;
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
