/* The batch interpreter's engines: the loops that fill batches, and one engine for each number of lanes.
 *
 * Vertices and triangles are taken in order until a batch is full. A batch of pixels collects quads with
 * coverage from consecutive entries. A quad that is already in the batch ends it, because the second one must
 * read the results of the first. Nothing else in a pixel call depends on the order except counters. Quads at
 * the same position of their blocks share a counter, so a routine that counts ends its batch at such a quad
 * too. */
#include "emu/batch/batch.h"

#include "base/words.h"
#include "emu/batch/scratch.h"
#include "machine/mxcsr.h"
#include "shader/program/program.h"

#include <stdlib.h>
#include <string.h>

enum { BATCH_LANES = 64, BLOCK_QUADS = BLOCK_PIXELS / GROUP_LANES };

enum fusing { FUSE_NONE, FUSE_PRODUCTS }; /* an engine's options */

struct batch_routine {
    struct routine routine;
    struct schedule *schedule;
};

const struct schedule *batch_schedule(const struct routine *routine)
{
    return ((const struct batch_routine *)(const void *)routine)->schedule;
}

static void set_common(struct batch *batch, enum base base, const void *address)
{
    for (int group = 0; group < GROUPS_MAXIMUM; group++)
        batch->base[base][group] = address;
}

static void flush(struct batch *batch, const struct schedule *schedule)
{
    if (batch->groups[0])
        schedule_run(schedule, batch);
    batch->groups[0] = 0;
}

static unsigned add_group(struct batch *batch, const struct schedule *schedule)
{
    if (batch->groups[0] * GROUP_LANES == schedule->lanes)
        flush(batch, schedule);
    return batch->groups[0]++;
}

static void run_vertices(struct batch *batch, const struct schedule *schedule,
                         const struct vertex_arguments *call)
{
    set_common(batch, BASE_JOB, call->job);
    set_common(batch, BASE_CONSTANT, call->job->constants[STAGE_VERTEX]);
    for (uint32_t i = 0; i < call->count; i += GROUP_LANES) {
        unsigned group = add_group(batch, schedule);
        batch->base[BASE_INPUT][group] = (const uint8_t *)(call->index + i);
        batch->base[BASE_OUTPUT][group] = (const uint8_t *)(call->out + i);
    }
    flush(batch, schedule);
}

static void run_setup(struct batch *batch, const struct schedule *schedule,
                      const struct setup_arguments *call, size_t stride)
{
    set_common(batch, BASE_JOB, call->job);
    set_common(batch, BASE_VERTICES, call->vertices);
    for (uint32_t i = 0; i < call->count; i += GROUP_LANES) {
        unsigned group = add_group(batch, schedule);
        batch->base[BASE_INPUT][group] = (const uint8_t *)(call->index + i);
        batch->base[BASE_OUTPUT][group] = call->out + i * stride;
    }
    flush(batch, schedule);
}

static void run_blit(struct batch *batch, const struct schedule *schedule, const struct blit_arguments *call)
{
    set_common(batch, BASE_JOB, call->job);
    for (uint32_t i = 0; i < call->count; i += GROUP_LANES) {
        unsigned group = add_group(batch, schedule);
        batch->base[BASE_INPUT][group] = (const uint8_t *)(call->index + i);
        batch->base[BASE_OUTPUT][group] = (const uint8_t *)(call->out + i);
    }
    flush(batch, schedule);
}

static void run_kernel(struct batch *batch, const struct schedule *schedule,
                       const struct kernel_arguments *call, size_t stride)
{
    set_common(batch, BASE_JOB, call->job);
    for (uint32_t i = 0; i < call->count; i += GROUP_LANES) {
        unsigned group = add_group(batch, schedule);
        batch->base[BASE_INPUT][group] = (const uint8_t *)(call->index + i);
        batch->base[BASE_OUTPUT][group] = call->out + i * stride;
    }
    flush(batch, schedule);
}

/* The quads in a batch of pixels, as masks of their positions: by block of the tile, and in all blocks. */
struct held {
    uint8_t block[TILE_BLOCKS];
    unsigned positions;
};

static void add_quad(struct batch *batch, const struct schedule *schedule, const struct pixel_arguments *call,
                     const struct entry *entry, unsigned quad, struct held *held)
{
    unsigned bit = 1u << quad;
    if (batch->groups[0] * GROUP_LANES == schedule->lanes || held->block[entry->block] & bit ||
        (schedule->counts && held->positions & bit)) {
        flush(batch, schedule);
        memset(held, 0, sizeof *held);
    }
    held->block[entry->block] |= (uint8_t)bit;
    held->positions |= bit;
    unsigned group = batch->groups[0]++, lane = quad * GROUP_LANES;
    size_t word = (size_t)entry->block * BLOCK_PIXELS + lane;
    batch->base[BASE_ENTRY][group] = (const uint8_t *)entry;
    batch->base[BASE_TRIANGLE][group] = call->triangles + entry->triangle;
    batch->base[BASE_LANES][group] = (const uint8_t *)call->lanes + 4 * lane;
    batch->base[BASE_COLOR][group] = (const uint8_t *)(call->color + word);
    batch->base[BASE_DEPTH][group] = (const uint8_t *)(call->depth + word);
}

