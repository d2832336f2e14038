/* From the state to the queue: what the state derives to is kept, and only what is stale is derived anew; draws share
 * what has not changed between them.
 *
 *   a setter         names the parts that it may change (draw/change.h)
 *   device_derive    derives these parts: the keys, parts of the job, what else a draw has
 *   device_record    routines for keys that have changed; a job, if a part of it or a constant has; the command
 *
 * Routines are held once for all draws that use them between two renderings, not once for each: device->draw has those
 * of the keys as long as they are held, and when other keys come, those that were held last are looked at before the
 * cache is asked. */
#include "base/prefetch.h"
#include "draw/derive.h"
#include "draw/device.h"

#include <stdlib.h>
#include <string.h>

/* Builds that check themselves (make CHECK_IR=1, and any with sanitizers): what is derived by parts is what would be from
 * scratch, and what of jobs is not said to be read is not. */
enum {
#ifdef TRIPTYCH_CHECK_IR
    JOBS_CHECKED = 1
#else
    JOBS_CHECKED = 0
#endif
};

/* --- Deriving ---------------------------------------------------------------------------------------------
 */

static const size_t key_bytes[UNIT_COUNT] = {[UNIT_VERTEX] = sizeof(struct vertex_key),
                                             [UNIT_SETUP] = sizeof(struct setup_key),
                                             [UNIT_PIXEL] = sizeof(struct pixel_key)};

static bool same_key(enum unit unit, const union key *a, const union key *b)
{
    return !memcmp(a, b, key_bytes[unit]);
}

/* Routines are those of the keys, or none. Returns the parts that depend on what has changed. */
static unsigned derive_new_keys(struct triptych_device *device, enum primitive primitive)
{
    union key key[UNIT_COUNT];
    unsigned parts = 0;
    derive_keys(&device->state, primitive, key);
    for (int unit = 0; unit < UNIT_COUNT; unit++) {
        if (same_key(unit, &key[unit], &device->key[unit]))
            continue;
        device->key[unit] = key[unit];
        device->draw.routine[unit] = NULL;
        parts |= derive_parts_of_key(unit);
    }
    if (parts)
        derive_live(&key[UNIT_VERTEX].vertex, &key[UNIT_PIXEL].pixel, &device->live);
    return parts;
}

static void derive_setting(struct triptych_device *device)
{
    const struct state *state = &device->state;
    const struct setup_key *setup = &device->key[UNIT_SETUP].setup;
    struct draw *draw = &device->draw;
    draw->scissor = derive_scissor(state);
    draw->stride = setup_layout(setup).stride;
    draw->shape = derive_shape(setup->primitive);
    draw->sampling = derive_sampling(state);
    draw->clip_ignored = derive_clip_ignored(state);
    draw->last_pixel = derive_last_pixel(state);
    draw->wrapped = derive_wrapped(state, &device->key[UNIT_PIXEL].pixel);
    draw->flat = derive_flat(state);
}

/* How many vertices an element has; any number, if it steps with the instance and has as many as these need. */
static uint64_t element_vertices(const struct state *state, const struct state_element *element)
{
    const struct state_stream *stream = state->stream + element->stream;
    size_t begin = stream->offset + element->offset, bytes = vertex_types[element->format].bytes;
    if (!stream->buffer || begin + bytes > stream->buffer->bytes)
        return 0;
    uint64_t last = state_last_vertex(state, element);
    if (stream->frequency == TRIPTYCH_FREQUENCY_INSTANCE)
        return (state_instances(state) - 1) / stream->count <= last ? UINT64_MAX : 0;
    return last == UINT64_MAX ? last : last + 1;
}

static bool derive_steps(const struct state *state)
{
    bool steps = false;
    for (unsigned i = 0; i < TRIPTYCH_STREAMS; i++)
        steps |= state->stream[i].frequency != TRIPTYCH_FREQUENCY_VERTEX;
    return steps;
}

