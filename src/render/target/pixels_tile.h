/* Shared by the functions of pixels.h that find tiles. */
#ifndef RENDER_TARGET_PIXELS_TILE_H
#define RENDER_TARGET_PIXELS_TILE_H

#include "render/target/pixels.h"

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

#endif
