#include "render/geometry/bin.h"

#include "base/minmax.h"
#include "render/geometry/bin_pair.h"
#include "render/geometry/bin_place.h"
#include "render/raster/raster_part.h"

#include <string.h>

_Static_assert(sizeof(struct bin_cell) == ARENA_ALIGNMENT, "a cell is a cache line");
_Static_assert(TARGET_TILES_MAXIMUM <= UINT16_MAX + 1, "tiles fit the cell's field");

/* The most cells that `pairs` of a triangle and a tile can need, when `tiles` tiles may each have a cell that
 * is not full. */
#define CELLS(pairs, tiles) ((pairs) / BIN_CELL_TRIANGLES + (tiles))

/* One group of triangles always fits the empty arena, so every round gets ahead. */
_Static_assert((size_t)CELLS(SETUP_CAPACITY *TARGET_TILES_MAXIMUM, TARGET_TILES_MAXIMUM) *
                           sizeof(struct bin_cell) +
                       2 * ARENA_BLOCK <
                   ARENA_BYTES,
               "the arena holds the largest group of triangles");

uint32_t bin_band_shift(uint32_t tiles)
{
    uint32_t shift = 0;
    while ((tiles - 1) >> shift >= BIN_BANDS)
        shift++;
    return shift;
}

void bin_begin_round(struct bin_writer *writer, struct arena *arena, uint32_t columns, uint32_t rows,
                     uint32_t band_shift)
{
    writer->arena = arena;
    writer->at = writer->end = writer->asked = 0;
    writer->columns = columns;
    writer->rows = rows;
    writer->band_shift = band_shift;
    writer->bands = ((columns * rows - 1) >> band_shift) + 1;
}

void bin_begin_chunk(struct bin_writer *writer, uint32_t chunk)
{
    writer->chunk = chunk;
    writer->wide = writer->covered = writer->head_count = 0;
    writer->heads[0] = 0;
    if (writer->bands > 1)
        memset(writer->heads, 0, sizeof writer->heads);
    writer->pixels = 0;
    writer->classified = 0;
    writer->joined = true;
}

void bin_end_chunk(struct bin_writer *writer)
{
    uint32_t band = 0;
    do
        for (uint32_t head = writer->heads[band]; head; head = bin_cell(writer->arena, head)->sibling)
            writer->open[bin_cell(writer->arena, head)->tile] = 0;
    while (++band < writer->bands);
}

uint8_t *bin_reserve(struct bin_writer *writer, uint32_t bytes)
{
    if (bytes > writer->end - writer->at) {
        uint32_t block = bytes > ARENA_BLOCK ? bytes : ARENA_BLOCK;
        uint32_t start = arena_take(writer->arena, block);
        if (!start)
            return NULL;
        writer->at = start;
        writer->end = start + block;
    }
    return writer->arena->base + writer->at;
}

static struct bin_cell *new_cell(struct bin_writer *writer, uint32_t tile)
{
    struct bin_cell *cell = bin_cell(writer->arena, writer->at);
    cell->next = 0;
    cell->count = cell->bits = 0;
    cell->tile = (uint16_t)tile;
    writer->open[tile] = writer->at;
    writer->at += sizeof *cell;
    return cell;
}

static inline void append(struct bin_writer *writer, uint32_t tile, uint32_t triangle)
{
    uint32_t open = writer->open[tile];
    struct bin_cell *cell;
    if (!open) {
        uint32_t *heads = writer->heads + (tile >> writer->band_shift);
        cell = new_cell(writer, tile);
        cell->sibling = *heads;
        cell->later = 0;
        cell->chunk = writer->chunk;
        *heads = writer->open[tile];
        writer->head_count++;
    } else if (bin_cell(writer->arena, open)->count == BIN_CELL_TRIANGLES) {
        cell = new_cell(writer, tile);
        bin_cell(writer->arena, open)->next = writer->open[tile];
    } else {
        cell = bin_cell(writer->arena, open);
    }
    cell->triangle[cell->count++] = triangle;
    cell->bits |= triangle & BIN_BITS;
}

