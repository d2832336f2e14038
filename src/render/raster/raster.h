/* The rasterizer: which pixels a triangle, a line or a point covers, tile by tile.
 *
 * Input is the head of a record (contract/layout.h). A pixel is covered by a triangle when its centre is
 * inside, or on an edge that is a top or a left one; so of triangles that share an edge exactly one covers
 * a centre on it. Lines follow the diamond rule (render/raster/raster_line.c), points the rule of the
 * squares that they are (render/raster/raster_point.c). Smooth primitives cover all pixels whose squares they
 * touch (render/raster/raster_smooth.c). Results are exact for all window positions within WINDOW_LIMIT. */
#ifndef RENDER_RASTER_RASTER_H
#define RENDER_RASTER_RASTER_H

#include "contract/arguments.h"

#include <emmintrin.h>
#include <stdbool.h>

/* Columns x0 <= x < x1, rows y0 <= y < y1; empty when either range is. */
struct rectangle {
    int32_t x0, y0, x1, y1;
};

/* A triangle prepared for one scissor rectangle. Edge function i of the pixel (x, y) is c[i] + a[i] * x +
 * b[i] * y, and the pixel is covered when it lies in the scissor and none of the three is negative. */
struct raster {
    int64_t c[3];
    int32_t a[3];
    int32_t b[3];
    struct rectangle bounds; /* pixels: the bounding box of the centres inside, cut to the scissor */
};

/* The shape that a record is drawn as. */
enum raster_shape {
    SHAPE_TRIANGLE,
    SHAPE_LINE,
    SHAPE_POINT,
    SHAPE_SMOOTH_TRIANGLE, /* the smooth ones have one sample a pixel */
    SHAPE_SMOOTH_LINE,
    SHAPE_SMOOTH_POINT,
    SHAPE_COUNT
};

/* Returns the edges of a smooth record, in the head's order. */
static inline const struct smooth_triangle *raster_smooth(const struct triangle_head *head)
{
    return (const struct smooth_triangle *)(const void *)((const uint8_t *)head + RECORD_COVERAGE);
}

/* Returns false when the triangle is not visible or certainly covers no pixel of the scissor rectangle, and
 * true with *raster filled in and bounds not empty otherwise. Scissor edges are 0 to TARGET_SIZE_MAXIMUM: the
 * intersection of target, viewport and scissor rectangle. */
bool raster_prepare(struct raster *raster, const struct triangle_head *head, const struct rectangle *scissor);

/* The tiles that bounds meet, in units of tiles: never empty. */
struct rectangle raster_tiles(const struct rectangle *bounds);

/* For a tile that the bounds meet: returns false only if the triangle covers no pixel of the tile (column,
 * row). */
bool raster_touches(const struct raster *raster, int column, int row);

/* Returns true only if it covers all pixels of the tile. */
bool raster_covers(const struct raster *raster, int column, int row);

/* The blocks of the tile (column, row) that the triangle covers within the scissor rectangle, in block order;
 * returns how many. `triangle` goes to the entries unchanged. Up to TILE_BLOCKS entries are written. For
 * tests: one tile without its pipeline. */
uint32_t raster_tile(const struct triangle_head *head, const struct rectangle *scissor, int column, int row,
                     uint32_t triangle, struct entry *entries);

/* A rectangle for bounds of triangles: word 0 is x and word 4 is y, the others mean nothing. Pixels of the
 * window need no more than 16 bits. */
struct box {
    __m128i low, high;
};

/* A tile and a scissor rectangle, made ready for many triangles. asm/raster/offset.c passes the layout to
 * assembly. */
struct raster_site {
    struct box limit; /* what both have in common */
    struct rectangle scissor;
    int32_t x, y; /* the tile's first pixel */
    bool whole;   /* the scissor takes nothing from the tile */
    bool kernel;  /* the processor has what the kernel for tiny triangles needs, and it may be used */
    bool rows;    /* the same for the one that finds the covered pixels of rows */
    __m128i column[TILE_SIZE / BLOCK_SIZE]; /* the part of an entry that depends on its column of blocks, */
    __m128i
        row[TILE_SIZE / BLOCK_SIZE + 1]; /* and of the row: or-ed together, its place; the last is not used */
};

/* All blocks of the tile, which the scissor leaves whole and a triangle covers. Returns how many. */
uint32_t raster_whole(const struct raster_site *site, uint32_t triangle, struct entry *entries);

/* The same of the first row of blocks of the tile (column, row). */
uint32_t raster_first_row(int column, int row, uint32_t triangle, struct entry *entries);

/* The triangle of the record at an offset from `records`, as raster_tile() has it. */
uint32_t raster_blocks(const struct raster_site *site, const uint8_t *records, uint32_t offset,
                       struct entry *entries);

/* The triangles of the records at `count` offsets from `records`, as raster_tile() has them one by one but
 * the blocks of one in any order, into entries *used and following of PIXEL_ENTRIES. Returns how many
 * triangles, fewer than `count` when the next one might not find room. */