static uint64_t derive_vertices(const struct state *state, const struct vertex_key *key)
{
    uint64_t least = UINT64_MAX;
    for (unsigned i = key_next(key->attribute, 0, ATTRIBUTE_COUNT); i < ATTRIBUTE_COUNT;
         i = key_next(key->attribute, i + 1, ATTRIBUTE_COUNT)) {
        uint64_t vertices = element_vertices(state, state->element + i);
        least = vertices < least ? vertices : least;
    }
    for (unsigned i = 0; i < INPUTS; i++) {
        const struct state_element *element = derive_input(state, key, i);
        uint64_t vertices = element ? element_vertices(state, element) : UINT64_MAX;
        least = vertices < least ? vertices : least;
    }
    return least;
}

/* The newest palette is that of the job; recorded draws may use the others. */
static enum triptych_result make_palette(struct triptych_device *device, struct error *error)
{
    struct palette *palette = malloc(sizeof *palette);
    if (!palette) {
        error_set(error, "out of memory for a palette of world matrices");
        return TRIPTYCH_NO_MEMORY;
    }
    derive_palette(&device->state, palette->entry);
    palette->next = device->palettes;
    device->palettes = palette;
    device->job.palette = palette->entry;
    return TRIPTYCH_OK;
}

enum triptych_result device_derive(struct triptych_device *device, enum triptych_primitive drawn,
                                   struct error *error)
{
    enum primitive primitive = derive_primitive(&device->state, drawn);
    const struct vertex_key *vertex = &device->key[UNIT_VERTEX].vertex;
    if (device->key[UNIT_SETUP].setup.primitive != primitive)
        device->stale = PARTS_ALL;
    unsigned stale = device->stale;
    if (!stale)
        return TRIPTYCH_OK;
    if (stale & PARTS(KEYS))
        stale |= derive_new_keys(device, primitive);
    if (stale & PARTS(SETTING))
        derive_setting(device);
    if (stale & PARTS(VERTICES)) {
        device->steps = derive_steps(&device->state);
        device->vertices = derive_vertices(&device->state, vertex);
    }
    if (stale & PARTS_OF_JOB)
        device->draw.job = NULL;
    if (stale == PARTS_ALL)
        derive_job(&device->state, vertex, &device->key[UNIT_PIXEL].pixel, &device->job);
    else
        derive_job_parts(&device->state, vertex, &device->key[UNIT_PIXEL].pixel, stale, &device->job);
    enum triptych_result result = TRIPTYCH_OK;
    if (stale & PARTS(PALETTE) && vertex->indexed_matrices)
        result = make_palette(device, error);
    if (result == TRIPTYCH_OK)
        device->stale = 0;
    return result;
}

/* --- Routines ---------------------------------------------------------------------------------------------
 */

enum { HELD_RECENTLY = 8 };

static void use(struct triptych_device *device, enum unit unit, uint32_t held)
{
    device->draw.routine[unit] = device->held[held].routine;
    device->in_use[unit] = held;
}

/* Uses one that was held not long ago for the key, if there is one. */
static bool use_held(struct triptych_device *device, enum unit unit)
{
    uint32_t end = device->held_count, begin = end > HELD_RECENTLY ? end - HELD_RECENTLY : 0;
    for (uint32_t i = end; i-- > begin;) {
        const struct routine *routine = device->held[i].routine;
        if (routine->unit == unit && same_key(unit, &routine->key, &device->key[unit])) {
            use(device, unit, i);
            return true;
        }
    }
    return false;
}

static void hold(struct triptych_device *device, enum unit unit, const struct routine *routine)
{
    device->held[device->held_count] = (struct held){routine, 0};
    use(device, unit, device->held_count++);
}

void device_let_go(struct triptych_device *device, uint32_t count)
{
    while (device->held_count > count) {
        const struct held *held = &device->held[--device->held_count];
        cache_add_hits(device->cache, held->routine, held->hits);
        cache_release(device->cache, held->routine);
    }
    for (int unit = 0; unit < UNIT_COUNT; unit++)
        if (device->in_use[unit] >= count)
            device->draw.routine[unit] = NULL;
}