/* A triangle that the scissor rectangle does not cut crosses all tiles that its bounds meet in a strip. */
static void append_to_strip(struct bin_writer *writer, const struct rectangle *tiles, uint32_t triangle)
{
    for (int32_t row = tiles->y0; row < tiles->y1; row++)
        for (int32_t column = tiles->x0; column < tiles->x1; column++)
            append(writer, (uint32_t)row * writer->columns + (uint32_t)column, triangle);
}

static void append_to_tiles(struct bin_writer *writer, const struct rectangle *tiles, const struct draw *draw,
                            uint32_t triangle)
{
    const uint8_t *record = writer->arena->base + (triangle & ~(uint32_t)BIN_BITS);
    struct sampled_raster raster;
    raster_sampled_prepare(&raster, &draw->sampling, draw->shape,
                           (const struct triangle_head *)(const void *)record, &draw->scissor);
    bool covers = draw->shape == SHAPE_TRIANGLE && !draw->sampling.samples && raster.count;
    for (int32_t row = tiles->y0; row < tiles->y1; row++)
        for (int32_t column = tiles->x0; column < tiles->x1; column++) {
            if (!(triangle & BIN_RECTANGLE) && !raster_sampled_touches(&raster, column, row))
                continue;
            uint32_t all = covers && raster_covers(&raster.raster[0], column, row) ? BIN_COVERS : 0;
            append(writer, (uint32_t)row * writer->columns + (uint32_t)column, triangle | all);
            writer->covered += all;
        }
}

bool bin_covers(const struct arena *arena, uint32_t head)
{
    for (uint32_t at = head; at; at = bin_cell(arena, at)->next)
        if (bin_cell(arena, at)->bits & BIN_COVERS)
            return true;
    return false;
}

/* --- Triangles that reach far --- */

static struct rectangle tiles_of_all(const struct bin_writer *writer, uint32_t count)
{
    struct rectangle all = writer->tiles[0];
    for (uint32_t i = 1; i < count; i++) {
        const struct rectangle *tiles = writer->tiles + i;
        all = (struct rectangle){min_i32(all.x0, tiles->x0), min_i32(all.y0, tiles->y0),
                                 max_i32(all.x1, tiles->x1), max_i32(all.y1, tiles->y1)};
    }
    return all;
}

/* The bits of triangle i of the group that hold in all tiles. */
static inline uint32_t marks_of(const struct bin_writer *writer, uint32_t i)
{
    return writer->marked ? writer->marks[i] : 0;
}

/* Returns true if the visible triangles of a group, the first of its chunk, get no cells; `tiles` are
 * those that all of them meet. */
static bool are_wide(const struct bin_writer *writer, uint32_t visible, struct rectangle *tiles)
{
    if (!visible || visible > WIDE_TRIANGLES || writer->head_count || writer->wide)
        return false;
    for (uint32_t i = 0; i < visible; i++)
        if (writer->tile[i] != MANY_TILES)
            return false;
    *tiles = tiles_of_all(writer, visible);
    uint32_t count = (uint32_t)((tiles->x1 - tiles->x0) * (tiles->y1 - tiles->y0));
    return count >= WIDE_TILES && count * WIDE_PART >= writer->columns * writer->rows;
}

/* Returns false when the arena is full. */
static bool keep_wide(struct bin_writer *writer, uint32_t triangle, const struct draw *draw, uint32_t visible,
                      const struct rectangle *tiles)
{
    const uint32_t bytes = (sizeof(struct wide) + ARENA_ALIGNMENT - 1) & -(uint32_t)ARENA_ALIGNMENT;
    struct wide *wide = (struct wide *)(void *)bin_reserve(writer, bytes);
    if (!wide)
        return false;
    wide->tiles = *tiles;
    wide->count = 0;
    for (uint32_t i = 0; i < visible; i++, triangle += draw->stride) {
        const uint8_t *record = writer->arena->base + triangle;
        wide->triangle[wide->count].offset = triangle | marks_of(writer, i);
        wide->count += raster_prepare(&wide->triangle[wide->count].raster,
                                      (const struct triangle_head *)(const void *)record, &draw->scissor);
    }
    writer->wide = writer->at;
    writer->at += bytes;
    return true;
}

