/* One tile: reads its bin in drawing order, rasterizes, and calls the pixel routines on lists of 4x4
 * blocks. */
#ifndef RENDER_TILE_TILE_H
#define RENDER_TILE_TILE_H

#include "render/tile/round.h"
#include "render/tile/span.h"

enum { LIST_TRIANGLES = 64, FILL_TRIANGLES = 32, FILL_PLANES = 4, FILL_KNOWN = 256 };

/* The words of triangles of one colour (render/tile/tile_fill.c). */
struct tile_fill {
    alignas(64) uint32_t words[FILL_PLANES * TILE_PIXELS]; /* of a tile; the first blocks are used */
    struct entry entry[FILL_TRIANGLES];
    bool wide; /* the processor can store words */
    struct known_word {
        uint32_t triangle, word; /* of the round, in the only plane; triangle 0: none */
    } known[FILL_KNOWN];
};

/* One thread's workspace. */
struct tile_worker {
    alignas(64) struct entry_list entries;
    struct tile_spans spans;       /* drawn before `entries` */
    struct lane_table lanes;       /* lane_table: its counters are zero between calls */
    uint32_t count;                /* of entries */
    uint32_t list[LIST_TRIANGLES]; /* triangles of the draw that are rasterized after these, together */
    uint32_t listed;
    const struct draw *draw; /* whose entries and spans these are */
    struct target *target; /* the round's, or its view (render/target/target.h); null: no tile is rendered */
    struct target view;
    uint32_t *view_words;    /* null: no target needs a view (queue_reserve_views) */
    struct raster_site site; /* the tile in the draw's scissor rectangle, once anything is rasterized */
    bool entered;            /* that it is so */
    bool whole;              /* the target has all pixels of the tile that its attachments have */
    uint32_t command;        /* its number */
    bool fills;              /* tile_may_fill() */
    bool joined;             /* so are all chunks of `entries` (struct bin_writer) */
    struct tile_fill fill;
    const struct draw *refused; /* of this round, whose span reading's routine refused a tile; or null */
    bool widened;               /* what is known of the tile's depth allows for what the draw writes */
    uint64_t pixels_shaded, pixel_calls;
};

/* Precedes the first tile of a round. */
void tile_begin_round(struct tile_worker *worker);

/* Renders the chunks of a linked round into tile number `tile`. */
void tile_render(struct tile_worker *worker, const struct round *round, uint32_t tile);

#endif
