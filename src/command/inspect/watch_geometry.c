/* Vertices and setup: the records of each primitive, and the touches of primitives that miss the pixel. */
#include "command/inspect/watch_part.h"

#include <stdlib.h>
#include <string.h>

/* --- Touches -------------------------------------------------------------------------------------------- */

struct touch *watch_new_touch(struct watch *watch, const struct watch_placed *placed, enum touch_kind kind)
{
    if (watch->touch_count == watch->touch_capacity) {
        uint32_t capacity = watch->touch_capacity ? 2 * watch->touch_capacity : 16;
        struct touch *larger =
            capacity <= TOUCHES_MAXIMUM ? realloc(watch->touch, capacity * sizeof *larger) : NULL;
        if (!larger) {
            watch->incomplete |= capacity > TOUCHES_MAXIMUM;
            watch->starved |= capacity <= TOUCHES_MAXIMUM;
            return NULL;
        }
        watch->touch = larger;
        watch->touch_capacity = capacity;
    }
    struct touch *touch = watch->touch + watch->touch_count++;
    *touch = (struct touch){.kind = kind,
                            .order = watch->touch_count,
                            .instance = placed->instance,
                            .primitive = placed->primitive,
                            .vertices = placed->vertices,
                            .clipped = placed->clipped};
    memcpy(touch->vertex, placed->vertex, sizeof touch->vertex);
    return touch;
}

/* --- Vertices ------------------------------------------------------------------------------------------- */

/* A batch is one primitive. Lanes up to the end of the routine's step repeat its last vertex. */
void watch_vertices(const void *arguments, const struct routine *routine)
{
    const struct vertex_arguments *call = arguments;
    struct watch *watch = watch_of(routine);
    watch_routine(routine)->inner->run(arguments, watch_routine(routine)->inner);
    watch->vertices = 0;
    for (uint32_t i = 0; i < call->count && watch->vertices < TOUCH_VERTICES; i++)
        if (!i || call->index[i] != watch->vertex[watch->vertices - 1])
            watch->vertex[watch->vertices++] = call->index[i];
    if (call->job == watch->job)
        return;
    watch->job = call->job;
    watch->instances++;
}

/* --- Setup ---------------------------------------------------------------------------------------------- */

/* Lanes up to the end of the routine's step repeat the last record. */
static bool repeats(const struct setup_arguments *call, uint32_t i)
{
    const uint32_t *index = call->index + i;
    for (int row = 0; row < 3 && i; row++)
        if (index[row * SETUP_CAPACITY] != index[row * SETUP_CAPACITY - 1])
            return false;
    return i;
}

/* Returns true if any record of the call has a vertex that the clipper made. */
static bool is_clipped(const struct watch *watch, const struct setup_arguments *call)
{
    for (uint32_t i = 0; i < call->count; i++)
        for (int row = 0; row < 3; row++)
            if (call->index[row * SETUP_CAPACITY + i] / 4 >= watch->vertices)
                return true;
    return false;
}

/* Notes where the records of the call are. The addresses of a round increase. Records that are dropped, or
 * set up again because the arena was full, leave their addresses to later ones. */
static struct watch_placed *place(struct watch *watch, const struct setup_arguments *call)
{
    if (watch->in_tiles)
        watch->placed_count = 0;
    watch->in_tiles = false;
    while (watch->placed_count && watch->placed[watch->placed_count - 1].address >= call->out)
        watch->placed_count--;
    if (watch->placed_count == watch->placed_capacity) {
        uint32_t capacity = watch->placed_capacity ? 2 * watch->placed_capacity : 1024;
        struct watch_placed *larger = realloc(watch->placed, capacity * sizeof *larger);
        if (!larger) {
            watch->starved = true;
            return NULL;
        }
        watch->placed = larger;
        watch->placed_capacity = capacity;
    }
    uint32_t parts = device_parts(watch->device->derived.now->draw.primitive);
    struct watch_placed *placed = watch->placed + watch->placed_count++;
    *placed = (struct watch_placed){.address = call->out,
                                    .instance = watch->instances - 1,
                                    .primitive = call->primitive / parts,
                                    .vertices = watch->vertices,
                                    .clipped = is_clipped(watch, call)};
    memcpy(placed->vertex, watch->vertex, sizeof placed->vertex);
    return placed;
}

