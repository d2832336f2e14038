/* Buffer objects: chapter 2.9; OES_mapbuffer, EXT_map_buffer_range. */
#include "front/gl/draw/buffer.h"
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/state.h"
#include "front/gl/draw/vertex_array.h"

#include <stdlib.h>
#include <string.h>

/* --- Names --- */

static void destroy(struct gl_object *object)
{
    struct gl_buffer *buffer = (struct gl_buffer *)object;
    triptych_buffer_destroy(object->share->renderer, buffer->renderer);
    free(buffer->memory);
}

static struct gl_object *make(struct gl_context *context, GLuint name)
{
    struct gl_buffer *buffer = gl_object_make(context->share, sizeof *buffer, name, destroy);
    if (buffer)
        buffer->usage = GL_STATIC_DRAW;
    return (struct gl_object *)buffer;
}

static struct gl_buffer **binding_of(struct gl_context *context, GLenum target)
{
    if (target == GL_ARRAY_BUFFER)
        return &context->array_buffer;
    if (target == GL_ELEMENT_ARRAY_BUFFER)
        return &context->vertex_array->elements;
    gl_error(context, GL_INVALID_ENUM, "found %s, expected a target of buffers", gl_constant_name(target));
    return NULL;
}

void gl_BindBuffer(struct gl_context *context, GLenum target, GLuint name)
{
    struct gl_buffer **place = binding_of(context, target);
    struct gl_object *found = NULL;
    if (place && (!name || (found = gl_object_bind(context, GL_KIND_BUFFER, name, make))))
        GL_HOLD(place, found);
}

void gl_GenBuffers(struct gl_context *context, GLsizei count, GLuint *names)
{
    gl_object_generate(context, GL_KIND_BUFFER, count, names);
}

static void unbind(struct gl_context *context, struct gl_object *object)
{
    if ((struct gl_object *)context->array_buffer == object)
        GL_HOLD(&context->array_buffer, NULL);
    gl_vertex_array_detach(context, object);
    ((struct gl_buffer *)object)->mapped = false;
}

void gl_DeleteBuffers(struct gl_context *context, GLsizei count, const GLuint *names)
{
    gl_object_delete(context, GL_KIND_BUFFER, count, names, unbind);
}

GLboolean gl_IsBuffer(struct gl_context *context, GLuint name)
{
    return gl_object_find(context, GL_KIND_BUFFER, name) != NULL;
}

/* --- Contents --- */

static struct gl_buffer *bound(struct gl_context *context, GLenum target)
{
    struct gl_buffer **place = binding_of(context, target);
    if (place && !*place)
        gl_error(context, GL_INVALID_OPERATION, "found no buffer at %s, expected a bound one",
                 gl_constant_name(target));
    return place ? *place : NULL;
}

static void change(struct gl_buffer *buffer, size_t first, size_t last)
{
    bool fresh = !buffer->last;
    buffer->first = fresh || first < buffer->first ? first : buffer->first;
    buffer->last = last > buffer->last ? last : buffer->last;
}

static bool is_usage(GLenum usage)
{
    return usage == GL_STATIC_DRAW || usage == GL_DYNAMIC_DRAW || usage == GL_STREAM_DRAW;
}

/* The renderer's buffer stays if its size does. */
static bool resize(struct gl_context *context, struct gl_buffer *buffer, size_t bytes)
{
    if (bytes == buffer->bytes)
        return true;
    uint8_t *memory = bytes ? malloc(bytes) : NULL;
    if (bytes && !memory)
        return false;
    free(buffer->memory);
    triptych_buffer_destroy(context->renderer, buffer->renderer);
    buffer->renderer = NULL;
    buffer->memory = memory;
    buffer->bytes = bytes;
    buffer->last = 0;
    return true;
}

