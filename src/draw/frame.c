#include "draw/frame.h"

#include "draw/hidden.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

/* The next primitive to render. */
struct cursor {
    uint32_t command, primitive;
};

static uint64_t now_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

static void *allocate_zeroed(size_t bytes)
{
    size_t rounded = (bytes + 63) & ~(size_t)63;
    void *memory = aligned_alloc(64, rounded);
    return memory ? memset(memory, 0, rounded) : NULL;
}

struct frame *frame_create(struct pool *pool, uint32_t arena_bytes, struct error *error)
{
    struct frame *frame = allocate_zeroed(sizeof *frame);
    if (frame) {
        frame->pool = pool;
        frame->command = allocate_zeroed(FRAME_COMMANDS * sizeof *frame->command);
        frame->job = allocate_zeroed(FRAME_COMMANDS * sizeof *frame->job);
        frame->passed = allocate_zeroed(FRAME_COMMANDS * sizeof *frame->passed);
        frame->worker = allocate_zeroed(pool_workers(pool) * sizeof *frame->worker);
    }
    if (!frame || !frame->command || !frame->job || !frame->passed || !frame->worker ||
        arena_create(&frame->arena, arena_bytes ? arena_bytes : ARENA_BYTES, error)) {
        error_set(error, "out of memory for the renderer's queue");
        frame_destroy(frame);
        return NULL;
    }
    return frame;
}

void frame_destroy(struct frame *frame)
{
    if (!frame)
        return;
    arena_destroy(&frame->arena);
    free(frame->command);
    free(frame->job);
    free(frame->passed);
    free(frame->worker);
    free(frame);
}

struct command *frame_next(struct frame *frame)
{
    return frame->commands < FRAME_COMMANDS ? frame->command + frame->commands : NULL;
}

/* --- The order of tasks -----------------------------------------------------------------------------------
 */

static uint32_t random_below(struct frame *frame, uint32_t bound)
{
    frame->shuffle = frame->shuffle * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)((frame->shuffle >> 32) * bound >> 32);
}

/* Before a phase of `count` tasks. */
static void order_tasks(struct frame *frame, uint32_t count)
{
    if (!frame->shuffle)
        return;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t j = random_below(frame, i + 1);
        frame->order[i] = frame->order[j];
        frame->order[j] = (uint16_t)i;
    }
}

/* The task that is handed out as the i-th. */
static uint32_t task_at(const struct frame *frame, uint32_t i)
{
    return frame->shuffle ? frame->order[i] : i;
}

/* --- Geometry ---------------------------------------------------------------------------------------------
 */

/* Cuts the commands from the cursor on into up to `limit` chunks. */
static void make_chunks(struct frame *frame, struct cursor at, uint32_t limit)
{
    frame->chunks = 0;
    while (at.command < frame->commands && frame->chunks < limit) {
        const struct command *command = frame->command + at.command;
        uint32_t left = command->kind == COMMAND_DRAW ? command->draw.count - at.primitive : 0;
        uint32_t count = left < CHUNK_PRIMITIVES ? left : CHUNK_PRIMITIVES;
        frame->chunk[frame->chunks++] =
            (struct chunk){.command = at.command, .first = at.primitive, .count = count};
        at.primitive += count;
        if (count == left) {
            at.command++;
            at.primitive = 0;
        }
    }
}

static void stop_after(struct frame *frame, uint32_t chunk)
{
    uint32_t first = atomic_load(&frame->first_stopped);
    while (chunk < first && !atomic_compare_exchange_weak(&frame->first_stopped, &first, chunk))
        ;
}

static void process_chunk(struct frame *frame, struct frame_worker *worker, uint32_t number)
{
    struct chunk *chunk = frame->chunk + number;
    const struct command *command = frame->command + chunk->command;
    if (command->kind != COMMAND_DRAW)
        return;
    memset(&worker->batch.counts, 0, sizeof worker->batch.counts);
    bin_begin_chunk(&worker->bins, number);
    chunk->done = batch_primitives(&worker->batch, &command->draw, chunk->first, chunk->count, &worker->bins);
    chunk->heads = bin_end_chunk(&worker->bins);
    chunk->covered = worker->bins.covered;
    chunk->counts = worker->batch.counts;
    if (chunk->done < chunk->count)
        stop_after(frame, number);
}

/* Whether no more chunks should begin; the first one always may, so every round gets ahead. */
static bool round_is_full(const struct frame *frame)
{
    uint64_t used = atomic_load_explicit(&frame->arena.used, memory_order_relaxed);
    return used > (uint64_t)ROUND_BYTES * pool_workers(frame->pool);
}

static void geometry_task(void *user, unsigned number)
{
    struct frame *frame = user;
    struct frame_worker *worker = frame->worker + number;
    uint64_t start = now_ns();
    bin_begin_round(&worker->bins, &frame->arena, frame->target->columns, frame->target->rows);
    uint32_t i;
    while ((i = atomic_fetch_add(&frame->next_chunk, 1)) < frame->chunks) {
        uint32_t chunk = task_at(frame, i);
        if (chunk && round_is_full(frame))
            stop_after(frame, chunk);
        if (chunk < atomic_load(&frame->first_stopped))
            process_chunk(frame, worker, chunk);
    }
    worker->geometry_ns += now_ns() - start;
}

