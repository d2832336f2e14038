#include "command/inspect/watch_part.h"

#include "emu/emulate/emulate.h"
#include "machine/mxcsr.h"

#include <stdlib.h>
#include <string.h>

/* --- Pixels --------------------------------------------------------------------------------------------- */

/* A quad of an entry. */
struct quad {
    const struct watched *self;
    const struct pixel_arguments *call;
    const struct entry *entry;
    uint32_t lane; /* its first, in the block */
};

/* The column and row of a lane of a block (contract/layout.h). */
static int32_t lane_x(uint32_t lane)
{
    return (int32_t)((lane & 1) | (lane >> 1 & 2));
}

static int32_t lane_y(uint32_t lane)
{
    return (int32_t)((lane >> 1 & 1) | (lane >> 2 & 2));
}

static void observe_quad(struct watch *watch, const struct quad *quad)
{
    const struct pixel_arguments *call = quad->call;
    const struct watched *self = quad->self;
    size_t word = (size_t)quad->entry->block * BLOCK_PIXELS + quad->lane;
    const uint8_t *base[BASE_COUNT] = {0};
    base[BASE_JOB] = (const uint8_t *)call->job;
    if (self->program)
        base[BASE_CONSTANT] = (const uint8_t *)call->job->constants[self->program->model->stage];
    base[BASE_ENTRY] = (const uint8_t *)quad->entry;
    base[BASE_TRIANGLE] = call->triangles + quad->entry->triangle;
    base[BASE_LANES] = (const uint8_t *)call->lanes + 4 * quad->lane;
    base[BASE_COLOR] = (const uint8_t *)(call->color + word);
    base[BASE_DEPTH] = (const uint8_t *)(call->depth + word);
    observe_pixels(&watch->sight, &self->routine.key.pixel, self->program, &self->layout, base);
}

/* Returns true if any sample of the lane passes all tests. */
static bool lane_passes(const struct sight *sight, unsigned lane)
{
    if (!observe_passes(sight, OBSERVED_kept, 0, lane) || !observe_passes(sight, OBSERVED_alpha, 0, lane))
        return false;
    for (unsigned i = 0; i < OBSERVED_NUMBERS; i++)
        if (sight->seen[OBSERVED_covered] >> i & 1 && sight->value[OBSERVED_covered][i][0][lane] &&
            observe_passes(sight, OBSERVED_remaining, i, lane) &&
            observe_passes(sight, OBSERVED_stencil, i, lane) &&
            observe_passes(sight, OBSERVED_depth, i, lane))
            return true;
    return false;
}

static void own(struct watch *watch, const struct quad *quad, size_t pixel)
{
    const struct watch_placed *placed =
        watch_find_placed(watch, quad->call->triangles + quad->entry->triangle);
    if (placed)
        watch->owner[pixel] = (struct watch_owner){watch->draw + 1, placed->primitive};
}

static void count_lane(struct watch *watch, const struct quad *quad, unsigned lane)
{
    const struct sight *sight = &watch->sight;
    uint32_t x = (uint32_t)((int32_t)quad->entry->x + lane_x(quad->lane + lane));
    uint32_t y = (uint32_t)((int32_t)quad->entry->y + lane_y(quad->lane + lane));
    bool shaded = sight->seen[OBSERVED_shaded] && sight->value[OBSERVED_shaded][0][0][lane];
    bool passed = lane_passes(sight, lane);
    bool counted = watch->what == WATCH_COVERED || (watch->what == WATCH_SHADED ? shaded : passed);
    watch->counts.covered++;
    watch->counts.shaded += shaded;
    watch->counts.passed += passed;
    if (watch->count)
        watch->count[(size_t)y * device_rendered_target(watch->device)->width + x] += counted;
    if (watch->owner && passed && pixel_write_mask(&quad->self->routine.key.pixel))
        own(watch, quad, (size_t)y * device_rendered_target(watch->device)->width + x);
}

