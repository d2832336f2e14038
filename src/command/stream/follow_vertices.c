/* Vertex declarations, bindings and draws. A draw is checked against everything that is bound, even if the
 * pipeline does not read it. */
#include "command/stream/follow_part.h"

#include <inttypes.h>

/* --- Bindings ------------------------------------------------------------------------------------------- */

static int bind_element(struct follower *follower, enum triptych_attribute attribute, uint32_t resource,
                        enum triptych_format format, uint32_t offset, uint32_t stride, struct error *error)
{
    struct triptych_element element = {.format = format, .offset = offset, .stride = stride};
    if (format != TRIPTYCH_FORMAT_NONE && !(element.buffer = follower_buffer(follower, resource, error)))
        return -1;
    return state_set_element(&follower->state, attribute, &element, error) ? -1 : 0;
}

int follow_bind_element(struct follower *follower, const struct call *call, struct error *error)
{
    return bind_element(follower, call->element.attribute, call->resource, call->element.format,
                        call->element.offset, call->element.stride, error);
}

int follow_bind_stream(struct follower *follower, const struct call *call, struct error *error)
{
    struct triptych_buffer *buffer = NULL;
    if (call->resource != NO_RESOURCE && !(buffer = follower_buffer(follower, call->resource, error)))
        return -1;
    return state_set_stream(&follower->state, call->bind_stream.number, buffer, call->bind_stream.offset,
                            call->bind_stream.stride, error);
}

int follow_declare(struct follower *follower, const struct call *call, struct error *error)
{
    struct triptych_declaration_element elements[TRIPTYCH_DECLARATION_ELEMENTS];
    unsigned count = stream_declaration(call, elements);
    return state_set_declaration(&follower->state, elements, count, error);
}

static int bind_vertices(struct follower *follower, uint32_t resource, struct error *error)
{
    const struct layout *layout = &follower->stream->resources[resource].layout;
    struct triptych_declaration_element elements[STREAM_ELEMENTS];
    unsigned count = stream_declare_layout(layout, elements);
    if (state_set_declaration(&follower->state, elements, count, error))
        return -1;
    if (count) {
        struct triptych_buffer *buffer = follower_buffer(follower, resource, error);
        return buffer ? (int)state_set_stream(&follower->state, 0, buffer, 0, layout->stride, error) : -1;
    }
    for (unsigned a = 0; a < TRIPTYCH_ATTRIBUTE_COUNT; a++)
        if (layout->format[a] != TRIPTYCH_FORMAT_NONE &&
            bind_element(follower, (enum triptych_attribute)a, resource, layout->format[a], layout->offset[a],
                         layout->stride, error))
            return -1;
    return 0;
}

int follow_bind_vertices(struct follower *follower, const struct call *call, struct error *error)
{
    return bind_vertices(follower, call->resource, error);
}

/* Also for a mesh that is drawn: its call has no bits, and no member. */
int follow_bind_indices(struct follower *follower, const struct call *call, struct error *error)
{
    uint32_t bits = call->type == CALL_BIND_INDICES ? call->bind_indices.bits : 0;
    (void)error;
    follower->indices = call->resource;
    if (call->resource != NO_RESOURCE)
        follower->index_bits = bits ? bits : follower->stream->resources[call->resource].index_bits;
    return 0;
}

int follow_fvf(struct follower *follower, const struct call *call, struct error *error)
{
    return state_set_fvf(&follower->state, call->fvf.code, error) ? -1 : 0;
}

int follow_frequency(struct follower *follower, const struct call *call, struct error *error)
{
    return state_set_frequency(&follower->state, call->frequency.stream, call->frequency.frequency,
                               call->frequency.count, error)
               ? -1
               : 0;
}

/* --- Draws ---------------------------------------------------------------------------------------------- */

static const char *buffer_name(const struct follower *follower, const struct triptych_buffer *buffer)
{
    return follower->stream->resources[((const struct stand_in *)(const void *)buffer)->resource].name;
}

/* The bound elements have numbers: the attributes, then the others. */
static const struct state_element *element_at(const struct state *state, unsigned number)
{
    return number < TRIPTYCH_ATTRIBUTE_COUNT ? &state->element[number]
                                             : &state->other[number - TRIPTYCH_ATTRIBUTE_COUNT].element;
}

