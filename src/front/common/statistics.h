/* Frames, times, draws and routines of a device, as a file for measurements of programs:
 * TRIPTYCH_STATISTICS=FILE.
 *
 * The file is one JSON object:
 *   "engine"                   the engine's name
 *   "frames"                   presented frames
 *   "first_frame_ms"           from the creation of the device to the end of the first frame
 *   "longest_frame_ms"         between the ends of two frames in a row
 *   "total_ms"                 from the end of the first frame to the end of the last
 *   "draws", "triangles"       of all frames
 *   "cache_hits", "cache_misses", "cache_evictions"    of the cache of routines
 *   "routines"                 routines in the cache by unit: "vertex", "setup", "pixel"
 *   "routines_of_a_frame"      routines that the draws of one frame use, the mean over every 64th frame
 *   "build_ms"                 the time that building the routines took
 * It is written at the end of the device, and once a second, because many programs are ended before they
 * destroy their device. A device without frames writes nothing. */
#ifndef FRONT_STATISTICS_H
#define FRONT_STATISTICS_H

#include "triptych.h"

#include <stdint.h>

struct front_statistics {
    const char *path; /* null: nothing is measured */
    uint64_t created_ns, first_ns, last_ns, longest_ns, written_ns;
    uint64_t frames;
    uint64_t *hits;         /* of each routine before a frame whose routines are counted */
    unsigned known;         /* entries of `hits` */
    uint64_t used, counted; /* routines that counted frames used, counted frames */
};

/* Begins to measure if the environment names a file. */
void front_statistics_begin(struct front_statistics *);
/* Counts a frame: called at the end of each Present and swap. */
void front_statistics_frame(struct front_statistics *, triptych_device *renderer);
/* Writes the file: called before the renderer's device is destroyed. */
void front_statistics_end(struct front_statistics *, triptych_device *renderer);

#endif
