/* Rasterization of a tile's triangles. Their blocks wait in the worker's list of entries or, for the span
 * reading, in its list of spans. */
#include "contract/key_query.h"
#include "render/tile/hidden.h"
#include "render/tile/tile_part.h"

#include <string.h>

/* Makes the site ready, before anything is rasterized. */
static void enter_site(struct tile_worker *worker, const struct round *round, uint32_t tile)
{
    if (!worker->entered)
        raster_enter(&worker->site, &worker->draw->scissor, (int)(tile % round->target->columns),
                     (int)(tile / round->target->columns));
    worker->entered = true;
}

void tile_rasterize_list(struct tile_worker *worker, const struct round *round, uint32_t tile)
{
    uint32_t done = 0, count = worker->listed;
    worker->listed = 0;
    while (true) {
        done += raster_list(&worker->site, round->arena.base, worker->list + done, count - done,
                            worker->entries.entry, &worker->count);
        if (done == count)
            return;
        tile_shade(worker, round, tile);
    }
}

/* Appends triangles to the list. The rasterizer is faster with many. */
static void list_triangles(struct tile_worker *worker, const struct round *round, uint32_t tile,
                           const uint32_t *triangle, uint32_t count)
{
    if (worker->listed + count > LIST_TRIANGLES)
        tile_rasterize_list(worker, round, tile);
    memcpy(worker->list + worker->listed, triangle, count * sizeof *triangle);
    worker->listed += count;
}

/* Triangles with BIN_RECTANGLE, and without bits of spans. */
static void rasterize_rectangles(struct tile_worker *worker, const struct round *round, uint32_t tile,
                                 const uint32_t *binned, uint32_t count)
{
    uint32_t triangle[BIN_CELL_TRIANGLES];
    for (uint32_t i = 0; i < count; i++)
        triangle[i] = binned[i] & ~(uint32_t)BIN_BITS;
    if (worker->listed)
        tile_rasterize_list(worker, round, tile);
    for (uint32_t done = 0;;) {
        done += raster_rectangles(&worker->site, round->arena.base, triangle + done, count - done,
                                  worker->entries.entry, &worker->count);
        if (done == count)
            return;
        tile_shade(worker, round, tile);
    }
}

/* --- Spans --- */

/* `binned` has BIN_COUNTED. */
static void count_spans(const struct draw *draw, uint32_t binned, uint32_t blocks)
{
    uint32_t *sums = draw->routine[UNIT_PIXEL]->span_blocks;
    if (sums && blocks >= SPAN_BLOCKS)
        __atomic_fetch_add(sums + (binned & BIN_COUNTED) / BIN_READING, blocks, __ATOMIC_RELAXED);
}

/* The `added` entries after the last of the spans wait, too. Of the ordinary routine's entries the first
 * `first` are of earlier triangles. */
static void add_spans(struct tile_worker *worker, const struct round *round, uint32_t tile, uint32_t first,
                      uint32_t added)
{
    struct tile_spans *spans = &worker->spans;
    if (first && tile_spans_meet(spans, worker->entries.entry, first, added)) {
        const struct entry *from = spans->entry + spans->count;
        tile_shade(worker, round, tile);
        memmove(spans->entry, from, added * sizeof *from);
    }
    spans->count += added;
}

/* Rasterizes a triangle. Its whole blocks are after the last of the spans, if there are at least `least`.
 * Returns how many are whole. */
static uint32_t divide_blocks(struct tile_worker *worker, const struct round *round, uint32_t binned,
                              uint32_t least)
{
    const uint32_t triangle = binned & ~(uint32_t)BIN_BITS;
    const uint8_t *records = round->arena.base;
    struct entry *entries = worker->entries.entry + worker->count;
    struct entry *spans = worker->spans.entry + worker->spans.count;
    uint32_t whole, left;
    if (binned & BIN_RECTANGLE) {
        whole = raster_divide_rectangle(&worker->site, records, triangle, least, spans, entries, &left);
    } else {
        left = raster_blocks(&worker->site, records, triangle, entries);
        whole = tile_take_spans(entries, &left, least, spans);
    }
    worker->count += left;
    return whole;
}

/* A triangle with BIN_SPANS or BIN_COUNTED. The order among its own blocks does not matter, because each
 * pixel is in one. */
static void rasterize_spans(struct tile_worker *worker, const struct round *round, uint32_t tile,
                            uint32_t binned)
{
    const uint32_t counts = binned & BIN_COUNTED;
    const uint32_t always = round->settings.of[SETTING_spans] == SETTING_spans_always;
    const uint32_t least = counts ? UINT32_MAX : always ? 1 : SPAN_BLOCKS;
    tile_make_room(worker, round, tile);
    const uint32_t begin = worker->count;
    const uint32_t whole = divide_blocks(worker, round, binned, least);
    if (counts)
        count_spans(worker->draw, binned, whole);
    else if (whole >= least)
        add_spans(worker, round, tile, begin, whole);
}

/* How many triangles from the first on have the same bits. */
static uint32_t count_alike(const uint32_t *triangle, uint32_t count)
{
    uint32_t alike = 1;
    while (alike < count && !((triangle[alike] ^ triangle[0]) & BIN_BITS))
        alike++;
    return alike;
}

