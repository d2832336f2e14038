/* Changes of the target and transfers between tiles and texels: phases whose tasks are the tiles of an
 * attachment. */
#include "render/queue/queue.h"

enum { MOVE_NS = 2000 }; /* of a tile's words, or of its texels */

/* A phase whose tasks are the tiles of an attachment. */
struct tile_work {
    struct queue *queue;
    const struct tile_move *move; /* or null: */
    const struct surface_transfer *transfer;
};

static void work_task(void *user, unsigned number)
{
    const struct tile_work *work = user;
    uint32_t first, count;
    while ((count = phase_take(&work->queue->phase, number, &first)))
        for (uint32_t i = first; i < first + count; i++) {
            uint32_t tile = phase_task(&work->queue->phase, i);
            if (work->move)
                target_move_tile(work->move, tile);
            else
                surface_transfer_tile(work->transfer, tile);
            timeline_task(work->queue->timeline);
        }
}

static void run_work(struct queue *queue, struct tile_work work, const struct attachment *attachment)
{
    uint32_t tiles = attachment->columns * attachment->rows;
    uint64_t ns = (uint64_t)tiles * MOVE_NS;
    timeline_begin(queue->timeline, TIMELINE_MOVE, ns);
    phase_make_parts(&queue->phase, tiles, ns);
    phase_run(&queue->phase, tiles, ns, work_task, &work);
    timeline_end(queue->timeline);
}

void queue_run_transfer(struct queue *queue, const struct surface_transfer *transfer)
{
    run_work(queue, (struct tile_work){queue, NULL, transfer}, transfer->attachment);
}

void queue_run_change(struct queue *queue, struct target *target)
{
    for (uint32_t i = 0; i < target->moves; i++)
        run_work(queue, (struct tile_work){queue, &target->move[i], NULL}, target->move[i].attachment);
    struct round *const rounds[] = {&queue->round, queue->second};
    for (int i = 0; i < 2 && rounds[i]; i++) {
        rounds[i]->target = target;
        rounds[i]->farthest = depth_encode(target->depth_format, 1);
    }
}

void queue_change_target(struct queue *queue, struct target *target)
{
    queue->phase.leader = 0;
    timeline_end(queue->timeline);
    queue_run_change(queue, target);
    timeline_begin(queue->timeline, TIMELINE_SUBMIT, 0);
}

void queue_transfer(struct queue *queue, const struct surface_transfer *transfer)
{
    queue->phase.leader = 0;
    timeline_end(queue->timeline);
    queue_run_transfer(queue, transfer);
    timeline_begin(queue->timeline, TIMELINE_SUBMIT, 0);
}
