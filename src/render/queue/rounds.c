/* The rounds of a queue: commands are cut into chunks, whose geometry is processed before their tiles are
 * rendered. */
#include "render/queue/queue.h"

#include "base/clock.h"
#include "base/minmax.h"

#include <string.h>

/* --- How long a phase takes ---
 *
 * Least nanoseconds that it takes one thread, by what is known of it; shaders may take any time. */

enum {
    CHUNK_NS = 100,
    PRIMITIVE_NS = 40,
    TILE_NS = 40, /* half of that with nothing but a clear */
    WIDE_NS = 5,  /* for each tile and chunk that is everywhere */
    HEAD_NS = 10, /* of linking, for each pair of a chunk and a tile */
    PIXELS_OF_NS = 8
};

static uint64_t geometry_ns(const struct queue *queue)
{
    return (uint64_t)queue->made->chunks * CHUNK_NS + (uint64_t)queue->chunks.primitives * PRIMITIVE_NS;
}

static uint64_t tiles_ns(const struct round *round)
{
    uint64_t cells = round->busy_count + (uint64_t)round->tiles;
    uint64_t everywhere = (uint64_t)round->everywhere_count * round->tiles;
    return cells * (TILE_NS / 2) + everywhere * WIDE_NS + round->pixels / PIXELS_OF_NS;
}

/* The threads that share a round. */
static unsigned round_threads(const struct queue *queue)
{
    return queue->timeline ? queue->timeline->threads : pool_limited(queue->phase.pool);
}

/* --- Chunks --- */

enum {
    TASK_PRIMITIVES = 64, /* least primitives of a task, if the round has that number */
    CHUNK_SHARES = 4,     /* a draw has at least as many chunks for each thread, */
    CHUNK_LEAST = 256,    /* if they do not have fewer primitives than this */
    BANDS_FROM = 1 << 14, /* primitives of a round whose chunks are linked by several threads */
    ROUND_BYTES =
        1 << 20,       /* of the arena, for each thread: chunks that begin beyond belong to the next round */
    COMMANDS_AHEAD = 8 /* commands are prefetched this many ahead: another core's cache may hold them */
};

static void prefetch_command(const struct queue *queue, uint32_t number)
{
    const char *command = (const char *)(queue->made->command + number);
    if (number >= queue->rendered_commands)
        return;
    __builtin_prefetch(command);
    __builtin_prefetch(command + sizeof(struct command) - 1);
}

/* A new chunk: nothing is done yet. Its heads are read only if there are some. */
static void begin_chunk(struct chunk *chunk, struct cursor at, uint32_t count)
{
    chunk->command = at.command;
    chunk->first = at.primitive;
    chunk->count = count;
    chunk->done = chunk->head_count = chunk->wide = chunk->covered = 0;
    chunk->pixels = 0;
    chunk->counts = (struct batch_counts){0};
}

/* Adds a chunk to the round, and to the last task if this has few primitives (*of_task). */
static void add_chunk(struct queue *queue, struct cursor at, uint32_t count, uint32_t *of_task)
{
    uint32_t number = queue->made->chunks++;
    begin_chunk(queue->made->chunk + number, at, count);
    queue->chunks.primitives += count;
    if (!number || *of_task >= TASK_PRIMITIVES || queue->phase.shuffle) {
        queue->chunks.first[queue->chunks.tasks++] = number;
        *of_task = 0;
    }
    *of_task += count;
}

/* Returns true if the round has its only draw and ends before the next. */
static bool ends_before(const struct queue *queue, uint32_t command)
{
    return queue->made->settings.of[SETTING_order] == SETTING_order_immediate && queue->made->chunks &&
           queue->made->chunk->command != command;
}

/* The most primitives of a draw's chunks, an even number, so that none ends between the two triangles of a
 * rectangle. Vertices that two chunks share are shaded in both. */
static uint32_t chunk_primitives(const struct queue *queue, uint32_t primitives)
{
    unsigned threads = round_threads(queue);
    if (threads == 1)
        return CHUNK_PRIMITIVES;
    return max_u32(CHUNK_LEAST, min_u32(primitives / (CHUNK_SHARES * threads), CHUNK_PRIMITIVES) & ~1u);
}

