#include "contract/key_query.h"
#include "machine/cpu.h"
#include "render/raster/raster_part.h"
#include "render/tile/tile_part.h"

#include <immintrin.h>
#include <string.h>

/* Four entries at a time (Warren, Hacker's Delight, 5-1). */
static uint64_t count_by_four(const struct entry *entry, uint32_t count)
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

/* The coverages of eight entries: the even ones, then the odd ones. */
__attribute__((target("avx2"))) static inline __m256i eight_coverages(const struct entry *entry)
{
    const __m256i *two = (const __m256i *)(const void *)entry;
    __m256i low = _mm256_unpackhi_epi32(_mm256_loadu_si256(two), _mm256_loadu_si256(two + 1));
    __m256i high = _mm256_unpackhi_epi32(_mm256_loadu_si256(two + 2), _mm256_loadu_si256(two + 3));
    return _mm256_and_si256(_mm256_unpacklo_epi64(low, high), _mm256_set1_epi32(WHOLE_BLOCK));
}

/* Eight entries at a time, with a table of the bits of half a byte. */
__attribute__((target("avx2"))) static uint64_t count_by_eight(const struct entry *entry, uint32_t count)
{
    const __m256i bits = _mm256_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4, 0, 1, 1, 2, 1, 2, 2,
                                          3, 1, 2, 2, 3, 2, 3, 3, 4);
    const __m256i half = _mm256_set1_epi8(15), number = _mm256_setr_epi32(0, 2, 4, 6, 1, 3, 5, 7);
    __m256i total = _mm256_setzero_si256();
    for (uint32_t i = 0; i < count; i += 8) {
        __m256i x = _mm256_and_si256(eight_coverages(entry + i),
                                     _mm256_cmpgt_epi32(_mm256_set1_epi32((int)(count - i)), number));
        __m256i sums =
            _mm256_add_epi8(_mm256_shuffle_epi8(bits, _mm256_and_si256(x, half)),
                            _mm256_shuffle_epi8(bits, _mm256_and_si256(_mm256_srli_epi16(x, 4), half)));
        total = _mm256_add_epi64(total, _mm256_sad_epu8(sums, _mm256_setzero_si256()));
    }
    __m128i sum = _mm_add_epi64(_mm256_castsi256_si128(total), _mm256_extracti128_si256(total, 1));
    return (uint64_t)_mm_cvtsi128_si64(_mm_add_epi64(sum, _mm_unpackhi_epi64(sum, sum)));
}

