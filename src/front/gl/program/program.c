/* Program objects: chapter 2.10.3. */
#include "front/gl/program/program.h"
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/state.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

struct gl_program *gl_program_find(struct gl_context *context, GLuint name)
{
    return (struct gl_program *)gl_code_find(context, name, true);
}

/* --- Names --- */

static void free_link(struct gl_program *program)
{
    for (unsigned i = 0; i < GLSL_STAGES; i++) {
        triptych_shader_destroy(program->code.object.share->renderer, program->stage[i]);
        program->stage[i] = NULL;
    }
    triptych_shader_destroy(program->code.object.share->renderer, program->turned);
    for (unsigned i = 0; i < 2 * GL_FORMS; i++)
        triptych_shader_destroy(program->code.object.share->renderer, program->other[i / 2][i % 2]);
    memset(program->other, 0, sizeof program->other);
    glsl_program_free(program->program);
    free(program->location);
    program->turned = NULL;
    program->program = NULL;
    program->location = NULL;
    program->locations = 0;
}

static void destroy(struct gl_object *object)
{
    struct gl_program *program = (struct gl_program *)object;
    gl_names_remove(&object->share->names[GL_KIND_PROGRAM], object->name);
    free_link(program);
    for (unsigned i = 0; i < GLSL_STAGES; i++)
        GL_HOLD(&program->shader[i], NULL);
    for (unsigned i = 0; i < program->wishes; i++)
        free(program->wish[i].name);
    free(program->wish);
    free(program->code.log);
}

GLuint gl_CreateProgram(struct gl_context *context)
{
    struct gl_names *names = gl_object_names(context, GL_KIND_PROGRAM);
    struct gl_program *program = NULL;
    GLuint name = 0;
    if (gl_names_reserve(names, 1, &name))
        program = gl_object_make(context->share, sizeof *program, name, destroy);
    if (!program) {
        gl_names_remove(names, name);
        gl_error(context, GL_OUT_OF_MEMORY, "no memory for a program");
        return 0;
    }
    program->code.is_program = true;
    gl_names_put(names, name, &program->code.object);
    return name;
}

void gl_DeleteProgram(struct gl_context *context, GLuint name)
{
    struct gl_program *program = name ? gl_program_find(context, name) : NULL;
    if (!program || program->code.object.deleted)
        return;
    program->code.object.deleted = true;
    gl_object_release(&program->code.object);
}

GLboolean gl_IsProgram(struct gl_context *context, GLuint name)
{
    const struct gl_code *code = (const struct gl_code *)gl_object_find(context, GL_KIND_PROGRAM, name);
    return code && code->is_program;
}

/* --- Shaders of a program --- */

void gl_AttachShader(struct gl_context *context, GLuint name, GLuint shader_name)
{
    struct gl_program *program = gl_program_find(context, name);
    struct gl_shader *shader = program ? (struct gl_shader *)gl_code_find(context, shader_name, false) : NULL;
    if (!shader)
        return;
    if (program->shader[shader->stage])
        gl_error(context, GL_INVALID_OPERATION, "found a second shader of one type in program %u", name);
    else
        GL_HOLD(&program->shader[shader->stage], shader);
}

void gl_DetachShader(struct gl_context *context, GLuint name, GLuint shader_name)
{
    struct gl_program *program = gl_program_find(context, name);
    struct gl_shader *shader = program ? (struct gl_shader *)gl_code_find(context, shader_name, false) : NULL;
    if (!shader)
        return;
    if (program->shader[shader->stage] != shader)
        gl_error(context, GL_INVALID_OPERATION, "found shader %u, which is not attached to program %u",
                 shader_name, name);
    else
        GL_HOLD(&program->shader[shader->stage], NULL);
}

void gl_GetAttachedShaders(struct gl_context *context, GLuint name, GLsizei room, GLsizei *count, GLuint *out)
{
    const struct gl_program *program = gl_program_find(context, name);
    GLsizei n = 0;
    if (!program)
        return;
    if (room < 0) {
        gl_error(context, GL_INVALID_VALUE, "found a size of %d, expected 0 or more", room);
        return;
    }
    for (unsigned i = 0; i < GLSL_STAGES; i++)
        if (program->shader[i] && n < room)
            out[n++] = program->shader[i]->code.object.name;
    if (count)
        *count = n;
}

/* --- Linking --- */

enum { TURNED = GLSL_STAGES, SHADERS };

static bool make_shaders(struct gl_context *context, const struct glsl_program *linked,
                         triptych_shader *shader[SHADERS])
{
    const char *const text[] = {linked->text[GLSL_VERTEX], linked->text[GLSL_FRAGMENT], linked->turned};
    for (unsigned i = 0; i < SHADERS; i++)
        if (text[i] && triptych_shader_assemble(context->renderer, i == GLSL_VERTEX ? "vertex" : "fragment",
                                                text[i], strlen(text[i]), &shader[i]) != TRIPTYCH_OK)
            return false;
    return true;
}

