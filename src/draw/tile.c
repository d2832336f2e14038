#include "draw/tile.h"

#include "draw/frame.h"
#include "draw/raster_part.h"
#include "draw/hidden.h"

#include <string.h>

/* Set bits of the entries' coverages, four at a time (Warren, Hacker's Delight, 5-1); up to three behind them
 * are read. */
static uint64_t count_pixels(const struct entry *entry, uint32_t count)
{
    const __m128i *at = (const __m128i *)(const void *)entry;
    __m128i total = _mm_setzero_si128();
    for (uint32_t i = 0; i < count; i += 4, at += 4) {
        /* The third words of four entries: coverage below, block above. */
        __m128i low = _mm_unpackhi_epi32(_mm_load_si128(at), _mm_load_si128(at + 1));
        __m128i high = _mm_unpackhi_epi32(_mm_load_si128(at + 2), _mm_load_si128(at + 3));
        __m128i x = _mm_and_si128(_mm_unpacklo_epi64(low, high), _mm_set1_epi32(WHOLE_BLOCK));
        __m128i some = _mm_cmplt_epi32(_mm_set_epi32(3, 2, 1, 0), _mm_set1_epi32((int)(count - i)));
        x = _mm_and_si128(x, some);
        x = _mm_sub_epi16(x, _mm_and_si128(_mm_srli_epi16(x, 1), _mm_set1_epi8(0x55)));
        x = _mm_add_epi16(_mm_and_si128(x, _mm_set1_epi8(0x33)),
                          _mm_and_si128(_mm_srli_epi16(x, 2), _mm_set1_epi8(0x33)));
        x = _mm_and_si128(_mm_add_epi16(x, _mm_srli_epi16(x, 4)), _mm_set1_epi8(0x0f));
        total = _mm_add_epi64(total, _mm_sad_epu8(x, _mm_setzero_si128()));
    }
    total = _mm_add_epi64(total, _mm_unpackhi_epi64(total, total));
    return (uint64_t)_mm_cvtsi128_si64(total);
}

/* What the call has counted, to the draw's sum: any order of threads gives the same. */
static void take_count(struct tile_worker *worker, const struct frame *frame)
{
    uint64_t sum = 0;
    for (int lane = 0; lane < LANES_MAXIMUM; lane++)
        sum += (uint32_t)worker->lanes.passed[lane];
    memset(worker->lanes.passed, 0, sizeof worker->lanes.passed);
    atomic_fetch_add_explicit(frame->passed + worker->command, sum, memory_order_relaxed);
}

/* Runs the pixel routine over the entries. */
static void run_pixels(struct tile_worker *worker, const struct frame *frame, uint32_t tile)
{
    struct target *target = frame->target;
    struct pixel_call call = {
        .job = worker->draw->job,
        .entries = worker->entries.entry,
        .triangles = frame->arena.base,
        .lanes = &worker->lanes,
        .color = target_tile_color(target, tile),
        .count = worker->count,
    };
    /* Nobody reads what is not there; an address it has all the same. */
    call.depth = target->depth ? target_tile_depth(target, tile) : call.color;
    uint64_t pixels = count_pixels(worker->entries.entry, worker->count);
    routine_run(worker->draw->routine[UNIT_PIXEL], &call, pixels);
    worker->pixels_shaded += pixels;
    worker->count = 0;
}

static void shade(struct tile_worker *worker, const struct frame *frame, uint32_t tile)
{
    if (!worker->count)
        return;
    const struct pixel_key *key = &worker->draw->routine[UNIT_PIXEL]->key.pixel;
    if (pixel_write_mask(key))
        target_fill_color(frame->target, tile);
    if (pixel_tests_depth(key) || pixel_stencil(key))
        target_fill_depth(frame->target, tile);
    run_pixels(worker, frame, tile);
    if (key->count)
        take_count(worker, frame);
}

/* --- What need not be drawn --------------------------------------------------------------------------------
 */

/* A triangle in a tile, and what its depth there has to do with what is stored. */
struct meeting {
    const struct triangle_head *head;
    uint32_t triangle; /* offset of its record */
    bool covers;       /* the whole tile */
    bool constant;     /* its depth */
    struct depth_range depths;
    enum depth_verdict verdict;
};

