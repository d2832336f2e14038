#include "render/tile/tile.h"
#include "contract/key_query.h"

#include "render/raster/raster_part.h"
#include "render/tile/hidden.h"

#include <string.h>

/* The number of set bits in the entries' coverages, four entries at a time (Warren, Hacker's Delight,
 * 5-1). Up to three entries after the last are read. */
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

/* Adds the count of the call to the draw's sum. The order of threads does not matter. */
static void take_count(struct tile_worker *worker, const struct round *round)
{
    uint64_t sum = 0;
    for (int lane = 0; lane < LANES_MAXIMUM; lane++)
        sum += (uint32_t)worker->lanes.passed[lane];
    memset(worker->lanes.passed, 0, sizeof worker->lanes.passed);
    atomic_fetch_add_explicit(round->passed + worker->command, sum, memory_order_relaxed);
}

/* The planes that a target lacks: routines do not read them, but take the address. */
alignas(64) static uint32_t nowhere[TILE_PIXELS];

/* Runs a routine of the draw over entries, which have `pixels` pixels together. */
static void run_pixels(struct tile_worker *worker, const struct round *round, uint32_t tile,
                       const struct routine *routine, const struct entry *entries, uint32_t count,
                       uint64_t pixels)
{
    struct target *target = worker->target;
    struct pixel_arguments call = {
        .job = worker->draw->job,
        .entries = entries,
        .triangles = round->arena.base,
        .lanes = &worker->lanes,
        .color = target->color ? target_tile_color(target, tile) : nowhere,
        .depth = target->depth ? target_tile_depth(target, tile) : nowhere,
        .count = count,
    };
    routine_run(routine, &call, pixels);
    worker->pixels_shaded += pixels;
    worker->pixel_calls++;
}

static void run_blocks(struct tile_worker *worker, const struct round *round, uint32_t tile)
{
    run_pixels(worker, round, tile, worker->draw->routine[UNIT_PIXEL], worker->entries.entry, worker->count,
               count_pixels(worker->entries.entry, worker->count));
    worker->count = 0;
}

/* The tile gets the words that it only remembers, as far as the draw's routines read or write them. */
static void fill_tile(const struct tile_worker *worker, uint32_t tile)
{
    const struct pixel_key *key = &worker->draw->routine[UNIT_PIXEL]->key.pixel;
    if (pixel_write_mask(key) && worker->target->color)
        target_fill_color(worker->target, tile);
    if ((pixel_tests_depth(key) || pixel_stencil(key)) && worker->target->depth)
        target_fill_depth(worker->target, tile);
}

static void rasterize_list(struct tile_worker *worker, const struct round *round, uint32_t tile);

/* Draws what waits. */
static void shade(struct tile_worker *worker, const struct round *round, uint32_t tile)
{
    if (worker->listed)
        rasterize_list(worker, round, tile);
    if (!worker->count && !worker->spans.count)
        return;
    fill_tile(worker, tile);
    if (worker->spans.count)
        run_pixels(worker, round, tile, worker->draw->routine[ROUTINE_SPAN], worker->spans.entry,
                   worker->spans.count, (uint64_t)worker->spans.count * BLOCK_PIXELS);
    if (worker->count)
        run_blocks(worker, round, tile);
    if (worker->spans.count || worker->spans.marked_count)
        tile_begin_spans(&worker->spans);
    if (worker->draw->routine[UNIT_PIXEL]->key.pixel.count)
        take_count(worker, round);
}

/* Room for one more triangle among the entries and the spans. */
static void make_room(struct tile_worker *worker, const struct round *round, uint32_t tile)
{
    if (worker->listed)
        rasterize_list(worker, round, tile);
    if (max_u32(worker->count, worker->spans.count) + TILE_BLOCKS > PIXEL_ENTRIES)
        shade(worker, round, tile);
}

/* --- Work that can be skipped --- */