static bool meets_tile(const struct rectangle *bounds, int32_t column, int32_t row)
{
    int32_t x = column * TILE_SIZE, y = row * TILE_SIZE;
    return bounds->x0 < x + TILE_SIZE && bounds->y0 < y + TILE_SIZE && bounds->x1 > x && bounds->y1 > y;
}

/* A rectangle covers what its bounds hold. */
static bool covers_tile(uint32_t offset, const struct raster *raster, int32_t column, int32_t row)
{
    const struct rectangle *bounds = &raster->bounds;
    int32_t x = column * TILE_SIZE, y = row * TILE_SIZE;
    if (!(offset & BIN_RECTANGLE))
        return raster_covers(raster, column, row);
    return bounds->x0 <= x && bounds->y0 <= y && bounds->x1 >= x + TILE_SIZE && bounds->y1 >= y + TILE_SIZE;
}

void bin_wide_cell(const struct wide *wide, uint32_t tile_column, uint32_t tile_row, struct bin_cell *cell)
{
    int32_t column = (int32_t)tile_column, row = (int32_t)tile_row;
    cell->count = cell->bits = 0;
    cell->next = 0;
    for (uint32_t i = 0; i < wide->count; i++) {
        const struct raster *raster = &wide->triangle[i].raster;
        uint32_t offset = wide->triangle[i].offset;
        if (!meets_tile(&raster->bounds, column, row) ||
            (!(offset & BIN_RECTANGLE) && !raster_touches(raster, column, row)))
            continue;
        offset |= covers_tile(offset, raster, column, row) ? BIN_COVERS : 0;
        cell->triangle[cell->count++] = offset;
        cell->bits |= offset & BIN_BITS;
    }
}

bool bin_wide_covers(const struct wide *wide, uint32_t column, uint32_t row)
{
    bool covers = false;
    for (uint32_t i = 0; i < wide->count && !covers; i++)
        covers =
            covers_tile(wide->triangle[i].offset, &wide->triangle[i].raster, (int32_t)column, (int32_t)row);
    return covers;
}

/* --- Records --- */

enum { OTHERWISE = -2 };

/* The offsets from `start` of the records that setup left visible. About half are not, in an unpredictable
 * order, so the loop has no branch for it. */
static uint32_t list_visible(const uint8_t *start, uint32_t count, uint32_t stride, uint32_t *list)
{
    uint32_t visible = 0, end = count * stride;
    for (uint32_t at = 0; at < end; at += stride) {
        list[visible] = at;
        visible += ((const struct triangle_head *)(const void *)(start + at))->visible != 0;
    }
    return visible;
}

static inline void copy_record(uint8_t *to, const uint8_t *from, uint32_t stride)
{
    for (uint32_t i = 0; i < stride; i += sizeof(__m128i))
        _mm_store_si128((__m128i *)(void *)(to + i),
                        _mm_load_si128((const __m128i *)(const void *)(from + i)));
}

/* Joins each record of the list with the next one where both are a rectangle, and removes the second. */
static uint32_t join_pairs(uint8_t *start, const struct draw *draw, uint32_t *list, uint32_t count)
{
    uint32_t left = 0;
    for (uint32_t i = 0; i < count; i++) {
        list[left++] = list[i];
        i += i + 1 < count && bin_pair_join(start + list[i], start + list[i + 1], &draw->pairs, draw->job);
    }
    return left;
}

/* The records of a group that are kept. */
struct kept {
    uint32_t records;
    uint32_t joined; /* that were two triangles */
    uint32_t pairs;  /* of such a record and a tile */
};

