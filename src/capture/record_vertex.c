/* Vertex declarations and draws.
 *
 * A stream checks draws against everything that is declared, a device only against what the pipeline reads.
 * An element that exceeds its buffer and that the draw does not read is therefore undeclared for the draw,
 * and declared again afterwards. */
#include "capture/record_part.h"

#include <string.h>

/* --- Declarations --------------------------------------------------------------------------------------- */

void record_element(struct triptych_device *device, enum triptych_attribute attribute,
                    const struct triptych_element *element)
{
    if (!device_recorder(device))
        return;
    struct call call = {.type = CALL_BIND_ELEMENT, .resource = NO_RESOURCE};
    call.element.attribute = attribute;
    call.element.format = element->format;
    if (element->format) {
        call.resource = element->buffer->recorded;
        call.element.offset = (uint32_t)element->offset;
        call.element.stride = (uint32_t)element->stride;
    }
    record_call(device, &call);
}

void record_declaration(struct triptych_device *device, const struct triptych_declaration_element *elements,
                        unsigned count)
{
    struct call call = {.type = CALL_DECLARE, .resource = NO_RESOURCE, .declare.count = count};
    for (unsigned i = 0; i < count && device_recorder(device); i++)
        call.declare.element[i] = (struct call_declared){.usage = (uint8_t)elements[i].usage,
                                                         .usage_index = (uint8_t)elements[i].usage_index,
                                                         .format = (uint8_t)elements[i].format,
                                                         .stream = (uint8_t)elements[i].stream,
                                                         .offset = (uint16_t)elements[i].offset};
    if (device_recorder(device)) {
        call.type = call_declare_type(&call.declare);
        record_call(device, &call);
    }
}

void record_stream(struct triptych_device *device, unsigned stream, const triptych_buffer *buffer,
                   size_t offset, size_t stride)
{
    if (!device_recorder(device))
        return;
    struct call call = {.type = CALL_BIND_STREAM, .resource = NO_RESOURCE, .bind_stream.number = stream};
    if (buffer) {
        call.resource = buffer->recorded;
        call.bind_stream.offset = (uint32_t)offset;
        call.bind_stream.stride = (uint32_t)stride;
    }
    record_call(device, &call);
}

void record_frequency(struct triptych_device *device, unsigned stream, enum triptych_frequency frequency,
                      uint32_t count)
{
    if (device_recorder(device))
        record_call(device, &(struct call){.type = CALL_FREQUENCY,
                                           .resource = NO_RESOURCE,
                                           .frequency = {stream, frequency, count}});
}

void record_indices(struct triptych_device *device, const triptych_buffer *buffer, unsigned bits)
{
    if (!device_recorder(device))
        return;
    struct call call = {.type = CALL_BIND_INDICES, .resource = NO_RESOURCE};
    if (buffer) {
        call.resource = buffer->recorded;
        call.bind_indices.bits = bits;
    }
    record_call(device, &call);
}

/* --- All that is declared ------------------------------------------------------------------------------- */

static struct call_declared declared_of(unsigned usage, unsigned usage_index,
                                        const struct state_element *element)
{
    return (struct call_declared){.usage = (uint8_t)usage,
                                  .usage_index = (uint8_t)usage_index,
                                  .format = (uint8_t)element->format,
                                  .stream = (uint8_t)element->stream,
                                  .offset = (uint16_t)element->offset};
}

static void write_declaration(struct triptych_device *device, const struct left_out *left_out)
{
    const struct state *state = device_state(device);
    struct call call = {.type = CALL_DECLARE, .resource = NO_RESOURCE};
    for (unsigned a = 0; a < TRIPTYCH_ATTRIBUTE_COUNT; a++) {
        const struct state_element *element = &state->element[a];
        unsigned index, usage = resource_element_usage(a, &index);
        if (element->format && element->stream < TRIPTYCH_STREAMS && !(left_out->attributes >> a & 1))
            call.declare.element[call.declare.count++] = declared_of(usage, index, element);
    }
    for (unsigned i = 0; i < state->others; i++)
        if (!(left_out->others >> i & 1))
            call.declare.element[call.declare.count++] =
                declared_of(state->other[i].usage, state->other[i].usage_index, &state->other[i].element);
    call.type = call_declare_type(&call.declare);
    record_call(device, &call);
}

void record_vertex_input(struct triptych_device *device, const struct left_out *left_out)
{
    const struct state *state = device_state(device);
    write_declaration(device, left_out);
    for (unsigned a = 0; a < TRIPTYCH_ATTRIBUTE_COUNT; a++) {
        const struct state_element *element = &state->element[a];
        const struct state_stream *stream = &state->stream[element->stream];
        struct call call = {.type = CALL_BIND_ELEMENT};
        if (!element->format || element->stream < TRIPTYCH_STREAMS || !stream->buffer ||
            left_out->attributes >> a & 1)
            continue;
        call.resource = stream->buffer->recorded;
        call.element.attribute = (enum triptych_attribute)a;
        call.element.format = element->format;
        call.element.offset = (uint32_t)stream->offset;
        call.element.stride = (uint32_t)stream->stride;
        record_call(device, &call);
    }
}