static int32_t tile_start(uint32_t number)
{
    return (int32_t)number * TILE_SIZE;
}

/* The pixels of the tile that the triangle's own bounds meet. */
static struct rectangle meeting_area(const struct frame *frame, uint32_t tile, const struct draw *draw,
                                     const struct triangle_head *head)
{
    int32_t x = tile_start(tile % frame->target->columns), y = tile_start(tile / frame->target->columns);
    struct rectangle limit = {x, y, x + TILE_SIZE, y + TILE_SIZE}, area;
    return rasterizer[draw->shape].bounds(head, &limit, &area) ? area : limit;
}

static void compare_depths(struct meeting *m, const struct frame *frame, uint32_t tile,
                           const struct draw *draw)
{
    const struct routine *routine = draw->routine[UNIT_PIXEL];
    const uint8_t *plane = (const uint8_t *)m->head + routine->depth_plane;
    struct rectangle area = meeting_area(frame, tile, draw, m->head);
    m->depths = triangle_depths(m->head, (const struct plane *)(const void *)plane, &area,
                                frame->target->depth_format, &m->constant);
    m->verdict =
        depth_verdict(routine->key.pixel.depth_function, m->depths, frame->target->clear[tile].range);
}

/* Whether the tile can keep one value in place of its words: nothing that is not written has to stay. */
static bool can_be_uniform(const struct target *target, const struct tile_clear *clear,
                           const struct pixel_key *key)
{
    return pixel_writes_all_targets(key, target) &&
           (!key->depth_write || clear->depth_pending || !stencil_mask(target->depth_format));
}

/* Shades one block of a triangle whose pixels are all alike, and takes its words for all. */
static void shade_uniform(struct tile_worker *worker, const struct frame *frame, uint32_t tile,
                          const struct meeting *m)
{
    struct target *target = frame->target;
    struct tile_clear *clear = target->clear + tile;
    const struct pixel_key *key = &worker->draw->routine[UNIT_PIXEL]->key.pixel;
    const uint32_t *color = target_tile_color(target, tile);
    uint32_t *depth = pixel_tests_depth(key) ? target_tile_depth(target, tile) : NULL;
    for (int i = 0; depth && clear->depth_pending && i < BLOCK_PIXELS; i++)
        depth[i] = clear->depth;
    worker->entries.entry[0] = (struct entry){.x = (float)tile_start(tile % target->columns),
                                              .y = (float)tile_start(tile / target->columns),
                                              .coverage = UINT16_MAX,
                                              .triangle = m->triangle};
    worker->count = 1;
    run_pixels(worker, frame, tile);
    for (uint32_t p = 0; p < target->planes; p++)
        clear->color[p] = color[p * TILE_PIXELS];
    clear->color_pending = true;
    if (!key->depth_write)
        return;
    clear->depth = depth[0];
    clear->depth_pending = true;
    clear->range = m->depths;
}

/* Notes what the triangle may leave behind in the tile's depth. */
static void note_depths(struct tile_worker *worker, const struct frame *frame, uint32_t tile,
                        const struct meeting *m)
{
    const struct routine *routine = worker->draw->routine[UNIT_PIXEL];
    int function = routine->key.pixel.depth_function;
    struct depth_range *range = &frame->target->clear[tile].range;
    if (!(routine->traits & PIXEL_WRITES_DEPTH))
        return;
    if (m->covers && routine->traits & PIXEL_DEPTH_KNOWN && !pixel_waits(&routine->key.pixel)) {
        *range = depth_narrowed(function, *range, m->depths);
    } else if (!worker->widened) {
        *range = depth_widened(function, *range, (struct depth_range){0, UINT32_MAX});
        worker->widened = true;
    }
}

