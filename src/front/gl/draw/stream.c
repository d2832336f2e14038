/* The streams of a draw: attribute i is stream i. */
#include "front/gl/draw/draw.h"
#include "front/gl/program/program.h"
#include "front/gl/state.h"

#include <string.h>

enum { STREAM_BYTES = 1 << 20, ALIGNMENT = 16, STRIDE_MOST = 65536 };

static size_t padded(size_t bytes)
{
    return (bytes + ALIGNMENT - 1) & ~(size_t)(ALIGNMENT - 1);
}

/* --- Memory of the program --- */

/* Makes room for everything that a draw copies. A buffer that is full begins again; earlier draws keep its
 * old bytes. */
static bool make_room(struct gl_context *context, size_t bytes)
{
    struct gl_stream *stream = &context->stream;
    if (stream->buffer && bytes <= stream->bytes - stream->used)
        return true;
    stream->fresh = true;
    stream->used = 0;
    if (stream->buffer && bytes <= stream->bytes)
        return true;
    if (bytes > INT32_MAX)
        return false;
    triptych_buffer_destroy(context->renderer, stream->buffer);
    *stream = (struct gl_stream){.bytes = bytes > STREAM_BYTES ? bytes : STREAM_BYTES, .fresh = true};
    return triptych_buffer_create(context->renderer, NULL, stream->bytes, &stream->buffer) == TRIPTYCH_OK;
}

/* Copies into the room. `*offset` is that of the copy in the buffer. */
static bool copy(struct gl_context *context, const void *data, size_t bytes, size_t *offset)
{
    struct gl_stream *stream = &context->stream;
    enum triptych_map how = stream->fresh ? TRIPTYCH_MAP_DISCARD : TRIPTYCH_MAP_NO_OVERWRITE;
    void *to;
    if (triptych_buffer_map(context->renderer, stream->buffer, stream->used, bytes, how, &to) != TRIPTYCH_OK)
        return false;
    memcpy(to, data, bytes);
    triptych_buffer_unmap(context->renderer, stream->buffer);
    *offset = stream->used;
    stream->used += padded(bytes);
    stream->fresh = false;
    return true;
}

/* --- Attributes --- */

/* The attributes that the program reads, bit i for location i. Without any, the renderer still needs one. */
static uint32_t used_attributes(const struct gl_context *context)
{
    const struct glsl_program *program = context->program->program;
    uint32_t used = 0;
    for (unsigned i = 0; i < program->attributes; i++)
        used |= ((1u << program->attribute[i].type.columns) - 1) << program->attribute[i].location;
    return used & ((1u << GL_ATTRIBUTES) - 1) ? used : 1;
}

static bool is_in_memory(const struct gl_array *array)
{
    return array->enabled && !array->buffer;
}

bool gl_stream_reads_memory(const struct gl_context *context)
{
    for (uint32_t left = used_attributes(context); left; left &= left - 1)
        if (is_in_memory(&context->vertex_array->array[__builtin_ctz(left)]))
            return true;
    return false;
}

/* The bytes that a draw reads of an array in memory. */
static size_t bytes_read(const struct gl_array *array, const struct gl_draw *draw)
{
    return draw->vertices ? (draw->vertices - 1) * gl_array_stride(array) + gl_array_bytes(array) : 0;
}

static bool bind_current(struct gl_context *context, unsigned i)
{
    const size_t bytes = sizeof context->current;
    enum triptych_result result = TRIPTYCH_OK;
    if (!context->current_buffer)
        result = triptych_buffer_create(context->renderer, context->current, bytes, &context->current_buffer);
    else if (context->current_changed)
        result =
            triptych_buffer_update(context->renderer, context->current_buffer, 0, context->current, bytes);
    context->current_changed = result != TRIPTYCH_OK;
    return result == TRIPTYCH_OK && triptych_set_stream(context->renderer, i, context->current_buffer,
                                                        i * sizeof context->current[0], 0) == TRIPTYCH_OK;
}

static bool bind_memory(struct gl_context *context, unsigned i, const struct gl_array *array,
                        const struct gl_draw *draw)
{
    size_t offset, stride = gl_array_stride(array);
    const uint8_t *first = (const uint8_t *)array->pointer + draw->origin * stride;
    return copy(context, first, bytes_read(array, draw), &offset) &&
           triptych_set_stream(context->renderer, i, context->stream.buffer, offset, stride) == TRIPTYCH_OK;
}