/* Makes the draw's routines those of the keys. Returns how many the cache was asked for, or -1 with nothing more held
 * than before. */
static int use_routines(struct triptych_device *device, struct error *error)
{
    uint32_t before = device->held_count;
    for (int unit = 0; unit < UNIT_COUNT; unit++) {
        if (device->draw.routine[unit] || use_held(device, unit)) {
            device->held[device->in_use[unit]].hits++;
            continue;
        }
        const struct routine *routine = cache_acquire(device->cache, unit, &device->key[unit], error);
        if (!routine) {
            device_let_go(device, before);
            return -1;
        }
        hold(device, unit, routine);
    }
    return (int)(device->held_count - before);
}

/* Renders what is recorded, or begins to, while the draw's routines stay held. */
static void render_before(struct triptych_device *device, void (*render)(struct triptych_device *))
{
    const struct routine *kept[UNIT_COUNT];
    for (int unit = 0; unit < UNIT_COUNT; unit++) {
        kept[unit] = device->draw.routine[unit];
        cache_retain(device->cache, kept[unit]);
    }
    render(device);
    for (int unit = 0; unit < UNIT_COUNT; unit++)
        hold(device, unit, kept[unit]);
}

/* Recorded draws hold routines; rendering these draws makes room, where there is none or others might soon have
 * none. */
static int prepare_routines(struct triptych_device *device, struct error *error)
{
    bool recorded = device->frame->commands;
    struct error first;
    error_clear(&first);
    int asked = use_routines(device, recorded ? &first : error);
    if (recorded && asked > 0 && cache_is_crowded(device->cache))
        render_before(device, device_finish);
    if (recorded && asked < 0) {
        device_finish(device);
        asked = use_routines(device, error);
    }
    return asked < 0 ? -1 : 0;
}

void device_count_hits(struct triptych_device *device)
{
    for (uint32_t i = 0; i < device->held_count; i++) {
        cache_add_hits(device->cache, device->held[i].routine, device->held[i].hits);
        device->held[i].hits = 0;
    }
}

/* --- Jobs -------------------------------------------------------------------------------------------------
 */

bool device_samples(const struct triptych_device *device, int i)
{
    const struct pixel_key *pixel = &device->key[UNIT_PIXEL].pixel;
    const struct vertex_key *vertex = &device->key[UNIT_VERTEX].vertex;
    return i < PIXEL_SAMPLERS ? pixel->texture[i] : vertex->texture[i - PIXEL_SAMPLERS];
}

/* The textures that draws sample must not change before these are rendered. */
static void mark_textures(struct triptych_device *device)
{
    for (int i = 0; i < SAMPLERS; i++)
        if (device_samples(device, i))
            device->state.texture[i]->recording = device->recording;
}

/* Elements of streams that step with the instance: the same vertex for the whole of it. */
static void step_element(const struct state *state, const struct state_element *element, uint32_t instance,
                         struct attribute_job *job)
{
    const struct state_stream *stream = state->stream + element->stream;
    if (job->data && stream->frequency == TRIPTYCH_FREQUENCY_INSTANCE)
        job->data += (size_t)(instance / stream->count) * stream->stride;
}

static void step_instance(const struct triptych_device *device, uint32_t instance, struct job *job)
{
    const struct state *state = &device->state;
    const struct vertex_key *key = &device->key[UNIT_VERTEX].vertex;
    for (unsigned i = key_next(key->attribute, 0, ATTRIBUTE_COUNT); i < ATTRIBUTE_COUNT;
         i = key_next(key->attribute, i + 1, ATTRIBUTE_COUNT))
        step_element(state, state->element + i, instance, &job->attribute[i]);
    for (unsigned i = 0; i < INPUTS; i++) {
        const struct state_element *element = derive_input(state, key, i);
        if (element)
            step_element(state, element, instance, &job->input[i]);
    }
}

/* Queues are used again, and another core has the lines that rendered what was there: so many draws before they are written
 * they are asked for. */
