#include "render/target/resolve.h"

#include <string.h>

enum { HALF_ROW = BLIT_ROW_WORDS / 2, NUMBER_PLANES = 4 };

/* Samples whose tiles follow each other are read where they are; others are copied, a row of blocks at a
 * time. Where there is one tile, the planes of both orders have the same distance. */
static bool is_in_tiles(const struct tile_order *order)
{
    return order->plane == TILE_PIXELS && order->block == BLOCK_PIXELS;
}

const struct routine *target_acquire_resolve(const struct blits *blits, enum target_storage storage,
                                             uint32_t samples, const struct tile_order *order,
                                             struct error *error)
{
    const struct blit_key key = {.operation = BLIT_RESOLVE,
                                 .numbers = storage_planes[storage] > 1,
                                 .samples = (uint8_t)samples_exponent(samples),
                                 .by_rows = !is_in_tiles(order)};
    return blit_acquire(blits, key, error);
}

/* A row of blocks of a plane: the upper quads of its blocks, then the lower ones. */
static void resolve_row(const struct routine *resolve, const struct tile_order *order, const uint32_t *words,
                        size_t sample, uint32_t *resolved)
{
    uint32_t samples = 1u << resolve->key.blit.samples;
    alignas(64) uint32_t row[SAMPLES_MAXIMUM * BLIT_ROW_WORDS], mean[BLIT_ROW_WORDS];
    for (uint32_t s = 0; s < samples; s++)
        for (uint32_t half = 0; half < 2; half++)
            memcpy(row + s * BLIT_ROW_WORDS + half * HALF_ROW, words + s * sample + half * order->lower,
                   HALF_ROW * sizeof *row);
    blit_run(resolve, NULL, row, mean, BLIT_ROW_WORDS);
    for (uint32_t block = 0; block < BLIT_ROW_WORDS / BLOCK_PIXELS; block++)
        for (uint32_t half = 0; half < 2; half++)
            memcpy(resolved + block * BLOCK_PIXELS + half * 8, mean + half * HALF_ROW + block * 8,
                   8 * sizeof *mean);
}

void target_resolve_tile(const struct routine *resolve, const struct tile_order *order, const uint32_t *words,
                         uint32_t *resolved)
{
    uint32_t planes = resolve->key.blit.numbers ? NUMBER_PLANES : 1;
    for (uint32_t p = 0; p < planes; p++, words += order->plane, resolved += TILE_PIXELS) {
        if (is_in_tiles(order))
            blit_run(resolve, NULL, words, resolved, TILE_PIXELS);
        for (uint32_t y = 0; y < TILE_SIZE / BLOCK_SIZE && !is_in_tiles(order); y++)
            resolve_row(resolve, order, words + y * order->block_row, planes * order->plane,
                        resolved + y * BLIT_ROW_WORDS);
    }
}

void pixels_resolve_tile(const struct routine *resolve, const struct pixels *from, const struct pixels *to,
                         uint32_t tile)
{
    const struct attachment *a = from->tiles, *b = to->tiles;
    b->color_clear[tile] = a->color_clear[tile];
    if (a->color_clear[tile].pending)
        return;
    uint32_t column = tile % a->columns, row = tile / a->columns;
    target_resolve_tile(resolve, &a->memory->order, tile_memory_words(a->memory, column, row, a->plane),
                        tile_memory_words(b->memory, column, row, b->plane));
}
