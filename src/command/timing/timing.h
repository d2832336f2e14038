/* `triptych bench --stages`: the time of each stage of the renderer, the idle time of threads, and the work
 * that the stages do, for each stream and engine. */
#ifndef COMMAND_TIMING_TIMING_H
#define COMMAND_TIMING_TIMING_H

#include "command/support/choose.h"
#include "command/support/json.h"

struct timing_settings {
    unsigned threads, frames;     /* frames 0: all */
    bool curve;                   /* also with 1, 2, 4 ... threads */
    double seconds;               /* of an engine on a stream, after one pass that builds routines */
    struct setting_values values; /* of the renderer */
};

/* Draws the streams and prints a table. `report`, which may be null, receives "stages", a row for each
 * stream, engine and number of threads:
 *
 *   frame_ns                            of the clock, without resolve_ns
 *   vertex_ns, setup_ns, pixel_ns       in routines, a frame, summed over threads
 *   geometry_ns, tiles_ns               outside of routines: assembly, clipping, bins; rasterizer
 *   all_ns                              in both phases
 *   geometry_idle, tiles_idle           share of the threads' time in a phase that none of them uses
 *   resolve_ns                          tiles to rows of a picture
 *   vertices_shaded, vertices_read      a frame; read: all between the least and the greatest of a draw
 *   triangles_set_up, triangles_visible
 *   tile_triangles                      pairs of a tile and a triangle that is tested in it
 *   pixels_shaded, overdraw             a frame; for each pixel of the target
 *   pixel_calls                         calls of pixel routines in a tile that something is drawn to
 *   rounds, records_bytes               a frame; most bytes that a round's records and bins have
 *
 * Returns 0, or STATUS_BAD after printing the reason. */
int timing_run(const struct command *self, char **paths, unsigned count, const struct choice *engines,
               const struct timing_settings *settings, cJSON *report);

#endif
