/* The verification of one stream.
 *
 * The reference is the emulator with one thread. It draws each frame once and keeps colours, depths and
 * stencils. Every other configuration draws the same frame on its own device and is compared immediately, so
 * memory does not grow with the number of frames. A device exists from its first frame to its last, so that
 * the devices for one frame use the same memory in turn. A configuration that differs is reported with its
 * first differing frame and skips the stream's remaining frames. */
#ifndef COMMAND_TOOL_VERIFY_STREAM_H
#define COMMAND_TOOL_VERIFY_STREAM_H

#include "command/support/choose.h"
#include "command/support/option.h"
#include "command/tool/verify_results.h"

extern const char verify_reference[]; /* the name of the engine */

/* The options of `triptych verify`, and the engines, threads and settings that they select. */
struct verify_settings {
    const char *engine_list, *thread_list, *setting_list, *frames_text, *json, *shard, *resume;
    struct golden golden; /* without a folder: none */
    struct variation variation;
    struct option_given set;
    unsigned precision;
    struct choice engines, threads;
    struct settings_choice renderer; /* settings of all configurations but the reference */
    const char *folder;              /* for pictures of differences, or null */
    bool all_frames, no_cache;
    unsigned frames;  /* the number to draw, spread over a longer stream */
    unsigned shuffle; /* seed of the order of tasks in all configurations but the reference; 0: in order */
    struct verify_results results;
};

/* The number of streams so far. */
struct verify_totals {
    unsigned streams, complete, different; /* with units in the shard; of these */
};

/* Verifies stream `number` of the operands and reports it, unless no engine is selected for it. */
int verify_stream(const struct command *self, const char *path, unsigned number,
                  struct verify_settings *settings, struct verify_totals *totals);

/* The verdict on the streams so far. */
enum verify_verdict verify_judge(const struct verify_settings *settings, const struct verify_totals *totals);

#endif