/* A triangle in a tile, and how its depth there compares with the stored one. */
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
static struct rectangle meeting_area(const struct round *round, uint32_t tile, const struct draw *draw,
                                     const struct triangle_head *head)
{
    int32_t x = tile_start(tile % round->target->columns), y = tile_start(tile / round->target->columns);
    struct rectangle limit = {x, y, x + TILE_SIZE, y + TILE_SIZE}, area;
    return raster_shapes[draw->shape].bounds(head, &limit, &area) ? area : limit;
}

static void compare_depths(struct meeting *m, const struct round *round, uint32_t tile,
                           const struct draw *draw)
{
    const struct routine *routine = draw->routine[UNIT_PIXEL];
    const uint8_t *plane = (const uint8_t *)m->head + routine->depth_plane;
    struct rectangle area = meeting_area(round, tile, draw, m->head);
    m->depths = hidden_depths(m->head, (const struct plane *)(const void *)plane, &area,
                              round->target->depth_format, &m->constant);
    m->verdict = hidden_verdict(routine->key.pixel.depth_function, m->depths,
                                target_depth_clear(round->target, tile)->range);
}

/* Returns true if the tile can store one value instead of its words: no word that is not written must
 * survive. */
static bool can_be_uniform(const struct target *target, uint32_t tile, const struct pixel_key *key)
{
    return hidden_writes_all_targets(key, target) &&
           (!key->depth_write || target_depth_clear(target, tile)->pending ||
            !stencil_mask(target->depth_format));
}

static void note_uniform_color(const struct target *target, uint32_t tile)
{
    const uint32_t *words = target_tile_color(target, tile);
    for (unsigned t = 0; t < TARGETS; t++) {
        const struct target_color *color = target->colors + t;
        if (!color->clear)
            continue;
        struct color_clear *clear = target_color_clear(target, t, tile);
        for (uint32_t p = 0; p < storage_planes[color->storage]; p++)
            clear->word[p] = words[(color->plane + p) * target->color_order.plane];
        clear->pending = clear->changed = true;
    }
}

/* Shades one block of a triangle whose pixels are all equal, and stores its words for the whole tile. */
static void shade_uniform(struct tile_worker *worker, const struct round *round, uint32_t tile,
                          const struct meeting *m)
{
    struct target *target = worker->target;
    const struct pixel_key *key = &worker->draw->routine[UNIT_PIXEL]->key.pixel;
    bool tests = pixel_tests_depth(key) && target->depth;
    uint32_t *depth = tests ? target_tile_depth(target, tile) : NULL;
    struct depth_clear *clear = tests ? target_depth_clear(target, tile) : NULL;
    for (int i = 0; depth && clear->pending && i < BLOCK_PIXELS; i++)
        depth[i] = clear->word;
    worker->entries.entry[0] = (struct entry){.x = (float)tile_start(tile % target->columns),
                                              .y = (float)tile_start(tile / target->columns),
                                              .coverage = UINT16_MAX,
                                              .triangle = m->triangle};
    worker->count = 1;
    run_blocks(worker, round, tile);
    note_uniform_color(target, tile);
    if (!key->depth_write)
        return;
    *clear = (struct depth_clear){.word = depth[0], .range = m->depths, .pending = true, .changed = true};
}

static bool uses_ranges(const struct round *round)
{
    return round->settings.of[SETTING_range] == SETTING_range_on;
}

static bool uses_uniform(const struct round *round)
{
    return round->settings.of[SETTING_uniform] == SETTING_uniform_on;
}