/* --- Draws ---------------------------------------------------------------------------------------------- */

/* The same condition as in command/stream/follow_vertices.c. */
static bool lies_within(const struct state *state, const struct state_element *element, uint64_t last)
{
    const struct state_stream *stream = &state->stream[element->stream];
    if (!stream->buffer)
        return element->stream >= TRIPTYCH_STREAMS;
    if (stream->frequency == TRIPTYCH_FREQUENCY_INSTANCE)
        last = (state_instances(state) - 1) / stream->count;
    if (stream->offset + element->offset + key_vertex_types[element->format].bytes > stream->buffer->bytes)
        return false;
    return last <= state_last_vertex(state, element);
}

/* The vertices of a draw. */
struct reach {
    uint64_t last; /* that it reads */
    size_t stride; /* of immediate vertices; 0: stream 0 is bound */
};

static bool fits(const struct state *state, const struct state_element *element, const struct reach *reach)
{
    if (reach->stride && !element->stream)
        return element->offset + key_vertex_types[element->format].bytes <= reach->stride;
    return lies_within(state, element, reach->last);
}

static struct left_out find_left_out(const struct state *state, const struct reach *reach)
{
    struct left_out left_out = {0};
    for (unsigned a = 0; a < TRIPTYCH_ATTRIBUTE_COUNT; a++)
        if (state->element[a].format && !fits(state, &state->element[a], reach))
            left_out.attributes |= (uint64_t)1 << a;
    for (unsigned i = 0; i < state->others; i++)
        if (!fits(state, &state->other[i].element, reach))
            left_out.others |= (uint64_t)1 << i;
    return left_out;
}

static void add_draw(struct triptych_device *device, const struct call *call, uint32_t count,
                     const struct reach *reach)
{
    static const struct left_out none;
    struct left_out left_out = count ? find_left_out(device_state(device), reach) : none;
    record_all_mapped(device);
    bool some = left_out.attributes || left_out.others;
    if (some)
        record_vertex_input(device, &left_out);
    record_call(device, call);
    if (some)
        record_vertex_input(device, &none);
}

void record_draw(struct triptych_device *device, enum triptych_primitive primitive, uint32_t first,
                 uint32_t count)
{
    if (!device_recorder(device))
        return;
    struct call call = {.type = CALL_DRAW, .resource = NO_RESOURCE};
    call.draw.primitive = primitive;
    call.draw.first = first;
    call.draw.count = count;
    uint64_t last = count ? first + device_corners(primitive, count) - 1 : 0;
    add_draw(device, &call, count, &(struct reach){.last = last});
}

void record_draw_indexed(struct triptych_device *device, enum triptych_primitive primitive, int32_t base,
                         uint32_t first, uint32_t count)
{
    struct call call = {.type = CALL_DRAW_INDEXED, .resource = NO_RESOURCE};
    uint64_t last = 0;
    if (!device_recorder(device))
        return;
    call.draw_indexed.primitive = primitive;
    call.draw_indexed.base = base;
    call.draw_indexed.first = first;
    call.draw_indexed.count = count;
    if (count) {
        const struct index_range *range =
            buffer_index_range(device_state(device)->indices, device_state(device)->index_bits, first,
                               (uint32_t)device_corners(primitive, count));
        last = (uint64_t)((int64_t)base + range->maximum);
    }
    add_draw(device, &call, count, &(struct reach){.last = last});
}

/* Vertices and indices become buffers, which are released after the draw. Without primitives there may be no
 * vertices. */
void record_draw_user(struct triptych_device *device, const struct user_draw *draw)
{
    if (!device_recorder(device) || !draw->count)
        return;
    struct call call = {.type = draw->indices ? CALL_DRAW_INDEXED_USER : CALL_DRAW_USER};
    uint64_t corners = device_corners(draw->primitive, draw->count), last = corners - 1;
    uint32_t indices = NO_RESOURCE;
    size_t count = draw->indices ? draw->vertex_count : (size_t)corners;
    call.resource = record_bytes(device, draw->vertices, count * draw->stride);
    if (draw->indices) {
        last = buffer_scan_indices(draw->indices, draw->index_bits, (uint32_t)corners).maximum;
        indices = record_bytes(device, draw->indices, (size_t)corners * draw->index_bits / 8);
        call.draw_indexed_user = (struct call_draw_indexed_user){
            draw->primitive, draw->count, (uint32_t)draw->stride, indices, draw->index_bits};
    } else {
        call.draw_user = (struct call_draw_user){draw->primitive, draw->count, (uint32_t)draw->stride};
    }
    add_draw(device, &call, draw->count, &(struct reach){last, draw->stride});
    record_release(device, call.resource);
    if (indices != NO_RESOURCE)
        record_release(device, indices);
}