static const char *element_word(const struct state *state, unsigned number)
{
    if (number < TRIPTYCH_ATTRIBUTE_COUNT)
        return word_text(WORDS_ATTRIBUTE, number);
    const struct state_other *other = &state->other[number - TRIPTYCH_ATTRIBUTE_COUNT];
    return stream_element_word(other->usage, other->usage_index);
}

/* Checks that vertices up to `last`, or all that the instances use, have the element. */
static int check_element(const struct follower *follower, unsigned number, uint64_t last, struct error *error)
{
    const struct state *state = &follower->state;
    const struct state_element *element = element_at(state, number);
    const struct state_stream *stream = state_source(state, element);
    if (stream->frequency == TRIPTYCH_FREQUENCY_INSTANCE)
        last = (state_instances(state) - 1) / stream->count;
    if (!stream->buffer)
        return error_set(error, "found %s in stream %u with nothing bound, expected bind stream before it",
                         element_word(state, number), element->stream);
    const char *name = buffer_name(follower, stream->buffer);
    size_t end = stream->offset + element->offset + key_vertex_types[element->format].bytes;
    if (end > stream->buffer->bytes)
        return error_set(error, "found %s at bytes up to %zu, expected at most %zu, those of %s",
                         element_word(state, number), end, stream->buffer->bytes, name);
    if (stream == &state->immediate_stream && end > stream->stride)
        return error_set(error, "found %s at bytes up to %zu, expected at most the stride of %zu",
                         element_word(state, number), end, stream->stride);
    uint64_t most = state_last_vertex(state, element);
    if (last > most)
        return error_set(error,
                         "found vertex %" PRIu64 " drawn, expected at most %" PRIu64 ", the last %s in %s",
                         last, most, element_word(state, number), name);
    return 0;
}

/* Checks that vertices up to `last` are within all bound elements. */
static int check_vertices(const struct follower *follower, uint64_t last, struct error *error)
{
    const struct state *state = &follower->state;
    for (unsigned number = 0; number < TRIPTYCH_ATTRIBUTE_COUNT + state->others; number++)
        if (element_at(state, number)->format != TRIPTYCH_FORMAT_NONE &&
            check_element(follower, number, last, error))
            return -1;
    return 0;
}

static int check_no_instances(const struct follower *follower, struct error *error)
{
    for (unsigned i = 0; i < TRIPTYCH_STREAMS; i++)
        if (follower->state.stream[i].frequency != TRIPTYCH_FREQUENCY_VERTEX)
            return error_set(error,
                             "found stream %u stepping by instance, expected frequency %u vertex 1 "
                             "or an indexed draw",
                             i, i);
    return 0;
}

/* Finds the smallest and largest index of a range. The buffer caches them. */
static int index_extremes(struct follower *follower, uint64_t first, uint64_t count, uint32_t *least,
                          uint32_t *most, struct error *error)
{
    struct triptych_buffer *buffer = follower_buffer(follower, follower->indices, error);
    if (!buffer)
        return -1;
    const struct index_range *range =
        buffer_index_range(buffer, follower->index_bits, (uint32_t)first, (uint32_t)count);
    *least = range->minimum;
    *most = range->maximum;
    return 0;
}

/* The extremes of all indices suffice for most draws. Only if they exceed the vertices is the range of the
 * draw examined. */
static int check_indices(struct follower *follower, int32_t base, uint64_t first, uint64_t count,
                         struct error *error)
{
    const struct resource *resource = &follower->stream->resources[follower->indices];
    const struct triptych_buffer *buffer = follower_buffer(follower, follower->indices, error);
    uint32_t least = resource->index_least, most = resource->index_most;
    if (!buffer)
        return -1;
    size_t bytes;
    resource_data(resource, &bytes);
    uint64_t room = bytes / (follower->index_bits / 8);
    if (first + count > room)
        return error_set(error, "found index %" PRIu64 " drawn, expected at most %" PRIu64 ", the last in %s",
                         first + count - 1, room - 1, resource->name);
    struct error ignored;
    error_clear(&ignored);
    if (!resource->indices || buffer->version || (int64_t)base + least < 0 ||
        check_vertices(follower, (uint64_t)((int64_t)base + most), &ignored))
        if (index_extremes(follower, first, count, &least, &most, error))
            return -1;
    if ((int64_t)base + least < 0)
        return error_set(error, "found vertex %" PRId64 " drawn, expected 0 or more", (int64_t)base + least);
    if ((int64_t)base + most > UINT32_MAX)
        return error_set(error, "found vertex %" PRId64 " drawn, expected less than 2^32",
                         (int64_t)base + most);
    return check_vertices(follower, (uint64_t)((int64_t)base + most), error);
}