/* Updates the bounds of the tile's depth for the triangle. */
static void note_depths(struct tile_worker *worker, const struct round *round, uint32_t tile,
                        const struct meeting *m)
{
    const struct routine *routine = worker->draw->routine[UNIT_PIXEL];
    int function = routine->key.pixel.depth_function;
    if (!(routine->traits & PIXEL_WRITES_DEPTH))
        return;
    struct depth_range *range = &target_depth_clear(round->target, tile)->range;
    if (m->covers && uses_ranges(round) && routine->traits & PIXEL_DEPTH_KNOWN &&
        !pixel_waits(&routine->key.pixel)) {
        *range = hidden_narrowed(function, *range, m->depths);
    } else if (!worker->widened) {
        *range = hidden_widened(function, *range, (struct depth_range){0, UINT32_MAX});
        worker->widened = true;
    }
}

/* Returns true if the triangle does not have to be rasterized. */
static bool is_dealt_with(struct tile_worker *worker, const struct round *round, uint32_t tile,
                          struct meeting *m)
{
    const struct routine *routine = worker->draw->routine[UNIT_PIXEL];
    bool tests = pixel_tests_depth(&routine->key.pixel);
    m->verdict = tests ? DEPTH_UNDECIDED : DEPTH_PASSES;
    m->constant = true;
    if (routine->traits & PIXEL_DEPTH_KNOWN)
        compare_depths(m, round, tile, worker->draw);
    if (m->verdict == DEPTH_FAILS && uses_ranges(round))
        return true;
    bool uniform = m->covers && uses_uniform(round) && routine->traits & PIXEL_UNIFORM &&
                   m->verdict == DEPTH_PASSES && (m->constant || !routine->key.pixel.depth_write) &&
                   can_be_uniform(round->target, tile, &routine->key.pixel);
    if (uniform) {
        shade(worker, round, tile);
        shade_uniform(worker, round, tile, m);
    }
    return uniform;
}

/* Returns true if a test of the triangle may succeed: it covers the tile, or the bounds of the depth are
 * narrower than at first. */
static bool asks(const struct tile_worker *worker, const struct round *round, uint32_t tile, bool covers)
{
    const struct routine *routine = worker->draw->routine[UNIT_PIXEL];
    if (covers)
        return uses_ranges(round) || uses_uniform(round);
    if (!uses_ranges(round) || !(routine->traits & PIXEL_DEPTH_KNOWN))
        return false;
    const struct depth_range *range = &target_depth_clear(round->target, tile)->range;
    switch (routine->key.pixel.depth_function) {
    case COMPARE_LESS:
    case COMPARE_LESS_EQUAL: return range->most < round->farthest;
    case COMPARE_GREATER:
    case COMPARE_GREATER_EQUAL: return range->least > 0;
    default: return false;
    }
}

/* --- A tile --- */

/* Prefetches a cell's records, with the planes at their start, and the next cell. The cache of the core
 * that ran the geometry may hold them. */
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
static void enter_site(struct tile_worker *worker, const struct round *round, uint32_t tile)
{
    if (!worker->entered)
        raster_enter(&worker->site, &worker->draw->scissor, (int)(tile % round->target->columns),
                     (int)(tile / round->target->columns));
    worker->entered = true;
}

/* Empties the list. */
static void rasterize_list(struct tile_worker *worker, const struct round *round, uint32_t tile)
{
    uint32_t done = 0, count = worker->listed;
    worker->listed = 0;
    while (true) {
        done += raster_list(&worker->site, round->arena.base, worker->list + done, count - done,
                            worker->entries.entry, &worker->count);
        if (done == count)
            return;
        shade(worker, round, tile);
    }
}

/* Appends triangles to the list. The rasterizer is faster with many. */
static void list_triangles(struct tile_worker *worker, const struct round *round, uint32_t tile,
                           const uint32_t *triangle, uint32_t count)
{
    if (worker->listed + count > LIST_TRIANGLES)
        rasterize_list(worker, round, tile);
    for (uint32_t i = 0; i < count; i++)
        worker->list[worker->listed++] = triangle[i];
}