/* Cuts the commands from the cursor on into up to `limit` chunks. */
static void make_chunks(struct queue *queue, struct cursor at, uint32_t limit)
{
    uint32_t of_task = 0;
    queue->made->chunks = queue->chunks.tasks = queue->chunks.primitives = 0;
    while (at.command < queue->rendered_commands && queue->made->chunks < limit) {
        const struct command *command = queue->made->command + at.command;
        if (!command_draws(command) || ends_before(queue, at.command))
            break;
        uint32_t left = command->kind == COMMAND_DRAW ? command->draw.count - at.primitive : 0;
        prefetch_command(queue, at.command + COMMANDS_AHEAD);
        uint32_t count = left ? min_u32(left, chunk_primitives(queue, command->draw.count)) : 0;
        add_chunk(queue, at, count, &of_task);
        at.primitive += count;
        if (count == left) {
            at.command++;
            at.primitive = 0;
        }
    }
    queue->chunks.first[queue->chunks.tasks] = queue->made->chunks;
}

/* --- Geometry --- */

/* Keeps compilers from loading two numbers as one vector that were stored one by one just before: the load
 * would wait for both stores, and for all stores before them, to reach the cache. */
static inline uint64_t scalar(uint64_t x)
{
    __asm__("" : "+r"(x));
    return x;
}

/* Vertices of a batch; 0: all that have room. */
static const uint32_t batch_limits[] = {
    [SETTING_batch_whole] = 0, [SETTING_batch_96] = 96, [SETTING_batch_24] = 24, [SETTING_batch_6] = 6};

static void process_chunk(struct queue *queue, struct queue_worker *worker, uint32_t number)
{
    struct chunk *chunk = queue->made->chunk + number;
    const struct command *command = queue->made->command + chunk->command;
    if (command->kind != COMMAND_DRAW)
        return;
    memset(&worker->batch.counts, 0, sizeof worker->batch.counts);
    worker->batch.limit = batch_limits[queue->made->settings.of[SETTING_batch]];
    worker->batch.joins_pairs = queue->made->settings.of[SETTING_pairs] == SETTING_pairs_on;
    bin_begin_chunk(&worker->bins, number);
    chunk->done = batch_primitives(&worker->batch, &command->draw, chunk->first, chunk->count, &worker->bins);
    bin_end_chunk(&worker->bins);
    chunk->heads[0] = worker->bins.heads[0];
    if (worker->bins.bands > 1)
        memcpy(chunk->heads, worker->bins.heads, sizeof chunk->heads);
    chunk->head_count = worker->bins.head_count;
    chunk->wide = worker->bins.wide;
    chunk->covered = worker->bins.covered;
    chunk->joined = worker->bins.joined;
    chunk->pixels = worker->bins.pixels;
    chunk->counts = (struct batch_counts){scalar(worker->batch.counts.vertices_shaded),
                                          scalar(worker->batch.counts.triangles_set_up),
                                          scalar(worker->batch.counts.triangles_visible)};
    if (chunk->done < chunk->count)
        round_stop_at(queue->made, number);
}

static bool round_is_full(const struct queue *queue)
{
    uint64_t used = atomic_load_explicit(&queue->made->arena.used, memory_order_relaxed);
    return used > (uint64_t)ROUND_BYTES * round_threads(queue);
}

/* The first chunk is always processed, so that every round gets ahead. */
static void process_task(struct queue *queue, struct queue_worker *worker, uint32_t task,
                         uint64_t *primitives)
{
    for (uint32_t chunk = queue->chunks.first[task]; chunk < queue->chunks.first[task + 1]; chunk++) {
        if (chunk && round_is_full(queue))
            round_stop_at(queue->made, chunk);
        if (chunk < atomic_load(&queue->made->first_stopped))
            process_chunk(queue, worker, chunk);
        *primitives += queue->made->chunk[chunk].count;
    }
}

static uint32_t task_number(const struct queue *queue, uint32_t i)
{
    return queue->made == queue->drawn ? phase_task(&queue->phase, i)
                                       : i; /* else the order is that of tiles */
}

static void geometry_task(void *user, unsigned number)
{
    struct queue *queue = user;
    struct queue_worker *worker = queue->worker + number;
    const struct target *target = queue->made->target;
    uint32_t tasks = queue->chunks.tasks;
    uint64_t primitives = 0;
    struct stint stint = phase_begin_stint(&queue->phase, number, primitives);
    bin_begin_round(&worker->bins, &queue->made->arena, target->columns, target->rows,
                    queue->made->band_shift);
    for (uint32_t i; (i = atomic_fetch_add(&queue->phase.next_task, 1)) < tasks;) {
        process_task(queue, worker, task_number(queue, i), &primitives);
        timeline_task(queue->timeline);
        phase_look_at_clock(&queue->phase, &stint, tasks - i - 1, primitives);
    }
    worker->geometry_ns += phase_end_stint(&stint);
}

/* --- Tiles --- */

