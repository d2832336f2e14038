/* The device's draws: what they need is checked, then they are recorded as they are, with the
 * routines and the job that the state derives to. Queries count what lies between. */
#include "contract/lane.h"
#include "render/derive/derive.h"
#include "render/device/device_part.h"
#include "render/state/primitive.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- Checking a draw --- */

uint64_t device_corners(enum triptych_primitive primitive, uint32_t count)
{
    return state_corners(primitive, count);
}

uint32_t device_parts(enum triptych_primitive primitive)
{
    return state_primitives[primitive].parts;
}

/* Fails if vertices of a draw lie outside of the buffer of an element: those up to `last`, or one for each
 * instance. */
static enum triptych_result check_element(const struct state *state, const struct state_element *element,
                                          const char *name, uint64_t last, struct error *error)
{
    const struct state_stream *stream = state_source(state, element);
    if (stream->frequency == TRIPTYCH_FREQUENCY_INSTANCE)
        last = (state_instances(state) - 1) / stream->count;
    if (!stream->buffer) {
        error_set(error, "%s: no buffer in stream %u, expected set_stream first", name, element->stream);
        return TRIPTYCH_BAD_CALL;
    }
    size_t begin = stream->offset + element->offset, bytes = key_vertex_types[element->format].bytes;
    if (stream == &state->immediate_stream)
        return TRIPTYCH_OK;
    if (begin + bytes > stream->buffer->bytes) {
        error_set(error, "%s: lies at byte %zu past its buffer of %zu bytes", name, begin,
                  stream->buffer->bytes);
        return TRIPTYCH_BAD_CALL;
    }
    uint64_t most = state_last_vertex(state, element);
    if (last > most) {
        error_set(error, "vertex %" PRIu64 ": %s lies past its buffer, which ends with vertex %" PRIu64, last,
                  name, most);
        return TRIPTYCH_BAD_CALL;
    }
    return TRIPTYCH_OK;
}

/* The number of vertices decides most cases; the search for the element that is too short is slower. */
enum triptych_result device_check_vertices(const struct triptych_device *device, uint64_t last,
                                           struct error *error)
{
    const struct state_element *masks = derive_edge_masks(&device->state);
    if (last < device->derived.now->vertices)
        return TRIPTYCH_OK;
    if (masks && check_element(&device->state, masks, "texcoord7", last, error))
        return TRIPTYCH_BAD_CALL;
    return device_check_elements(&device->state, &device->derived.now->key[UNIT_VERTEX].vertex, last, error);
}

enum triptych_result device_check_elements(const struct state *state, const struct vertex_key *key,
                                           uint64_t last, struct error *error)
{
    enum triptych_result result = TRIPTYCH_OK;
    for (int i = 0; i < ATTRIBUTE_COUNT && result == TRIPTYCH_OK; i++)
        if (key->attribute[i] != ATTRIBUTE_FORMAT_NONE)
            result = check_element(state, state->element + i, state_attribute_name[i], last, error);
    for (unsigned i = 0; i < INPUTS && result == TRIPTYCH_OK; i++) {
        const struct state_element *element = derive_input(state, key, i);
        char name[8];
        if (!element)
            continue;
        snprintf(name, sizeof name, "v%u", i);
        result = check_element(state, element, name, last, error);
    }
    return result;
}

enum triptych_result device_check_vertex_input(struct triptych_device *device, struct error *error)
{
    enum triptych_result result = device_has_target(device, error);
    if (result == TRIPTYCH_OK && !device->state.program[STAGE_VERTEX] &&
        !device->state.element[ATTRIBUTE_POSITION].format &&
        !device->state.element[ATTRIBUTE_POSITIONT].format) {
        error_set(error, "no position: expected a vertex declaration or an element with one");
        return TRIPTYCH_BAD_CALL;
    }
    return result == TRIPTYCH_OK ? device_check_integers(device, error) : result;
}

