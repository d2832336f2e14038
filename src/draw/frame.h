/* The frame: the queue of recorded commands, and the rounds that render it.
 *
 * There are two queues where there are threads: one is rendered in the background while the other is recorded.
 *
 * A round takes commands from the queue in order, draws cut into chunks of primitives, and runs two phases on
 * the pool. Geometry: threads take chunks in any order, each written into its own bins in the arena. Tiles:
 * each chunk's bins are appended to the tiles' in the order of chunks, then threads take tiles, each rendered
 * by one thread in that order. So the image does not depend on who did what. A test can have chunks and tiles
 * handed out in a random order to see that it is so: with one thread too, what a task finds then depends on
 * nothing that happened to be done before.
 *
 * Chunks are taken in runs of some primitives, tiles in runs that get shorter towards the end, each thread beginning with
 * a part of its own, so that threads seldom meet at a counter and find in their caches what they have drawn before. A
 * phase with little work is its thread's own; one with some more is open to threads that look
 * for work anyway; and those that sleep are woken for what is worth it, by what is known before or by the time that it
 * turns out to take.
 *
 * A round ends early when its records outgrow the caches: tiles then find in them what geometry has written, and
 * the next round writes to the same place.
 *
 * When the arena fills up, the chunk that ran out of it stops where it is, later ones are given up, and the
 * next round begins at the first primitive not done: memory is bounded whatever is drawn. */
#ifndef DRAW_FRAME_H
#define DRAW_FRAME_H

#include "draw/batch.h"
#include "draw/pool.h"
#include "draw/tile.h"

enum {
    FRAME_COMMANDS = 1024, /* the queue's capacity */
    FRAME_CHUNKS = 4096,   /* chunks of a round, at most */
    CHUNK_PRIMITIVES = 2048,
    TILE_PARTS = 16,
    TASK_PRIMITIVES = 64,  /* of the chunks that a thread takes at once, at least, if there are as many */
    ROUND_BYTES = 1 << 20, /* of the arena, for each thread: chunks that begin beyond are the next round's */
    TASKS_MAXIMUM = FRAME_CHUNKS > TARGET_TILES_MAXIMUM ? FRAME_CHUNKS : TARGET_TILES_MAXIMUM
};

_Static_assert(TASKS_MAXIMUM <= UINT16_MAX + 1, "tasks are numbered with 16 bits");

/* A run of one draw's primitives, or a clear. */
struct chunk {
    uint32_t command;
    uint32_t first, count; /* primitives */
    uint32_t done;         /* how many of them are in the bins */
    uint32_t heads;        /* head cells of its bins */
    uint32_t wide;         /* see struct bin_writer */
    uint32_t covered;      /* of the bins */
    uint64_t pixels;       /* as well */
    struct batch_counts counts;
};

struct frame_worker {
    struct batch batch;
    struct bin_writer bins;
    struct tile_worker tile;
    uint64_t geometry_ns, tiles_ns;
};

struct frame_statistics { /* of what frame_wait has seen rendered */
    uint64_t vertices_shaded, triangles_set_up, triangles_visible, pixels_shaded;
    uint64_t geometry_ns, tiles_ns; /* summed over threads */
    uint64_t rounds;
    uint64_t starved_rounds; /* of them, those that got nothing done */
};

struct queue {
    struct command *command; /* FRAME_COMMANDS of them */
    struct job *job;         /* as many: no draw needs more than one */
};

struct frame {
    /* What is recorded, in lines that no other thread looks at. */
    alignas(64) struct command *command;
    struct job *job;
    uint32_t commands, jobs;
    struct queue other; /* null: there is none */

    /* What is rendered. */
    alignas(64) struct pool *pool;
    const struct command *rendered;
    uint32_t rendered_commands;
    bool rendering;      /* in the background, or nobody has waited for it yet */
    unsigned leader;     /* the worker that does what one alone does */
    enum pool_call call; /* who was asked to the phase */
    struct target *target;
    uint32_t farthest; /* the word of its greatest depth */
    struct arena arena;
    _Atomic uint64_t *passed;    /* samples that passed the tests of each draw whose key counts */
    struct frame_worker *worker; /* one per thread of the pool */

    /* The round. */
    struct chunk chunk[FRAME_CHUNKS];
    uint32_t chunks;
    uint32_t
        chunk_task[FRAME_CHUNKS + 1]; /* the first chunk of each task of the geometry phase, and the end */
    uint32_t chunk_tasks;
    uint32_t primitives;
    uint32_t everywhere[FRAME_CHUNKS]; /* numbers of the chunks that are clears, or have wide triangles */
    uint32_t everywhere_count;
    uint32_t
        wide_start[FRAME_CHUNKS]; /* of them, those whose wide triangles overwrite tiles that they cover */
    uint32_t wide_starts;
    uint32_t tile_first[TARGET_TILES_MAXIMUM]; /* head cells of each tile's bin */
    uint32_t tile_last[TARGET_TILES_MAXIMUM];
    uint32_t
        tile_start[TARGET_TILES_MAXIMUM]; /* behind the last chunk whose bin has a triangle that overwrites
                                                  the tile; 0: there is none */
    uint16_t busy[TARGET_TILES_MAXIMUM];  /* the tiles that have one, in no order that matters */
    uint32_t busy_count;
    uint32_t tile_tasks; /* of the tile phase: the busy tiles, or all of them if a chunk is everywhere */
    uint64_t pixels;     /* of the bounds of what the tile phase draws */
    _Atomic uint32_t first_stopped;         /* the first chunk that did not fit the arena */
    alignas(64) _Atomic uint32_t next_task; /* of the geometry phase */
    uint32_t parts;                         /* that the tasks of the tile phase are in */
    struct {
        alignas(64) _Atomic uint32_t next; /* task */
    } part[TILE_PARTS];

    alignas(
        64) uint64_t shuffle; /* state of the random order in which tasks are handed out; 0: as they come */
    uint16_t order[TASKS_MAXIMUM]; /* of the tasks of a phase, when shuffled */

    struct frame_statistics statistics, unseen; /* of what nobody has waited for yet */
};

/* A frame whose rendering runs on `pool` with an arena of `arena_bytes` (draw/bin.h; 0: ARENA_BYTES); null
 * with the reason when memory is short. */
struct frame *frame_create(struct pool *pool, uint32_t arena_bytes, struct error *error);
void frame_destroy(struct frame *frame);

/* The place of the next job; there is one for each command. It counts once frame->jobs is increased. */
static inline struct job *frame_next_job(struct frame *frame)
{
    return frame->job + frame->jobs;
}

/* The place of the next command; null when the queue is full. It counts once frame->commands is increased. */
struct command *frame_next(struct frame *frame);

/* Renders all commands that are recorded, in order, into the target; the queue is empty then. `passed` has the counts of
 * the rendered ones. Nothing is being rendered. */
void frame_render(struct frame *frame, struct target *target);

/* The same in the background: until frame_wait nobody touches the target, nor what commands refer to. There must be
 * threads for it (frame_has_threads). */
void frame_start(struct frame *frame, struct target *target);
bool frame_has_threads(const struct frame *frame);
/* Returns when what was started is rendered. */
void frame_wait(struct frame *frame);

static inline const struct command *frame_command(const struct frame *frame, uint32_t chunk)
{
    return frame->rendered + frame->chunk[chunk].command;
}

#endif
