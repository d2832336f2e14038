/* Client arrays and current values: chapters 2.7 and 2.8 of version 1.1; OES_point_size_array. They are
 * those of generic attributes, at fixed locations. */
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/draw/vertex_array.h"
#include "front/gl/fixed.h"
#include "front/gl/state.h"

/* --- Arrays --- */

static unsigned client_unit(const struct gl_context *context)
{
    return (unsigned)context->fixed->client_texture[0] - GL_TEXTURE0;
}

void gl_ClientActiveTexture(struct gl_context *context, GLenum texture)
{
    if (texture - GL_TEXTURE0 >= GL_FIXED_UNITS)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected GL_TEXTURE0 to %d more",
                 gl_constant_name(texture), GL_FIXED_UNITS - 1);
    else
        context->fixed->client_texture[0] = (GLfloat)texture;
}

static void switch_array(struct gl_context *context, GLenum array, bool enabled)
{
    struct gl_array *arrays = context->vertex_array->array;
    switch (array) {
    case GL_VERTEX_ARRAY: arrays[GL_FIXED_POSITION].enabled = enabled; break;
    case GL_NORMAL_ARRAY: arrays[GL_FIXED_NORMAL].enabled = enabled; break;
    case GL_COLOR_ARRAY: arrays[GL_FIXED_COLOR].enabled = enabled; break;
    case GL_TEXTURE_COORD_ARRAY: arrays[GL_FIXED_COORDINATES + client_unit(context)].enabled = enabled; break;
    case GL_POINT_SIZE_ARRAY_OES: arrays[GL_FIXED_SIZE].enabled = enabled; break;
    default: gl_error(context, GL_INVALID_ENUM, "found %s, expected an array", gl_constant_name(array));
    }
}

void gl_EnableClientState(struct gl_context *context, GLenum array)
{
    switch_array(context, array, true);
}

void gl_DisableClientState(struct gl_context *context, GLenum array)
{
    switch_array(context, array, false);
}

/* Bits of the types that an array can have. */
enum { BYTES = 1, UNSIGNED_BYTES = 2, SHORTS = 4, NUMBERS = 8 };

static unsigned bit_of(GLenum type)
{
    return type == GL_BYTE                        ? BYTES
           : type == GL_UNSIGNED_BYTE             ? UNSIGNED_BYTES
           : type == GL_SHORT                     ? SHORTS
           : type == GL_FLOAT || type == GL_FIXED ? NUMBERS
                                                  : 0;
}

struct form {
    GLint least, most; /* components */
    unsigned types;
    GLboolean normalized;
};

static void set_pointer(struct gl_context *context, unsigned location, struct form form, GLint size,
                        GLenum type, GLsizei stride, const void *pointer)
{
    if (size < form.least || size > form.most)
        gl_error(context, GL_INVALID_VALUE, "found %d components, expected %d to %d", size, form.least,
                 form.most);
    else if (!(bit_of(type) & form.types))
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a type of the array", gl_constant_name(type));
    else
        gl_VertexAttribPointer(context, location, size, type, form.normalized, stride, pointer);
}

void gl_VertexPointer(struct gl_context *context, GLint size, GLenum type, GLsizei stride,
                      const void *pointer)
{
    struct form form = {2, 4, BYTES | SHORTS | NUMBERS, GL_FALSE};
    set_pointer(context, GL_FIXED_POSITION, form, size, type, stride, pointer);
}

void gl_NormalPointer(struct gl_context *context, GLenum type, GLsizei stride, const void *pointer)
{
    struct form form = {3, 3, BYTES | SHORTS | NUMBERS, GL_TRUE};
    set_pointer(context, GL_FIXED_NORMAL, form, 3, type, stride, pointer);
}

void gl_ColorPointer(struct gl_context *context, GLint size, GLenum type, GLsizei stride, const void *pointer)
{
    struct form form = {4, 4, UNSIGNED_BYTES | NUMBERS, GL_TRUE};
    set_pointer(context, GL_FIXED_COLOR, form, size, type, stride, pointer);
}

void gl_TexCoordPointer(struct gl_context *context, GLint size, GLenum type, GLsizei stride,
                        const void *pointer)
{
    struct form form = {2, 4, BYTES | SHORTS | NUMBERS, GL_FALSE};
    set_pointer(context, GL_FIXED_COORDINATES + client_unit(context), form, size, type, stride, pointer);
}

void gl_PointSizePointerOES(struct gl_context *context, GLenum type, GLsizei stride, const void *pointer)
{
    struct form form = {1, 1, NUMBERS, GL_FALSE};
    set_pointer(context, GL_FIXED_SIZE, form, 1, type, stride, pointer);
}

bool gl_fixed_pointer(struct gl_context *context, GLenum name, void **out)
{
    unsigned location;
    switch (name) {
    case GL_VERTEX_ARRAY_POINTER: location = GL_FIXED_POSITION; break;
    case GL_NORMAL_ARRAY_POINTER: location = GL_FIXED_NORMAL; break;
    case GL_COLOR_ARRAY_POINTER: location = GL_FIXED_COLOR; break;
    case GL_TEXTURE_COORD_ARRAY_POINTER: location = GL_FIXED_COORDINATES + client_unit(context); break;
    case GL_POINT_SIZE_ARRAY_POINTER_OES: location = GL_FIXED_SIZE; break;
    default: return false;
    }
    *out = (void *)context->vertex_array->array[location].pointer;
    return true;
}

/* --- Current values --- */

void gl_Color4f(struct gl_context *context, GLfloat red, GLfloat green, GLfloat blue, GLfloat alpha)
{
    gl_VertexAttrib4f(context, GL_FIXED_COLOR, red, green, blue, alpha);
}

void gl_Color4ub(struct gl_context *context, GLubyte red, GLubyte green, GLubyte blue, GLubyte alpha)
{
    gl_Color4f(context, (GLfloat)red / 255, (GLfloat)green / 255, (GLfloat)blue / 255, (GLfloat)alpha / 255);
}

void gl_Normal3f(struct gl_context *context, GLfloat x, GLfloat y, GLfloat z)
{
    gl_VertexAttrib3f(context, GL_FIXED_NORMAL, x, y, z);
}

void gl_MultiTexCoord4f(struct gl_context *context, GLenum target, GLfloat s, GLfloat t, GLfloat r, GLfloat q)
{
    if (target - GL_TEXTURE0 >= GL_FIXED_UNITS)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected GL_TEXTURE0 to %d more",
                 gl_constant_name(target), GL_FIXED_UNITS - 1);
    else
        gl_VertexAttrib4f(context, GL_FIXED_COORDINATES + target - GL_TEXTURE0, s, t, r, q);
}