void gl_BufferData(struct gl_context *context, GLenum target, GLsizeiptr size, const void *data, GLenum usage)
{
    struct gl_buffer **place = binding_of(context, target);
    if (!place)
        return;
    if (!is_usage(usage)) {
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a usage of buffers", gl_constant_name(usage));
        return;
    }
    if (size < 0) {
        gl_error(context, GL_INVALID_VALUE, "found %td bytes, expected 0 or more", (ptrdiff_t)size);
        return;
    }
    struct gl_buffer *buffer = bound(context, target);
    if (!buffer)
        return;
    buffer->mapped = false;
    if (size > INT32_MAX || !resize(context, buffer, (size_t)size)) {
        gl_error(context, GL_OUT_OF_MEMORY, "no memory for a buffer of %td bytes", (ptrdiff_t)size);
        return;
    }
    buffer->usage = usage;
    if (!size)
        return;
    if (data)
        memcpy(buffer->memory, data, (size_t)size);
    else
        memset(buffer->memory, 0, (size_t)size);
    change(buffer, 0, (size_t)size);
}

static bool check_range(struct gl_context *context, const struct gl_buffer *buffer, GLintptr offset,
                        GLsizeiptr size)
{
    bool fits = offset >= 0 && size >= 0 && (size_t)offset <= buffer->bytes &&
                (size_t)size <= buffer->bytes - (size_t)offset;
    if (!fits)
        gl_error(context, GL_INVALID_VALUE, "found %td bytes at %td, expected a part of %zu bytes",
                 (ptrdiff_t)size, (ptrdiff_t)offset, buffer->bytes);
    return fits;
}

void gl_BufferSubData(struct gl_context *context, GLenum target, GLintptr offset, GLsizeiptr size,
                      const void *data)
{
    struct gl_buffer *buffer = bound(context, target);
    if (!buffer || !check_range(context, buffer, offset, size))
        return;
    if (buffer->mapped) {
        gl_error(context, GL_INVALID_OPERATION, "found a mapped buffer");
        return;
    }
    if (!size)
        return;
    memcpy(buffer->memory + offset, data, (size_t)size);
    change(buffer, (size_t)offset, (size_t)(offset + size));
}

triptych_buffer *gl_buffer_use(struct gl_context *context, struct gl_buffer *buffer)
{
    enum triptych_result result = TRIPTYCH_OK;
    if (!buffer->bytes)
        return NULL;
    if (!buffer->renderer)
        result = triptych_buffer_create(context->renderer, buffer->memory, buffer->bytes, &buffer->renderer);
    else if (buffer->last)
        result = triptych_buffer_update(context->renderer, buffer->renderer, buffer->first,
                                        buffer->memory + buffer->first, buffer->last - buffer->first);
    if (result != TRIPTYCH_OK)
        return NULL;
    buffer->last = 0;
    return buffer->renderer;
}

void gl_GetBufferParameteriv(struct gl_context *context, GLenum target, GLenum name, GLint *out)
{
    const struct gl_buffer *buffer;
    struct gl_buffer **place = binding_of(context, target);
    if (!place)
        return;
    if (name != GL_BUFFER_SIZE && name != GL_BUFFER_USAGE && name != GL_BUFFER_MAPPED_OES &&
        name != GL_BUFFER_ACCESS_OES)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a parameter of buffers",
                 gl_constant_name(name));
    else if ((buffer = bound(context, target)))
        *out = name == GL_BUFFER_SIZE         ? (GLint)buffer->bytes
               : name == GL_BUFFER_USAGE      ? (GLint)buffer->usage
               : name == GL_BUFFER_MAPPED_OES ? buffer->mapped
                                              : GL_WRITE_ONLY_OES;
}

/* --- Mappings --- */

static void *map(struct gl_context *context, struct gl_buffer *buffer, size_t offset, size_t bytes,
                 GLbitfield access)
{
    if (buffer->mapped) {
        gl_error(context, GL_INVALID_OPERATION, "found a mapped buffer, expected one that is not");
        return NULL;
    }
    buffer->mapped = true;
    buffer->map_offset = offset;
    buffer->map_bytes = bytes;
    buffer->access = access;
    return buffer->memory + offset;
}

