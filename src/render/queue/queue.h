/* The queue: the commands that the device has queued, and the rounds that render them.
 *
 * With threads there are two buffers of commands: one is rendered in the background while the other is
 * filled.
 *
 * Changes of the target and transfers between tiles and texels end a round. They are phases of their own, in
 * which threads take tiles. The target stays the same from one buffer to the next.
 *
 * A round takes commands from the queue in order, cuts draws into chunks of primitives, and runs two phases
 * on the pool (render/queue/phase.h). Geometry: threads take chunks in any order, and write each into its own
 * bins in the arena. Tiles: the bins of the chunks are linked, tile by tile, in the order of the chunks
 * (render/tile/round.h); then threads take tiles, and one thread renders each of them in that order. So the
 * image does not depend on which thread did what.
 *
 * A round ends early when its records outgrow the caches: the tile phase then finds in them what geometry has
 * written, and the next round writes to the same addresses.
 *
 * With the setting queue=priority there are two rounds, each with an arena. While the tiles of one are
 * rendered, threads that find none process the geometry of the other. So the memory is twice that of a round,
 * and threads wait once for each round. The setting of threads for geometry has no effect then.
 *
 * When the arena is full, the chunk that ran out of it stops where it is, later chunks are given up, and
 * the next round begins at the first primitive that is not done. So memory is bounded, whatever is drawn. */
#ifndef RENDER_QUEUE_QUEUE_H
#define RENDER_QUEUE_QUEUE_H

#include "render/geometry/batch.h"
#include "render/queue/commands.h"
#include "render/queue/phase.h"
#include "render/queue/pool.h"
#include "render/queue/timeline.h"
#include "render/target/surface.h"
#include "render/tile/tile.h"

enum { CHUNK_PRIMITIVES = 2048 }; /* of a chunk at most, and with one thread */

_Static_assert((int)ROUND_CHUNKS <= (int)PHASE_TASKS_MAXIMUM, "a phase may have a task for each chunk");
_Static_assert((int)TARGET_TILES_MAXIMUM <= (int)PHASE_TASKS_MAXIMUM, "and one for each tile");

struct queue_worker {
    struct batch batch;
    struct bin_writer bins;
    struct tile_worker tile;
    uint64_t geometry_ns, tiles_ns;
};

struct queue_statistics {
    uint64_t vertices_shaded, triangles_set_up, triangles_visible, pixels_shaded;
    uint64_t geometry_ns, tiles_ns; /* sums over all threads */
    uint64_t rounds;
    uint64_t starved_rounds; /* rounds that completed no primitive */
    uint64_t pixel_calls;    /* of pixel routines */
    /* Only if the queue is measured: */
    uint64_t geometry_wall_ns, tiles_wall_ns; /* from the beginnings of phases to their ends */
    uint64_t tiles;                           /* that were rendered, each as often as it was */
    uint64_t tile_triangles;                  /* pairs of one of these and a triangle of its bin */
    uint64_t records_bytes;                   /* the most that a round has in the arena */
};

/* The tasks of the geometry phase: runs of chunks. */
struct queue_chunks {
    uint32_t first[ROUND_CHUNKS + 1]; /* the first chunk of each task, and the end of the last */
    uint32_t tasks;
    uint32_t primitives;
};

struct queue {
    /* The buffer that is filled, in cache lines that no other thread accesses. */
    alignas(64) struct queue_commands commands;

    /* The buffer that is rendered. */
    alignas(64) uint32_t rendered_commands;
    bool rendering;              /* in the background, and queue_wait has not been called yet */
    struct queue_worker *worker; /* one for each thread of the pool */
    uint32_t *view_words;        /* of all workers; null: not reserved */
    struct round round;
    struct round *second; /* of the setting queue=priority; null: there is none */
    struct round *made;   /* whose geometry is processed */
    struct round *drawn;  /* whose tiles are rendered; the same, unless there is a second */
    struct queue_chunks chunks;
    struct phase phase;
    bool measured;             /* phases are timed, and triangles in tiles counted */
    struct timeline *timeline; /* of what one thread does, in a queue without threads; null: not recorded */

    struct queue_statistics statistics; /* of all that queue_render and queue_wait have seen end */
    struct queue_statistics unseen;     /* of what they have not */
};

/* A queue whose rendering runs on `pool`, with an arena of `arena_bytes` (render/geometry/arena.h; 0:
 * ARENA_BYTES). Null with the reason when memory is short. */
struct queue *queue_create(struct pool *pool, uint32_t arena_bytes, struct error *error);
void queue_destroy(struct queue *queue);

/* Room for the next job; there is room for one with each command. The job counts once queue->commands.jobs
 * is increased. */
static inline struct job *queue_next_job(struct queue *queue)
{
    return queue->commands.job + queue->commands.jobs;
}

/* Room for the next command; null when the buffer is full. It counts once queue->commands.count is
 * increased. */
static inline struct command *queue_next(struct queue *queue)
{
    struct queue_commands *commands = &queue->commands;
    return commands->count < QUEUE_COMMANDS ? commands->command + commands->count : NULL;
}

/* Renders all queued commands, in order, and empties the queue. queue->round.passed then has the counts of
 * these commands. Nothing may be rendered in the background. */
void queue_render(struct queue *queue);

/* The next queue_render renders what queue_start would in a queue with threads. */
static inline void queue_could_start(struct queue *queue)
{
    if (queue->timeline && queue->timeline->parts)
        queue->timeline->part[queue->timeline->parts - 1].background = true;
}

/* The same in the background. Until queue_wait the caller must not access what the commands refer to, nor
 * change it. queue_has_threads must be true. */
void queue_start(struct queue *queue);
bool queue_has_threads(const struct queue *queue);
/* Returns when what was started is rendered. */
void queue_wait(struct queue *queue);

/* Make a change of the target or a transfer immediately. Nothing may be rendered in the background. */
void queue_change_target(struct queue *queue, struct target *target);
void queue_transfer(struct queue *queue, const struct surface_transfer *transfer);

/* The same between two rounds (render/queue/transfers.c). */
void queue_run_change(struct queue *queue, struct target *target);
void queue_run_transfer(struct queue *queue, const struct surface_transfer *transfer);

/* Renders all rounds, as worker `number` of the pool (render/queue/rounds.c); `user` is the queue. */
void queue_render_rounds(void *user, unsigned number);

/* From now on tasks are handed out in a random order, from this seed; 0: in order. */
static inline void queue_shuffle(struct queue *queue, uint64_t seed)
{
    queue->phase.shuffle = seed;
}

/* From now on rounds have these settings. Nothing may be rendered in the background. Without memory for a
 * second round, the setting queue=priority has no effect. */
void queue_set_settings(struct queue *queue, const struct setting_values *settings);

/* Gives each worker memory for views of targets (render/target/target.h), once. Returns false if memory is
 * short: then targets have to stay in tiles. */
bool queue_reserve_views(struct queue *queue);

#endif
