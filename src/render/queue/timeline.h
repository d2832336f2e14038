/* A timeline: what a queue of one thread does, part by part, with the time of each task. A simulation of more
 * threads reads it (command/simulate/simulate.h).
 *
 * The parts are in the order of execution. A part of tasks can be shared out among threads, and the next part
 * begins when all of its tasks have ended. A part without tasks is serial. The application's part ends when
 * a buffer of commands is handed over; with threads, buffers are rendered in the background while the
 * application fills the next one. */
#ifndef RENDER_QUEUE_TIMELINE_H
#define RENDER_QUEUE_TIMELINE_H

#include <stdbool.h>
#include <stdint.h>

enum timeline_kind {
    TIMELINE_SUBMIT,   /* serial: the application fills a buffer of commands */
    TIMELINE_CUT,      /* serial: commands become chunks */
    TIMELINE_GEOMETRY, /* tasks: runs of chunks */
    TIMELINE_LINK,     /* bins of chunks become those of tiles: serial, and in large rounds tasks too */
    TIMELINE_TILES,    /* tasks: tiles, or rows of them */
    TIMELINE_MOVE,     /* tasks: tiles that are moved, or transferred to texels and back */
    TIMELINE_KINDS
};

struct timeline_part {
    enum timeline_kind kind;
    bool background;       /* TIMELINE_SUBMIT: with threads, the buffer is rendered in the background */
    uint32_t first, tasks; /* in task_ns */
    uint64_t ns;           /* of the whole part, its tasks included */
    uint64_t estimate_ns;  /* of the tasks, as the queue estimates them before (render/queue/phase.h) */
};

/* Zero, but for the threads: nothing is recorded so far. */
struct timeline {
    unsigned threads; /* rounds are made as large as with this number of threads */
    struct timeline_part *part;
    uint32_t *task_ns;
    uint32_t parts, part_capacity, tasks, task_capacity;
    uint64_t mark;   /* the end of the last task, or the beginning of the part */
    uint64_t begun;  /* the beginning of the part */
    bool incomplete; /* memory was refused */
};

/* Forgets all parts, and begins the application's. */
void timeline_restart(struct timeline *timeline);
void timeline_free(struct timeline *timeline);

/* Begin a part, end one of its tasks, and end the part. Nothing is recorded in a null timeline. */
void timeline_begin(struct timeline *timeline, enum timeline_kind kind, uint64_t estimate_ns);
void timeline_task(struct timeline *timeline);
void timeline_end(struct timeline *timeline);

/* Makes each time of samples[0] the median of the same part or task of all samples. Returns false if they do
 * not have the same parts and tasks, or if memory is refused. */
bool timeline_take_medians(struct timeline *samples, unsigned count);

#endif