enum { JOBS_AHEAD = 4, COMMANDS_AHEAD = 8 };

/* The same lines of later jobs are likely to be written. Nobody reads the rest of the job, but in builds that check themselves it is what would be noticed. */
static void copy_live(struct job *to, const struct job *from, const struct live_job *live)
{
    if (JOBS_CHECKED)
        memset(to, 0xbb, sizeof *to);
    for (unsigned i = 0; i < live->count; i++) {
        size_t begin = live->run[i].begin, end = live->run[i].end;
        memcpy((char *)to + begin, (const char *)from + begin, end - begin);
        prefetch_to_write((const char *)(to + JOBS_AHEAD) + begin, end - begin);
    }
}

/* Blocks of constants, one by one: loaded as one vector they would have to wait for the stores of both. */
static struct job *new_job(struct triptych_device *device, const float *vertex, const float *pixel)
{
    struct job *job = frame_next_job(device->frame);
    device->frame->jobs++;
    copy_live(job, &device->job, &device->live);
    job->constants[STAGE_VERTEX] = vertex;
    job->constants[STAGE_PIXEL] = pixel;
    return job;
}

/* The job of an instance: that of the draw before, if it is the same. Instances after the first have their own. */
static const struct job *make_job(struct triptych_device *device, uint32_t instance)
{
    const float *vertex = constants_block(&device->constants, &device->state, STAGE_VERTEX);
    const float *pixel = constants_block(&device->constants, &device->state, STAGE_PIXEL);
    const struct job *last = device->draw.job;
    if (!last)
        mark_textures(device);
    if (instance) {
        struct job *job = new_job(device, vertex, pixel);
        step_instance(device, instance, job);
        return job;
    }
    if (!last || last->constants[STAGE_VERTEX] != vertex || last->constants[STAGE_PIXEL] != pixel)
        device->draw.job = new_job(device, vertex, pixel);
    return device->draw.job;
}

/* --- The queue --------------------------------------------------------------------------------------------
 */

struct command *device_next_command(struct triptych_device *device)
{
    if (!frame_next(device->frame))
        device_start(device);
    return frame_next(device->frame);
}

static void record_instance(struct triptych_device *device, const struct draw *source, uint32_t instance)
{
    if (!frame_next(device->frame) || !constants_fit(&device->constants, &device->state))
        render_before(device, device_start);
    struct command *command = frame_next(device->frame);
    prefetch_to_write(command + COMMANDS_AHEAD, sizeof *command);
    command->kind = COMMAND_DRAW;
    command->draw = device->draw;
    command->draw.job = make_job(device, instance); /* which may be new to device->draw, too */
    command->draw.primitive = source->primitive;
    command->draw.count = source->count;
    command->draw.indices = source->indices;
    command->draw.index_bits = source->index_bits;
    command->draw.base = source->base;
    device->frame->commands++;
}

static bool is_derived(const struct triptych_device *device)
{
    union key key[UNIT_COUNT];
    struct job job;
    enum primitive primitive = (enum primitive)device->key[UNIT_SETUP].setup.primitive;
    derive_keys(&device->state, primitive, key);
    for (int unit = 0; unit < UNIT_COUNT; unit++)
        if (!same_key(unit, &key[unit], &device->key[unit]))
            return false;
    derive_job(&device->state, &key[UNIT_VERTEX].vertex, &key[UNIT_PIXEL].pixel, &job);
    job.palette = device->job.palette;
    return !memcmp(&job, &device->job, sizeof job);
}

enum triptych_result device_record(struct triptych_device *device, const struct draw *source,
                                   uint32_t instances, struct error *error)
{
    if (JOBS_CHECKED && !is_derived(device))
        abort();
    if (prepare_routines(device, error))
        return device_refusal(TRIPTYCH_ENGINE_FAILED);
    for (uint32_t i = 0; i < instances; i++)
        record_instance(device, source, i);
    return TRIPTYCH_OK;
}
