#include "command/inspect/pixel.h"

/* Colours that are not stored have all bits set. */
static void read_color(const struct target *target, const struct target_color *color, uint32_t sample,
                       const uint32_t *pixel, uint32_t words[TARGET_PLANES])
{
    for (uint32_t p = color->plane; color->format && p < color->plane + storage_planes[color->storage]; p++)
        words[p] =
            color->attachment ? pixel[(sample * target->planes + p) * target->color_order.plane] : UINT32_MAX;
}

void pixel_read(struct target *target, uint32_t x, uint32_t y, struct pixel_words *words)
{
    uint32_t tile = y / TILE_SIZE * target->columns + x / TILE_SIZE;
    const uint32_t *color = NULL, *depth = NULL;
    x %= TILE_SIZE, y %= TILE_SIZE;
    if (target->color)
        color = target_fill_color(target, tile) + tile_order_word(&target->color_order, x, y);
    if (target->depth)
        depth = target_fill_depth(target, tile) + tile_order_word(&target->depth_order, x, y);
    *words = (struct pixel_words){0};
    for (uint32_t sample = 0; sample < target->samples; sample++) {
        for (unsigned t = 0; t < TARGETS; t++)
            read_color(target, &target->colors[t], sample, color, words->color[sample]);
        if (depth)
            words->depth[sample] = depth[sample * target->depth_order.plane];
    }
}