/* Moves the records that may touch a pixel to the front, their tiles to the writer. */
static struct kept keep_visible(struct bin_writer *writer, uint32_t count, const struct bin_placing *how)
{
    const uint32_t stride = how->draw->stride;
    uint32_t list[SETUP_CAPACITY + RASTER_LIST_MARGIN];
    int32_t tile[SETUP_CAPACITY + RASTER_LIST_MARGIN];
    uint8_t *start = writer->arena->base + writer->at, *kept = start;
    uint32_t candidates = list_visible(start, count, stride, list);
    struct kept found = {0};
    if (writer->joins && candidates > 1)
        candidates = join_pairs(start, how->draw, list, candidates);
    writer->marked = false;
    bin_place_list(how, start, list, candidates, tile);
    for (uint32_t i = 0; i < candidates; i++) {
        const uint8_t *record = start + list[i];
        uint32_t tiles = tile[i] >= 0;
        if (tile[i] == RASTER_NOWHERE)
            continue;
        if (tiles)
            writer->tile[found.records] = (uint32_t)tile[i];
        else if (!(tiles = bin_place(writer, how, found.records, record)))
            continue;
        found.pairs += tiles;
        if (((const struct triangle_head *)(const void *)record)->visible == HEAD_RECTANGLE) {
            bin_mark(writer, found.records, BIN_RECTANGLE);
            found.joined++;
            writer->joined &= bin_pair_has_unit_color(record, &how->draw->pairs);
        } else {
            writer->joined = false;
        }
        if (kept != record)
            copy_record(kept, record, stride);
        kept += stride;
        found.records++;
    }
    return found;
}

/* The only record of a group, if it is a triangle whose bounds are in one tile. Returns how many are kept, -1
 * when the arena is full, or OTHERWISE: bin_group() has to do it. */
static int bin_single(struct bin_writer *writer, const struct draw *draw)
{
    const struct triangle_head *head =
        (const struct triangle_head *)(const void *)(writer->arena->base + writer->at);
    const struct box limit = box_of(&draw->scissor);
    uint32_t triangle = writer->at;
    if (!head->visible)
        return 0;
    if (draw->shape != SHAPE_TRIANGLE || (draw->sampling.samples && !draw->sampling.centers))
        return OTHERWISE;
    const struct box box = triangle_box(head, &limit);
    if (box_is_empty(&box))
        return 0;
    if (draw->span_extent && box_extends(&box, bin_span_extent(draw)))
        return OTHERWISE;
    if (!bin_place_in_tile(writer, 0, &box))
        return OTHERWISE;
    writer->joined = false;
    writer->at += draw->stride;
    writer->pixels += PIXELS_GUESSED;
    if (!bin_reserve(writer, sizeof(struct bin_cell)))
        return -1;
    append(writer, writer->tile[0], triangle);
    return 1;
}

static int bin_group(struct bin_writer *writer, uint32_t count, const struct draw *draw)
{
    const bool triangles = draw->shape == SHAPE_TRIANGLE, single = !draw->sampling.samples;
    const struct bin_placing how = bin_placing(writer, draw);
    struct kept kept = keep_visible(writer, count, &how);
    uint32_t triangle = writer->at, visible = kept.records, pairs = kept.pairs;
    int found = (int)(visible + kept.joined);
    writer->at += visible * draw->stride;
    writer->pixels += (uint64_t)visible * PIXELS_GUESSED;
    struct rectangle all;
    if (triangles && single && are_wide(writer, visible, &all))
        return keep_wide(writer, triangle, draw, visible, &all) ? found : -1;
    uint32_t tiles = writer->columns * writer->rows;
    uint32_t cells = CELLS(pairs, pairs < tiles ? pairs : tiles);
    if (!bin_reserve(writer, cells * (uint32_t)sizeof(struct bin_cell)))
        return -1;
    const bool marked = writer->marked;
    const uint32_t stride = draw->stride;
    for (uint32_t i = 0; i < visible; i++, triangle += stride) {
        uint32_t binned = marked ? triangle | writer->marks[i] : triangle;
        if (writer->tile[i] < STRIP_TILES)
            append(writer, writer->tile[i], binned);
        else if (writer->tile[i] == STRIP_TILES)
            append_to_strip(writer, writer->tiles + i, binned);
        else
            append_to_tiles(writer, writer->tiles + i, draw, binned);
    }
    return found;
}

int bin_records(struct bin_writer *writer, uint32_t count, const struct draw *draw)
{
    int found = count == 1 ? bin_single(writer, draw) : OTHERWISE;
    return found == OTHERWISE ? bin_group(writer, count, draw) : found;
}