/* Checks the state that both kinds of draws need. */
static int check_state(struct follower *follower, struct error *error)
{
    const struct state *state = &follower->state;
    if (!follower->integers_checked && state_check_integers(&follower->state, error))
        return -1;
    follower->integers_checked = true;
    if (!state->program[STAGE_VERTEX] && !state->element[TRIPTYCH_POSITION].format &&
        !state->element[TRIPTYCH_POSITIONT].format)
        return error_set(error, "found no position bound, expected bind vertices before it");
    return 0;
}

int follow_draw(struct follower *follower, const struct call *call, struct error *error)
{
    uint64_t first = call->draw.first;
    if (check_state(follower, error) || check_no_instances(follower, error))
        return -1;
    if (!call->draw.count)
        return 0;
    uint64_t last = first + device_corners(call->draw.primitive, call->draw.count) - 1;
    if (last > UINT32_MAX)
        return error_set(error, "found vertex %" PRIu64 " drawn, expected less than 2^32", last);
    return check_vertices(follower, last, error);
}

int follow_draw_indexed(struct follower *follower, const struct call *call, struct error *error)
{
    if (check_state(follower, error))
        return -1;
    if (follower->indices == NO_RESOURCE)
        return error_set(error, "found no indices bound, expected bind indices before it");
    if (!call->draw_indexed.count)
        return 0;
    uint64_t count = device_corners(call->draw_indexed.primitive, call->draw_indexed.count);
    return check_indices(follower, call->draw_indexed.base, call->draw_indexed.first, count, error);
}

/* --- Immediate draws ------------------------------------------------------------------------------------ */

/* Checks vertices up to `last`, stream 0 being a resource with its first vertex at the start. */
static int check_immediate(struct follower *follower, uint32_t resource, uint32_t stride, uint64_t last,
                           struct error *error)
{
    struct triptych_buffer *buffer = follower_buffer(follower, resource, error);
    if (!buffer)
        return -1;
    if (!stride)
        return error_set(error, "found a stride of 0, expected 1 to 65536");
    if (last >= buffer->bytes / stride)
        return error_set(error, "found vertex %" PRIu64 " drawn, expected less than %zu, the vertices of %s",
                         last, buffer->bytes / stride, buffer_name(follower, buffer));
    follower->state.immediate_stream = (struct state_stream){.buffer = buffer, .stride = stride};
    follower->state.immediate = true;
    int result = check_vertices(follower, last, error);
    follower->state.immediate = false;
    return result;
}

int follow_draw_user(struct follower *follower, const struct call *call, struct error *error)
{
    if (check_state(follower, error) || check_no_instances(follower, error))
        return -1;
    uint64_t corners =
        call->draw_user.count
            ? device_corners((enum triptych_primitive)call->draw_user.primitive, call->draw_user.count)
            : 1;
    return check_immediate(follower, call->resource, call->draw_user.stride, corners - 1, error);
}

int follow_draw_indexed_user(struct follower *follower, const struct call *call, struct error *error)
{
    const struct resource *indices = &follower->stream->resources[call->draw_indexed_user.indices];
    uint32_t bits = call->draw_indexed_user.bits, count = call->draw_indexed_user.count;
    size_t bytes;
    const void *data = resource_data(indices, &bytes);
    if (check_state(follower, error))
        return -1;
    if (bits != 8 && bits != 16 && bits != 32)
        return error_set(error, "found indices of %u bits, expected 8, 16 or 32", bits);
    uint64_t corners =
        count ? device_corners((enum triptych_primitive)call->draw_indexed_user.primitive, count) : 0;
    if (corners > bytes / (bits / 8))
        return error_set(error, "found index %" PRIu64 " drawn, expected at most %zu, the last in %s",
                         corners - 1, bytes / (bits / 8) - 1, indices->name);
    uint32_t last = corners ? buffer_scan_indices(data, bits, (uint32_t)corners).maximum : 0;
    return check_immediate(follower, call->resource, call->draw_indexed_user.stride, last, error);
}

int follow_draw_mesh(struct follower *follower, const struct call *call, struct error *error)
{
    follow_bind_indices(follower, call, error);
    return bind_vertices(follower, call->resource, error);
}