static bool has_stripes(const struct round *round)
{
    return round->settings.of[SETTING_order] == SETTING_order_stripes;
}

/* The number of tasks of the tile phase: tiles, or rows of them. */
static uint32_t tile_tasks(const struct round *round)
{
    return has_stripes(round) && round->tiles ? round->target->rows : round->tiles;
}

static void render_stripe(struct tile_worker *worker, const struct round *round, uint32_t row)
{
    uint32_t columns = round->target->columns;
    for (uint32_t tile = row * columns; tile < (row + 1) * columns; tile++)
        if (round_has_tile(round, tile))
            tile_render(worker, round, tile);
}

static void tiles_task(void *user, unsigned number)
{
    struct queue *queue = user;
    const struct round *round = queue->drawn;
    struct tile_worker *tile = &queue->worker[number].tile;
    struct stint stint = phase_begin_stint(&queue->phase, number, tile->pixels_shaded);
    uint32_t first, count, tasks = tile_tasks(round);
    tile_begin_round(tile);
    while ((count = phase_take(&queue->phase, number, &first))) {
        for (uint32_t i = first; i < first + count; i++) {
            uint32_t task = phase_task(&queue->phase, i);
            if (has_stripes(round))
                render_stripe(tile, round, task);
            else
                tile_render(tile, round, round_tile(round, task));
            timeline_task(queue->timeline);
            phase_look_at_clock(&queue->phase, &stint, tasks - first - count, tile->pixels_shaded);
        }
    }
    queue->worker[number].tiles_ns += phase_end_stint(&stint);
}

/* --- Rounds --- */

/* 0 unless phases are timed. */
static uint64_t look_at_clock(const struct queue *queue)
{
    return queue->measured ? clock_ns() : 0;
}

static uint32_t bytes_used(const struct round *round)
{
    return min_u32(atomic_load(&round->arena.used), round->arena.capacity);
}

static void measure_round(struct queue *queue)
{
    const struct round *round = queue->drawn;
    uint64_t used = bytes_used(round) + (queue->made == round ? 0 : bytes_used(queue->made));
    queue->unseen.tiles += round->tiles;
    queue->unseen.tile_triangles += round_tile_triangles(round);
    queue->unseen.records_bytes = max_u64(queue->unseen.records_bytes, used);
}

static void count_round(struct queue *queue)
{
    if (queue->measured)
        measure_round(queue);
    queue->unseen.vertices_shaded += queue->drawn->counts.vertices_shaded;
    queue->unseen.triangles_set_up += queue->drawn->counts.triangles_set_up;
    queue->unseen.triangles_visible += queue->drawn->counts.triangles_visible;
    queue->unseen.rounds++;
}

static struct cursor execute(struct queue *queue, struct cursor at)
{
    const struct command *command = queue->round.command + at.command;
    if (command->kind == COMMAND_TARGET)
        queue_run_change(queue, command->target);
    else
        queue_run_transfer(queue, command->transfer);
    return (struct cursor){at.command + 1, 0};
}

/* Cuts commands into the chunks of a new round. */
static void begin_round(struct queue *queue, struct cursor at, uint32_t limit)
{
    struct round *round = queue->made;
    make_chunks(queue, at, limit);
    round_begin_bands(round, round_threads(queue) > 1 && queue->chunks.primitives >= BANDS_FROM);
    arena_reset(&round->arena);
    round->arena.shared = pool_limited(queue->phase.pool) > 1;
    atomic_store(&round->first_stopped, UINT32_MAX);
}

static void run_geometry(struct queue *queue)
{
    uint64_t begin = look_at_clock(queue), ns = geometry_ns(queue);
    bool serial = queue->made->settings.of[SETTING_geometry] == SETTING_geometry_serial;
    timeline_begin(queue->timeline, TIMELINE_GEOMETRY, ns);
    if (serial)
        phase_run_alone(&queue->phase, queue->chunks.tasks, geometry_task, queue);
    else
        phase_run(&queue->phase, queue->chunks.tasks, ns, geometry_task, queue);
    timeline_end(queue->timeline);
    queue->unseen.geometry_wall_ns += look_at_clock(queue) - begin;
}

static void link_task(void *user, unsigned number)
{
    struct queue *queue = user;
    uint32_t first, count;
    while ((count = phase_take(&queue->phase, number, &first)))
        for (uint32_t band = first; band < first + count; band++) {
            round_link_band(queue->made, band);
            timeline_task(queue->timeline);
        }
}