/* A refusal by the renderer is one of its limits. */
static bool take_link(struct gl_context *context, struct gl_program *program, struct glsl_program *linked)
{
    triptych_shader *shader[SHADERS] = {NULL, NULL, NULL};
    if (!make_shaders(context, linked, shader)) {
        free(program->code.log);
        program->code.log = strdup(triptych_error(context->renderer));
        for (unsigned i = 0; i < SHADERS; i++)
            triptych_shader_destroy(context->renderer, shader[i]);
        glsl_program_free(linked);
        return false;
    }
    free_link(program);
    memcpy(program->stage, shader, sizeof program->stage);
    program->turned = shader[TURNED];
    program->program = linked;
    context->late |= GL_LATE_ALL;
    return gl_uniforms_begin(program);
}

static struct glsl_program *link_units(struct gl_context *context, struct gl_program *program)
{
    const struct gl_shader *vertex = program->shader[GLSL_VERTEX], *fragment = program->shader[GLSL_FRAGMENT];
    struct glsl_binding *bindings = calloc(program->wishes + 1, sizeof *bindings);
    struct glsl_program *linked = NULL;
    free(program->code.log);
    program->code.log = NULL;
    if (bindings && (!vertex || !fragment || !vertex->unit || !fragment->unit)) {
        program->code.log =
            strdup("ERROR: expected a compiled vertex shader and a compiled fragment shader\n");
    } else if (bindings) {
        for (unsigned i = 0; i < program->wishes; i++)
            bindings[i] = (struct glsl_binding){program->wish[i].name, program->wish[i].location};
        linked = glsl_link(vertex->unit, fragment->unit, bindings, program->wishes, &program->code.log);
    }
    if (!linked && !program->code.log)
        gl_error(context, GL_OUT_OF_MEMORY, "no memory for a program");
    free(bindings);
    return linked;
}

void gl_LinkProgram(struct gl_context *context, GLuint name)
{
    struct gl_program *program = gl_program_find(context, name);
    if (!program)
        return;
    struct glsl_program *linked = link_units(context, program);
    program->validated = false;
    program->linked = linked && take_link(context, program, linked);
    if (!program->linked && context->program != program)
        free_link(program);
}

void gl_UseProgram(struct gl_context *context, GLuint name)
{
    struct gl_program *program = name ? gl_program_find(context, name) : NULL;
    if (name && !program)
        return;
    if (program && !program->linked) {
        gl_error(context, GL_INVALID_OPERATION, "found program %u, expected one that is linked", name);
        return;
    }
    GL_HOLD(&context->program, program);
    context->late |= GL_LATE_SHADERS | GL_LATE_PROGRAM | GL_LATE_TEXTURES;
}

/* Two samplers of different types must not use one unit. */
static bool samplers_agree(const struct gl_program *program)
{
    uint8_t type[GL_UNITS] = {0};
    for (unsigned i = 0; i < program->program->uniforms; i++) {
        const struct glsl_uniform *uniform = program->program->uniform + i;
        for (unsigned s = 0; s < GLSL_STAGES && glsl_is_sampler(uniform->type); s++)
            for (unsigned e = 0; uniform->stage[s].first >= 0 && e < uniform->stage[s].elements; e++) {
                uint8_t *seen = type + program->unit[s][(unsigned)uniform->stage[s].first + e];
                if (*seen && *seen != uniform->type.base)
                    return false;
                *seen = uniform->type.base;
            }
    }
    return true;
}

bool gl_program_is_valid(const struct gl_program *program)
{
    return program->program && samplers_agree(program);
}

void gl_ValidateProgram(struct gl_context *context, GLuint name)
{
    struct gl_program *program = gl_program_find(context, name);
    if (!program)
        return;
    program->validated = program->linked && gl_program_is_valid(program);
    free(program->code.log);
    program->code.log = strdup(
        program->validated ? "" : "ERROR: expected a linked program, and a unit for samplers of one type\n");
}

/* --- Attributes --- */

static bool set_wish(struct gl_program *program, const GLchar *name, unsigned location)
{
    for (unsigned i = 0; i < program->wishes; i++)
        if (!strcmp(program->wish[i].name, name)) {
            program->wish[i].location = location;
            return true;
        }
    struct gl_wish *larger = realloc(program->wish, (program->wishes + 1) * sizeof *larger);
    if (!larger)
        return false;
    program->wish = larger;
    larger[program->wishes] = (struct gl_wish){strdup(name), location};
    program->wishes += larger[program->wishes].name != NULL;
    return larger[program->wishes - 1].location == location;
}

