#include "draw/tile.h"

#include "draw/frame.h"

#include <string.h>

/* Set bits of the entries' coverages, four at a time (Warren, Hacker's Delight, 5-1). */
static uint64_t count_pixels(const struct entry *entry, uint32_t count)
{
    uint64_t total = 0;
    for (uint32_t i = 0; i < count; i += 4) {
        uint64_t x = 0;
        for (uint32_t j = i; j < i + 4 && j < count; j++)
            x = x << 16 | entry[j].coverage;
        x -= x >> 1 & 0x5555555555555555;
        x = (x & 0x3333333333333333) + (x >> 2 & 0x3333333333333333);
        x = (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0f;
        total += x * 0x0101010101010101 >> 56;
    }
    return total;
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
