/* Shared by the rasterizers of triangles, lines and points: pixels of window positions, lanes of blocks. */
#ifndef RENDER_RASTER_RASTER_PART_H
#define RENDER_RASTER_RASTER_PART_H

#include "base/minmax.h"
#include "render/raster/raster.h"

enum {
    SUBPIXELS = 1 << SUBPIXEL_BITS,
    CENTRE = SUBPIXELS / 2,
    ROW_BLOCKS = TILE_SIZE / BLOCK_SIZE,
    WHOLE_BLOCK = (1 << BLOCK_PIXELS) - 1,
    TILE_BITS = 6 /* of a pixel's position in its tile */
};

_Static_assert(1 << TILE_BITS == TILE_SIZE, "bits of a tile's side");

/* Lanes of a block in its columns (rows) k and after, for k from 0 to 4. */
static const uint16_t columns_from[BLOCK_SIZE + 1] = {0xffff, 0xfafa, 0xf0f0, 0xa0a0, 0};
static const uint16_t rows_from[BLOCK_SIZE + 1] = {0xffff, 0xffcc, 0xff00, 0xcc00, 0};

/* The first pixel whose centre is at the window position or after it. */
static inline int32_t pixel_from(int32_t position)
{
    return (position + CENTRE - 1) >> SUBPIXEL_BITS;
}

/* The triangle's own bounds, in 1/256 pixel, inclusive. */
static inline struct rectangle window_bounds(const struct triangle_head *head)
{
    const int32_t *x = head->x, *y = head->y;
    return (struct rectangle){min_i32(x[0], min_i32(x[1], x[2])), min_i32(y[0], min_i32(y[1], y[2])),
                              max_i32(x[0], max_i32(x[1], x[2])), max_i32(y[0], max_i32(y[1], y[2]))};
}

/* The pixels of `window` within the limit; returns whether there are any. The largest x and y are exclusive:
 * a centre there could only lie on an edge that is neither top nor left, or be a vertex that ends one. */
static inline bool bound(const struct rectangle *window, const struct rectangle *limit,
                         struct rectangle *bounds)
{
    bounds->x0 = max_i32(limit->x0, pixel_from(window->x0));
    bounds->y0 = max_i32(limit->y0, pixel_from(window->y0));
    bounds->x1 = min_i32(limit->x1, pixel_from(window->x1));
    bounds->y1 = min_i32(limit->y1, pixel_from(window->y1));
    return bounds->x0 < bounds->x1 && bounds->y0 < bounds->y1;
}

/* Value at the centre of the pixel (x, y), and steps, of the edge from vertex p to vertex q. */
static inline int64_t edge(const struct triangle_head *head, int p, int q, int32_t x, int32_t y, int32_t *a,
                           int32_t *b)
{
    *a = head->y[p] - head->y[q];
    *b = head->x[q] - head->x[p];
    int64_t dx = x * SUBPIXELS + CENTRE - head->x[p];
    int64_t dy = y * SUBPIXELS + CENTRE - head->y[p];
    bool top_left = *a > 0 || (*a == 0 && *b > 0);
    return (*b * dy + *a * dx - !top_left) >> SUBPIXEL_BITS;
}

/* The same of edge i of a record with smooth edges. Of a smooth edge, the value is not negative if the
 * pixel's square has area inside: the centre is beyond the edge by less than half of the square's extent
 * along the edge's normal. */
static inline int64_t smooth_edge(const struct triangle_head *head, int i, int32_t x, int32_t y, int32_t *a,
                                  int32_t *b)
{
    int next = i < 2 ? i + 1 : 0;
    int64_t value = edge(head, i, next, x, y, a, b);
    if (!(raster_smooth(head)->edges >> i & 1))
        return value;
    int64_t dx = x * SUBPIXELS + CENTRE - head->x[i], dy = y * SUBPIXELS + CENTRE - head->y[i];
    int64_t reach = CENTRE * ((int64_t)(*a < 0 ? -*a : *a) + (*b < 0 ? -*b : *b));
    return (*b * dy + *a * dx + reach - 1) >> SUBPIXEL_BITS;
}

/* Lanes of the block from `first` on, along one axis, that the range start <= position < end keeps. */
static inline uint32_t kept(const uint16_t from[BLOCK_SIZE + 1], int32_t first, int32_t start, int32_t end)
{
    return from[max_i32(start - first, 0)] & ~from[min_i32(end - first, BLOCK_SIZE)];
}

static inline __m128i box_corner(int32_t x, int32_t y)
{
    return _mm_unpacklo_epi64(_mm_set1_epi16((int16_t)x), _mm_set1_epi16((int16_t)y));
}

static inline struct box box_of(const struct rectangle *r)
{
    return (struct box){box_corner(r->x0, r->y0), box_corner(r->x1, r->y1)};
}

