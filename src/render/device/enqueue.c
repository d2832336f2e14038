/* From a checked draw to the queue: the routines of its keys, its job, its command.
 *
 * A job is shared by all draws between which neither a part of it nor a constant has changed. */
#include "base/minmax.h"
#include "machine/prefetch.h"
#include "render/device/device_part.h"
#include "render/tile/hidden.h"

#include <stdlib.h>
#include <string.h>

/* Builds that check themselves (make CHECK_IR=1, and any with sanitizers) compare what is derived part by
 * part with a derivation from scratch, and overwrite the bytes of jobs that must not be read. */
enum {
#ifdef TRIPTYCH_CHECK_IR
    JOBS_CHECKED = 1
#else
    JOBS_CHECKED = 0
#endif
};

/* --- Routines --- */

/* Renders what is recorded, or begins to, while the draw's routines stay held. */
static void render_before(struct triptych_device *device, void (*render)(struct triptych_device *))
{
    const struct routine *kept[DRAW_ROUTINES];
    for (int i = 0; i < DRAW_ROUTINES; i++) {
        kept[i] = device->derived.now->draw.routine[i];
        if (kept[i])
            cache_retain(device->cache, kept[i]);
    }
    render(device);
    for (unsigned i = 0; i < DRAW_ROUTINES; i++)
        if (kept[i])
            device_routines_hold(&device->routines, i, kept[i], device->derived.now->draw.routine);
}

/* How large a triangle of the draw must be to be tested for spans; 0: none is tested, since spans are neither
 * drawn nor counted. */
static uint32_t span_extent(const struct draw *draw, enum setting_spans spans)
{
    if (!draw->routine[ROUTINE_SPAN] && !draw->counts_spans)
        return 0;
    return spans == SETTING_spans_always ? 1 : SPAN_EXTENT;
}

static int use_routines(struct triptych_device *device, struct error *error)
{
    struct draw *draw = &device->derived.now->draw;
    enum setting_spans spans = draw->shape == SHAPE_TRIANGLE ? device->spans : SETTING_spans_off;
    int asked = device_routines_use(&device->routines, device->cache, device->derived.now->key, spans,
                                    draw->pairs.bytes, draw->routine, error);
    if (asked < 0) {
        draw->span_extent = 0;
        return asked;
    }
    const struct routine *pixel = draw->routine[UNIT_PIXEL], *spanned = draw->routine[ROUTINE_SPAN];
    draw->span = spanned ? spanned->key.pixel.span : SPAN_NONE;
    draw->span_narrowest = (uint8_t)span_narrowest(&pixel->key.pixel);
    draw->span_widest = (uint8_t)span_widest(&pixel->key.pixel);
    draw->counts_spans =
        spans == SETTING_spans_on && pixel->traits & PIXEL_SPANS && draw->span < draw->span_widest;
    draw->counts_joined = spans == SETTING_spans_on && pixel->traits & PIXEL_SPANS && draw->pairs.bytes &&
                          !draw->routine[ROUTINE_JOINED];
    draw->span_extent = span_extent(draw, spans);
    return asked;
}

/* Recorded draws hold routines; rendering these draws makes room, where there is none or others might soon
 * have none. */
