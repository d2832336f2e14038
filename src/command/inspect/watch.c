#include "command/inspect/watch.h"

#include "emu/emulate/emulate.h"
#include "machine/mxcsr.h"

#include <stdlib.h>
#include <string.h>

enum { ALIGNMENT = 64, SCRATCH_BYTES = SETUP_CAPACITY * 1024 };

/* The primitive of a setup call, and where its records begin. */
struct placed {
    const uint8_t *address;
    uint32_t instance, primitive;
    uint32_t vertices, vertex[TOUCH_VERTICES];
    bool clipped;
};

struct watch {
    struct engine engine;
    struct triptych_device *device;
    int32_t x, y; /* the pixel; x < 0: none */
    uint32_t *count;
    enum watch_what what;
    struct watch_owner *owner;
    uint32_t draw;

    /* Geometry of the draw. */
    const struct job *job;                     /* of the instance */
    uint32_t instances;                        /* that have begun */
    uint32_t vertices, vertex[TOUCH_VERTICES]; /* of the primitive */
    bool in_tiles;                             /* the records of the round are complete */
    struct placed *placed;                     /* of the round, by address */
    uint32_t placed_count, placed_capacity;
    alignas(ALIGNMENT) uint8_t scratch[SCRATCH_BYTES]; /* records without culling */
    struct entry_list entries;

    /* Results of the draw. */
    uint64_t triangles_before;
    struct watch_counts counts;
    struct touch *touch;
    uint32_t touch_count, touch_capacity;
    bool incomplete, starved;

    struct sight sight;
};

/* A routine of the watch's engine. */
struct watched {
    struct routine routine;
    struct routine *inner;    /* the emulator's */
    struct routine *unculled; /* setup: the same without culling; null if nothing is culled */
    const struct program *program;
    struct triangle_layout layout;
};

static struct watch *watch_of(const struct routine *routine)
{
    return (struct watch *)(uintptr_t)routine->engine->options;
}

static const struct watched *watched(const struct routine *routine)
{
    return (const struct watched *)(const void *)routine;
}

/* --- Touches -------------------------------------------------------------------------------------------- */

/* Null after TOUCHES_MAXIMUM, or when there is no memory. */
static struct touch *new_touch(struct watch *watch, const struct placed *placed, enum touch_kind kind)
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
static void run_vertex(const void *arguments, const struct routine *routine)
{
    const struct vertex_arguments *call = arguments;
    struct watch *watch = watch_of(routine);
    watched(routine)->inner->run(arguments, watched(routine)->inner);
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
static struct placed *place(struct watch *watch, const struct setup_arguments *call)
{
    if (watch->in_tiles)
        watch->placed_count = 0;
    watch->in_tiles = false;
    while (watch->placed_count && watch->placed[watch->placed_count - 1].address >= call->out)
        watch->placed_count--;
    if (watch->placed_count == watch->placed_capacity) {
        uint32_t capacity = watch->placed_capacity ? 2 * watch->placed_capacity : 1024;
        struct placed *larger = realloc(watch->placed, capacity * sizeof *larger);
        if (!larger) {
            watch->starved = true;
            return NULL;
        }
        watch->placed = larger;
        watch->placed_capacity = capacity;
    }
    struct placed *placed = watch->placed + watch->placed_count++;
    *placed = (struct placed){.address = call->out,
                              .instance = watch->instances - 1,
                              .primitive = call->primitive,
                              .vertices = watch->vertices,
                              .clipped = is_clipped(watch, call)};
    memcpy(placed->vertex, watch->vertex, sizeof placed->vertex);
    return placed;
}

/* The primitive of a record, or null if it was not noted. */
static const struct placed *find_placed(const struct watch *watch, const uint8_t *record)
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
    const struct draw *draw = &watch->device->derived.draw;
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
    const struct target *target = device_target(watch->device);
    const struct rectangle *scissor = &watch->device->derived.draw.scissor;
    const struct rectangle whole = {0, 0, (int32_t)target->width, (int32_t)target->height};
    bool inside = in_rectangle(scissor, watch->x, watch->y);
    if (drawn->visible && !inside && covers(watch, drawn, &whole))
        return TOUCH_SCISSORED;
    if (!drawn->visible && unculled && unculled->visible && inside && covers(watch, unculled, scissor))
        return TOUCH_CULLED;
    return TOUCH_DRAWN;
}

static void note_absent(struct watch *watch, const struct watched *self, const struct setup_arguments *call,
                        const struct placed *placed)
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
            new_touch(watch, placed, kind);
    }
}

static void run_setup(const void *arguments, const struct routine *routine)
{
    const struct setup_arguments *call = arguments;
    const struct watched *self = watched(routine);
    struct watch *watch = watch_of(routine);
    self->inner->run(arguments, self->inner);
    const struct placed *placed = place(watch, call);
    if (placed && watch->x >= 0)
        note_absent(watch, self, call, placed);
}

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
            observe_passes(sight, OBSERVED_stencil, i, lane) &&
            observe_passes(sight, OBSERVED_depth, i, lane))
            return true;
    return false;
}

static void own(struct watch *watch, const struct quad *quad, size_t pixel)
{
    const struct placed *placed = find_placed(watch, quad->call->triangles + quad->entry->triangle);
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
        watch->count[(size_t)y * device_target(watch->device)->width + x] += counted;
    if (watch->owner && passed && pixel_write_mask(&quad->self->routine.key.pixel))
        own(watch, quad, (size_t)y * device_target(watch->device)->width + x);
}

static struct touch_tests tests_of(const struct quad *quad, bool clockwise)
{
    const struct pixel_key *key = &quad->self->routine.key.pixel;
    const struct job *job = quad->call->job;
    int side = key->stencil == STENCIL_TWO && !clockwise ? SIDE_COUNTERCLOCKWISE : SIDE_CLOCKWISE;
    return (struct touch_tests){.depth = key->depth_function,
                                .alpha = (uint8_t)(COMPARE_ALWAYS - key->alpha_discard),
                                .stencil = key->stencil_function[side],
                                .alpha_reference = job->alpha_reference,
                                .stencil_reference = job->stencil_reference,
                                .stencil_mask = job->stencil_mask};
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
    const struct placed *placed = find_placed(watch, record);
    struct target *target = device_target(watch->device);
    struct touch *touch = placed ? new_touch(watch, placed, TOUCH_DRAWN) : NULL;
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
        struct quad quad = {watched(routine), call, call->entries + i, 0};
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

static struct routine *build(const struct engine *self, struct code_arena *arena, enum unit unit,
                             const union key *key, struct error *error)
{
    static routine_function *const run[UNIT_COUNT] = {run_vertex, run_setup, run_pixel};
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
    size_t bytes = (sizeof(struct watch) + ALIGNMENT - 1) & -(size_t)ALIGNMENT;
    struct watch *watch = aligned_alloc(ALIGNMENT, bytes);
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

struct triptych_device *watch_device(struct watch *watch, struct error *error)
{
    const struct device_options options = {.threads = 1};
    return device_create(&watch->engine, &options, &watch->device, error) ? NULL : watch->device;
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