static enum triptych_result check_draw(struct triptych_device *device, enum triptych_primitive primitive,
                                       struct error *error)
{
    if ((unsigned)primitive >= TRIPTYCH_PRIMITIVE_COUNT) {
        error_set(error, "primitive %u: expected one of Triptych's, 0 to %d", (unsigned)primitive,
                  TRIPTYCH_PRIMITIVE_COUNT - 1);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    return device_check_vertex_input(device, error);
}

enum triptych_result device_prepare_draw(struct triptych_device *device, enum triptych_primitive primitive,
                                         struct error *error)
{
    enum triptych_result result = check_draw(device, primitive, error);
    if (result == TRIPTYCH_OK)
        result = device_derived_update(&device->derived, &device->state, primitive, device->epoch, error);
    device->routines.in_use = device->derived.now->in_use;
    return result;
}

/* Direct3D 9 steps by instances in indexed draws only. */
enum triptych_result device_check_no_instances(const struct triptych_device *device, struct error *error)
{
    for (unsigned i = 0; i < TRIPTYCH_STREAMS && device->derived.now->steps; i++)
        if (device->state.stream[i].frequency != TRIPTYCH_FREQUENCY_VERTEX) {
            error_set(error, "stream %u: its frequency is by instance, expected an indexed draw", i);
            return TRIPTYCH_BAD_CALL;
        }
    return TRIPTYCH_OK;
}

static enum triptych_result check_sequence(const struct triptych_device *device, uint64_t first,
                                           uint64_t corners, struct drawn *drawn, struct error *error)
{
    drawn->lowest = first;
    drawn->highest = first + corners - 1;
    if (drawn->highest > UINT32_MAX) {
        error_set(error, "vertices %" PRIu64 " to %" PRIu64 ": expected them below 2^32", drawn->lowest,
                  drawn->highest);
        return TRIPTYCH_BAD_CALL;
    }
    return device_check_vertices(device, drawn->highest, error);
}

static enum triptych_result check_indices(const struct triptych_device *device, int32_t base, uint64_t first,
                                          uint64_t corners, struct drawn *drawn, struct error *error)
{
    struct triptych_buffer *buffer = device->state.indices;
    uint32_t bits = device->state.index_bits, bytes = bits / 8;
    uint64_t room = buffer->bytes / bytes;
    if (first + corners > room) {
        error_set(error,
                  "indices %" PRIu64 " to %" PRIu64 ": expected them in the buffer of %" PRIu64 " indices",
                  first, first + corners - 1, room);
        return TRIPTYCH_BAD_CALL;
    }
    const struct index_range *range = buffer_index_range(buffer, bits, (uint32_t)first, (uint32_t)corners);
    int64_t lowest = (int64_t)base + range->minimum, highest = (int64_t)base + range->maximum;
    if (lowest < 0 || highest > UINT32_MAX) {
        error_set(error, "vertices %" PRId64 " to %" PRId64 ": expected them from 0 to 2^32 - 1", lowest,
                  highest);
        return TRIPTYCH_BAD_CALL;
    }
    drawn->lowest = (uint64_t)lowest;
    drawn->highest = (uint64_t)highest;
    drawn->index_bits = bits;
    drawn->index_span = (struct buffer_span){(size_t)first * bytes, (size_t)(first + corners) * bytes};
    drawn->indices = buffer->data + drawn->index_span.begin;
    return device_check_vertices(device, drawn->highest, error);
}

/* The parts of the target that the pixel routine changes. */
static unsigned drawn_parts(const struct pixel_key *key)
{
    unsigned parts = key->depth_write || pixel_stencil(key) ? TARGET_DEPTH : 0;
    for (unsigned t = 0; t < TARGETS; t++)
        parts |= key->write_mask[t] ? 1u << t : 0;
    return parts;
}

/* --- Draws --- */

enum triptych_result device_count_draw(struct triptych_device *device, const struct drawn *drawn,
                                       struct error *error)
{
    uint32_t instances = drawn->index_bits ? state_instances(&device->state) : 1;
    const struct pixel_key *key = &device->derived.now->key[UNIT_PIXEL].pixel;
    const struct rectangle *visible = &device->derived.now->draw.scissor;
    bool reaches = visible->x0 < visible->x1 && visible->y0 < visible->y1;
    if (drawn->count && reaches && derive_effective(key)) {
        device_prepare_target(device);
        device_prepare_textures(device);
        enum triptych_result result = device_enqueue(device, drawn, instances, error);
        if (result != TRIPTYCH_OK)
            return result;
        device_note_drawn(device, drawn_parts(key));
    }
    if (device->hook.on_draw)
        device->hook.on_draw(device->hook.user, device->counts.draws, device->derived.now->key);
    device->counts.draws++;
    device->counts.triangles += (uint64_t)drawn->count * instances;
    if (drawn->count)
        device->counts.vertices += (drawn->highest - drawn->lowest + 1) * instances;
    return TRIPTYCH_OK;
}

void device_use_streams(struct triptych_device *device)
{
    if (!device->state.immediate)
        return;
    device->state.immediate = false;
    device_state_changed(device, CHANGE_OF_STREAM);
}

enum triptych_result device_draw(struct triptych_device *device, enum triptych_primitive primitive,
                                 uint32_t first, uint32_t count, struct error *error)
{
    struct drawn drawn = {.primitive = primitive, .count = count, .base = first};
    device_use_streams(device);
    enum triptych_result result = device_prepare_draw(device, primitive, error);
    if (result == TRIPTYCH_OK)
        result = device_check_no_instances(device, error);
    if (count && result == TRIPTYCH_OK)
        result = check_sequence(device, first, device_corners(primitive, count), &drawn, error);
    if (result == TRIPTYCH_OK)
        drawn.count *= device_parts(primitive);
    return result == TRIPTYCH_OK ? device_count_draw(device, &drawn, error) : result;
}

enum triptych_result device_draw_indexed(struct triptych_device *device, enum triptych_primitive primitive,
                                         int32_t base, uint32_t first, uint32_t count, struct error *error)
{
    struct drawn drawn = {.primitive = primitive, .count = count, .base = (uint32_t)base};
    device_use_streams(device);
    enum triptych_result result = device_prepare_draw(device, primitive, error);
    if (result == TRIPTYCH_OK && !device->state.indices) {
        error_set(error, "no indices: expected set_indices first");
        result = TRIPTYCH_BAD_CALL;
    }
    if (count && result == TRIPTYCH_OK)
        result = check_indices(device, base, first, device_corners(primitive, count), &drawn, error);
    if (result == TRIPTYCH_OK)
        drawn.count *= device_parts(primitive);
    return result == TRIPTYCH_OK ? device_count_draw(device, &drawn, error) : result;
}

/* --- Queries --- */

/* Draws count pixels while any query needs it. */
static void count_while_asked(struct triptych_device *device)
{
    bool counting = device->queries.counting;
    if (device->state.counting != counting)
        device_state_changed(device, CHANGE_OF_COUNTING);
    device->state.counting = counting;
}

enum triptych_result device_query_begin(struct triptych_device *device, struct triptych_query *query,
                                        struct error *error)
{
    enum triptych_result result = query_begin(&device->queries, query, device_commands(device), error);
    count_while_asked(device);
    return result;
}

enum triptych_result device_query_end(struct triptych_device *device, struct triptych_query *query,
                                      struct error *error)
{
    enum triptych_result result = query_end(&device->queries, query, device_commands(device), error);
    count_while_asked(device);
    return result;
}

static enum triptych_result check_ended(const struct triptych_query *query, struct error *error)
{
    if (query->phase != QUERY_IDLE && query->phase != QUERY_BEGUN)
        return TRIPTYCH_OK;
    error_set(error, "result of a query that has not ended: expected its end first");
    return TRIPTYCH_BAD_CALL;
}

enum triptych_result device_query_result(struct triptych_device *device, struct triptych_query *query,
                                         uint64_t *result, struct error *error)
{
    if (check_ended(query, error))
        return TRIPTYCH_BAD_CALL;
    device_finish(device);
    *result = query->result;
    return TRIPTYCH_OK;
}

enum triptych_result device_query_poll(struct triptych_device *device, struct triptych_query *query,
                                       int *ready, uint64_t *result, struct error *error)
{
    if (check_ended(query, error))
        return TRIPTYCH_BAD_CALL;
    if (query->phase != QUERY_RESOLVED)
        device_flush(device);
    *ready = query->phase == QUERY_RESOLVED;
    if (*ready)
        *result = query->result;
    return TRIPTYCH_OK;
}