/* One band is linked already. */
static void link_bands(struct queue *queue)
{
    const uint32_t bands = queue->made->bands;
    const uint64_t ns = queue->made->head_count * HEAD_NS;
    if (bands == 1)
        return;
    timeline_end(queue->timeline);
    timeline_begin(queue->timeline, TIMELINE_LINK, ns);
    phase_make_parts(&queue->phase, bands, ns);
    phase_run(&queue->phase, bands, ns, link_task, queue);
    timeline_end(queue->timeline);
    timeline_begin(queue->timeline, TIMELINE_LINK, 0);
}

static struct cursor link_round(struct queue *queue)
{
    timeline_begin(queue->timeline, TIMELINE_LINK, 0);
    struct cursor end = round_begin_linking(queue->made);
    link_bands(queue);
    round_end_linking(queue->made);
    timeline_end(queue->timeline);
    return end;
}

static void run_tiles(struct queue *queue)
{
    uint32_t tasks = tile_tasks(queue->drawn);
    uint64_t begin = look_at_clock(queue), ns = tiles_ns(queue->drawn);
    timeline_begin(queue->timeline, TIMELINE_TILES, ns);
    phase_make_parts(&queue->phase, tasks, ns);
    phase_run(&queue->phase, tasks, ns, tiles_task, queue);
    timeline_end(queue->timeline);
    queue->unseen.tiles_wall_ns += look_at_clock(queue) - begin;
}

static struct cursor render_round(struct queue *queue, struct cursor at, uint32_t limit)
{
    if (!command_draws(queue->round.command + at.command))
        return execute(queue, at);
    timeline_begin(queue->timeline, TIMELINE_CUT, 0);
    begin_round(queue, at, limit);
    timeline_end(queue->timeline);
    run_geometry(queue);
    struct cursor end = link_round(queue);
    run_tiles(queue);
    count_round(queue);
    return end;
}

static bool is_ahead(struct cursor at, struct cursor before)
{
    return at.command != before.command || at.primitive != before.primitive;
}

/* --- Rounds that overlap --- */

/* Tiles first: what they read takes the most memory, and it is free when they are rendered. */
static void tiles_then_geometry_task(void *user, unsigned number)
{
    tiles_task(user, number);
    geometry_task(user, number);
}

/* The tiles of the round that is drawn, if any, with the geometry of the one that is made, if any. */
static void run_both(struct queue *queue, bool draws, bool makes)
{
    uint32_t tiles = draws ? tile_tasks(queue->drawn) : 0;
    uint64_t begin = look_at_clock(queue), ns = draws ? tiles_ns(queue->drawn) : 0;
    if (makes)
        ns += geometry_ns(queue);
    else
        queue->chunks.tasks = 0;
    phase_make_parts(&queue->phase, tiles, ns);
    phase_run_both(&queue->phase, tiles, queue->chunks.tasks, ns, tiles_then_geometry_task, queue);
    queue->unseen.tiles_wall_ns += look_at_clock(queue) - begin;
}

static void exchange_rounds(struct queue *queue)
{
    struct round *made = queue->made;
    queue->made = queue->drawn;
    queue->drawn = made;
}

static void render_overlapping(struct queue *queue)
{
    struct cursor at = {0, 0};
    uint32_t limit = ROUND_CHUNKS;
    for (bool draws = false; draws || at.command < queue->rendered_commands;) {
        bool makes =
            at.command < queue->rendered_commands && command_draws(queue->round.command + at.command);
        if (!draws && !makes) {
            at = execute(queue, at);
            continue;
        }
        if (makes)
            begin_round(queue, at, limit);
        run_both(queue, draws, makes);
        if (draws)
            count_round(queue);
        draws = makes;
        if (makes) {
            struct cursor before = at;
            at = round_link(queue->made);
            limit = is_ahead(at, before) ? ROUND_CHUNKS : 1;
            queue->unseen.starved_rounds += !is_ahead(at, before);
            exchange_rounds(queue);
        }
    }
}

/* Threads that work on later chunks may take all of the arena before the first chunk gets any of it. Then
 * the first chunk has a round of its own. */
void queue_render_rounds(void *user, unsigned number)
{
    struct queue *queue = user;
    struct cursor at = {0, 0};
    uint32_t limit = ROUND_CHUNKS;
    queue->phase.leader = number;
    if (queue->second) {
        render_overlapping(queue);
        return;
    }
    while (at.command < queue->rendered_commands) {
        struct cursor before = at;
        at = render_round(queue, at, limit);
        limit = is_ahead(at, before) ? ROUND_CHUNKS : 1;
        queue->unseen.starved_rounds += !is_ahead(at, before);
    }
}
