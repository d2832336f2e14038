/* `triptych bench --tasks`: the time of a frame with more threads than the machine has, by simulation. */
#ifndef COMMAND_SIMULATE_SIMULATE_H
#define COMMAND_SIMULATE_SIMULATE_H

#include "command/support/choose.h"
#include "command/support/json.h"

struct simulate_settings {
    unsigned threads;             /* the most that are simulated; 1, 2, 4 ... up to it */
    unsigned frames;              /* 0: all */
    unsigned repetitions;         /* of each frame; the time of each task is a median */
    struct setting_values values; /* of the renderer */
};

/* Records the tasks of each frame on one thread, simulates more threads (command/simulate/model.h), and
 * prints a table. With as many threads as the process has processors, the frames are also drawn with them.
 * `report` receives "handover", the costs that the model has, and "tasks", a row for each
 * stream, engine and number of threads:
 *
 *   frame_ns            simulated, mean of the frames
 *   speedup             of the simulated frame over that of one thread
 *   efficiency          share of the threads' time that is in tasks
 *   submit_ns ...       of the clock, in each kind of part (render/queue/timeline.h)
 *   measured_ns         the same frames drawn with that number of threads; only where there are processors
 *
 * Returns 0, or STATUS_BAD after printing the reason. */
int simulate_run(const struct command *self, char **paths, unsigned count, const struct choice *engines,
                 const struct simulate_settings *settings, cJSON *report);

#endif