/* Triangles with BIN_RECTANGLE, and without BIN_SPANS. */
static void rasterize_rectangles(struct tile_worker *worker, const struct round *round, uint32_t tile,
                                 const uint32_t *binned, uint32_t count)
{
    uint32_t triangle[BIN_CELL_TRIANGLES];
    for (uint32_t i = 0; i < count; i++)
        triangle[i] = binned[i] & ~(uint32_t)BIN_BITS;
    if (worker->listed)
        rasterize_list(worker, round, tile);
    for (uint32_t done = 0;;) {
        done += raster_rectangles(&worker->site, round->arena.base, triangle + done, count - done,
                                  worker->entries.entry, &worker->count);
        if (done == count)
            return;
        shade(worker, round, tile);
    }
}

/* --- Spans --- */

static void count_spans(const struct draw *draw, uint32_t blocks)
{
    uint32_t *sum = draw->routine[UNIT_PIXEL]->span_blocks;
    if (sum && blocks >= SPAN_BLOCKS)
        __atomic_fetch_add(sum, blocks, __ATOMIC_RELAXED);
}

/* The `added` entries after the last of the spans wait, too. Of the ordinary routine's entries the first
 * `first` are of earlier triangles. */
static void add_spans(struct tile_worker *worker, const struct round *round, uint32_t tile, uint32_t first,
                      uint32_t added)
{
    struct tile_spans *spans = &worker->spans;
    if (first && tile_spans_meet(spans, worker->entries.entry, first, added)) {
        const struct entry *from = spans->entry + spans->count;
        shade(worker, round, tile);
        memmove(spans->entry, from, added * sizeof *from);
    }
    spans->count += added;
}

/* A triangle with BIN_SPANS. The order among its own blocks does not matter, because each pixel is in one. */
static void rasterize_spans(struct tile_worker *worker, const struct round *round, uint32_t tile,
                            uint32_t binned)
{
    uint32_t least = round->settings.of[SETTING_spans] == SETTING_spans_always ? 1 : SPAN_BLOCKS;
    make_room(worker, round, tile);
    uint32_t begin = worker->count, end = begin, triangle = binned & ~(uint32_t)BIN_BITS;
    struct entry *entries = worker->entries.entry + begin;
    if (binned & BIN_RECTANGLE)
        raster_rectangles(&worker->site, round->arena.base, &triangle, 1, worker->entries.entry, &end);
    else
        end += raster_blocks(&worker->site, round->arena.base, triangle, entries);
    uint32_t left = end - begin, counts = worker->draw->counts_spans;
    uint32_t whole = tile_take_spans(entries, &left, counts ? UINT32_MAX : least,
                                     worker->spans.entry + worker->spans.count);
    worker->count = begin + left;
    if (counts)
        count_spans(worker->draw, whole);
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
        alike = bits & (BIN_SPANS | BIN_RECTANGLE) ? count_alike(triangle, count) : count;
        if (triangle[0] & BIN_SPANS)
            for (uint32_t i = 0; i < alike; i++)
                rasterize_spans(worker, round, tile, triangle[i]);
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
    if (uses_uniform(round) && routine->traits & PIXEL_OVERWRITES_ALL && !worker->count &&
        !worker->listed && !worker->spans.count && worker->target->samples == 1 &&
        hidden_writes_all_targets(&routine->key.pixel, worker->target))
        target_replace_color(worker->target, tile);
}