/* Triangles with one sample a pixel. None has BIN_COVERS. `bits` has those of any of them. */
static void rasterize_triangles(struct tile_worker *worker, const struct round *round, uint32_t tile,
                                const uint32_t *triangle, uint32_t count, uint32_t bits)
{
    if (count)
        enter_site(worker, round, tile);
    for (uint32_t alike; count; triangle += alike, count -= alike) {
        alike = bits ? count_alike(triangle, count) : count;
        if (triangle[0] & (BIN_SPANS | BIN_COUNTED))
            for (uint32_t i = 0; i < alike; i++)
                rasterize_spans(worker, round, tile, triangle[i]);
        else if (triangle[0] & BIN_RECTANGLE && worker->fills)
            tile_fill_rectangles(worker, round, tile, triangle, alike);
        else if (triangle[0] & BIN_RECTANGLE)
            rasterize_rectangles(worker, round, tile, triangle, alike);
        else
            list_triangles(worker, round, tile, triangle, alike);
    }
}

/* If nothing waits, a triangle that covers the tile may be the first that needs words instead of a clear.
 * They need no value if it writes them all. */
static void replace_clear(const struct tile_worker *worker, const struct round *round, uint32_t tile)
{
    const struct routine *routine = worker->draw->routine[UNIT_PIXEL];
    if (tile_uses_uniform(round) && routine->traits & PIXEL_OVERWRITES_ALL && !worker->count &&
        !worker->listed && !worker->spans.count && worker->target->samples == 1 &&
        hidden_writes_all_targets(&routine->key.pixel, worker->target))
        target_replace_color(worker->target, tile);
}

/* A triangle that covers the tile. */
static void rasterize_whole(struct tile_worker *worker, const struct round *round, uint32_t tile,
                            uint32_t binned)
{
    const uint32_t triangle = binned & ~(uint32_t)BIN_BITS;
    replace_clear(worker, round, tile);
    if (binned & BIN_SPANS) {
        if (tile_shade_whole(worker, round, tile, triangle))
            return;
        tile_make_room(worker, round, tile);
        enter_site(worker, round, tile);
        add_spans(worker, round, tile, worker->count,
                  raster_whole(&worker->site, triangle, worker->spans.entry + worker->spans.count));
        return;
    }
    if (binned & BIN_COUNTED)
        count_spans(worker->draw, binned, TILE_BLOCKS);
    tile_make_room(worker, round, tile);
    enter_site(worker, round, tile);
    worker->count += raster_whole(&worker->site, triangle, worker->entries.entry + worker->count);
}

/* The same from number `from` on; each triangle is tested first if that may be worth it. */
static void rasterize_seen(struct tile_worker *worker, const struct round *round, uint32_t tile,
                           const struct bin_cell *cell, uint32_t from)
{
    uint32_t seen[BIN_CELL_TRIANGLES], count = 0;
    for (uint32_t i = from; i < cell->count; i++) {
        uint32_t binned = cell->triangle[i], triangle = binned & ~(uint32_t)BIN_BITS;
        struct meeting m = {.head =
                                (const struct triangle_head *)(const void *)(round->arena.base + triangle),
                            .triangle = triangle,
                            .covers = binned & BIN_COVERS && worker->whole};
        if (m.covers && count) {
            rasterize_triangles(worker, round, tile, seen, count, cell->bits);
            count = 0;
        }
        if (tile_may_skip(worker, round, tile, m.covers) && tile_deals_with(worker, round, tile, &m))
            continue;
        tile_note_depths(worker, round, tile, &m);
        if (m.covers)
            rasterize_whole(worker, round, tile, binned);
        else
            seen[count++] = binned & ~(uint32_t)BIN_COVERS;
    }
    if (count)
        rasterize_triangles(worker, round, tile, seen, count, cell->bits);
}

static void rasterize_any(struct tile_worker *worker, const struct round *round, uint32_t tile,
                          const struct bin_cell *cell)
{
    const uint8_t *base = round->arena.base;
    const struct draw *draw = worker->draw;
    int column = (int)(tile % round->target->columns), row = (int)(tile / round->target->columns);
    for (uint32_t i = 0; i < cell->count; i++) {
        uint32_t triangle = cell->triangle[i];
        if (worker->count + TILE_BLOCKS > PIXEL_ENTRIES)
            tile_shade(worker, round, tile);
        worker->count += raster_sampled_tile(
            &draw->sampling, draw->shape, (const struct triangle_head *)(const void *)(base + triangle),
            &draw->scissor, column, row, triangle, &worker->entries, worker->count);
    }
}

void tile_rasterize_cell(struct tile_worker *worker, const struct round *round, uint32_t tile,
                         const struct bin_cell *cell, uint32_t from)
{
    const struct draw *draw = worker->draw;
    const struct meeting any = {.covers = false};
    bool plain = draw->shape == SHAPE_TRIANGLE && !draw->sampling.samples;
    if (plain && (cell->bits & BIN_COVERS || tile_may_skip(worker, round, tile, false))) {
        rasterize_seen(worker, round, tile, cell, from);
        return;
    }
    tile_note_depths(worker, round, tile, &any);
    if (plain)
        rasterize_triangles(worker, round, tile, cell->triangle, cell->count, cell->bits);
    else
        rasterize_any(worker, round, tile, cell);
}