uint32_t raster_list(const struct raster_site *site, const uint8_t *records, const uint32_t *offset,
                     uint32_t count, struct entry *entries, uint32_t *used);

/* The same of records that are rectangles, which raster_list() does not take. */
uint32_t raster_rectangles(const struct raster_site *site, const uint8_t *records, const uint32_t *offset,
                           uint32_t count, struct entry *entries, uint32_t *used);

/* The same of one record, with its whole blocks apart: in `whole`, by their numbers, if there are at least
 * `least`. *count others are in `entries`. Returns how many are whole. */
uint32_t raster_divide_rectangle(const struct raster_site *site, const uint8_t *records, uint32_t offset,
                                 uint32_t least, struct entry *whole, struct entry *entries, uint32_t *count);

/* The result of raster_tiny_avx512(). */
struct raster_progress {
    struct entry *next; /* the first entry that is not written */
    uint64_t left;      /* triangles that are not done */
};

/* Rasterizes tiny triangles from the first on, with AVX-512 (asm/raster/raster.asm). It stops at a
 * triangle that is not tiny, and when `next` is after `last`. It writes up to four entries after the
 * returned `next`. The scissor rectangle must contain the whole tile, and `count` must not be 0. */
struct raster_progress raster_tiny_avx512(const struct raster_site *site, const uint8_t *records,
                                          const uint32_t *offset, uint32_t count, struct entry *next,
                                          const struct entry *last);

/* A window of tiles, and the extent in pixels beyond which triangles are looked at one by one. */
struct raster_window {
    struct rectangle limit; /* the scissor */
    int32_t extent;
    int32_t columns; /* of tiles */
};

enum { RASTER_NOWHERE = -1, RASTER_TILES = -2, RASTER_LIST_MARGIN = 7 };

/* For each record at `count` offsets, at least one, from `records`: the number of the tile that has its
 * triangle's bounds. RASTER_NOWHERE: they have no pixel within the limit. RASTER_TILES: they meet several
 * tiles, or are wider and higher than the extent. Writes up to RASTER_LIST_MARGIN words after both lists.
 * With AVX2. */
void raster_place_eight(const struct raster_window *window, const uint8_t *records, uint32_t *offset,
                        uint32_t count, int32_t *tile);

void raster_enter(struct raster_site *site, const struct rectangle *scissor, int column, int row);

typedef uint32_t raster_function(const struct triangle_head *head, const struct rectangle *scissor,
                                 int column, int row, uint32_t record, struct entry *entries);

/* The same three functions for each shape: bounds, prepare and tile. */
struct rasterizer {
    bool (*bounds)(const struct triangle_head *head, const struct rectangle *limit, struct rectangle *bounds);
    bool (*prepare)(struct raster *raster, const struct triangle_head *head, const struct rectangle *scissor);
    raster_function *tile;
};

extern const struct rasterizer raster_shapes[SHAPE_COUNT];

bool raster_line_bounds(const struct triangle_head *head, const struct rectangle *limit,
                        struct rectangle *bounds);
bool raster_line_prepare(struct raster *raster, const struct triangle_head *head,
                         const struct rectangle *scissor);
uint32_t raster_line_tile(const struct triangle_head *head, const struct rectangle *scissor, int column,
                          int row, uint32_t record, struct entry *entries);
bool raster_point_bounds(const struct triangle_head *head, const struct rectangle *limit,
                         struct rectangle *bounds);
bool raster_point_prepare(struct raster *raster, const struct triangle_head *head,
                          const struct rectangle *scissor);
uint32_t raster_point_tile(const struct triangle_head *head, const struct rectangle *scissor, int column,
                           int row, uint32_t record, struct entry *entries);

/* Smooth primitives: the pixels whose squares have area in common with them. */
bool raster_smooth_bounds(const struct triangle_head *head, const struct rectangle *limit,
                          struct rectangle *bounds);
bool raster_smooth_prepare(struct raster *raster, const struct triangle_head *head,
                           const struct rectangle *scissor);
uint32_t raster_smooth_tile(const struct triangle_head *head, const struct rectangle *scissor, int column,
                            int row, uint32_t record, struct entry *entries);
bool raster_smooth_line_bounds(const struct triangle_head *head, const struct rectangle *limit,
                               struct rectangle *bounds);
bool raster_smooth_line_prepare(struct raster *raster, const struct triangle_head *head,
                                const struct rectangle *scissor);
uint32_t raster_smooth_line_tile(const struct triangle_head *head, const struct rectangle *scissor,
                                 int column, int row, uint32_t record, struct entry *entries);
bool raster_smooth_point_bounds(const struct triangle_head *head, const struct rectangle *limit,
                                struct rectangle *bounds);
bool raster_smooth_point_prepare(struct raster *raster, const struct triangle_head *head,
                                 const struct rectangle *scissor);
uint32_t raster_smooth_point_tile(const struct triangle_head *head, const struct rectangle *scissor,
                                  int column, int row, uint32_t record, struct entry *entries);

#endif
