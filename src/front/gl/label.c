/* Labels of objects: KHR_debug. */
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/debug.h"
#include "front/gl/state.h"

#include <stdlib.h>
#include <string.h>

/* The kind of an identifier. Returns GL_KINDS, with an error, if OpenGL ES 2.0 has no such objects. */
static enum gl_kind kind_of(struct gl_context *context, GLenum identifier)
{
    switch (identifier) {
    case GL_BUFFER_KHR: return GL_KIND_BUFFER;
    case GL_TEXTURE: return GL_KIND_TEXTURE;
    case GL_SHADER_KHR:
    case GL_PROGRAM_KHR: return GL_KIND_PROGRAM;
    case GL_RENDERBUFFER: return GL_KIND_RENDERBUFFER;
    case GL_FRAMEBUFFER: return GL_KIND_FRAMEBUFFER;
    case GL_VERTEX_ARRAY_KHR: return GL_KIND_VERTEX_ARRAY;
    default: break;
    }
    gl_error(context, GL_INVALID_ENUM, "found %s, expected a kind of objects", gl_constant_name(identifier));
    return GL_KINDS;
}

static struct gl_object *find(struct gl_context *context, GLenum identifier, GLuint name)
{
    enum gl_kind kind = kind_of(context, identifier);
    struct gl_object *object = kind < GL_KINDS ? gl_object_find(context, kind, name) : NULL;
    bool shader = object && kind == GL_KIND_PROGRAM && gl_IsShader(context, name);
    if (object && (kind != GL_KIND_PROGRAM || shader == (identifier == GL_SHADER_KHR)))
        return object;
    if (kind < GL_KINDS)
        gl_error(context, GL_INVALID_VALUE, "found %u, expected an object of %s", name,
                 gl_constant_name(identifier));
    return NULL;
}

void gl_ObjectLabelKHR(struct gl_context *context, GLenum identifier, GLuint name, GLsizei length,
                       const GLchar *label)
{
    struct gl_object *object = find(context, identifier, name);
    if (!object)
        return;
    size_t bytes = !label ? 0 : length < 0 ? strlen(label) : (size_t)length;
    if (bytes >= GL_DEBUG_TEXT) {
        gl_error(context, GL_INVALID_VALUE, "found a label of %zu bytes, expected less than %d", bytes,
                 GL_DEBUG_TEXT);
        return;
    }
    char *copy = label ? strndup(label, bytes) : NULL;
    if (label && !copy) {
        gl_error(context, GL_OUT_OF_MEMORY, "no memory for a label");
        return;
    }
    free(object->label);
    object->label = copy;
}

void gl_GetObjectLabelKHR(struct gl_context *context, GLenum identifier, GLuint name, GLsizei room,
                          GLsizei *length, GLchar *out)
{
    const struct gl_object *object = find(context, identifier, name);
    if (!object)
        return;
    if (room < 0) {
        gl_error(context, GL_INVALID_VALUE, "found a size of %d, expected 0 or more", room);
        return;
    }
    const char *label = object->label ? object->label : "";
    size_t all = strlen(label), bytes = all < (size_t)room ? all : room ? (size_t)room - 1 : 0;
    if (out && room) {
        memcpy(out, label, bytes);
        out[bytes] = 0;
    }
    if (length)
        *length = (GLsizei)(out ? bytes : all);
}

/* Labels of synchronization objects, which OpenGL ES 2.0 does not have. */
static void refuse_pointer(struct gl_context *context, const void *pointer)
{
    gl_error(context, GL_INVALID_VALUE, "found %p, and no synchronization object exists", pointer);
}

void gl_ObjectPtrLabelKHR(struct gl_context *context, const void *pointer, GLsizei length,
                          const GLchar *label)
{
    (void)length, (void)label;
    refuse_pointer(context, pointer);
}

void gl_GetObjectPtrLabelKHR(struct gl_context *context, const void *pointer, GLsizei room, GLsizei *length,
                             GLchar *out)
{
    (void)room, (void)length, (void)out;
    refuse_pointer(context, pointer);
}