/* --- Tiles ------------------------------------------------------------------------------------------------
 */

/* Appends a chunk's bins to the tiles'. */
static void link_chunk(struct frame *frame, const struct chunk *chunk)
{
    for (uint32_t head = chunk->heads; head; head = bin_cell(&frame->arena, head)->sibling) {
        uint32_t tile = bin_cell(&frame->arena, head)->tile;
        if (!frame->tile_first[tile]) {
            frame->tile_first[tile] = head;
            frame->busy[frame->busy_count++] = (uint16_t)tile;
        } else {
            bin_cell(&frame->arena, frame->tile_last[tile])->later = head;
        }
        frame->tile_last[tile] = head;
    }
}

/* Remembers the bins of a chunk that overwrite their tiles. */
static void link_covered(struct frame *frame, const struct chunk *chunk)
{
    const struct routine *routine = frame->command[chunk->command].draw.routine[UNIT_PIXEL];
    if (!(routine->traits & PIXEL_OVERWRITES_ALL) ||
        !pixel_writes_all_targets(&routine->key.pixel, frame->target))
        return;
    for (uint32_t head = chunk->heads; head; head = bin_cell(&frame->arena, head)->sibling)
        if (bin_covers(&frame->arena, head))
            frame->tile_start[bin_cell(&frame->arena, head)->tile] = head;
}

/* Makes the tiles' bins from those of the chunks that are done, and moves the cursor behind these. */
static void link_chunks(struct frame *frame, struct cursor *at)
{
    uint32_t stopped = atomic_load(&frame->first_stopped);
    uint32_t tiles = frame->target->columns * frame->target->rows;
    memset(frame->tile_first, 0, tiles * sizeof *frame->tile_first);
    memset(frame->tile_start, 0, tiles * sizeof *frame->tile_start);
    frame->clears = frame->busy_count = 0;
    for (uint32_t i = 0; i < frame->chunks && i <= stopped; i++) {
        const struct chunk *chunk = frame->chunk + i;
        const struct command *command = frame->command + chunk->command;
        if (command->kind == COMMAND_CLEAR)
            frame->clear_chunk[frame->clears++] = i;
        link_chunk(frame, chunk);
        if (chunk->covered)
            link_covered(frame, chunk);
        frame->statistics.vertices_shaded += chunk->counts.vertices_shaded;
        frame->statistics.triangles_set_up += chunk->counts.triangles_set_up;
        frame->statistics.triangles_visible += chunk->counts.triangles_visible;
        *at = (struct cursor){chunk->command, chunk->first + chunk->done};
        if (command->kind == COMMAND_CLEAR || at->primitive == command->draw.count)
            *at = (struct cursor){chunk->command + 1, 0};
    }
    frame->tile_tasks = frame->clears ? tiles : frame->busy_count;
}

static void tiles_task(void *user, unsigned number)
{
    struct frame *frame = user;
    struct frame_worker *worker = frame->worker + number;
    uint64_t start = now_ns();
    uint32_t i;
    while ((i = atomic_fetch_add(&frame->next_tile, 1)) < frame->tile_tasks) {
        uint32_t task = task_at(frame, i);
        tile_render(&worker->tile, frame, frame->clears ? task : frame->busy[task]);
    }
    worker->tiles_ns += now_ns() - start;
}

/* --- Rounds -----------------------------------------------------------------------------------------------
 */

static void render_round(struct frame *frame, struct cursor *at, uint32_t limit)
{
    make_chunks(frame, *at, limit);
    arena_reset(&frame->arena);
    atomic_store(&frame->next_chunk, 0);
    atomic_store(&frame->next_tile, 0);
    atomic_store(&frame->first_stopped, UINT32_MAX);
    order_tasks(frame, frame->chunks);
    pool_run(frame->pool, frame->chunks, geometry_task, frame);
    link_chunks(frame, at);
    order_tasks(frame, frame->tile_tasks);
    pool_run(frame->pool, frame->tile_tasks, tiles_task, frame);
    frame->statistics.rounds++;
}

static void gather_statistics(struct frame *frame)
{
    for (unsigned i = 0; i < pool_workers(frame->pool); i++) {
        struct frame_worker *worker = frame->worker + i;
        frame->statistics.pixels_shaded += worker->tile.pixels_shaded;
        frame->statistics.geometry_ns += worker->geometry_ns;
        frame->statistics.tiles_ns += worker->tiles_ns;
        worker->tile.pixels_shaded = worker->geometry_ns = worker->tiles_ns = 0;
    }
}

/* Threads that work on later chunks may have taken all of the arena before the first chunk got any of it;
 * alone, it gets ahead. */
void frame_render(struct frame *frame, struct target *target)
{
    struct cursor at = {0, 0};
    uint32_t limit = FRAME_CHUNKS;
    frame->target = target;
    frame->farthest = depth_encode(target->depth_format, 1);
    memset(frame->passed, 0, frame->commands * sizeof *frame->passed);
    while (at.command < frame->commands) {
        struct cursor before = at;
        render_round(frame, &at, limit);
        bool ahead = at.command != before.command || at.primitive != before.primitive;
        limit = ahead ? FRAME_CHUNKS : 1;
        frame->statistics.starved_rounds += !ahead;
    }
    gather_statistics(frame);
}
