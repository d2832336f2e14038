/* Attributes: chapters 2.7 and 2.8; OES_vertex_array_object. */
#include "front/gl/draw/vertex_array.h"
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/state.h"

#include <string.h>

/* --- Types --- */

unsigned gl_array_bytes(const struct gl_array *array)
{
    switch (array->type) {
    case GL_BYTE:
    case GL_UNSIGNED_BYTE: return (unsigned)array->size;
    case GL_SHORT:
    case GL_UNSIGNED_SHORT:
    case GL_HALF_FLOAT_OES: return (unsigned)array->size * 2;
    default: return (unsigned)array->size * 4;
    }
}

size_t gl_array_stride(const struct gl_array *array)
{
    return array->stride ? (size_t)array->stride : gl_array_bytes(array);
}

#define EACH_SIZE(name)                                                                                      \
    {                                                                                                        \
        TRIPTYCH_FORMAT_##name##1, TRIPTYCH_FORMAT_##name##2, TRIPTYCH_FORMAT_##name##3,                     \
            TRIPTYCH_FORMAT_##name##4                                                                        \
    }
#define EACH_NORMALIZED(name)                                                                                \
    {                                                                                                        \
        TRIPTYCH_FORMAT_##name##1N, TRIPTYCH_FORMAT_##name##2N, TRIPTYCH_FORMAT_##name##3N,                  \
            TRIPTYCH_FORMAT_##name##4N                                                                       \
    }

enum triptych_format gl_array_format(const struct gl_array *array)
{
    static const struct {
        GLenum type;
        enum triptych_format plain[4], normalized[4];
    } formats[] = {
        {GL_BYTE, EACH_SIZE(BYTE), EACH_NORMALIZED(BYTE)},
        {GL_UNSIGNED_BYTE, EACH_SIZE(UBYTE), EACH_NORMALIZED(UBYTE)},
        {GL_SHORT, EACH_SIZE(SHORT), EACH_NORMALIZED(SHORT)},
        {GL_UNSIGNED_SHORT, EACH_SIZE(USHORT), EACH_NORMALIZED(USHORT)},
        {GL_FLOAT, EACH_SIZE(FLOAT), EACH_SIZE(FLOAT)},
        {GL_FIXED, EACH_SIZE(FIXED), EACH_SIZE(FIXED)},
    };
    for (unsigned i = 0; i < sizeof formats / sizeof *formats; i++)
        if (formats[i].type == array->type)
            return array->normalized ? formats[i].normalized[array->size - 1]
                                     : formats[i].plain[array->size - 1];
    return TRIPTYCH_FORMAT_NONE;
}

/* --- Names --- */

static void destroy(struct gl_object *object)
{
    struct gl_vertex_array *arrays = (struct gl_vertex_array *)object;
    for (unsigned i = 0; i < GL_ATTRIBUTES; i++)
        GL_HOLD(&arrays->array[i].buffer, NULL);
    GL_HOLD(&arrays->elements, NULL);
}

struct gl_object *gl_vertex_array_make(struct gl_context *context, GLuint name)
{
    struct gl_vertex_array *arrays = gl_object_make(context->share, sizeof *arrays, name, destroy);
    if (!arrays)
        return NULL;
    for (unsigned i = 0; i < GL_ATTRIBUTES; i++)
        arrays->array[i] = (struct gl_array){.size = 4, .type = GL_FLOAT};
    return &arrays->object;
}

void gl_vertex_array_detach(struct gl_context *context, struct gl_object *buffer)
{
    struct gl_vertex_array *arrays = context->vertex_array;
    for (unsigned i = 0; i < GL_ATTRIBUTES; i++)
        if ((struct gl_object *)arrays->array[i].buffer == buffer)
            GL_HOLD(&arrays->array[i].buffer, NULL);
    if ((struct gl_object *)arrays->elements == buffer)
        GL_HOLD(&arrays->elements, NULL);
}

/* Names are those of glGenVertexArraysOES. */
void gl_BindVertexArrayOES(struct gl_context *context, GLuint name)
{
    struct gl_object *found = (struct gl_object *)context->vertex_array_0;
    if (name && !gl_names_has(gl_object_names(context, GL_KIND_VERTEX_ARRAY), name)) {
        gl_error(context, GL_INVALID_OPERATION, "found %u, expected a name of a vertex array", name);
        return;
    }
    if (!name || (found = gl_object_bind(context, GL_KIND_VERTEX_ARRAY, name, gl_vertex_array_make)))
        GL_HOLD(&context->vertex_array, found);
}

void gl_GenVertexArraysOES(struct gl_context *context, GLsizei count, GLuint *names)
{
    gl_object_generate(context, GL_KIND_VERTEX_ARRAY, count, names);
}

static void unbind(struct gl_context *context, struct gl_object *object)
{
    if ((struct gl_object *)context->vertex_array == object)
        GL_HOLD(&context->vertex_array, context->vertex_array_0);
}

void gl_DeleteVertexArraysOES(struct gl_context *context, GLsizei count, const GLuint *names)
{
    gl_object_delete(context, GL_KIND_VERTEX_ARRAY, count, names, unbind);
}

GLboolean gl_IsVertexArrayOES(struct gl_context *context, GLuint name)
{
    return gl_object_find(context, GL_KIND_VERTEX_ARRAY, name) != NULL;
}

/* --- Arrays --- */