static int prepare_routines(struct triptych_device *device, struct error *error)
{
    bool recorded = device->queue->commands.count;
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

/* --- Jobs --- */

/* The textures that draws sample must not change before these are rendered. */
static void mark_textures(struct triptych_device *device)
{
    for (uint32_t left = device->derived.now->sampled; left; left &= left - 1)
        device->state.texture[__builtin_ctz(left)]->epoch = device->epoch;
    if (device_derived_masks(&device->derived))
        device->state.clip_mask.texture->epoch = device->epoch;
}

/* Adds a span to what queued draws read of a buffer. */
static void use_buffer(const struct triptych_device *device, struct triptych_buffer *buffer,
                       struct buffer_span span)
{
    if (buffer->epoch != device->epoch) {
        if (!device_epoch_is_queued(device, buffer->epoch))
            buffer->used = span;
        buffer->epoch = device->epoch;
    }
    buffer_add_used(buffer, span);
}

/* The bytes of buffers that a draw reads must not change before it is rendered. */
static void mark_buffers(struct triptych_device *device, const struct drawn *drawn)
{
    const struct state *state = &device->state;
    for (uint64_t left = device->derived.now->streams; left; left &= left - 1) {
        unsigned i = (unsigned)__builtin_ctzll(left);
        const struct state_stream *stream = state->stream + i;
        struct buffer_span span = {0, stream->buffer ? stream->buffer->bytes : 0};
        if (!i && state->immediate)
            continue;
        if (stream->stride && stream->frequency != TRIPTYCH_FREQUENCY_INSTANCE) {
            span.begin = stream->offset + (size_t)drawn->lowest * stream->stride;
            span.end =
                stream->offset + (size_t)drawn->highest * stream->stride + device->derived.now->extent[i];
            if (device->derived.now->overread >> i & 1)
                span.end = min_size(span.end + FETCH_OVERREAD, stream->buffer->bytes);
        }
        use_buffer(device, stream->buffer, span);
    }
    if (drawn->indices && !state->immediate)
        use_buffer(device, state->indices, drawn->index_span);
}

/* Elements of streams that step with the instance: the same vertex for the whole of it. */
static void step_element(const struct state *state, const struct state_element *element, uint32_t instance,
                         struct attribute_job *job)
{
    const struct state_stream *stream = state_source(state, element);
    if (job->data && stream->frequency == TRIPTYCH_FREQUENCY_INSTANCE)
        job->data += (size_t)(instance / stream->count) * stream->stride;
}

static void step_instance(const struct triptych_device *device, uint32_t instance, struct job *job)
{
    const struct state *state = &device->state;
    const struct vertex_key *key = &device->derived.now->key[UNIT_VERTEX].vertex;
    for (unsigned i = key_next(key->attribute, 0, ATTRIBUTE_COUNT); i < ATTRIBUTE_COUNT;
         i = key_next(key->attribute, i + 1, ATTRIBUTE_COUNT))
        step_element(state, state->element + i, instance, &job->attribute[i]);
    for (unsigned i = key_next(key->input, 0, INPUTS); i < INPUTS; i = key_next(key->input, i + 1, INPUTS))
        step_element(state, derive_input(state, key, i), instance, &job->input[i]);
}

static void step_masks(const struct triptych_device *device, uint32_t instance, struct draw *draw)
{
    if (instance && draw->edge_masks.data)
        step_element(&device->state, derive_edge_masks(&device->state), instance, &draw->edge_masks);
}

/* Buffers of the queue are reused, and the cache of the core that rendered them still holds their lines.
 * So jobs and commands are prefetched this many draws ahead of writing. */
enum { JOBS_AHEAD = 4, COMMANDS_AHEAD = 8 };

/* Later jobs are likely to need the same lines, so these are prefetched. The rest of the job is not read;
 * builds that check themselves fill it, so that a read of it would change the picture. */
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
    struct job *job = queue_next_job(device->queue);
    device->queue->commands.jobs++;
    copy_live(job, &device->derived.now->job, &device->derived.now->live);
    job->constants[STAGE_VERTEX] = vertex;
    job->constants[STAGE_PIXEL] = pixel;
    return job;
}

/* The job of an instance: that of the draw before, if it is the same. Instances after the first have their
 * own. */
static const struct job *make_job(struct triptych_device *device, uint32_t instance)
{
    const float *vertex = constants_block(&device->constants, &device->state, STAGE_VERTEX);
    const float *pixel = constants_block(&device->constants, &device->state, STAGE_PIXEL);
    const struct job *last = device->derived.now->draw.job;
    if (!last)
        mark_textures(device);
    if (instance) {
        struct job *job = new_job(device, vertex, pixel);
        step_instance(device, instance, job);
        return job;
    }
    if (!last || last->constants[STAGE_VERTEX] != vertex || last->constants[STAGE_PIXEL] != pixel)
        device->derived.now->draw.job = new_job(device, vertex, pixel);
    return device->derived.now->draw.job;
}

