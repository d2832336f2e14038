#include "render/geometry/bin_place.h"

#include "machine/cpu.h"

#include <string.h>

enum { LEAST_LIST = 4 }; /* records that are placed eight at a time */

/* Returns false if the triangle's area is too small for the whole blocks that the span reading is called for.
 * These have span_extent squared pixels. Of a whole block, the triangle contains at least the square
 * between the centres of its corners, which is 9/16 of the block. */
static bool has_span_area(const struct draw *draw, const struct triangle_head *head)
{
    const int64_t pixels = (int64_t)draw->span_extent * draw->span_extent;
    const int64_t twice = (int64_t)(head->x[1] - head->x[0]) * (head->y[2] - head->y[0]) -
                          (int64_t)(head->x[2] - head->x[0]) * (head->y[1] - head->y[0]);
    return head->visible == HEAD_RECTANGLE || twice * 8 >= 9 * pixels << (2 * SUBPIXEL_BITS);
}

/* Returns true if the record's triangle is in the class of a reading. */
static bool is_spanned(struct bin_writer *writer, const struct draw *draw, enum span span,
                       const uint8_t *record)
{
    if (!(writer->classified >> span & 1))
        writer->class[span] = span_class(&draw->routine[UNIT_PIXEL]->key.pixel, span);
    writer->classified |= 1u << span;
    return span_includes(&writer->class[span], record);
}

/* BIN_SPANS if the draw's span reading can draw the record's triangle; else, if they are counted, the first
 * wider one that can. */
static unsigned span_bits(struct bin_writer *writer, const struct draw *draw, const uint8_t *record)
{
    const unsigned span = draw->span, end = draw->counts_spans ? draw->span_widest + 1u : 0;
    if (!has_span_area(draw, (const struct triangle_head *)(const void *)record))
        return 0;
    if (span && is_spanned(writer, draw, (enum span)span, record))
        return BIN_SPANS;
    for (unsigned wider = span ? span + 1 : draw->span_narrowest; wider < end; wider++)
        if (is_spanned(writer, draw, (enum span)wider, record))
            return BIN_READING * wider;
    return 0;
}

/* Where the bounds put triangle i of the group; returns how many tiles they meet. */
static uint32_t place_rectangle(struct bin_writer *writer, uint32_t i, const struct rectangle *bounds)
{
    struct rectangle tiles = raster_tiles(bounds);
    int32_t width = bounds->x1 - bounds->x0, height = bounds->y1 - bounds->y0;
    uint32_t columns = (uint32_t)(tiles.x1 - tiles.x0), rows = (uint32_t)(tiles.y1 - tiles.y0);
    writer->pixels += (uint64_t)(width * height);
    writer->tiles[i] = tiles;
    if (columns > 1 && rows > 1)
        writer->tile[i] = MANY_TILES;
    else if (columns > 1 || rows > 1)
        writer->tile[i] = min_i32(width, height) < TILE_SIZE ? STRIP_TILES : MANY_TILES;
    else
        writer->tile[i] = (uint32_t)tiles.y0 * writer->columns + (uint32_t)tiles.x0;
    return columns * rows;
}

static inline uint32_t place_box(struct bin_writer *writer, uint32_t i, const struct box *box)
{
    if (bin_place_in_tile(writer, i, box))
        return 1;
    struct rectangle bounds = {box_x(box->low), box_y(box->low), box_x(box->high), box_y(box->high)};
    return place_rectangle(writer, i, &bounds);
}

void bin_mark(struct bin_writer *writer, uint32_t i, unsigned bit)
{
    if (!writer->marked)
        memset(writer->marks, 0, sizeof writer->marks);
    writer->marked = true;
    writer->marks[i] |= (uint8_t)bit;
}

uint32_t bin_place(struct bin_writer *writer, const struct bin_placing *how, uint32_t i,
                   const uint8_t *record)
{
    const struct triangle_head *head = (const struct triangle_head *)(const void *)record;
    const struct draw *draw = how->draw;
    struct rectangle bounds;
    if (how->plain) {
        struct box box = triangle_box(head, &how->limit);
        if (box_is_empty(&box))
            return 0;
        unsigned bits = how->spans && box_extends(&box, how->extent) ? span_bits(writer, draw, record) : 0;
        if (bits)
            bin_mark(writer, i, bits);
        return place_box(writer, i, &box);
    }
    if (!raster_sampled_bounds(&draw->sampling, draw->shape, head, &draw->scissor, &bounds))
        return 0;
    return place_rectangle(writer, i, &bounds);
}

/* --- Many at a time --- */

struct bin_placing bin_placing(const struct bin_writer *writer, const struct draw *draw)
{
    const bool triangles = draw->shape == SHAPE_TRIANGLE, single = !draw->sampling.samples;
    const bool plain = triangles && (single || draw->sampling.centers);
    return (struct bin_placing){
        .draw = draw,
        .limit = box_of(&draw->scissor),
        .extent = bin_span_extent(draw),
        .spans = draw->span_extent != 0,
        .plain = plain,
        .eight = plain && cpu_has_avx2_fma(),
        .window = {draw->scissor, draw->span_extent ? draw->span_extent - 1 : INT32_MAX,
                   (int32_t)writer->columns},
    };
}

void bin_place_list(const struct bin_placing *how, const uint8_t *start, uint32_t *list, uint32_t count,
                    int32_t *tile)
{
    if (how->eight && count >= LEAST_LIST) {
        raster_place_eight(&how->window, start, list, count, tile);
        return;
    }
    for (uint32_t i = 0; i < count; i++)
        tile[i] = RASTER_TILES;
}