static bool bind_buffer(struct gl_context *context, unsigned i, const struct gl_array *array,
                        const struct gl_draw *draw)
{
    size_t offset = (size_t)array->pointer, stride = gl_array_stride(array), skip = draw->origin * stride;
    triptych_buffer *buffer = gl_buffer_use(context, array->buffer);
    return buffer && offset < array->buffer->bytes && skip < array->buffer->bytes - offset &&
           triptych_set_stream(context->renderer, i, buffer, offset + skip, stride) == TRIPTYCH_OK;
}

static bool bind(struct gl_context *context, unsigned i, const struct gl_draw *draw)
{
    const struct gl_array *array = &context->vertex_array->array[i];
    return !array->enabled       ? bind_current(context, i)
           : is_in_memory(array) ? bind_memory(context, i, array, draw)
                                 : bind_buffer(context, i, array, draw);
}

static bool declare(struct gl_context *context, uint32_t used)
{
    struct triptych_declaration_element elements[GL_ATTRIBUTES];
    unsigned count = 0;
    memset(elements, 0, sizeof elements); /* they are compared byte by byte */
    for (uint32_t left = used; left; left &= left - 1) {
        unsigned i = (unsigned)__builtin_ctz(left);
        const struct gl_array *array = &context->vertex_array->array[i];
        elements[count].stream = i;
        elements[count].format = array->enabled ? gl_array_format(array) : TRIPTYCH_FORMAT_FLOAT4;
        elements[count].usage = TRIPTYCH_USAGE_TEXCOORD;
        elements[count++].usage_index = i;
    }
    bool known = context->declared == count && !(context->late & GL_LATE_SHADERS) &&
                 !memcmp(elements, context->declaration, count * sizeof *elements);
    memcpy(context->declaration, elements, sizeof elements);
    context->declared = count;
    return known || triptych_set_declaration(context->renderer, elements, count) == TRIPTYCH_OK;
}

/* --- Indices --- */

static bool are_copied(const struct gl_draw *draw)
{
    if (!draw->indices)
        return false;
    return !draw->elements ||
           (size_t)((const uint8_t *)draw->indices - draw->elements->memory) % (draw->bits / 8);
}

static bool bind_indices(struct gl_context *context, const struct gl_draw *draw, uint32_t *first)
{
    unsigned bytes = draw->bits / 8;
    triptych_buffer *buffer = context->stream.buffer;
    size_t offset = 0;
    *first = 0;
    if (!draw->indices)
        return true;
    if (are_copied(draw)) {
        if (!copy(context, draw->indices, (size_t)draw->count * bytes, &offset))
            return false;
    } else {
        offset = (size_t)((const uint8_t *)draw->indices - draw->elements->memory);
        buffer = gl_buffer_use(context, draw->elements);
    }
    *first = (uint32_t)(offset / bytes);
    return buffer && triptych_set_indices(context->renderer, buffer, draw->bits) == TRIPTYCH_OK;
}

/* The room for all that is copied; SIZE_MAX if an array cannot be read. */
static size_t room_of(const struct gl_context *context, uint32_t used, const struct gl_draw *draw)
{
    size_t room = are_copied(draw) ? padded((size_t)draw->count * draw->bits / 8) : 0;
    for (uint32_t left = used; left; left &= left - 1) {
        const struct gl_array *array = &context->vertex_array->array[__builtin_ctz(left)];
        if (array->enabled && gl_array_stride(array) > STRIDE_MOST)
            return SIZE_MAX;
        if (is_in_memory(array) && !array->pointer)
            return SIZE_MAX;
        room += is_in_memory(array) ? padded(bytes_read(array, draw)) : 0;
    }
    return room;
}

bool gl_stream_bind(struct gl_context *context, const struct gl_draw *draw, uint32_t *first)
{
    uint32_t used = used_attributes(context);
    size_t room = room_of(context, used, draw);
    if (room == SIZE_MAX)
        return false;
    if (room && !make_room(context, room)) {
        gl_error(context, GL_OUT_OF_MEMORY, "no memory for %zu bytes of vertices", room);
        return false;
    }
    for (uint32_t left = used; left; left &= left - 1)
        if (!bind(context, (unsigned)__builtin_ctz(left), draw))
            return false;
    return declare(context, used) && bind_indices(context, draw, first);
}