/* --- Variants for constants --- */

/* The bytes of code that a routine has got since it was built. */
static size_t bytes_since(const struct routine *routine)
{
    return (routine->tracking ? routine->tracking->bytes : 0) +
           (routine->second ? routine->second->bytes : 0);
}

/* A routine of the draw for the newest constants of its shader, which the job has; or its second code (struct
 * engine, select). */
static void select_variant(struct triptych_device *device, unsigned number, enum shader_stage stage,
                           struct draw *draw)
{
    const struct routine *routine = draw->routine[number];
    const float *constants = draw->job->constants[stage];
    bool tracks = routine && routine->tracking && constants;
    if (!routine || (!tracks && !routine_wants_second(routine)) || !routine->engine->select)
        return;
    size_t bytes = bytes_since(routine);
    draw->routine[number] = routine->engine->select(routine, constants, device->constants.number[stage]);
    if (bytes_since(routine) > bytes)
        cache_add_bytes(device->cache, routine, bytes_since(routine) - bytes);
}

/* --- The queue --- */

struct command *device_next_command(struct triptych_device *device)
{
    if (!queue_next(device->queue))
        device_start(device);
    return queue_next(device->queue);
}

/* The data of an immediate draw in transient memory. */
struct placed {
    uint64_t epoch; /* the device's */
    uint32_t first; /* vertex of the stream */
    const void *indices;
};

static bool has_room(const struct triptych_device *device, const struct immediate *immediate)
{
    return queue_next(device->queue) && constants_fit(&device->constants, &device->state) &&
           (!immediate || transient_fits(&device->transient, immediate));
}

static void place(struct triptych_device *device, const struct immediate *immediate, struct placed *placed)
{
    struct state_stream *stream = &device->state.immediate_stream;
    size_t before = stream->offset;
    placed->epoch = device->epoch;
    placed->first = transient_place(&device->transient, immediate, stream, &placed->indices);
    if (stream->offset != before)
        device_state_changed(device, CHANGE_OF_STREAM);
    if (device->derived.changed)
        device_derived_update_streams(&device->derived, &device->state);
}

static void enqueue_instance(struct triptych_device *device, const struct drawn *drawn, uint32_t instance,
                             struct placed *placed)
{
    const struct immediate *immediate = drawn->immediate;
    if (!has_room(device, immediate))
        render_before(device, device_start);
    if (immediate && (!instance || placed->epoch != device->epoch))
        place(device, immediate, placed);
    mark_buffers(device, drawn);
    struct command *command = queue_next(device->queue);
    prefetch_to_write(command + COMMANDS_AHEAD, sizeof *command);
    command->kind = COMMAND_DRAW;
    command->draw = device->derived.now->draw;
    command->draw.job = make_job(device, instance); /* which may be new to the derived draw, too */
    step_masks(device, instance, &command->draw);
    select_variant(device, UNIT_VERTEX, STAGE_VERTEX, &command->draw);
    select_variant(device, UNIT_PIXEL, STAGE_PIXEL, &command->draw);
    select_variant(device, ROUTINE_SPAN, STAGE_PIXEL, &command->draw);
    select_variant(device, ROUTINE_JOINED, STAGE_PIXEL, &command->draw);
    command->draw.count = drawn->count;
    command->draw.indices = immediate ? placed->indices : drawn->indices;
    command->draw.index_bits = drawn->index_bits;
    command->draw.base = drawn->base + placed->first;
    device->queue->commands.count++;
}

enum triptych_result device_enqueue(struct triptych_device *device, const struct drawn *drawn,
                                    uint32_t instances, struct error *error)
{
    struct placed placed = {0};
    if (JOBS_CHECKED && !device_derived_is_exact(&device->derived, &device->state))
        abort();
    if (prepare_routines(device, error))
        return device_refusal(TRIPTYCH_ENGINE_FAILED);
    device->derived.now->draw.primitive = drawn->primitive;
    for (uint32_t i = 0; i < instances; i++)
        enqueue_instance(device, drawn, i, &placed);
    return TRIPTYCH_OK;
}