/* Whether there is nothing left to rasterize of the triangle. */
static bool is_dealt_with(struct tile_worker *worker, const struct frame *frame, uint32_t tile,
                          struct meeting *m)
{
    const struct routine *routine = worker->draw->routine[UNIT_PIXEL];
    const struct tile_clear *clear = frame->target->clear + tile;
    bool tests = pixel_tests_depth(&routine->key.pixel);
    m->verdict = tests ? DEPTH_UNDECIDED : DEPTH_PASSES;
    m->constant = true;
    if (routine->traits & PIXEL_DEPTH_KNOWN)
        compare_depths(m, frame, tile, worker->draw);
    if (m->verdict == DEPTH_FAILS)
        return true;
    bool uniform = m->covers && routine->traits & PIXEL_UNIFORM && m->verdict == DEPTH_PASSES &&
                   (m->constant || !routine->key.pixel.depth_write) &&
                   can_be_uniform(frame->target, clear, &routine->key.pixel);
    if (uniform) {
        shade(worker, frame, tile);
        shade_uniform(worker, frame, tile, m);
    }
    return uniform;
}

/* Whether asking can be worth it: of triangles that cover the tile, and where depth is known to be less than
 * anything. */
static bool asks(const struct tile_worker *worker, const struct frame *frame, uint32_t tile, bool covers)
{
    const struct depth_range *range = &frame->target->clear[tile].range;
    const struct routine *routine = worker->draw->routine[UNIT_PIXEL];
    if (covers || !(routine->traits & PIXEL_DEPTH_KNOWN))
        return covers;
    switch (routine->key.pixel.depth_function) {
    case COMPARE_LESS:
    case COMPARE_LESS_EQUAL: return range->most < frame->farthest;
    case COMPARE_GREATER:
    case COMPARE_GREATER_EQUAL: return range->least > 0;
    default: return false;
    }
}

/* --- A tile ------------------------------------------------------------------------------------------------
 */

/* Asks for a cell's records with the planes that begin in them, and for the cell behind it. They may be in the cache of
 * another core, where geometry has written them. */
static void prefetch_cell(const struct arena *arena, uint32_t offset)
{
    const struct bin_cell *cell = bin_cell(arena, offset);
    __builtin_prefetch(arena->base + cell->next);
    for (uint32_t i = 0; i < cell->count; i++) {
        __builtin_prefetch(arena->base + cell->triangle[i]);
        __builtin_prefetch(arena->base + cell->triangle[i] + 64);
    }
}

/* Makes the site ready, before anything is rasterized. */
static void enter_site(struct tile_worker *worker, const struct frame *frame, uint32_t tile)
{
    if (!worker->entered)
        raster_enter(&worker->site, &worker->draw->scissor, (int)(tile % frame->target->columns),
                     (int)(tile / frame->target->columns));
    worker->entered = true;
}

/* Triangles with one sample a pixel, none of which has BIN_COVERS. */
static void rasterize_triangles(struct tile_worker *worker, const struct frame *frame, uint32_t tile,
                                const uint32_t *triangle, uint32_t count)
{
    if (count)
        enter_site(worker, frame, tile);
    for (uint32_t done = 0; count;) {
        done += raster_list(&worker->site, frame->arena.base, triangle + done, count - done,
                            worker->entries.entry, &worker->count);
        if (done == count)
            return;
        shade(worker, frame, tile);
    }
}

/* A triangle that covers the tile, which the scissor leaves whole. */
static void rasterize_whole(struct tile_worker *worker, const struct frame *frame, uint32_t tile,
                            uint32_t triangle)
{
    if (worker->count + TILE_BLOCKS > PIXEL_ENTRIES)
        shade(worker, frame, tile);
    worker->count += raster_whole(&worker->site, triangle, worker->entries.entry + worker->count);
}

/* The same from number `from` on, each looked at first if that may be worth it. */
static void rasterize_seen(struct tile_worker *worker, const struct frame *frame, uint32_t tile,
                           const struct bin_cell *cell, uint32_t from)
{
    uint32_t seen[BIN_CELL_TRIANGLES], count = 0;
    for (uint32_t i = from; i < cell->count; i++) {
        uint32_t triangle = cell->triangle[i] & ~(uint32_t)BIN_COVERS;
        struct meeting m = {.head =
                                (const struct triangle_head *)(const void *)(frame->arena.base + triangle),
                            .triangle = triangle,
                            .covers = cell->triangle[i] & BIN_COVERS};
        if (m.covers) {
            rasterize_triangles(worker, frame, tile, seen, count);
            count = 0;
        }
        if (asks(worker, frame, tile, m.covers) && is_dealt_with(worker, frame, tile, &m))
            continue;
        note_depths(worker, frame, tile, &m);
        enter_site(worker, frame, tile);
        if (m.covers && worker->site.whole)
            rasterize_whole(worker, frame, tile, triangle);
        else
            seen[count++] = triangle;
    }
    rasterize_triangles(worker, frame, tile, seen, count);
}