static struct touch_tests tests_of(const struct quad *quad, bool clockwise)
{
    const struct pixel_key *key = &quad->self->routine.key.pixel;
    const struct job *job = quad->call->job;
    int side = key->stencil == STENCIL_TWO && !clockwise ? SIDE_COUNTERCLOCKWISE : SIDE_CLOCKWISE;
    bool second = key->stencil_values == STENCIL_VALUES_EACH ? side == SIDE_COUNTERCLOCKWISE
                                                             : key->stencil_values == STENCIL_VALUES_SECOND;
    return (struct touch_tests){.depth = key->depth_function,
                                .alpha = (uint8_t)(COMPARE_ALWAYS - key->alpha_discard),
                                .stencil = key->stencil_function[side],
                                .alpha_reference = job->alpha_reference,
                                .stencil_reference =
                                    second ? job->ccw_stencil_reference : job->stencil_reference,
                                .stencil_mask = second ? job->ccw_stencil_mask : job->stencil_mask};
}

static void note_sight(struct touch *touch, const struct sight *sight, unsigned lane)
{
    memcpy(touch->seen, sight->seen, sizeof touch->seen);
    for (int name = 0; name < OBSERVED_COUNT; name++)
        for (int number = 0; number < OBSERVED_NUMBERS; number++)
            for (int part = 0; part < OBSERVED_PARTS; part++)
                touch->value[name][number][part] = sight->value[name][number][part][lane];
}

/* Observes the quad with the pixel, which is its lane number `lane`. */
static void touch_quad(struct watch *watch, const struct quad *quad, unsigned lane)
{
    const uint8_t *record = quad->call->triangles + quad->entry->triangle;
    const struct triangle_head *head = (const struct triangle_head *)(const void *)record;
    const struct watch_placed *placed = watch_find_placed(watch, record);
    struct target *target = device_rendered_target(watch->device);
    struct touch *touch = placed ? watch_new_touch(watch, placed, TOUCH_DRAWN) : NULL;
    if (touch)
        pixel_read(target, (uint32_t)watch->x, (uint32_t)watch->y, &touch->before);
    observe_quad(watch, quad);
    if (!touch)
        return;
    pixel_read(target, (uint32_t)watch->x, (uint32_t)watch->y, &touch->after);
    touch->tests = tests_of(quad, head->visible < 0);
    note_sight(touch, &watch->sight, lane);
}

/* The lane of the quad that is the pixel and is covered, or -1. */
static int pixel_lane(const struct watch *watch, const struct quad *quad)
{
    for (uint32_t l = 0; l < OBSERVED_LANES; l++)
        if (quad->entry->coverage >> (quad->lane + l) & 1 &&
            (int32_t)quad->entry->x + lane_x(quad->lane + l) == watch->x &&
            (int32_t)quad->entry->y + lane_y(quad->lane + l) == watch->y)
            return (int)l;
    return -1;
}

static void run_quad(struct watch *watch, const struct quad *quad)
{
    int lane = pixel_lane(watch, quad);
    if (lane >= 0)
        touch_quad(watch, quad, (unsigned)lane);
    else
        observe_quad(watch, quad);
    for (unsigned l = 0; l < OBSERVED_LANES; l++)
        if (quad->entry->coverage >> (quad->lane + l) & 1)
            count_lane(watch, quad, l);
}

static void run_pixel(const void *arguments, const struct routine *routine)
{
    const struct pixel_arguments *call = arguments;
    struct watch *watch = watch_of(routine);
    unsigned saved = mxcsr_enter();
    watch->in_tiles = true;
    for (uint32_t i = 0; i < call->count; i++) {
        struct quad quad = {watch_routine(routine), call, call->entries + i, 0};
        for (; quad.lane < BLOCK_PIXELS; quad.lane += OBSERVED_LANES)
            if (quad.entry->coverage >> quad.lane & ((1 << OBSERVED_LANES) - 1))
                run_quad(watch, &quad);
    }
    mxcsr_leave(saved);
}

/* --- The engine ----------------------------------------------------------------------------------------- */

static void free_watched(struct code_arena *arena, struct routine *routine)
{
    struct watched *self = (struct watched *)(void *)routine;
    if (self->inner)
        engine_emulate.free(arena, self->inner);
    if (self->unculled)
        engine_emulate.free(arena, self->unculled);
    free(self);
}

/* Blits are not observed. */
static void run_blit(const void *arguments, const struct routine *routine)
{
    const struct routine *inner = ((const struct watched *)(const void *)routine)->inner;
    inner->run(arguments, inner);
}

