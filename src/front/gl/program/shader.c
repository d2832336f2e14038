/* Shader objects: chapter 2.10.1. */
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/program/program.h"
#include "front/gl/state.h"

#include <stdlib.h>
#include <string.h>

struct gl_code *gl_code_find(struct gl_context *context, GLuint name, bool program)
{
    struct gl_code *code = (struct gl_code *)gl_object_find(context, GL_KIND_PROGRAM, name);
    if (code && code->is_program == program)
        return code;
    gl_error(context, code ? GL_INVALID_OPERATION : GL_INVALID_VALUE, "found %u, expected a %s", name,
             program ? "program" : "shader");
    return NULL;
}

static struct gl_shader *find(struct gl_context *context, GLuint name)
{
    return (struct gl_shader *)gl_code_find(context, name, false);
}

void gl_code_copy_text(const char *text, GLsizei room, GLsizei *length, GLchar *out)
{
    size_t bytes = text ? strlen(text) : 0;
    bytes = room <= 0 ? 0 : bytes < (size_t)room ? bytes : (size_t)room - 1;
    if (room > 0) {
        memcpy(out, text ? text : "", bytes);
        out[bytes] = 0;
    }
    if (length)
        *length = (GLsizei)bytes;
}

/* --- Names --- */

static void destroy(struct gl_object *object)
{
    struct gl_shader *shader = (struct gl_shader *)object;
    gl_names_remove(&object->share->names[GL_KIND_PROGRAM], object->name);
    glsl_unit_free(shader->unit);
    free(shader->source);
    free(shader->code.log);
}

GLuint gl_CreateShader(struct gl_context *context, GLenum type)
{
    struct gl_names *names = gl_object_names(context, GL_KIND_PROGRAM);
    GLuint name = 0;
    if (type != GL_VERTEX_SHADER && type != GL_FRAGMENT_SHADER) {
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a type of shaders", gl_constant_name(type));
        return 0;
    }
    struct gl_shader *shader = NULL;
    if (gl_names_reserve(names, 1, &name))
        shader = gl_object_make(context->share, sizeof *shader, name, destroy);
    if (!shader) {
        gl_names_remove(names, name);
        gl_error(context, GL_OUT_OF_MEMORY, "no memory for a shader");
        return 0;
    }
    shader->stage = type == GL_VERTEX_SHADER ? GLSL_VERTEX : GLSL_FRAGMENT;
    gl_names_put(names, name, &shader->code.object);
    return name;
}

void gl_DeleteShader(struct gl_context *context, GLuint name)
{
    struct gl_shader *shader = name ? find(context, name) : NULL;
    if (!shader || shader->code.object.deleted)
        return;
    shader->code.object.deleted = true;
    gl_object_release(&shader->code.object);
}

GLboolean gl_IsShader(struct gl_context *context, GLuint name)
{
    const struct gl_code *code = (const struct gl_code *)gl_object_find(context, GL_KIND_PROGRAM, name);
    return code && !code->is_program;
}

/* --- Sources --- */

static size_t bytes_at(const GLchar *const *strings, const GLint *lengths, GLsizei i)
{
    return lengths && lengths[i] >= 0 ? (size_t)lengths[i] : strlen(strings[i]);
}

static char *join(GLsizei count, const GLchar *const *strings, const GLint *lengths)
{
    size_t bytes = 0;
    for (GLsizei i = 0; i < count; i++)
        bytes += strings[i] ? bytes_at(strings, lengths, i) : 0;
    char *source = malloc(bytes + 1), *to = source;
    for (GLsizei i = 0; source && i < count; i++)
        if (strings[i])
            to =
                (char *)memcpy(to, strings[i], bytes_at(strings, lengths, i)) + bytes_at(strings, lengths, i);
    if (source)
        *to = 0;
    return source;
}

