#include "render/queue/queue.h"

#include "base/minmax.h"

#include <stdlib.h>
#include <string.h>

static int create_parts(struct queue *queue, uint32_t arena_bytes, struct error *error)
{
    unsigned workers = pool_workers(queue->phase.pool);
    queue->round.passed = queue_allocate(QUEUE_COMMANDS * sizeof *queue->round.passed);
    queue->worker = queue_allocate(workers * sizeof *queue->worker);
    if (!queue->round.passed || !queue->worker || queue_commands_create(&queue->commands, workers > 1))
        return -1;
    return arena_create(&queue->round.arena, arena_bytes ? arena_bytes : ARENA_BYTES, error);
}

struct queue *queue_create(struct pool *pool, uint32_t arena_bytes, struct error *error)
{
    struct queue *queue = queue_allocate(sizeof *queue);
    if (queue)
        queue->phase.pool = pool;
    if (!queue || create_parts(queue, arena_bytes, error)) {
        error_set(error, "out of memory for the renderer's queue");
        queue_destroy(queue);
        return NULL;
    }
    return queue;
}

static void destroy_round(struct round *round)
{
    if (round)
        arena_destroy(&round->arena);
    queue_free(round);
}

void queue_destroy(struct queue *queue)
{
    if (!queue)
        return;
    destroy_round(queue->second);
    arena_destroy(&queue->round.arena);
    queue_commands_destroy(&queue->commands);
    queue_free(queue->round.passed);
    free(queue->view_words);
    queue_free(queue->worker);
    queue_free(queue);
}

static struct round *create_second(const struct queue *queue)
{
    struct round *round = queue_allocate(sizeof *round);
    if (round && arena_create(&round->arena, queue->round.arena.capacity, NULL)) {
        queue_free(round);
        return NULL;
    }
    return round;
}

void queue_set_settings(struct queue *queue, const struct setting_values *settings)
{
    bool priority = settings->of[SETTING_queue] == SETTING_queue_priority;
    queue->round.settings = *settings;
    if (priority && !queue->second)
        queue->second = create_second(queue);
    if (!priority) {
        destroy_round(queue->second);
        queue->second = NULL;
    }
}

/* Pages are made present when a worker first draws to them. */
bool queue_reserve_views(struct queue *queue)
{
    unsigned workers = pool_workers(queue->phase.pool);
    if (!queue->view_words)
        queue->view_words = aligned_alloc(64, (size_t)workers * TARGET_VIEW_WORDS * sizeof(uint32_t));
    for (unsigned i = 0; i < workers && queue->view_words; i++)
        queue->worker[i].tile.view_words = queue->view_words + (size_t)i * TARGET_VIEW_WORDS;
    return queue->view_words;
}

/* The values that both rounds have in common. */
static void share_round(struct queue *queue)
{
    queue->made = queue->drawn = &queue->round;
    if (!queue->second)
        return;
    queue->drawn = queue->second;
    queue->second->command = queue->round.command;
    queue->second->target = queue->round.target;
    queue->second->farthest = queue->round.farthest;
    queue->second->settings = queue->round.settings;
    queue->second->passed = queue->round.passed;
}

static void begin_rendering(struct queue *queue)
{
    queue->round.command = queue->commands.command;
    share_round(queue);
    queue->rendered_commands = queue->commands.count;
    memset(queue->round.passed, 0, queue->commands.count * sizeof *queue->round.passed);
    queue->commands.count = queue->commands.jobs = 0;
}

static void add_statistics(struct queue *queue)
{
    struct queue_statistics *all = &queue->statistics, *unseen = &queue->unseen;
    for (unsigned i = 0; i < pool_workers(queue->phase.pool); i++) {
        struct queue_worker *worker = queue->worker + i;
        all->pixels_shaded += worker->tile.pixels_shaded;
        all->geometry_ns += worker->geometry_ns;
        all->tiles_ns += worker->tiles_ns;
        all->pixel_calls += worker->tile.pixel_calls;
        worker->tile.pixels_shaded = worker->tile.pixel_calls = worker->geometry_ns = worker->tiles_ns = 0;
    }
    all->vertices_shaded += unseen->vertices_shaded;
    all->triangles_set_up += unseen->triangles_set_up;
    all->triangles_visible += unseen->triangles_visible;
    all->rounds += unseen->rounds;
    all->starved_rounds += unseen->starved_rounds;
    all->geometry_wall_ns += unseen->geometry_wall_ns;
    all->tiles_wall_ns += unseen->tiles_wall_ns;
    all->tiles += unseen->tiles;
    all->tile_triangles += unseen->tile_triangles;
    all->records_bytes = max_u64(all->records_bytes, unseen->records_bytes);
    *unseen = (struct queue_statistics){0};
}

void queue_render(struct queue *queue)
{
    timeline_end(queue->timeline);
    begin_rendering(queue);
    queue_render_rounds(queue, 0);
    add_statistics(queue);
    timeline_begin(queue->timeline, TIMELINE_SUBMIT, 0);
}

bool queue_has_threads(const struct queue *queue)
{
    return queue->commands.other.command && pool_limited(queue->phase.pool) > 1;
}

void queue_start(struct queue *queue)
{
    begin_rendering(queue);
    queue_commands_exchange(&queue->commands);
    queue->rendering = true;
    pool_start(queue->phase.pool, queue_render_rounds, queue);
}

void queue_wait(struct queue *queue)
{
    if (!queue->rendering)
        return;
    pool_wait(queue->phase.pool);
    queue->rendering = false;
    add_statistics(queue);
}