void *gl_MapBufferOES(struct gl_context *context, GLenum target, GLenum access)
{
    struct gl_buffer **place = binding_of(context, target);
    if (!place)
        return NULL;
    if (access != GL_WRITE_ONLY_OES) {
        gl_error(context, GL_INVALID_ENUM, "found %s, expected GL_WRITE_ONLY_OES", gl_constant_name(access));
        return NULL;
    }
    struct gl_buffer *buffer = bound(context, target);
    if (!buffer || buffer->memory)
        return buffer ? map(context, buffer, 0, buffer->bytes, GL_MAP_WRITE_BIT_EXT) : NULL;
    gl_error(context, GL_OUT_OF_MEMORY, "found a buffer without bytes");
    return NULL;
}

static bool check_access(struct gl_context *context, GLsizeiptr bytes, GLbitfield access)
{
    const GLbitfield reads = GL_MAP_READ_BIT_EXT, writes = GL_MAP_WRITE_BIT_EXT;
    const GLbitfield drops =
        GL_MAP_INVALIDATE_RANGE_BIT_EXT | GL_MAP_INVALIDATE_BUFFER_BIT_EXT | GL_MAP_UNSYNCHRONIZED_BIT_EXT;
    if (access & ~(reads | writes | drops | GL_MAP_FLUSH_EXPLICIT_BIT_EXT))
        gl_error(context, GL_INVALID_VALUE, "found the access 0x%x", access);
    else if (!bytes || !(access & (reads | writes)) || (access & reads && access & drops) ||
             (access & GL_MAP_FLUSH_EXPLICIT_BIT_EXT && !(access & writes)))
        gl_error(context, GL_INVALID_OPERATION, "found the access 0x%x of %td bytes", access,
                 (ptrdiff_t)bytes);
    else
        return true;
    return false;
}

void *gl_MapBufferRangeEXT(struct gl_context *context, GLenum target, GLintptr offset, GLsizeiptr bytes,
                           GLbitfield access)
{
    struct gl_buffer *buffer = bound(context, target);
    if (!buffer || !check_range(context, buffer, offset, bytes) || !check_access(context, bytes, access))
        return NULL;
    return map(context, buffer, (size_t)offset, (size_t)bytes, access);
}

void gl_FlushMappedBufferRangeEXT(struct gl_context *context, GLenum target, GLintptr offset,
                                  GLsizeiptr bytes)
{
    struct gl_buffer *buffer = bound(context, target);
    if (!buffer)
        return;
    if (!buffer->mapped || !(buffer->access & GL_MAP_FLUSH_EXPLICIT_BIT_EXT))
        gl_error(context, GL_INVALID_OPERATION, "found a buffer that is not mapped to be flushed");
    else if (offset < 0 || bytes < 0 || (size_t)offset > buffer->map_bytes ||
             (size_t)bytes > buffer->map_bytes - (size_t)offset)
        gl_error(context, GL_INVALID_VALUE, "found %td bytes at %td, expected a part of the mapping",
                 (ptrdiff_t)bytes, (ptrdiff_t)offset);
    else if (bytes)
        change(buffer, buffer->map_offset + (size_t)offset, buffer->map_offset + (size_t)(offset + bytes));
}

GLboolean gl_UnmapBufferOES(struct gl_context *context, GLenum target)
{
    struct gl_buffer *buffer = bound(context, target);
    if (buffer && !buffer->mapped)
        gl_error(context, GL_INVALID_OPERATION, "found a buffer that is not mapped");
    if (!buffer || !buffer->mapped)
        return GL_FALSE;
    if (buffer->access & GL_MAP_WRITE_BIT_EXT && !(buffer->access & GL_MAP_FLUSH_EXPLICIT_BIT_EXT))
        change(buffer, buffer->map_offset, buffer->map_offset + buffer->map_bytes);
    buffer->mapped = false;
    return GL_TRUE;
}

void gl_GetBufferPointervOES(struct gl_context *context, GLenum target, GLenum name, void **out)
{
    const struct gl_buffer *buffer;
    if (name != GL_BUFFER_MAP_POINTER_OES)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected GL_BUFFER_MAP_POINTER_OES",
                 gl_constant_name(name));
    else if ((buffer = bound(context, target)))
        *out = buffer->mapped ? buffer->memory + buffer->map_offset : NULL;
}
