#include "draw/tile.h"

#include "draw/frame.h"
#include "draw/raster_part.h"

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

static void shade(struct tile_worker *worker, const struct frame *frame, uint32_t tile)
{
    if (!worker->count)
        return;
    const struct routine *routine = worker->draw->routine[UNIT_PIXEL];
    const struct pixel_key *key = &routine->key.pixel;
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
    if (pixel_write_mask(key))
        target_fill_color(target, tile);
    if (pixel_tests_depth(key) || pixel_stencil(key))
        target_fill_depth(target, tile);
    uint64_t pixels = count_pixels(worker->entries.entry, worker->count);
    routine_run(routine, &call, pixels);
    if (key->count)
        take_count(worker, frame);
    worker->pixels_shaded += pixels;
    worker->count = 0;
}

/* Asks for what is next: the cell behind this one, and this one's records with the planes that begin in them.
 */
static void prefetch_cell(const uint8_t *base, const struct bin_cell *cell)
{
    __builtin_prefetch(base + cell->next);
    for (uint32_t i = 0; i < cell->count; i++) {
        __builtin_prefetch(base + cell->triangle[i]);
        __builtin_prefetch(base + cell->triangle[i] + 64);
    }
}

/* Triangles with one sample a pixel. */
static void rasterize_triangles(struct tile_worker *worker, const struct frame *frame, uint32_t tile,
                                const struct bin_cell *cell)
{
    uint32_t done = 0;
    for (;;) {
        done += raster_list(&worker->site, frame->arena.base, cell->triangle + done, cell->count - done,
                            worker->entries.entry, &worker->count);
        if (done == cell->count)
            return;
        shade(worker, frame, tile);
    }
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

static void rasterize_cells(struct tile_worker *worker, const struct frame *frame, uint32_t tile,
                            uint32_t first)
{
    const struct draw *draw = worker->draw;
    bool plain = draw->shape == SHAPE_TRIANGLE && !draw->sampling.samples;
    for (uint32_t at = first; at;) {
        const struct bin_cell *cell = bin_cell(&frame->arena, at);
        prefetch_cell(frame->arena.base, cell);
        if (plain)
            rasterize_triangles(worker, frame, tile, cell);
        else
            rasterize_any(worker, frame, tile, cell);
        at = cell->next;
    }
}

/* Entries from here on are another draw's. */
static void begin_draw(struct tile_worker *worker, const struct frame *frame, uint32_t tile, uint32_t command)
{
    shade(worker, frame, tile);
    worker->draw = &frame->command[command].draw;
    worker->command = command;
    raster_enter(&worker->site, &worker->draw->scissor, (int)(tile % frame->target->columns),
                 (int)(tile / frame->target->columns));
}

void tile_render(struct tile_worker *worker, const struct frame *frame, uint32_t tile)
{
    uint32_t clear = 0;
    worker->count = 0;
    worker->draw = NULL;
    worker->lanes = lane_table;
    for (uint32_t head = frame->tile_first[tile];; head = bin_cell(&frame->arena, head)->later) {
        uint32_t chunk = head ? bin_cell(&frame->arena, head)->chunk : UINT32_MAX;
        for (; clear < frame->clears && frame->clear_chunk[clear] < chunk; clear++) {
            shade(worker, frame, tile);
            target_clear_tile(frame->target, tile, &frame_command(frame, frame->clear_chunk[clear])->clear);
        }
        if (!head)
            break;
        __builtin_prefetch(frame->arena.base + bin_cell(&frame->arena, head)->later);
        if (&frame_command(frame, chunk)->draw != worker->draw)
            begin_draw(worker, frame, tile, frame->chunk[chunk].command);
        rasterize_cells(worker, frame, tile, head);
    }
    shade(worker, frame, tile);
}
