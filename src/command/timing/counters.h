/* The counters of a device that times its routines and phases. */
#ifndef COMMAND_TIMING_COUNTERS_H
#define COMMAND_TIMING_COUNTERS_H

#include "contract/key.h"

struct triptych_device;

/* Since the device was made; the meaning of the others is in render/queue/queue.h. */
struct timing_counters {
    uint64_t routine_ns[UNIT_ALL];
    uint64_t vertices_read; /* struct device_counts */
    uint64_t vertices_shaded, triangles_set_up, triangles_visible, pixels_shaded, pixel_calls;
    uint64_t geometry_ns, tiles_ns, geometry_wall_ns, tiles_wall_ns;
    uint64_t tiles, tile_triangles, rounds;
    uint64_t records_bytes; /* the most of all rounds */
    unsigned threads;
};

void timing_read(struct triptych_device *device, struct timing_counters *counters);

/* Subtracts an earlier reading from all but the last two. */
void timing_subtract(struct timing_counters *counters, const struct timing_counters *before);

#endif