static bool check_index(struct gl_context *context, GLuint index)
{
    if (index >= GL_ATTRIBUTES)
        gl_error(context, GL_INVALID_VALUE, "found attribute %u, expected 0 to %d", index, GL_ATTRIBUTES - 1);
    return index < GL_ATTRIBUTES;
}

void gl_EnableVertexAttribArray(struct gl_context *context, GLuint index)
{
    if (check_index(context, index))
        context->vertex_array->array[index].enabled = true;
}

void gl_DisableVertexAttribArray(struct gl_context *context, GLuint index)
{
    if (check_index(context, index))
        context->vertex_array->array[index].enabled = false;
}

void gl_VertexAttribPointer(struct gl_context *context, GLuint index, GLint size, GLenum type,
                            GLboolean normalized, GLsizei stride, const void *pointer)
{
    struct gl_array array = {.size = size, .type = type, .normalized = normalized != 0};
    if (!check_index(context, index))
        return;
    if (size < 1 || size > 4)
        gl_error(context, GL_INVALID_VALUE, "found %d components, expected 1 to 4", size);
    else if (gl_array_format(&array) == TRIPTYCH_FORMAT_NONE)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a type of attributes", gl_constant_name(type));
    else if (stride < 0)
        gl_error(context, GL_INVALID_VALUE, "found a stride of %d, expected 0 or more", stride);
    else {
        struct gl_array *place = &context->vertex_array->array[index];
        place->size = size;
        place->type = type;
        place->normalized = array.normalized;
        place->stride = stride;
        place->pointer = pointer;
        GL_HOLD(&place->buffer, context->array_buffer);
    }
}

/* --- Current values --- */

static void set_current(struct gl_context *context, GLuint index, GLfloat x, GLfloat y, GLfloat z, GLfloat w)
{
    const GLfloat value[4] = {x, y, z, w};
    if (!check_index(context, index))
        return;
    memcpy(context->current[index], value, sizeof value);
    context->current_changed = true;
}

void gl_VertexAttrib1f(struct gl_context *context, GLuint index, GLfloat x)
{
    set_current(context, index, x, 0, 0, 1);
}

void gl_VertexAttrib2f(struct gl_context *context, GLuint index, GLfloat x, GLfloat y)
{
    set_current(context, index, x, y, 0, 1);
}

void gl_VertexAttrib3f(struct gl_context *context, GLuint index, GLfloat x, GLfloat y, GLfloat z)
{
    set_current(context, index, x, y, z, 1);
}

void gl_VertexAttrib4f(struct gl_context *context, GLuint index, GLfloat x, GLfloat y, GLfloat z, GLfloat w)
{
    set_current(context, index, x, y, z, w);
}

void gl_VertexAttrib1fv(struct gl_context *context, GLuint index, const GLfloat *v)
{
    set_current(context, index, v[0], 0, 0, 1);
}

void gl_VertexAttrib2fv(struct gl_context *context, GLuint index, const GLfloat *v)
{
    set_current(context, index, v[0], v[1], 0, 1);
}

void gl_VertexAttrib3fv(struct gl_context *context, GLuint index, const GLfloat *v)
{
    set_current(context, index, v[0], v[1], v[2], 1);
}

void gl_VertexAttrib4fv(struct gl_context *context, GLuint index, const GLfloat *v)
{
    set_current(context, index, v[0], v[1], v[2], v[3]);
}

/* --- Queries --- */

static GLint parameter(struct gl_context *context, const struct gl_array *array, GLenum name)
{
    switch (name) {
    case GL_VERTEX_ATTRIB_ARRAY_ENABLED: return array->enabled;
    case GL_VERTEX_ATTRIB_ARRAY_SIZE: return array->size;
    case GL_VERTEX_ATTRIB_ARRAY_STRIDE: return array->stride;
    case GL_VERTEX_ATTRIB_ARRAY_TYPE: return (GLint)array->type;
    case GL_VERTEX_ATTRIB_ARRAY_NORMALIZED: return array->normalized;
    case GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING: return array->buffer ? (GLint)array->buffer->object.name : 0;
    default:
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a parameter of attributes",
                 gl_constant_name(name));
        return -1;
    }
}

void gl_GetVertexAttribfv(struct gl_context *context, GLuint index, GLenum name, GLfloat *out)
{
    if (!check_index(context, index))
        return;
    if (name == GL_CURRENT_VERTEX_ATTRIB) {
        memcpy(out, context->current[index], sizeof context->current[index]);
        return;
    }
    GLint value = parameter(context, &context->vertex_array->array[index], name);
    if (value >= 0)
        *out = (GLfloat)value;
}

/* A current value is rounded to the nearest integer. */
void gl_GetVertexAttribiv(struct gl_context *context, GLuint index, GLenum name, GLint *out)
{
    if (!check_index(context, index))
        return;
    if (name == GL_CURRENT_VERTEX_ATTRIB) {
        for (int i = 0; i < 4; i++)
            out[i] = gl_round(context->current[index][i]);
        return;
    }
    GLint value = parameter(context, &context->vertex_array->array[index], name);
    if (value >= 0)
        *out = value;
}

void gl_GetVertexAttribPointerv(struct gl_context *context, GLuint index, GLenum name, void **out)
{
    if (name != GL_VERTEX_ATTRIB_ARRAY_POINTER)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected GL_VERTEX_ATTRIB_ARRAY_POINTER",
                 gl_constant_name(name));
    else if (check_index(context, index))
        *out = (void *)context->vertex_array->array[index].pointer;
}