void gl_BindAttribLocation(struct gl_context *context, GLuint name, GLuint location, const GLchar *attribute)
{
    struct gl_program *program = gl_program_find(context, name);
    if (!program)
        return;
    if (location >= GL_ATTRIBUTES)
        gl_error(context, GL_INVALID_VALUE, "found location %u, expected 0 to %d", location,
                 GL_ATTRIBUTES - 1);
    else if (!strncmp(attribute, "gl_", 3))
        gl_error(context, GL_INVALID_OPERATION, "found the reserved name %s", attribute);
    else if (!set_wish(program, attribute, location))
        gl_error(context, GL_OUT_OF_MEMORY, "no memory for a name");
}

GLint gl_GetAttribLocation(struct gl_context *context, GLuint name, const GLchar *attribute)
{
    const struct gl_program *program = gl_program_find(context, name);
    if (program && !program->linked)
        gl_error(context, GL_INVALID_OPERATION, "found program %u, expected one that is linked", name);
    for (unsigned i = 0; program && program->linked && i < program->program->attributes; i++)
        if (!strcmp(program->program->attribute[i].name, attribute))
            return (GLint)program->program->attribute[i].location;
    return -1;
}

GLenum gl_code_type(struct glsl_type type)
{
    static const GLenum vectors[3][4] = {
        {GL_FLOAT, GL_FLOAT_VEC2, GL_FLOAT_VEC3, GL_FLOAT_VEC4},
        {GL_INT, GL_INT_VEC2, GL_INT_VEC3, GL_INT_VEC4},
        {GL_BOOL, GL_BOOL_VEC2, GL_BOOL_VEC3, GL_BOOL_VEC4},
    };
    if (type.columns > 1)
        return GL_FLOAT_MAT2 + type.columns - 2u;
    switch (type.base) {
    case GLSL_FLOAT: return vectors[0][type.rows - 1];
    case GLSL_INT: return vectors[1][type.rows - 1];
    case GLSL_BOOL: return vectors[2][type.rows - 1];
    default: return type.base == GLSL_SAMPLER_2D ? GL_SAMPLER_2D : GL_SAMPLER_CUBE;
    }
}

void gl_GetActiveAttrib(struct gl_context *context, GLuint name, GLuint index, GLsizei room, GLsizei *length,
                        GLint *size, GLenum *type, GLchar *out)
{
    const struct gl_program *program = gl_program_find(context, name);
    if (!program)
        return;
    if (room < 0 || !program->program || index >= program->program->attributes) {
        gl_error(context, GL_INVALID_VALUE, "found attribute %u and a size of %d", index, room);
        return;
    }
    const struct glsl_attribute *attribute = program->program->attribute + index;
    gl_code_copy_text(attribute->name, room, length, out);
    *size = 1;
    *type = gl_code_type(attribute->type);
}

/* --- Queries --- */

void gl_GetProgramInfoLog(struct gl_context *context, GLuint name, GLsizei room, GLsizei *length, GLchar *out)
{
    const struct gl_program *program = gl_program_find(context, name);
    if (program && room < 0)
        gl_error(context, GL_INVALID_VALUE, "found a size of %d, expected 0 or more", room);
    else if (program)
        gl_code_copy_text(program->code.log, room, length, out);
}

void gl_GetProgramiv(struct gl_context *context, GLuint name, GLenum parameter, GLint *out)
{
    static const struct glsl_program none = {0};
    const struct gl_program *program = gl_program_find(context, name);
    if (!program)
        return;
    const struct glsl_program *linked = program->program ? program->program : &none;
    const char *log = program->code.log;
    switch (parameter) {
    case GL_DELETE_STATUS: *out = program->code.object.deleted; break;
    case GL_LINK_STATUS: *out = program->linked; break;
    case GL_VALIDATE_STATUS: *out = program->validated; break;
    case GL_INFO_LOG_LENGTH: *out = log && *log ? (GLint)strlen(log) + 1 : 0; break;
    case GL_ATTACHED_SHADERS: *out = !!program->shader[GLSL_VERTEX] + !!program->shader[GLSL_FRAGMENT]; break;
    case GL_ACTIVE_ATTRIBUTES: *out = (GLint)linked->attributes; break;
    case GL_ACTIVE_ATTRIBUTE_MAX_LENGTH: *out = (GLint)linked->attribute_name_bytes; break;
    case GL_ACTIVE_UNIFORMS: *out = (GLint)linked->uniforms; break;
    case GL_ACTIVE_UNIFORM_MAX_LENGTH: *out = (GLint)linked->uniform_name_bytes; break;
    default:
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a parameter of programs",
                 gl_constant_name(parameter));
    }
}
