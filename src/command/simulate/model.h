/* A model of the renderer with more threads than the machine has: it replays the tasks of a timeline
 * (render/queue/timeline.h), each with its measured time, on simulated threads.
 *
 * The model follows the queue. The application fills buffers on thread 0, and waits for the previous buffer
 * before it hands one over. Serial parts run on the thread that leads. A part of tasks invites the threads
 * that its estimate permits, threads take tasks in the order and in runs of the size that the renderer's own
 * function gives (phase_take), and the part ends when all have left. Entering, waking, taking and leaving
 * cost the times that a measurement of two threads has (handover.h); sleeping threads are woken in a tree;
 * only one thread at a time takes from a counter.
 *
 * Not in the model: tasks take as long as on one thread, so shared caches and memory are as fast for all
 * threads as for one, and so is the processor's clock. */
#ifndef COMMAND_SIMULATE_MODEL_H
#define COMMAND_SIMULATE_MODEL_H

#include "command/simulate/handover.h"
#include "render/queue/timeline.h"

enum { MODEL_THREADS_MAXIMUM = 256 };

/* Nanoseconds of one frame. */
struct model_time {
    double frame;
    double part[TIMELINE_KINDS]; /* of the clock, while parts of this kind ran and the application waited */
    double busy;                 /* of all threads, in tasks and serial parts */
};

/* Returns 0, or -1 with the reason when memory is short. */
int model_run(const struct timeline *timeline, unsigned threads, const struct handover *costs,
              struct model_time *time, struct error *error);

#endif
