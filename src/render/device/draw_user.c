/* Immediate draws: their vertices and indices are in memory of the caller, which may change after the
 * call.
 *
 * The data are copied to transient memory (render/draw/transient.h) when the draw is queued. Stream 0 of
 * the draw is a stream of that memory. Data that do not fit there are storage that is retired immediately. */
#include "render/device/device_part.h"

#include <inttypes.h>
#include <string.h>

enum { USER_STRIDE_MAXIMUM = 65536 };

/* --- Checks --- */

static enum triptych_result check_sizes(const struct user_draw *draw, uint64_t vertices, uint64_t indices,
                                        struct error *error)
{
    if (vertices > INT32_MAX / draw->stride || indices > INT32_MAX / sizeof(uint32_t)) {
        error_set(error,
                  "%" PRIu64 " vertices of %zu bytes, %" PRIu64 " indices: expected at most 2^31 - 1 bytes",
                  vertices, draw->stride, indices);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    return TRIPTYCH_OK;
}

static enum triptych_result check_indices(const struct user_draw *draw, uint32_t corners, struct drawn *drawn,
                                          struct error *error)
{
    struct index_range range = buffer_scan_indices(draw->indices, draw->index_bits, corners);
    if (range.maximum >= draw->vertex_count) {
        error_set(error, "index %" PRIu32 ": expected less than %" PRIu32 ", the number of vertices",
                  range.maximum, draw->vertex_count);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    drawn->lowest = range.minimum;
    drawn->highest = range.maximum;
    return TRIPTYCH_OK;
}

static enum triptych_result check_vertices(const struct triptych_device *device, const struct user_draw *draw,
                                           const struct drawn *drawn, struct error *error)
{
    const struct derived_source *derived = device->derived.now;
    if (derived->streams & 1 && derived->extent[0] > draw->stride) {
        error_set(error, "vertices of %zu bytes: expected at least %" PRIu32 ", the end of their elements",
                  draw->stride, derived->extent[0]);
        return TRIPTYCH_BAD_CALL;
    }
    return device_check_vertices(device, drawn->highest, error);
}

/* --- Draws --- */

/* Makes a stream of transient memory stream 0 of the next draw. */
static void use_stream(struct triptych_device *device, struct triptych_buffer *buffer, size_t stride)
{
    struct state *state = &device->state;
    struct state_stream *stream = &state->immediate_stream;
    if (state->immediate && stream->buffer == buffer && stream->stride == stride)
        return;
    *stream = (struct state_stream){
        .buffer = buffer, .stride = stride, .offset = transient_next(&device->transient)};
    state->immediate = true;
    device_state_changed(device, CHANGE_OF_STREAM);
}

/* Draws data that do not fit into transient memory. */
static enum triptych_result draw_large(struct triptych_device *device, const struct immediate *immediate,
                                       struct drawn *drawn, struct error *error)
{
    struct state *state = &device->state;
    size_t index_offset = (immediate->vertex_bytes + sizeof(uint32_t) - 1) & -sizeof(uint32_t);
    size_t bytes = index_offset + immediate->index_bytes;
    uint8_t *storage = device_new_storage(device, bytes);
    if (!storage) {
        error_set(error, "out of memory for %zu bytes of immediate vertices", bytes);
        return TRIPTYCH_NO_MEMORY;
    }
    memcpy(storage, immediate->vertices, immediate->vertex_bytes);
    if (immediate->index_bytes)
        memcpy(storage + index_offset, immediate->indices, immediate->index_bytes);
    device->transient.large.data = storage;
    device->transient.large.bytes = immediate->vertex_bytes;
    state->immediate_stream =
        (struct state_stream){.buffer = &device->transient.large, .stride = immediate->stride};
    device_state_changed(device, CHANGE_OF_STREAM);
    device_derived_update_streams(&device->derived, state);
    drawn->immediate = NULL;
    if (drawn->index_bits)
        drawn->indices = storage + index_offset;
    enum triptych_result result = device_count_draw(device, drawn, error);
    state->immediate = false;
    device_state_changed(device, CHANGE_OF_STREAM);
    device_retire(device, storage, device->epoch);
    device_limit_retired(device);
    return result;
}

static enum triptych_result draw_checked(struct triptych_device *device, const struct user_draw *draw,
                                         uint32_t corners, struct drawn *drawn, struct error *error)
{
    uint32_t vertices = draw->indices ? draw->vertex_count : corners;
    const struct immediate immediate = {
        .vertices = draw->vertices,
        .vertex_bytes = vertices * draw->stride,
        .stride = (uint32_t)draw->stride,
        .indices = draw->indices,
        .index_bytes = draw->indices ? (size_t)corners * draw->index_bits / 8 : 0,
        .moves = device->derived.now->streams != 1,
    };
    drawn->immediate = &immediate;
    if (!transient_may_fit(&immediate))
        return draw_large(device, &immediate, drawn, error);
    enum triptych_result result = device_count_draw(device, drawn, error);
    drawn->immediate = NULL;
    return result;
}

/* Checks what depends on the number of vertices, and draws. */
static enum triptych_result draw_vertices(struct triptych_device *device, const struct user_draw *draw,
                                          struct error *error)
{
    uint64_t corners = device_corners(draw->primitive, draw->count);
    struct drawn drawn = {.primitive = draw->primitive,
                          .count = draw->count * device_parts(draw->primitive),
                          .highest = corners - 1};
    enum triptych_result result =
        check_sizes(draw, draw->indices ? draw->vertex_count : corners, corners, error);
    if (draw->indices && result == TRIPTYCH_OK) {
        drawn.index_bits = draw->index_bits;
        result = check_indices(draw, (uint32_t)corners, &drawn, error);
    }
    if (result == TRIPTYCH_OK)
        result = check_vertices(device, draw, &drawn, error);
    return result == TRIPTYCH_OK ? draw_checked(device, draw, (uint32_t)corners, &drawn, error) : result;
}

static enum triptych_result check_types(const struct user_draw *draw, struct error *error)
{
    if (draw->indices && draw->index_bits != 8 && draw->index_bits != 16 && draw->index_bits != 32) {
        error_set(error, "indices of %u bits: expected 8, 16 or 32", draw->index_bits);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    if (!draw->stride || draw->stride > USER_STRIDE_MAXIMUM) {
        error_set(error, "vertices of %zu bytes: expected 1 to %d", draw->stride, USER_STRIDE_MAXIMUM);
        return TRIPTYCH_BAD_ARGUMENT;
    }
    return TRIPTYCH_OK;
}

enum triptych_result device_draw_user(struct triptych_device *device, const struct user_draw *draw,
                                      struct error *error)
{
    enum triptych_result result = check_types(draw, error);
    if (result == TRIPTYCH_OK && transient_create(&device->transient, error))
        result = TRIPTYCH_NO_MEMORY;
    if (result != TRIPTYCH_OK)
        return result;
    use_stream(device, &device->transient.buffer, draw->stride);
    result = device_prepare_draw(device, draw->primitive, error);
    if (result == TRIPTYCH_OK && !draw->indices)
        result = device_check_no_instances(device, error);
    if (result != TRIPTYCH_OK)
        return result;
    if (!draw->count)
        return device_count_draw(device, &(struct drawn){.primitive = draw->primitive}, error);
    return draw_vertices(device, draw, error);
}