uint64_t tile_count_pixels(const struct entry *entry, uint32_t count)
{
    return count > 4 && cpu_has_avx2_fma() ? count_by_eight(entry, count) : count_by_four(entry, count);
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

static struct pixel_arguments call_of(struct tile_worker *worker, const struct round *round, uint32_t tile,
                                      const struct entry *entries, uint32_t count)
{
    struct target *target = worker->target;
    return (struct pixel_arguments){
        .job = worker->draw->job,
        .entries = entries,
        .triangles = round->arena.base,
        .lanes = &worker->lanes,
        .color = target->color ? target_tile_color(target, tile) : nowhere,
        .depth = target->depth ? target_tile_depth(target, tile) : nowhere,
        .count = count,
    };
}

/* Runs a routine of the draw over entries, which have `pixels` pixels together. */
static void run_pixels(struct tile_worker *worker, const struct round *round, uint32_t tile,
                       const struct routine *routine, const struct entry *entries, uint32_t count,
                       uint64_t pixels)
{
    const struct pixel_arguments call = call_of(worker, round, tile, entries, count);
    routine_run(routine, &call, pixels);
    worker->pixels_shaded += pixels;
    worker->pixel_calls++;
}

void tile_run_entries(struct tile_worker *worker, const struct round *round, uint32_t tile,
                      const struct entry *entries, uint32_t count)
{
    run_pixels(worker, round, tile, worker->draw->routine[UNIT_PIXEL], entries, count,
               tile_count_pixels(entries, count));
}

/* Runs the reading for joined rectangles, if the draw has it; else counts the blocks that it would draw. */
static const struct routine *routine_of_joined(const struct draw *draw, uint32_t count)
{
    if (draw->routine[ROUTINE_JOINED])
        return draw->routine[ROUTINE_JOINED];
    if (draw->counts_joined)
        __atomic_fetch_add(draw->routine[UNIT_PIXEL]->joined_blocks, count, __ATOMIC_RELAXED);
    return draw->routine[UNIT_PIXEL];
}

void tile_run_blocks(struct tile_worker *worker, const struct round *round, uint32_t tile)
{
    const struct draw *draw = worker->draw;
    const struct routine *routine =
        worker->joined ? routine_of_joined(draw, worker->count) : draw->routine[UNIT_PIXEL];
    run_pixels(worker, round, tile, routine, worker->entries.entry, worker->count,
               tile_count_pixels(worker->entries.entry, worker->count));
    worker->count = 0;
}

void tile_fill_clear(const struct tile_worker *worker, uint32_t tile)
{
    const struct pixel_key *key = &worker->draw->routine[UNIT_PIXEL]->key.pixel;
    if (pixel_write_mask(key) && worker->target->color)
        target_fill_color(worker->target, tile);
    if ((pixel_tests_depth(key) || pixel_stencil(key)) && worker->target->depth)
        target_fill_depth(worker->target, tile);
}

void tile_shade_waiting(struct tile_worker *worker, const struct round *round, uint32_t tile)
{
    if (worker->listed)
        tile_rasterize_list(worker, round, tile);
    if (!worker->count && !worker->spans.count)
        return;
    tile_fill_clear(worker, tile);
    if (worker->spans.count)
        run_pixels(worker, round, tile, worker->draw->routine[ROUTINE_SPAN], worker->spans.entry,
                   worker->spans.count, (uint64_t)worker->spans.count * BLOCK_PIXELS);
    if (worker->count && worker->fills)
        tile_fill_blocks(worker, round, tile);
    else if (worker->count)
        tile_run_blocks(worker, round, tile);
    if (worker->spans.count || worker->spans.marked_count)
        tile_begin_spans(&worker->spans);
    if (worker->draw->routine[UNIT_PIXEL]->key.pixel.count)
        take_count(worker, round);
}

bool tile_shade_whole(struct tile_worker *worker, const struct round *round, uint32_t tile, uint32_t triangle)
{
    const struct routine *routine = worker->draw->routine[ROUTINE_SPAN];
    if (!routine->takes_tiles || worker->refused == worker->draw || worker->count || worker->listed ||
        worker->spans.count)
        return false;
    const uint32_t columns = round->target->columns;
    struct pixel_arguments call = call_of(
        worker, round, tile, worker->spans.entry,
        raster_first_row((int)(tile % columns), (int)(tile / columns), triangle, worker->spans.entry));
    call.tile = 1;
    tile_fill_clear(worker, tile);
    routine_run(routine, &call, TILE_PIXELS);
    worker->pixel_calls++;
    if (call.tile)
        worker->pixels_shaded += TILE_PIXELS;
    else
        worker->refused = worker->draw;
    return call.tile;
}

void tile_make_room(struct tile_worker *worker, const struct round *round, uint32_t tile)
{
    if (worker->listed)
        tile_rasterize_list(worker, round, tile);
    if (max_u32(worker->count, worker->spans.count) + TILE_BLOCKS > PIXEL_ENTRIES)
        tile_shade(worker, round, tile);
}

/* --- Chains --- */

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
    worker->joined &= round->chunk[bin_cell(&round->arena, head)->chunk].joined;
    if (starts_at_last(worker, bin_cell(&round->arena, head)->chunk, start))
        at = last_covering(round, head, &from);
    for (; at; from = 0) {
        const struct bin_cell *cell = bin_cell(&round->arena, at);
        uint32_t next = cell->next ? cell->next : bin_cell(&round->arena, head)->later;
        if (next)
            prefetch_cell(&round->arena, next);
        tile_rasterize_cell(worker, round, tile, cell, from);
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
    tile_shade(worker, round, tile);
    worker->draw = &round->command[command].draw;
    worker->command = command;
    worker->widened = false;
    worker->joined = true;
    worker->fills = tile_may_fill(worker, round, worker->draw);
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
    worker->joined &= chunk->joined;
    for (uint32_t i = 0; i < cell.count && starts_at_last(worker, number, start); i++)
        if (cell.triangle[i] & BIN_COVERS)
            from = i;
    tile_rasterize_cell(worker, round, tile, &cell, from);
}

/* --- Overwritten draws --- */

/* 1 + the last chunk with a triangle that overwrites the tile; 0: there is none. */
static uint32_t find_start(const struct round *round, uint32_t tile)
{
    uint32_t start = round->tile_start[tile];
    if (!tile_uses_uniform(round))
        return 0;
    for (uint32_t i = round->wide_starts; i-- > 0 && round->wide_start[i] >= start;) {
        uint32_t number = round->wide_start[i];
        if (bin_wide_covers(bin_wide(&round->arena, round->chunk[number].wide), tile % round->target->columns,
                            tile / round->target->columns))
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
        tile_shade(worker, round, tile);
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
    tile_shade(worker, round, tile);
}

void tile_begin_round(struct tile_worker *worker)
{
    worker->lanes = lane_table;
    worker->refused = NULL;
    tile_fill_begin_round(&worker->fill);
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
