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

static int create_queue(struct queue *queue)
{
    queue->command = allocate_zeroed(FRAME_COMMANDS * sizeof *queue->command);
    queue->job = allocate_zeroed(FRAME_COMMANDS * sizeof *queue->job);
    return queue->command && queue->job ? 0 : -1;
}

/* Records into the other queue, and makes the one that was recorded the other. */
static void exchange_queues(struct frame *frame)
{
    struct queue recorded = {frame->command, frame->job};
    frame->command = frame->other.command;
    frame->job = frame->other.job;
    frame->other = recorded;
}

static int create_parts(struct frame *frame, uint32_t arena_bytes, struct error *error)
{
    unsigned workers = pool_workers(frame->pool);
    frame->passed = allocate_zeroed(FRAME_COMMANDS * sizeof *frame->passed);
    frame->worker = allocate_zeroed(workers * sizeof *frame->worker);
    if (!frame->passed || !frame->worker || create_queue(&frame->other))
        return -1;
    exchange_queues(frame);
    if (workers > 1 && create_queue(&frame->other))
        return -1;
    return arena_create(&frame->arena, arena_bytes ? arena_bytes : ARENA_BYTES, error);
}

struct frame *frame_create(struct pool *pool, uint32_t arena_bytes, struct error *error)
{
    struct frame *frame = allocate_zeroed(sizeof *frame);
    if (frame)
        frame->pool = pool;
    if (!frame || create_parts(frame, arena_bytes, error)) {
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
    free(frame->other.command);
    free(frame->other.job);
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

/* --- Whose work a phase is ---------------------------------------------------------------------------------
 *
 * Nanoseconds of one thread that a phase takes at least, by what is known of it: shaders may take any time. */

enum {
    CHUNK_NS = 100,
    PRIMITIVE_NS = 40,
    TILE_NS = 40, /* with nothing but a clear, half of that */
    WIDE_NS = 5,  /* and with what is everywhere, in each of them */
    PIXELS_OF_NS = 8,
    SHARED_NS = 10000, /* a phase that is worth another thread that looks for work */
    CALL_NS = 25000    /* and one that is worth waking it */
};

static enum pool_call call_for(uint64_t ns)
{
    return ns < SHARED_NS ? POOL_ALONE : ns < CALL_NS ? POOL_AWAKE : POOL_ALL;
}

/* A thread's time in a phase; the leader calls the others if it is more than was thought. */
struct stint {
    uint64_t start;
    uint64_t work; /* that was done when it last looked at the clock, in what the phase counts */
    bool may_call;
};

static struct stint begin_stint(const struct frame *frame, unsigned number, uint64_t work)
{
    bool may_call = number == frame->leader && frame->call != POOL_ALL && pool_limited(frame->pool) > 1;
    return (struct stint){now_ns(), work, may_call};
}

static void look_at_clock(struct stint *stint, const struct frame *frame, uint32_t tasks_left, uint64_t work)
{
    enum { WORK_BETWEEN_LOOKS = 256 }; /* pixels or primitives: a look costs what a few of them do */
    if (!stint->may_call || !tasks_left || work - stint->work < WORK_BETWEEN_LOOKS)
        return;
    stint->work = work;
    if (now_ns() - stint->start < CALL_NS / 2)
        return;
    stint->may_call = false;
    pool_call(frame->pool, tasks_left + 1);
}

static void run_phase(struct frame *frame, uint32_t tasks, uint64_t ns, pool_task *task)
{
    order_tasks(frame, tasks);
    atomic_store(&frame->next_task, 0);
    frame->call = call_for(ns);
    pool_run(frame->pool, frame->leader, tasks, frame->call, task, frame);
}

/* --- Geometry ---------------------------------------------------------------------------------------------
 */

/* Chunks and their tasks. */
static void add_chunk(struct frame *frame, struct cursor at, uint32_t count, uint32_t *of_task)
{
    uint32_t number = frame->chunks++;
    frame->chunk[number] = (struct chunk){.command = at.command, .first = at.primitive, .count = count};
    frame->primitives += count;
    if (!number || *of_task >= TASK_PRIMITIVES || frame->shuffle) {
        frame->chunk_task[frame->chunk_tasks++] = number;
        *of_task = 0;
    }
    *of_task += count;
}

/* Commands lie in another core's cache when that has recorded them. */
enum { COMMANDS_AHEAD = 8 };

static void prefetch_command(const struct frame *frame, uint32_t number)
{
    const char *command = (const char *)(frame->rendered + number);
    if (number >= frame->rendered_commands)
        return;
    __builtin_prefetch(command);
    __builtin_prefetch(command + sizeof(struct command) - 1);
}

/* Cuts the commands from the cursor on into up to `limit` chunks. */
static void make_chunks(struct frame *frame, struct cursor at, uint32_t limit)
{
    uint32_t of_task = 0;
    frame->chunks = frame->chunk_tasks = frame->primitives = 0;
    while (at.command < frame->rendered_commands && frame->chunks < limit) {
        const struct command *command = frame->rendered + at.command;
        uint32_t left = command->kind == COMMAND_DRAW ? command->draw.count - at.primitive : 0;
        prefetch_command(frame, at.command + COMMANDS_AHEAD);
        uint32_t count = left < CHUNK_PRIMITIVES ? left : CHUNK_PRIMITIVES;
        add_chunk(frame, at, count, &of_task);
        at.primitive += count;
        if (count == left) {
            at.command++;
            at.primitive = 0;
        }
    }
    frame->chunk_task[frame->chunk_tasks] = frame->chunks;
}

static void stop_after(struct frame *frame, uint32_t chunk)
{
    uint32_t first = atomic_load(&frame->first_stopped);
    while (chunk < first && !atomic_compare_exchange_weak(&frame->first_stopped, &first, chunk))
        ;
}

/* Keeps compilers from loading two numbers at once that were stored one by one a moment ago: the load would wait until
 * both are in the cache, behind all that was stored before. */
static inline uint64_t scalar(uint64_t x)
{
    __asm__("" : "+r"(x));
    return x;
}

static void process_chunk(struct frame *frame, struct frame_worker *worker, uint32_t number)
{
    struct chunk *chunk = frame->chunk + number;
    const struct command *command = frame->rendered + chunk->command;
    if (command->kind != COMMAND_DRAW)
        return;
    memset(&worker->batch.counts, 0, sizeof worker->batch.counts);
    bin_begin_chunk(&worker->bins, number);
    chunk->done = batch_primitives(&worker->batch, &command->draw, chunk->first, chunk->count, &worker->bins);
    chunk->heads = bin_end_chunk(&worker->bins);
    chunk->wide = worker->bins.wide;
    chunk->covered = worker->bins.covered;
    chunk->pixels = worker->bins.pixels;
    chunk->counts = (struct batch_counts){scalar(worker->batch.counts.vertices_shaded),
                                          scalar(worker->batch.counts.triangles_set_up),
                                          scalar(worker->batch.counts.triangles_visible)};
    if (chunk->done < chunk->count)
        stop_after(frame, number);
}

/* Whether no more chunks should begin; the first one always may, so every round gets ahead. */
static bool round_is_full(const struct frame *frame)
{
    uint64_t used = atomic_load_explicit(&frame->arena.used, memory_order_relaxed);
    return used > (uint64_t)ROUND_BYTES * pool_limited(frame->pool);
}

static void geometry_task(void *user, unsigned number)
{
    struct frame *frame = user;
    struct frame_worker *worker = frame->worker + number;
    uint64_t primitives = 0;
    struct stint stint = begin_stint(frame, number, primitives);
    bin_begin_round(&worker->bins, &frame->arena, frame->target->columns, frame->target->rows);
    for (uint32_t i; (i = atomic_fetch_add(&frame->next_task, 1)) < frame->chunk_tasks;) {
        uint32_t task = task_at(frame, i);
        for (uint32_t chunk = frame->chunk_task[task]; chunk < frame->chunk_task[task + 1]; chunk++) {
            if (chunk && round_is_full(frame))
                stop_after(frame, chunk);
            if (chunk < atomic_load(&frame->first_stopped))
                process_chunk(frame, worker, chunk);
            primitives += frame->chunk[chunk].count;
        }
        look_at_clock(&stint, frame, frame->chunk_tasks - i - 1, primitives);
    }
    worker->geometry_ns += now_ns() - stint.start;
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

/* Whether the chunk's draw overwrites all of what a triangle covers. */
static bool overwrites(const struct frame *frame, const struct chunk *chunk)
{
    const struct routine *routine = frame->rendered[chunk->command].draw.routine[UNIT_PIXEL];
    return routine->traits & PIXEL_OVERWRITES_ALL &&
           pixel_writes_all_targets(&routine->key.pixel, frame->target);
}

/* Remembers the bins of a chunk that overwrite their tiles. */
static void link_covered(struct frame *frame, uint32_t number)
{
    const struct chunk *chunk = frame->chunk + number;
    if (!overwrites(frame, chunk))
        return;
    for (uint32_t head = chunk->heads; head; head = bin_cell(&frame->arena, head)->sibling)
        if (bin_covers(&frame->arena, head))
            frame->tile_start[bin_cell(&frame->arena, head)->tile] = number + 1;
}

static void link_everywhere(struct frame *frame, uint32_t number)
{
    const struct chunk *chunk = frame->chunk + number;
    frame->everywhere[frame->everywhere_count++] = number;
    if (chunk->wide && overwrites(frame, chunk))
        frame->wide_start[frame->wide_starts++] = number;
}

static void begin_linking(struct frame *frame)
{
    uint32_t tiles = frame->target->columns * frame->target->rows;
    memset(frame->tile_first, 0, tiles * sizeof *frame->tile_first);
    memset(frame->tile_start, 0, tiles * sizeof *frame->tile_start);
    frame->everywhere_count = frame->wide_starts = frame->busy_count = 0;
    frame->pixels = 0;
}

static void count_chunk(struct frame *frame, const struct chunk *chunk)
{
    frame->pixels += chunk->pixels;
    frame->unseen.vertices_shaded += chunk->counts.vertices_shaded;
    frame->unseen.triangles_set_up += chunk->counts.triangles_set_up;
    frame->unseen.triangles_visible += chunk->counts.triangles_visible;
}

/* Makes the tiles' bins from those of the chunks that are done, and moves the cursor behind these. */
static void link_chunks(struct frame *frame, struct cursor *at)
{
    uint32_t stopped = atomic_load(&frame->first_stopped);
    begin_linking(frame);
    for (uint32_t i = 0; i < frame->chunks && i <= stopped; i++) {
        const struct chunk *chunk = frame->chunk + i;
        const struct command *command = frame->rendered + chunk->command;
        if (command->kind == COMMAND_CLEAR || chunk->wide)
            link_everywhere(frame, i);
        link_chunk(frame, chunk);
        if (chunk->covered)
            link_covered(frame, i);
        count_chunk(frame, chunk);
        *at = (struct cursor){chunk->command, chunk->first + chunk->done};
        if (command->kind == COMMAND_CLEAR || at->primitive == command->draw.count)
            *at = (struct cursor){chunk->command + 1, 0};
    }
    frame->tile_tasks =
        frame->everywhere_count ? frame->target->columns * frame->target->rows : frame->busy_count;
}

static uint32_t part_begin(const struct frame *frame, uint32_t part)
{
    return (uint32_t)((uint64_t)frame->tile_tasks * part / frame->parts);
}

/* As many parts as threads may come, if there are not too many. */
static void make_parts(struct frame *frame, uint64_t ns)
{
    unsigned threads = call_for(ns) == POOL_ALONE ? 1 : pool_limited(frame->pool);
    frame->parts = threads < TILE_PARTS ? threads : TILE_PARTS;
    for (uint32_t i = 0; i < frame->parts; i++)
        atomic_store_explicit(&frame->part[i].next, part_begin(frame, i), memory_order_relaxed);
}

/* Takes tiles off a part: many at first, one by one at the end, so that threads end together. Returns how many, from *first
 * on. */
static uint32_t take_of_part(struct frame *frame, uint32_t part, uint32_t *first)
{
    enum { RUNS = 8, ALONE_MOST = 4 };
    _Atomic uint32_t *counter = &frame->part[part].next;
    uint32_t next = atomic_load_explicit(counter, memory_order_relaxed), count;
    do {
        uint32_t left = part_begin(frame, part + 1) - next;
        if (!left)
            return 0;
        count = left / RUNS;
        count = frame->call == POOL_ALONE && count > ALONE_MOST ? ALONE_MOST : count;
        count = count ? count : 1;
    } while (!atomic_compare_exchange_weak(counter, &next, next + count));
    *first = next;
    return count;
}

/* The thread's own part first, then what others have left of theirs. */
static uint32_t take_tiles(struct frame *frame, unsigned number, uint32_t *first)
{
    for (uint32_t i = 0; i < frame->parts; i++) {
        uint32_t count = take_of_part(frame, (number + i) % frame->parts, first);
        if (count)
            return count;
    }
    return 0;
}

static void tiles_task(void *user, unsigned number)
{
    struct frame *frame = user;
    struct frame_worker *worker = frame->worker + number;
    struct stint stint = begin_stint(frame, number, worker->tile.pixels_shaded);
    uint32_t first, count;
    worker->tile.lanes = lane_table;
    while ((count = take_tiles(frame, number, &first))) {
        for (uint32_t i = first; i < first + count; i++) {
            uint32_t task = task_at(frame, i);
            tile_render(&worker->tile, frame, frame->everywhere_count ? task : frame->busy[task]);
            look_at_clock(&stint, frame, frame->tile_tasks - first - count, worker->tile.pixels_shaded);
        }
    }
    worker->tiles_ns += now_ns() - stint.start;
}

/* --- Rounds -----------------------------------------------------------------------------------------------
 */

static uint64_t geometry_ns(const struct frame *frame)
{
    return (uint64_t)frame->chunks * CHUNK_NS + (uint64_t)frame->primitives * PRIMITIVE_NS;
}

static uint64_t tiles_ns(const struct frame *frame)
{
    uint64_t cells = frame->busy_count + (uint64_t)frame->tile_tasks;
    uint64_t everywhere = (uint64_t)frame->everywhere_count * frame->tile_tasks;
    return cells * (TILE_NS / 2) + everywhere * WIDE_NS + frame->pixels / PIXELS_OF_NS;
}

static void render_round(struct frame *frame, struct cursor *at, uint32_t limit)
{
    make_chunks(frame, *at, limit);
    arena_reset(&frame->arena);
    frame->arena.shared = pool_limited(frame->pool) > 1;
    atomic_store(&frame->first_stopped, UINT32_MAX);
    run_phase(frame, frame->chunk_tasks, geometry_ns(frame), geometry_task);
    link_chunks(frame, at);
    make_parts(frame, tiles_ns(frame));
    run_phase(frame, frame->tile_tasks, tiles_ns(frame), tiles_task);
    frame->unseen.rounds++;
}

/* Threads that work on later chunks may have taken all of the arena before the first chunk got any of it;
 * alone, it gets ahead. */
static void render_task(void *user, unsigned number)
{
    struct frame *frame = user;
    struct cursor at = {0, 0};
    uint32_t limit = FRAME_CHUNKS;
    frame->leader = number;
    while (at.command < frame->rendered_commands) {
        struct cursor before = at;
        render_round(frame, &at, limit);
        bool ahead = at.command != before.command || at.primitive != before.primitive;
        limit = ahead ? FRAME_CHUNKS : 1;
        frame->unseen.starved_rounds += !ahead;
    }
}

/* What is recorded is rendered from now on. */
static void begin_rendering(struct frame *frame, struct target *target)
{
    frame->target = target;
    frame->farthest = depth_encode(target->depth_format, 1);
    frame->rendered = frame->command;
    frame->rendered_commands = frame->commands;
    memset(frame->passed, 0, frame->commands * sizeof *frame->passed);
    frame->commands = frame->jobs = 0;
}

static void see_statistics(struct frame *frame)
{
    struct frame_statistics *all = &frame->statistics, *new = &frame->unseen;
    for (unsigned i = 0; i < pool_workers(frame->pool); i++) {
        struct frame_worker *worker = frame->worker + i;
        all->pixels_shaded += worker->tile.pixels_shaded;
        all->geometry_ns += worker->geometry_ns;
        all->tiles_ns += worker->tiles_ns;
        worker->tile.pixels_shaded = worker->geometry_ns = worker->tiles_ns = 0;
    }
    all->vertices_shaded += new->vertices_shaded;
    all->triangles_set_up += new->triangles_set_up;
    all->triangles_visible += new->triangles_visible;
    all->rounds += new->rounds;
    all->starved_rounds += new->starved_rounds;
    *new = (struct frame_statistics){0};
}

void frame_render(struct frame *frame, struct target *target)
{
    begin_rendering(frame, target);
    render_task(frame, 0);
    see_statistics(frame);
}

bool frame_has_threads(const struct frame *frame)
{
    return frame->other.command && pool_limited(frame->pool) > 1;
}

void frame_start(struct frame *frame, struct target *target)
{
    begin_rendering(frame, target);
    exchange_queues(frame);
    frame->rendering = true;
    pool_start(frame->pool, render_task, frame);
}

void frame_wait(struct frame *frame)
{
    if (!frame->rendering)
        return;
    pool_wait(frame->pool);
    frame->rendering = false;
    see_statistics(frame);
}