static void run_pixels(struct batch *batch, const struct schedule *schedule,
                       const struct pixel_arguments *call)
{
    struct held held = {0};
    set_common(batch, BASE_JOB, call->job);
    set_common(batch, BASE_CONSTANT, call->job->constants[STAGE_PIXEL]);
    for (uint32_t i = 0; i < call->count; i++)
        for (unsigned quad = 0; quad < BLOCK_QUADS; quad++)
            if (call->entries[i].coverage >> quad * GROUP_LANES & ((1 << GROUP_LANES) - 1))
                add_quad(batch, schedule, call, call->entries + i, quad, &held);
    flush(batch, schedule);
}

static void run(const void *call, const struct routine *routine)
{
    const struct schedule *schedule = batch_schedule(routine);
    struct batch batch; /* most of its addresses are not used */
    batch.scratch = batch_scratch_take();
    batch.groups[0] = 0;
    batch.groups[1] = 1;
    unsigned saved = mxcsr_enter();
    schedule_start(schedule, batch.scratch);
    switch (routine->unit) {
    case UNIT_VERTEX: run_vertices(&batch, schedule, call); break;
    case UNIT_SETUP: run_setup(&batch, schedule, call, layout_of_setup(&routine->key.setup).stride); break;
    case UNIT_BLIT: run_blit(&batch, schedule, call); break;
    case UNIT_KERNEL: run_kernel(&batch, schedule, call, routine->key.kernel.stride); break;
    default: run_pixels(&batch, schedule, call); break;
    }
    mxcsr_leave(saved);
    batch_scratch_give(batch.scratch);
}

struct routine *batch_routine(const struct ir *ir, unsigned lanes, bool fuses, enum unit unit,
                              const union key *key, struct error *error)
{
    struct batch_routine *batch = calloc(1, sizeof *batch);
    if (!batch) {
        error_set(error, "out of memory for a routine");
        return NULL;
    }
    batch->schedule = schedule_create(ir, lanes, fuses, NULL, error);
    bool held = batch->schedule && batch_scratch_hold();
    if (!held) {
        if (batch->schedule)
            error_set(error, "out of memory for the values of a batch");
        schedule_free(batch->schedule);
        free(batch);
        return NULL;
    }
    struct routine *routine = &batch->routine;
    routine->run = run;
    routine->unit = unit;
    routine->key = *key;
    routine->parts = batch->schedule->count;
    routine->data_bytes = (uint32_t)(sizeof *batch + batch->schedule->count * sizeof(struct schedule_step));
    return routine;
}

static struct routine *build(const struct engine *self, struct code_arena *arena, enum unit unit,
                             const union key *key, struct error *error)
{
    (void)arena;
    struct ir *ir = ir_take(unit, key, error);
    if (!ir)
        return NULL;
    struct routine *routine = batch_routine(ir, (unsigned)self->width, batch_fuses(self), unit, key, error);
    ir_give(ir);
    if (routine)
        routine->engine = self;
    return routine;
}

static void free_routine(struct code_arena *arena, struct routine *routine)
{
    (void)arena;
    schedule_free(((struct batch_routine *)(void *)routine)->schedule);
    batch_scratch_release();
    free(routine);
}

#define ENGINE(title, lanes, named)                                                                          \
    {                                                                                                        \
        .name = title,                                                                                       \
        .description = "interpreter of the recording, one operation at a time over batches of elements",     \
        .width = lanes, .without_arena = true, .on_request = named,                                          \
        .options = &(const enum fusing){FUSE_NONE}, .build = build, .free = free_routine,                    \
    }

const struct engine engine_batch = ENGINE("batch", BATCH_LANES, false);

#define BATCH(lanes) const struct engine engine_batch_##lanes = ENGINE("batch-" #lanes, lanes, true);
#include "def/engine/batch.def"
#undef BATCH

/* --- Options -------------------------------------------------------------------------------------------- */

bool batch_is_engine(const struct engine *engine)
{
    return engine->build == build;
}

bool batch_fuses(const struct engine *engine)
{
    return batch_is_engine(engine) && *(const enum fusing *)engine->options == FUSE_PRODUCTS;
}

void *batch_copy_options(const struct engine *engine)
{
    enum fusing *copy = malloc(sizeof *copy);
    if (copy)
        *copy = *(const enum fusing *)engine->options;
    return copy;
}

static const char *const fusings[] = {[FUSE_NONE] = "none", [FUSE_PRODUCTS] = "products"};

int batch_set_fuse(void *options, const char *value, struct error *error)
{
    unsigned index;
    if (words_choose(WORDS_OF_ROWS(fusings), "fuse", value, &index, error))
        return -1;
    *(enum fusing *)options = (enum fusing)index;
    return 0;
}