/* A triangle that covers the tile, which the scissor leaves whole. */
static void rasterize_whole(struct tile_worker *worker, const struct round *round, uint32_t tile,
                            uint32_t binned)
{
    const uint32_t triangle = binned & ~(uint32_t)BIN_BITS;
    const bool spanned = binned & BIN_SPANS;
    replace_clear(worker, round, tile);
    if (spanned && !worker->draw->counts_spans) {
        make_room(worker, round, tile);
        add_spans(worker, round, tile, worker->count,
                  raster_whole(&worker->site, triangle, worker->spans.entry + worker->spans.count));
        return;
    }
    if (spanned)
        count_spans(worker->draw, TILE_BLOCKS);
    make_room(worker, round, tile);
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
        if (m.covers) {
            rasterize_triangles(worker, round, tile, seen, count, cell->bits);
            count = 0;
        }
        if (asks(worker, round, tile, m.covers) && is_dealt_with(worker, round, tile, &m))
            continue;
        note_depths(worker, round, tile, &m);
        enter_site(worker, round, tile);
        if (m.covers && worker->site.whole)
            rasterize_whole(worker, round, tile, binned);
        else
            seen[count++] = binned & ~(uint32_t)BIN_COVERS;
    }
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
            shade(worker, round, tile);
        worker->count += raster_sampled_tile(
            &draw->sampling, draw->shape, (const struct triangle_head *)(const void *)(base + triangle),
            &draw->scissor, column, row, triangle, &worker->entries, worker->count);
    }
}

/* The triangles of a cell from number `from` on. */
static void rasterize_cell(struct tile_worker *worker, const struct round *round, uint32_t tile,
                           const struct bin_cell *cell, uint32_t from)
{
    const struct draw *draw = worker->draw;
    const struct meeting any = {.covers = false};
    bool plain = draw->shape == SHAPE_TRIANGLE && !draw->sampling.samples;
    if (plain && (cell->bits & BIN_COVERS || asks(worker, round, tile, false))) {
        rasterize_seen(worker, round, tile, cell, from);
        return;
    }
    note_depths(worker, round, tile, &any);
    if (plain)
        rasterize_triangles(worker, round, tile, cell->triangle, cell->count, cell->bits);
    else
        rasterize_any(worker, round, tile, cell);
}

/* The last triangle of the chain that covers the tile: its cell, and its number there. */
static uint32_t last_covering(const struct round *round, uint32_t head, uint32_t *number)
{
    uint32_t found = head;
    *number = 0;
    for (uint32_t at = head; at; at = bin_cell(&round->arena, at)->next)
        for (uint32_t i = 0; i < bin_cell(&round->arena, at)->count; i++)
            if (bin_cell(&round->arena, at)->triangle[i] & BIN_COVERS) {
                found = at;
                *number = i;
            }
    return found;
}

/* Returns true if everything that the chunk draws before its last covering triangle is overwritten by it. */
static bool starts_at_last(const struct tile_worker *worker, uint32_t chunk, uint32_t start)
{
    return chunk + 1 == start && worker->draw->routine[UNIT_PIXEL]->traits & PIXEL_COLORS_ONLY;
}

/* The chain of one chunk. */
static void rasterize_chain(struct tile_worker *worker, const struct round *round, uint32_t tile,
                            uint32_t head, uint32_t start)
{
    uint32_t at = head, from = 0;
    if (starts_at_last(worker, bin_cell(&round->arena, head)->chunk, start))
        at = last_covering(round, head, &from);
    for (; at; from = 0) {
        const struct bin_cell *cell = bin_cell(&round->arena, at);
        uint32_t next = cell->next ? cell->next : bin_cell(&round->arena, head)->later;
        if (next)
            prefetch_cell(&round->arena, next);
        rasterize_cell(worker, round, tile, cell, from);
        at = cell->next;
    }
}

static bool same_rectangle(const struct rectangle *a, const struct rectangle *b)
{
    return !memcmp(a, b, sizeof *a);
}

/* The following entries belong to this draw. */
static void begin_draw(struct tile_worker *worker, const struct round *round, uint32_t tile, uint32_t command)
{
    if (worker->draw == &round->command[command].draw)
        return;
    shade(worker, round, tile);
    worker->draw = &round->command[command].draw;
    worker->command = command;
    worker->widened = false;
    worker->entered &= same_rectangle(&worker->site.scissor, &worker->draw->scissor);
}

