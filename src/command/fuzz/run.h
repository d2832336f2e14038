/* The runner: draws a case with every engine, width and number of threads, and compares every bit that was
 * drawn: the tiles of the target, of images and of surfaces of textures with all their samples, depth and
 * stencil words, the texels of every texture, the counts of queries. The first engine with the first number
 * of threads and the default settings of the renderer is the reference.
 *
 * Devices are made once and draw all cases, so that the remains of one case in a device can show in another.
 * A device draws a case once for each number of threads, with the routines that it already has. */
#ifndef COMMAND_FUZZ_RUN_H
#define COMMAND_FUZZ_RUN_H

#include "base/error.h"
#include "contract/engine.h"
#include "setting/setting.h"

#include <stddef.h>

enum outcome {
    OUTCOME_SAME,
    OUTCOME_REFUSED,   /* no valid stream; the reason is in `what` */
    OUTCOME_LIMITED,   /* valid, but an engine reported one of its documented limits */
    OUTCOME_DIFFERENT, /* something has other bits */
    OUTCOME_FAILED,    /* an engine could not draw what the reference draws */
    OUTCOME_CRASHED,   /* (campaigns) the process ended */
    OUTCOME_HUNG,      /* (campaigns) it took too long */
    OUTCOME_COUNT
};

extern const char *const outcome_name[OUTCOME_COUNT]; /* "same", "refused", ... */

enum { RUNNER_ENGINES = 65, RUNNER_THREADS = 8, FINDING_TEXT = 320 };

struct finding {
    enum outcome outcome;
    const struct engine *engine; /* the one that is unlike the reference, or null */
    unsigned threads;
    struct setting_values settings; /* of the renderer */
    char what[FINDING_TEXT];        /* one line */
};

/* The configurations; the first engine is the reference. */
struct runner_options {
    const struct engine *engine[RUNNER_ENGINES];
    unsigned engines;
    unsigned thread[RUNNER_THREADS]; /* numbers of threads */
    unsigned threads;
};

struct runner;

/* Null with the reason. */
struct runner *runner_create(const struct runner_options *options, struct error *error);
void runner_destroy(struct runner *runner); /* null is allowed */

/* Draws all frames of a stream's text, all but the reference with these settings. `path` is where the files
 * that it names are looked for, and its name in reasons. */
enum outcome runner_run(struct runner *runner, const char *path, const char *text, size_t bytes,
                        const struct setting_values *settings, struct finding *finding);

/* How many pixels the reference has covered so far: an eye on whether cases draw anything. */
uint64_t runner_pixels(const struct runner *runner);

#endif