static void rasterize_any(struct tile_worker *worker, const struct frame *frame, uint32_t tile,
                          const struct bin_cell *cell)
{
    const uint8_t *base = frame->arena.base;
    const struct draw *draw = worker->draw;
    int column = (int)(tile % frame->target->columns), row = (int)(tile / frame->target->columns);
    for (uint32_t i = 0; i < cell->count; i++) {
        uint32_t triangle = cell->triangle[i];
        if (worker->count + TILE_BLOCKS > PIXEL_ENTRIES)
            shade(worker, frame, tile);
        worker->count += sampled_tile(&draw->sampling, draw->shape,
                                      (const struct triangle_head *)(const void *)(base + triangle),
                                      &draw->scissor, column, row, triangle, &worker->entries, worker->count);
    }
}

/* Whether any triangle of the cell covers the tile. */
static bool cell_covers(const struct bin_cell *cell)
{
    uint32_t all = 0;
    for (uint32_t i = 0; i < cell->count; i++)
        all |= cell->triangle[i];
    return all & BIN_COVERS;
}

/* The triangles of a cell from number `from` on. */
static void rasterize_cell(struct tile_worker *worker, const struct frame *frame, uint32_t tile,
                           const struct bin_cell *cell, uint32_t from)
{
    const struct draw *draw = worker->draw;
    const struct meeting any = {.covers = false};
    bool plain = draw->shape == SHAPE_TRIANGLE && !draw->sampling.samples;
    if (plain && (cell_covers(cell) || asks(worker, frame, tile, false))) {
        rasterize_seen(worker, frame, tile, cell, from);
        return;
    }
    note_depths(worker, frame, tile, &any);
    if (plain)
        rasterize_triangles(worker, frame, tile, cell->triangle, cell->count);
    else
        rasterize_any(worker, frame, tile, cell);
}

/* The last triangle of the chain that covers the tile: its cell, and its number there. */
static uint32_t last_covering(const struct frame *frame, uint32_t head, uint32_t *number)
{
    uint32_t found = head;
    *number = 0;
    for (uint32_t at = head; at; at = bin_cell(&frame->arena, at)->next)
        for (uint32_t i = 0; i < bin_cell(&frame->arena, at)->count; i++)
            if (bin_cell(&frame->arena, at)->triangle[i] & BIN_COVERS) {
                found = at;
                *number = i;
            }
    return found;
}

/* Whether of the chunk nothing counts that its last triangle over the whole tile is drawn over. */
static bool starts_at_last(const struct tile_worker *worker, uint32_t chunk, uint32_t start)
{
    return chunk + 1 == start && worker->draw->routine[UNIT_PIXEL]->traits & PIXEL_COLORS_ONLY;
}

/* The chain of one chunk. */
static void rasterize_chain(struct tile_worker *worker, const struct frame *frame, uint32_t tile,
                            uint32_t head, uint32_t start)
{
    uint32_t at = head, from = 0;
    if (starts_at_last(worker, bin_cell(&frame->arena, head)->chunk, start))
        at = last_covering(frame, head, &from);
    for (; at; from = 0) {
        const struct bin_cell *cell = bin_cell(&frame->arena, at);
        uint32_t next = cell->next ? cell->next : bin_cell(&frame->arena, head)->later;
        if (next)
            prefetch_cell(&frame->arena, next);
        rasterize_cell(worker, frame, tile, cell, from);
        at = cell->next;
    }
}

static bool same_rectangle(const struct rectangle *a, const struct rectangle *b)
{
    return !memcmp(a, b, sizeof *a);
}

