/* Where triangles are: the tiles that their bounds meet, and the bits that hold in all of these. */
#ifndef RENDER_GEOMETRY_BIN_PLACE_H
#define RENDER_GEOMETRY_BIN_PLACE_H

#include "render/geometry/bin.h"
#include "render/raster/raster_part.h"

/* How bounds are found. */
struct bin_placing {
    const struct draw *draw;
    struct box limit; /* the scissor */
    __m128i extent;   /* bin_span_extent() */
    bool spans;       /* the draw has tested ones */
    bool plain;       /* triangles with one sample a pixel, or several at its centre */
    bool eight;       /* these can be placed eight at a time, in this window */
    struct raster_window window;
};

struct bin_placing bin_placing(const struct bin_writer *writer, const struct draw *draw);

/* The extent of triangles that are tested for spans, less one, in each word. */
static inline __m128i bin_span_extent(const struct draw *draw)
{
    return _mm_set1_epi16((int16_t)(draw->span_extent - 1));
}

/* Returns false if the bounds meet several tiles. */
static inline bool bin_place_in_tile(struct bin_writer *writer, uint32_t i, const struct box *box)
{
    __m128i first = _mm_srai_epi16(box->low, TILE_BITS);
    __m128i last = _mm_srai_epi16(_mm_add_epi16(box->high, _mm_set1_epi16(-1)), TILE_BITS);
    if (!of_both(_mm_cmpeq_epi16(first, last)))
        return false;
    writer->tile[i] = (uint32_t)box_y(first) * writer->columns + (uint32_t)box_x(first);
    return true;
}

/* Places triangle i of the group. Returns how many tiles its bounds meet: 0 when the record touches no pixel
 * of the scissor rectangle. */
uint32_t bin_place(struct bin_writer *writer, const struct bin_placing *how, uint32_t i,
                   const uint8_t *record);

/* The tiles of the records at `count` offsets from `start`, as raster_place_eight() has them; all are
 * RASTER_TILES if it is of no use. Both lists have a margin. */
void bin_place_list(const struct bin_placing *how, const uint8_t *start, uint32_t *list, uint32_t count,
                    int32_t *tile);

/* Triangle i of the group has the bit. */
void bin_mark(struct bin_writer *writer, uint32_t i, unsigned bit);

#endif