static struct routine *build(const struct engine *self, struct code_arena *arena, enum unit unit,
                             const union key *key, struct error *error)
{
    static routine_function *const run[UNIT_ALL] = {[UNIT_VERTEX] = watch_vertices,
                                                    [UNIT_SETUP] = watch_setup,
                                                    [UNIT_PIXEL] = run_pixel,
                                                    [UNIT_BLIT] = run_blit};
    struct watched *made = calloc(1, sizeof *made);
    union key unculled = *key;
    if (!made) {
        error_set(error, "out of memory for a routine");
        return NULL;
    }
    made->routine = (struct routine){.run = run[unit], .engine = self, .unit = unit, .key = *key};
    made->program = key_shader(unit, key);
    made->layout = layout_of_unit(unit, key);
    made->inner = engine_build(&engine_emulate, arena, unit, key, error);
    if (made->inner && unit == UNIT_SETUP && key->setup.cull != CULL_NONE) {
        unculled.setup.cull = CULL_NONE;
        made->unculled = engine_build(&engine_emulate, arena, unit, &unculled, error);
    }
    if (made->inner && (made->unculled || unit != UNIT_SETUP || key->setup.cull == CULL_NONE))
        return &made->routine;
    free_watched(arena, &made->routine);
    return NULL;
}

struct watch *watch_create(void)
{
    size_t bytes = (sizeof(struct watch) + WATCH_ALIGNMENT - 1) & -(size_t)WATCH_ALIGNMENT;
    struct watch *watch = aligned_alloc(WATCH_ALIGNMENT, bytes);
    if (!watch)
        return NULL;
    memset(watch, 0, bytes);
    watch->x = -1;
    watch->engine = (struct engine){.name = "watch",
                                    .description = "emulate, observed",
                                    .width = OBSERVED_LANES,
                                    .without_arena = true,
                                    .observes = true,
                                    .options = watch,
                                    .build = build,
                                    .free = free_watched};
    return watch;
}

void watch_free(struct watch *watch)
{
    if (!watch)
        return;
    free(watch->placed);
    free(watch->touch);
    free(watch);
}

struct triptych_device *watch_device(struct watch *watch, const struct setting_values *settings,
                                     struct error *error)
{
    const struct device_options options = {.threads = 1};
    if (device_create(&watch->engine, &options, &watch->device, error))
        return NULL;
    device_set_settings(watch->device, settings);
    return watch->device;
}

void watch_pixel(struct watch *watch, int32_t x, int32_t y)
{
    watch->x = x;
    watch->y = y;
}

void watch_count(struct watch *watch, uint32_t *count, enum watch_what what)
{
    watch->count = count;
    watch->what = what;
}

void watch_owners(struct watch *watch, struct watch_owner *owner)
{
    watch->owner = owner;
}

/* --- Draws ---------------------------------------------------------------------------------------------- */

void watch_begin(struct watch *watch, uint32_t draw)
{
    watch->draw = draw;
    watch->job = NULL;
    watch->instances = watch->placed_count = watch->touch_count = 0;
    watch->incomplete = watch->starved = false;
    watch->triangles_before = watch->device->counts.triangles;
    watch->counts = (struct watch_counts){0};
}

static int compare_touches(const void *a, const void *b)
{
    const struct touch *first = a, *second = b;
    if (first->instance != second->instance)
        return first->instance < second->instance ? -1 : 1;
    if (first->primitive != second->primitive)
        return first->primitive < second->primitive ? -1 : 1;
    return first->order < second->order ? -1 : 1;
}

static bool same_absence(const struct touch *a, const struct touch *b)
{
    return a->kind != TOUCH_DRAWN && a->kind == b->kind && a->instance == b->instance &&
           a->primitive == b->primitive;
}

/* Primitives are set up again when the arena was full, and are then noted twice. */
const struct touch *watch_touches(struct watch *watch, uint32_t *count)
{
    uint32_t kept = 0;
    if (watch->touch_count)
        qsort(watch->touch, watch->touch_count, sizeof *watch->touch, compare_touches);
    for (uint32_t i = 0; i < watch->touch_count; i++)
        if (!kept || !same_absence(watch->touch + kept - 1, watch->touch + i))
            watch->touch[kept++] = watch->touch[i];
    *count = watch->touch_count = kept;
    return watch->touch;
}

struct watch_counts watch_totals(const struct watch *watch)
{
    struct watch_counts counts = watch->counts;
    counts.primitives = watch->device->counts.triangles - watch->triangles_before;
    return counts;
}

bool watch_is_starved(const struct watch *watch)
{
    return watch->starved;
}

bool watch_is_incomplete(const struct watch *watch)
{
    return watch->incomplete;
}