/* The triangles of a chunk that are in no bins. */
static void rasterize_wide(struct tile_worker *worker, const struct round *round, uint32_t tile,
                           uint32_t number, uint32_t start)
{
    const struct chunk *chunk = round->chunk + number;
    struct bin_cell cell;
    uint32_t from = 0;
    bin_wide_cell(bin_wide(&round->arena, chunk->wide), tile % round->target->columns,
                  tile / round->target->columns, &cell);
    if (!cell.count)
        return;
    begin_draw(worker, round, tile, chunk->command);
    for (uint32_t i = 0; i < cell.count && starts_at_last(worker, number, start); i++)
        if (cell.triangle[i] & BIN_COVERS)
            from = i;
    rasterize_cell(worker, round, tile, &cell, from);
}

/* --- Overwritten draws --- */

/* 1 + the last chunk with a triangle that overwrites the tile; 0: there is none. */
static uint32_t find_start(const struct round *round, uint32_t tile)
{
    uint32_t start = round->tile_start[tile];
    if (!uses_uniform(round))
        return 0;
    for (uint32_t i = round->wide_starts; i-- > 0 && round->wide_start[i] >= start;) {
        uint32_t number = round->wide_start[i];
        struct bin_cell cell;
        bin_wide_cell(bin_wide(&round->arena, round->chunk[number].wide), tile % round->target->columns,
                      tile / round->target->columns, &cell);
        if (cell.bits & BIN_COVERS)
            return number + 1;
    }
    return start;
}

/* Returns true if everything that the chunk draws to the tile is overwritten. */
static bool is_overwritten(const struct round *round, uint32_t chunk, uint32_t start)
{
    return chunk + 1 < start &&
           round_command(round, chunk)->draw.routine[UNIT_PIXEL]->traits & PIXEL_COLORS_ONLY;
}

/* A chunk that is in all tiles. Where the tile is overwritten later, the colour of a clear does not
 * matter. */
static void render_everywhere(struct tile_worker *worker, const struct round *round, uint32_t tile,
                              uint32_t chunk, uint32_t start)
{
    const struct command *command = round_command(round, chunk);
    if (command->kind == COMMAND_CLEAR) {
        struct clear clear = command->clear;
        shade(worker, round, tile);
        clear.set_color &= chunk + 1 >= start;
        target_clear_tile(worker->target, tile, &clear);
    } else if (!is_overwritten(round, chunk, start)) {
        rasterize_wide(worker, round, tile, chunk, start);
    }
}

static void render(struct tile_worker *worker, const struct round *round, uint32_t tile)
{
    uint32_t next = 0, start = find_start(round, tile), end = round->everywhere_count;
    worker->count = worker->listed = 0;
    tile_begin_spans(&worker->spans);
    worker->draw = NULL;
    worker->entered = false;
    worker->whole = target_has_whole(round->target, tile);
    if (round->tile_first[tile])
        prefetch_cell(&round->arena, round->tile_first[tile]);
    for (uint32_t head = round->tile_first[tile]; head; head = bin_cell(&round->arena, head)->later) {
        uint32_t chunk = bin_cell(&round->arena, head)->chunk;
        __builtin_prefetch(round->arena.base + bin_cell(&round->arena, head)->later);
        while (next < end && round->everywhere[next] <= chunk)
            render_everywhere(worker, round, tile, round->everywhere[next++], start);
        if (is_overwritten(round, chunk, start))
            continue;
        begin_draw(worker, round, tile, round->chunk[chunk].command);
        rasterize_chain(worker, round, tile, head, start);
    }
    while (next < end)
        render_everywhere(worker, round, tile, round->everywhere[next++], start);
    shade(worker, round, tile);
}

void tile_render(struct tile_worker *worker, const struct round *round, uint32_t tile)
{
    const bool views = target_needs_view(round->target);
    worker->target = views ? &worker->view : round->target;
    if (views)
        target_open_view(round->target, tile, worker->view_words, &worker->view);
    render(worker, round, tile);
    if (views)
        target_close_view(&worker->view, tile, round->target);
    worker->target = NULL;
}