static inline __m128i next_corner(__m128i v)
{
    return _mm_shufflehi_epi16(_mm_shufflelo_epi16(v, _MM_SHUFFLE(0, 0, 2, 1)), _MM_SHUFFLE(0, 0, 2, 1));
}

/* The centres that a visible triangle may cover. */
static inline struct box whole_box(const struct triangle_head *head)
{
    __m128i half = _mm_set1_epi32(CENTRE - 1);
    __m128i x = _mm_loadu_si128((const __m128i *)(const void *)head->x); /* the fourth is not used */
    __m128i y = _mm_loadu_si128((const __m128i *)(const void *)head->y);
    x = _mm_srai_epi32(_mm_add_epi32(x, half), SUBPIXEL_BITS);
    y = _mm_srai_epi32(_mm_add_epi32(y, half), SUBPIXEL_BITS);
    __m128i a = _mm_packs_epi32(x, y), b = next_corner(a), c = next_corner(b);
    return (struct box){_mm_min_epi16(_mm_min_epi16(a, b), c), _mm_max_epi16(_mm_max_epi16(a, b), c)};
}

static inline struct box cut_box(const struct box *box, const struct box *limit)
{
    return (struct box){_mm_max_epi16(box->low, limit->low), _mm_min_epi16(box->high, limit->high)};
}

/* The centres that a visible triangle may cover, cut to the limit. */
static inline struct box triangle_box(const struct triangle_head *head, const struct box *limit)
{
    struct box box = whole_box(head);
    return cut_box(&box, limit);
}

/* Returns true if a comparison holds for both coordinates. */
static inline bool of_both(__m128i words)
{
    return (_mm_movemask_epi8(words) & 0x0101) == 0x0101;
}

static inline bool box_is_empty(const struct box *box)
{
    return !of_both(_mm_cmpgt_epi16(box->high, box->low));
}

/* Returns true if the box is wider and higher than the extent, which each 16-bit word has. */
static inline bool box_extends(const struct box *box, __m128i extent)
{
    return of_both(_mm_cmpgt_epi16(_mm_sub_epi16(box->high, box->low), extent));
}

static inline int32_t box_x(__m128i corner)
{
    return (int16_t)_mm_extract_epi16(corner, 0);
}

static inline int32_t box_y(__m128i corner)
{
    return (int16_t)_mm_extract_epi16(corner, 4);
}

static inline bool intersect(struct rectangle *a, const struct rectangle *b)
{
    a->x0 = max_i32(a->x0, b->x0);
    a->y0 = max_i32(a->y0, b->y0);
    a->x1 = min_i32(a->x1, b->x1);
    a->y1 = min_i32(a->y1, b->y1);
    return a->x0 < a->x1 && a->y0 < a->y1;
}

static inline struct rectangle tile_rectangle(int column, int row)
{
    int32_t x = column * TILE_SIZE, y = row * TILE_SIZE;
    return (struct rectangle){x, y, x + TILE_SIZE, y + TILE_SIZE};
}

/* The block at (x, y) in the window. */
static inline struct entry block_entry(int32_t x, int32_t y, uint32_t coverage, uint32_t record)
{
    return (struct entry){
        .x = (float)x,
        .y = (float)y,
        .coverage = (uint16_t)coverage,
        .block = (uint16_t)((y % TILE_SIZE / BLOCK_SIZE) * ROW_BLOCKS + x % TILE_SIZE / BLOCK_SIZE),
        .triangle = record,
    };
}

static inline __m128i entry_triangle(uint32_t triangle)
{
    return _mm_slli_si128(_mm_cvtsi32_si128((int)triangle), offsetof(struct entry, triangle));
}

#define ALL_LANES(v, i) _mm_shuffle_epi32(v, (i)*0x55)

/* The blocks of any triangle in the site's tile, as raster_tile() gives them. Not inlined into the code
 * for tiny triangles, which needs the registers. */
uint32_t raster_any(const struct raster_site *site, const struct triangle_head *head, uint32_t triangle,
                    struct entry *entries);

/* The blocks of a record that is a rectangle. Returns the end of the entries. */
struct entry *raster_rectangle(const struct raster_site *site, const struct triangle_head *head,
                               uint32_t triangle, struct entry *entries);

/* The blocks of a triangle with a box in the tile, with AVX2, from `next` on. Returns the entries' end. */
struct entry *raster_rows(const struct raster_site *site, const struct triangle_head *head,
                          const struct box *box, uint32_t triangle, struct entry *next);

/* The same of the records at `count` offsets, until `next` is after `last`. It writes up to three entries
 * after the returned `next`. */
struct raster_progress raster_eight(const struct raster_site *site, const uint8_t *records,
                                    const uint32_t *offset, uint32_t count, struct entry *next,
                                    const struct entry *last);

/* The same of any visible triangle, by the way that suits it. */
struct entry *raster_one(const struct raster_site *site, const struct triangle_head *head, uint32_t triangle,
                         struct entry *next);

#endif
