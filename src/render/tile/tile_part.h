/* The parts of a tile's rendering. */
#ifndef RENDER_TILE_TILE_PART_H
#define RENDER_TILE_TILE_PART_H

#include "render/tile/hidden.h"
#include "render/tile/tile.h"

/* A triangle in a tile, and how its depth there compares with the stored one. */
struct meeting {
    const struct triangle_head *head;
    uint32_t triangle; /* offset of its record */
    bool covers;       /* the whole tile */
    bool constant;     /* its depth */
    struct depth_range depths;
    enum depth_verdict verdict;
};

static inline bool tile_uses_ranges(const struct round *round)
{
    return round->settings.of[SETTING_range] == SETTING_range_on;
}

static inline bool tile_uses_uniform(const struct round *round)
{
    return round->settings.of[SETTING_uniform] == SETTING_uniform_on;
}

/* --- tile.c --- */

/* Draws what waits; something does. */
void tile_shade_waiting(struct tile_worker *worker, const struct round *round, uint32_t tile);

/* Draws what waits, if anything does. */
static inline void tile_shade(struct tile_worker *worker, const struct round *round, uint32_t tile)
{
    if (worker->listed || worker->count || worker->spans.count)
        tile_shade_waiting(worker, round, tile);
}

/* Draws a triangle with BIN_SPANS that covers the tile, if its routine takes tiles and nothing waits. Returns
 * true if it has. */
bool tile_shade_whole(struct tile_worker *worker, const struct round *round, uint32_t tile,
                      uint32_t triangle);

/* Leaves room for one more triangle among the entries and the spans. */
void tile_make_room(struct tile_worker *worker, const struct round *round, uint32_t tile);

/* Draws the entries; there is at least one. */
void tile_run_blocks(struct tile_worker *worker, const struct round *round, uint32_t tile);

/* The number of set bits in the entries' coverages. Up to seven entries after the last are read. */
uint64_t tile_count_pixels(const struct entry *entry, uint32_t count);

/* Runs the draw's ordinary routine over `count` entries, at least one; up to seven more are read. */
void tile_run_entries(struct tile_worker *worker, const struct round *round, uint32_t tile,
                      const struct entry *entries, uint32_t count);

/* Makes the tile's words valid, as far as the draw's routines read or write them. */
void tile_fill_clear(const struct tile_worker *worker, uint32_t tile);

/* --- tile_fill.c --- */

void tile_fill_begin_round(struct tile_fill *fill);

/* Returns true if the draw's triangles have one colour each, which replaces what is there without a test. */
bool tile_may_fill(const struct tile_worker *worker, const struct round *round, const struct draw *draw);

/* Draws the entries of such a draw; there is at least one. */
void tile_fill_blocks(struct tile_worker *worker, const struct round *round, uint32_t tile);

/* Draws rectangles of such a draw: triangles of a bin. The site is ready. */
void tile_fill_rectangles(struct tile_worker *worker, const struct round *round, uint32_t tile,
                          const uint32_t *binned, uint32_t count);

/* --- tile_skip.c --- */

/* Updates the bounds of the tile's depth for the triangle. */
void tile_note_depths(struct tile_worker *worker, const struct round *round, uint32_t tile,
                      const struct meeting *m);

/* Returns true if the triangle does not have to be rasterized. */
bool tile_deals_with(struct tile_worker *worker, const struct round *round, uint32_t tile, struct meeting *m);

/* Returns true if tile_deals_with() may return true: the triangle covers the tile, or the bounds of the depth
 * are narrower than at first. */
bool tile_may_skip(const struct tile_worker *worker, const struct round *round, uint32_t tile, bool covers);

/* --- tile_raster.c --- */

/* Empties the list of triangles. */
void tile_rasterize_list(struct tile_worker *worker, const struct round *round, uint32_t tile);

/* Rasterizes the triangles of a cell from number `from` on. */
void tile_rasterize_cell(struct tile_worker *worker, const struct round *round, uint32_t tile,
                         const struct bin_cell *cell, uint32_t from);

#endif
