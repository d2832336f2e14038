#include "command/timing/counters.h"

#include "render/device/device.h"

#include <string.h>

static enum unit unit_of(const char *name)
{
    enum unit unit = 0;
    while (unit + 1 < UNIT_ALL && strcmp(unit_name[unit], name))
        unit++;
    return unit;
}

void timing_read(struct triptych_device *device, struct timing_counters *counters)
{
    struct triptych_routine_info info;
    const struct queue_statistics *queue = &device->queue->statistics;
    *counters = (struct timing_counters){
        .vertices_read = device->counts.vertices,
        .vertices_shaded = queue->vertices_shaded,
        .triangles_set_up = queue->triangles_set_up,
        .triangles_visible = queue->triangles_visible,
        .pixels_shaded = queue->pixels_shaded,
        .pixel_calls = queue->pixel_calls,
        .geometry_ns = queue->geometry_ns,
        .tiles_ns = queue->tiles_ns,
        .geometry_wall_ns = queue->geometry_wall_ns,
        .tiles_wall_ns = queue->tiles_wall_ns,
        .tiles = queue->tiles,
        .tile_triangles = queue->tile_triangles,
        .rounds = queue->rounds,
        .records_bytes = queue->records_bytes,
        .threads = pool_limited(device->pool),
    };
    for (unsigned i = 0; triptych_get_routine(device, i, &info); i++)
        counters->routine_ns[unit_of(info.unit)] += info.run_ns;
}

#define SUBTRACT(member) counters->member -= before->member

void timing_subtract(struct timing_counters *counters, const struct timing_counters *before)
{
    for (int unit = 0; unit < UNIT_ALL; unit++)
        SUBTRACT(routine_ns[unit]);
    SUBTRACT(vertices_read);
    SUBTRACT(vertices_shaded);
    SUBTRACT(triangles_set_up);
    SUBTRACT(triangles_visible);
    SUBTRACT(pixels_shaded);
    SUBTRACT(pixel_calls);
    SUBTRACT(geometry_ns);
    SUBTRACT(tiles_ns);
    SUBTRACT(geometry_wall_ns);
    SUBTRACT(tiles_wall_ns);
    SUBTRACT(tiles);
    SUBTRACT(tile_triangles);
    SUBTRACT(rounds);
}