const struct watch_placed *watch_find_placed(const struct watch *watch, const uint8_t *record)
{
    uint32_t low = 0, high = watch->placed_count;
    while (low < high) {
        uint32_t middle = (low + high) / 2;
        if (watch->placed[middle].address <= record)
            low = middle + 1;
        else
            high = middle;
    }
    return low ? watch->placed + low - 1 : NULL;
}

/* Returns true if the record covers any sample of the pixel within the rectangle. */
static bool covers(struct watch *watch, const struct triangle_head *head, const struct rectangle *within)
{
    const struct draw *draw = &watch->device->derived.now->draw;
    uint32_t x = (uint32_t)watch->x, y = (uint32_t)watch->y;
    uint32_t word = pixel_word(x % TILE_SIZE, y % TILE_SIZE);
    struct rectangle bounds;
    if (!raster_sampled_bounds(&draw->sampling, draw->shape, head, within, &bounds) || watch->x < bounds.x0 ||
        watch->x >= bounds.x1 || watch->y < bounds.y0 || watch->y >= bounds.y1)
        return false;
    uint32_t count = raster_sampled_tile(&draw->sampling, draw->shape, head, within, (int)(x / TILE_SIZE),
                                         (int)(y / TILE_SIZE), 0, &watch->entries, 0);
    for (uint32_t i = 0; i < count; i++)
        if (watch->entries.entry[i].block == word / BLOCK_PIXELS)
            return watch->entries.entry[i].coverage >> word % BLOCK_PIXELS & 1;
    return false;
}

static bool in_rectangle(const struct rectangle *r, int32_t x, int32_t y)
{
    return x >= r->x0 && x < r->x1 && y >= r->y0 && y < r->y1;
}

/* Why a record does not reach the pixel; TOUCH_DRAWN: for no reason that is looked for, or it does. */
static enum touch_kind absence(struct watch *watch, const struct triangle_head *drawn,
                               const struct triangle_head *unculled)
{
    const struct target *target = device_rendered_target(watch->device);
    const struct rectangle *scissor = &watch->device->derived.now->draw.scissor;
    const struct rectangle whole = {0, 0, (int32_t)target->width, (int32_t)target->height};
    bool inside = in_rectangle(scissor, watch->x, watch->y);
    if (drawn->visible && !inside && covers(watch, drawn, &whole))
        return TOUCH_SCISSORED;
    if (!drawn->visible && unculled && unculled->visible && inside && covers(watch, unculled, scissor))
        return TOUCH_CULLED;
    return TOUCH_DRAWN;
}

static void note_absent(struct watch *watch, const struct watched *self, const struct setup_arguments *call,
                        const struct watch_placed *placed)
{
    size_t stride = self->layout.stride;
    struct setup_arguments again = *call;
    again.out = watch->scratch;
    bool unculled = self->unculled && call->count * stride <= sizeof watch->scratch;
    if (unculled)
        self->unculled->run(&again, self->unculled);
    for (uint32_t i = 0; i < call->count; i++) {
        const void *drawn = call->out + i * stride, *other = watch->scratch + i * stride;
        if (repeats(call, i))
            continue;
        enum touch_kind kind = absence(watch, drawn, unculled ? other : NULL);
        if (kind != TOUCH_DRAWN)
            watch_new_touch(watch, placed, kind);
    }
}

void watch_setup(const void *arguments, const struct routine *routine)
{
    const struct setup_arguments *call = arguments;
    const struct watched *self = watch_routine(routine);
    struct watch *watch = watch_of(routine);
    self->inner->run(arguments, self->inner);
    const struct watch_placed *placed = place(watch, call);
    if (placed && watch->x >= 0)
        note_absent(watch, self, call, placed);
}