/* Entries from here on are another draw's. */
static void begin_draw(struct tile_worker *worker, const struct frame *frame, uint32_t tile, uint32_t command)
{
    if (worker->draw == &frame->rendered[command].draw)
        return;
    shade(worker, frame, tile);
    worker->draw = &frame->rendered[command].draw;
    worker->command = command;
    worker->widened = false;
    worker->entered &= same_rectangle(&worker->site.scissor, &worker->draw->scissor);
}

/* The triangles of a chunk that are in no bins. */
static void rasterize_wide(struct tile_worker *worker, const struct frame *frame, uint32_t tile,
                           uint32_t number, uint32_t start)
{
    const struct chunk *chunk = frame->chunk + number;
    struct bin_cell cell;
    uint32_t from = 0;
    bin_wide_cell(bin_wide(&frame->arena, chunk->wide), tile % frame->target->columns,
                  tile / frame->target->columns, &cell);
    if (!cell.count)
        return;
    begin_draw(worker, frame, tile, chunk->command);
    for (uint32_t i = 0; i < cell.count && starts_at_last(worker, number, start); i++)
        if (cell.triangle[i] & BIN_COVERS)
            from = i;
    rasterize_cell(worker, frame, tile, &cell, from);
}

/* --- What is overwritten -----------------------------------------------------------------------------------
 */

/* Behind the last chunk with a triangle that overwrites the tile; 0: there is none. */
static uint32_t find_start(const struct frame *frame, uint32_t tile)
{
    uint32_t start = frame->tile_start[tile];
    for (uint32_t i = frame->wide_starts; i-- > 0 && frame->wide_start[i] >= start;) {
        uint32_t number = frame->wide_start[i];
        struct bin_cell cell;
        bin_wide_cell(bin_wide(&frame->arena, frame->chunk[number].wide), tile % frame->target->columns,
                      tile / frame->target->columns, &cell);
        if (cell_covers(&cell))
            return number + 1;
    }
    return start;
}

/* Whether what a chunk draws to the tile is overwritten, and leaves nothing else. */
static bool is_overwritten(const struct frame *frame, uint32_t chunk, uint32_t start)
{
    return chunk + 1 < start &&
           frame_command(frame, chunk)->draw.routine[UNIT_PIXEL]->traits & PIXEL_COLORS_ONLY;
}

/* A chunk that is in all tiles. Where the tile is overwritten later, the colour of a clear does not matter. */
static void render_everywhere(struct tile_worker *worker, const struct frame *frame, uint32_t tile,
                              uint32_t chunk, uint32_t start)
{
    const struct command *command = frame_command(frame, chunk);
    if (command->kind == COMMAND_CLEAR) {
        struct clear clear = command->clear;
        shade(worker, frame, tile);
        clear.set_color &= chunk + 1 >= start;
        target_clear_tile(frame->target, tile, &clear);
    } else if (!is_overwritten(frame, chunk, start)) {
        rasterize_wide(worker, frame, tile, chunk, start);
    }
}

void tile_render(struct tile_worker *worker, const struct frame *frame, uint32_t tile)
{
    uint32_t next = 0, start = find_start(frame, tile), end = frame->everywhere_count;
    worker->count = 0;
    worker->draw = NULL;
    worker->entered = false;
    if (frame->tile_first[tile])
        prefetch_cell(&frame->arena, frame->tile_first[tile]);
    for (uint32_t head = frame->tile_first[tile]; head; head = bin_cell(&frame->arena, head)->later) {
        uint32_t chunk = bin_cell(&frame->arena, head)->chunk;
        __builtin_prefetch(frame->arena.base + bin_cell(&frame->arena, head)->later);
        while (next < end && frame->everywhere[next] <= chunk)
            render_everywhere(worker, frame, tile, frame->everywhere[next++], start);
        if (is_overwritten(frame, chunk, start))
            continue;
        begin_draw(worker, frame, tile, frame->chunk[chunk].command);
        rasterize_chain(worker, frame, tile, head, start);
    }
    while (next < end)
        render_everywhere(worker, frame, tile, frame->everywhere[next++], start);
    shade(worker, frame, tile);
}
