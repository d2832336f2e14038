/* One tile: consumes its bin in drawing order, rasterizes, and calls the pixel routines on lists of 4x4
 * blocks. */
#ifndef DRAW_TILE_H
#define DRAW_TILE_H

#include "draw/bin.h"
#include "draw/command.h"

/* One thread's workspace. */
struct tile_worker {
    alignas(64) struct entry_list entries;
    struct lane_table lanes; /* lane_table: its counters are zero between calls */
    uint32_t count;
    const struct draw *draw; /* whose entries these are */
    struct raster_site site; /* the tile in the draw's scissor rectangle, once anything is rasterized */
    bool entered;            /* that it is so */
    uint32_t command;        /* its number */
    bool widened;            /* what is known of the tile's depth allows for what the draw writes */
    uint64_t pixels_shaded;
};

struct frame;

/* Renders the chunks of the frame's round into tile number `tile`. */
void tile_render(struct tile_worker *worker, const struct frame *frame, uint32_t tile);

#endif
