#include "command/inspect/pixel.h"

void pixel_read(struct target *target, uint32_t x, uint32_t y, struct pixel_words *words)
{
    uint32_t tile = y / TILE_SIZE * target->columns + x / TILE_SIZE;
    uint32_t word = pixel_word(x % TILE_SIZE, y % TILE_SIZE);
    const uint32_t *color = target_fill_color(target, tile) + word;
    const uint32_t *depth = target->depth ? target_fill_depth(target, tile) + word : NULL;
    *words = (struct pixel_words){0};
    for (uint32_t sample = 0; sample < target->samples; sample++) {
        for (uint32_t plane = 0; plane < target->planes; plane++)
            words->color[sample][plane] = color[(sample * target->planes + plane) * TILE_PIXELS];
        if (depth)
            words->depth[sample] = depth[sample * TILE_PIXELS];
    }
}
