/* Shared by the rasterizers of triangles, lines and points: pixels of window positions, lanes of blocks. */
#ifndef DRAW_RASTER_PART_H
#define DRAW_RASTER_PART_H

#include "draw/raster.h"

enum {
    SUBPIXELS = 1 << SUBPIXEL_BITS,
    CENTRE = SUBPIXELS / 2,
    ROW_BLOCKS = TILE_SIZE / BLOCK_SIZE,
    WHOLE_BLOCK = (1 << BLOCK_PIXELS) - 1
};

/* Lanes of a block in its columns (rows) k and after, for k from 0 to 4. */
static const uint16_t columns_from[BLOCK_SIZE + 1] = {0xffff, 0xfafa, 0xf0f0, 0xa0a0, 0};
static const uint16_t rows_from[BLOCK_SIZE + 1] = {0xffff, 0xffcc, 0xff00, 0xcc00, 0};

static inline int32_t minimum(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static inline int32_t maximum(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

/* The first pixel whose centre is at the window position or after it. */
static inline int32_t pixel_from(int32_t position)
{
    return (position + CENTRE - 1) >> SUBPIXEL_BITS;
}

/* Lanes of the block from `first` on, along one axis, that the range start <= position < end keeps. */
static inline uint32_t kept(const uint16_t from[BLOCK_SIZE + 1], int32_t first, int32_t start, int32_t end)
{
    return from[maximum(start - first, 0)] & ~from[minimum(end - first, BLOCK_SIZE)];
}

static inline bool intersect(struct rectangle *a, const struct rectangle *b)
{
    a->x0 = maximum(a->x0, b->x0);
    a->y0 = maximum(a->y0, b->y0);
    a->x1 = minimum(a->x1, b->x1);
    a->y1 = minimum(a->y1, b->y1);
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

#endif