void gl_ShaderSource(struct gl_context *context, GLuint name, GLsizei count, const GLchar *const *strings,
                     const GLint *lengths)
{
    struct gl_shader *shader = find(context, name);
    if (!shader)
        return;
    if (count < 0) {
        gl_error(context, GL_INVALID_VALUE, "found %d strings, expected 0 or more", count);
        return;
    }
    char *source = join(count, strings, lengths);
    if (!source) {
        gl_error(context, GL_OUT_OF_MEMORY, "no memory for a source");
        return;
    }
    free(shader->source);
    shader->source = source;
}

void gl_CompileShader(struct gl_context *context, GLuint name)
{
    struct gl_shader *shader = find(context, name);
    if (!shader)
        return;
    const char *source = shader->source ? shader->source : "";
    glsl_unit_free(shader->unit);
    free(shader->code.log);
    shader->unit = glsl_compile(shader->stage, &source, NULL, 1, NULL, &shader->code.log);
    if (!shader->unit && !shader->code.log)
        gl_error(context, GL_OUT_OF_MEMORY, "no memory for a shader");
}

void gl_GetShaderSource(struct gl_context *context, GLuint name, GLsizei room, GLsizei *length, GLchar *out)
{
    const struct gl_shader *shader = find(context, name);
    if (shader && room < 0)
        gl_error(context, GL_INVALID_VALUE, "found a size of %d, expected 0 or more", room);
    else if (shader)
        gl_code_copy_text(shader->source, room, length, out);
}

void gl_GetShaderInfoLog(struct gl_context *context, GLuint name, GLsizei room, GLsizei *length, GLchar *out)
{
    const struct gl_shader *shader = find(context, name);
    if (shader && room < 0)
        gl_error(context, GL_INVALID_VALUE, "found a size of %d, expected 0 or more", room);
    else if (shader)
        gl_code_copy_text(shader->code.log, room, length, out);
}

/* The bytes of a text with its zero; 0 without one. */
static GLint text_bytes(const char *text)
{
    return text && *text ? (GLint)strlen(text) + 1 : 0;
}

void gl_GetShaderiv(struct gl_context *context, GLuint name, GLenum parameter, GLint *out)
{
    const struct gl_shader *shader = find(context, name);
    if (!shader)
        return;
    switch (parameter) {
    case GL_SHADER_TYPE: *out = shader->stage == GLSL_VERTEX ? GL_VERTEX_SHADER : GL_FRAGMENT_SHADER; break;
    case GL_DELETE_STATUS: *out = shader->code.object.deleted; break;
    case GL_COMPILE_STATUS: *out = shader->unit != NULL; break;
    case GL_INFO_LOG_LENGTH: *out = text_bytes(shader->code.log); break;
    case GL_SHADER_SOURCE_LENGTH: *out = text_bytes(shader->source); break;
    default:
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a parameter of shaders",
                 gl_constant_name(parameter));
    }
}

/* --- The compiler --- */

/* No binary format exists. */
void gl_ShaderBinary(struct gl_context *context, GLsizei count, const GLuint *names, GLenum format,
                     const void *binary, GLsizei bytes)
{
    (void)names, (void)binary;
    if (count < 0 || bytes < 0)
        gl_error(context, GL_INVALID_VALUE, "found %d shaders of %d bytes", count, bytes);
    else
        gl_error(context, GL_INVALID_ENUM, "found %s, and no binary format exists", gl_constant_name(format));
}

void gl_ReleaseShaderCompiler(struct gl_context *context)
{
    (void)context; /* it keeps nothing between compilations */
}

/* All numbers of shaders are binary32, integers included. */
void gl_GetShaderPrecisionFormat(struct gl_context *context, GLenum stage, GLenum precision, GLint *range,
                                 GLint *bits)
{
    bool integer = precision >= GL_LOW_INT && precision <= GL_HIGH_INT;
    if (stage != GL_VERTEX_SHADER && stage != GL_FRAGMENT_SHADER)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a type of shaders", gl_constant_name(stage));
    else if (!integer && (precision < GL_LOW_FLOAT || precision > GL_HIGH_FLOAT))
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a precision", gl_constant_name(precision));
    else {
        range[0] = range[1] = integer ? 24 : 127;
        *bits = integer ? 0 : 23;
    }
}
