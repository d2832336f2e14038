/* Contexts of version 1.1: their values, and what glGet... returns of them. */
#include "front/gl/fixed.h"
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/draw/vertex_array.h"
#include "front/gl/object.h"
#include "front/gl/program/program.h"
#include "front/gl/state.h"

#include <stdlib.h>
#include <string.h>

/* --- Initial values --- */

static const struct gl_fixed initial = {
#define GL_NUMBER(name, field, type, count, ...) .field = {__VA_ARGS__},
#include "front/gl/fixed.def"
    .material = {.ambient = {0.2F, 0.2F, 0.2F, 1},
                 .diffuse = {0.8F, 0.8F, 0.8F, 1},
                 .specular = {0, 0, 0, 1},
                 .emission = {0, 0, 0, 1}},
};

static const struct gl_fixed_environment initial_environment = {
    .mode = GL_MODULATE,
    .combine = {GL_MODULATE, GL_MODULATE},
    .source = {{GL_TEXTURE, GL_PREVIOUS, GL_CONSTANT}, {GL_TEXTURE, GL_PREVIOUS, GL_CONSTANT}},
    .operand = {{GL_SRC_COLOR, GL_SRC_COLOR, GL_SRC_ALPHA}, {GL_SRC_ALPHA, GL_SRC_ALPHA, GL_SRC_ALPHA}},
    .scale = {1, 1},
};

static void begin_stack(struct gl_fixed_stack *stack)
{
    for (unsigned i = 0; i < 16; i += 5)
        stack->matrix[0][i] = 1;
}

static void begin_lights(struct gl_fixed *fixed)
{
    for (unsigned i = 0; i < GL_FIXED_LIGHTS; i++) {
        struct gl_fixed_light *light = &fixed->light[i];
        *light = (struct gl_fixed_light){.ambient[3] = 1,
                                         .diffuse[3] = 1,
                                         .specular[3] = 1,
                                         .position[2] = 1,
                                         .direction[2] = -1,
                                         .cutoff = 180,
                                         .constant = 1};
        for (unsigned c = 0; c < 3 && !i; c++)
            light->diffuse[c] = light->specular[c] = 1;
    }
}

bool gl_fixed_begin(struct gl_context *context)
{
    struct gl_fixed *fixed = malloc(sizeof *fixed);
    if (!fixed)
        return false;
    *fixed = initial;
    begin_lights(fixed);
    begin_stack(&fixed->modelview);
    begin_stack(&fixed->projection);
    for (unsigned i = 0; i < GL_FIXED_UNITS; i++) {
        fixed->environment[i] = initial_environment;
        begin_stack(&fixed->texture[i]);
    }
    context->fixed = fixed;
    for (unsigned c = 0; c < 4; c++)
        context->current[GL_FIXED_COLOR][c] = 1;
    context->current[GL_FIXED_NORMAL][2] = 1;
    return true;
}

void gl_fixed_end(struct gl_context *context)
{
    for (unsigned i = 0; context->fixed && i < GL_FIXED_KEPT; i++)
        GL_HOLD(&context->fixed->kept[i].program, NULL);
    free(context->fixed);
}

/* --- Simple commands --- */

void gl_AlphaFunc(struct gl_context *context, GLenum function, GLfloat reference)
{
    if (function - GL_NEVER > GL_ALWAYS - GL_NEVER) {
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a comparison", gl_constant_name(function));
        return;
    }
    context->fixed->alpha_func[0] = (GLfloat)function;
    context->fixed->alpha_reference[0] = gl_clamp(reference);
    context->late |= GL_LATE_RASTER;
}

void gl_LogicOp(struct gl_context *context, GLenum operation)
{
    if (operation - GL_CLEAR > GL_SET - GL_CLEAR) {
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a logic operation",
                 gl_constant_name(operation));
        return;
    }
    context->fixed->logic_op[0] = (GLfloat)operation;
    context->late |= GL_LATE_RASTER;
}

void gl_ShadeModel(struct gl_context *context, GLenum mode)
{
    if (mode != GL_FLAT && mode != GL_SMOOTH) {
        gl_error(context, GL_INVALID_ENUM, "found %s, expected GL_FLAT or GL_SMOOTH", gl_constant_name(mode));
        return;
    }
    context->fixed->shade_model[0] = (GLfloat)mode;
    context->late |= GL_LATE_FIXED | GL_LATE_RASTER;
}

static GLfloat *plane_of(struct gl_context *context, GLenum plane)
{
    if (plane - GL_CLIP_PLANE0 < GL_FIXED_PLANES)
        return context->fixed->plane[plane - GL_CLIP_PLANE0];
    gl_error(context, GL_INVALID_ENUM, "found %s, expected a plane", gl_constant_name(plane));
    return NULL;
}

/* A plane is of the space of vertices: the row is multiplied by the inverse matrix. */
void gl_ClipPlanef(struct gl_context *context, GLenum name, const GLfloat *equation)
{
    GLfloat *plane = plane_of(context, name), inverse[16], moved[4];
    if (!plane)
        return;
    gl_matrix_invert(gl_fixed_modelview(context->fixed), inverse);
    for (unsigned i = 0; i < 4; i++)
        moved[i] = equation[0] * inverse[i * 4] + equation[1] * inverse[i * 4 + 1] +
                   equation[2] * inverse[i * 4 + 2] + equation[3] * inverse[i * 4 + 3];
    memcpy(plane, moved, sizeof moved);
    context->late |= GL_LATE_FIXED;
}

void gl_GetClipPlanef(struct gl_context *context, GLenum name, GLfloat *out)
{
    const GLfloat *plane = plane_of(context, name);
    if (plane)
        memcpy(out, plane, 4 * sizeof *out);
}

GLboolean *gl_fixed_switch(struct gl_context *context, GLenum name)
{
    return name == GL_TEXTURE_2D ? &context->fixed->texture_2d[gl_state_unit(context)] : NULL;
}

GLfloat *gl_fixed_hint(struct gl_context *context, GLenum name)
{
    struct gl_fixed *fixed = context->fixed;
    return name == GL_FOG_HINT                      ? fixed->fog_hint
           : name == GL_LINE_SMOOTH_HINT            ? fixed->line_hint
           : name == GL_PERSPECTIVE_CORRECTION_HINT ? fixed->perspective_hint
           : name == GL_POINT_SMOOTH_HINT           ? fixed->point_hint
                                                    : NULL;
}

/* --- Values --- */

enum field { ENABLED, SIZE, TYPE, STRIDE, BUFFER };

static unsigned client_coordinates(const struct gl_context *context)
{
    return GL_FIXED_COORDINATES + (unsigned)context->fixed->client_texture[0] - GL_TEXTURE0;
}

static GLfloat field_of(const struct gl_array *array, enum field field)
{
    switch (field) {
    case ENABLED: return array->enabled;
    case SIZE: return (GLfloat)array->size;
    case TYPE: return (GLfloat)array->type;
    case STRIDE: return (GLfloat)array->stride;
    default: return array->buffer ? (GLfloat)array->buffer->object.name : 0;
    }
}

/* Values of client arrays. */
static bool get_array(const struct gl_context *context, GLenum name, GLfloat *out)
{
    const struct {
        GLenum name;
        unsigned location;
        enum field field;
    } rows[] = {
        {GL_VERTEX_ARRAY, GL_FIXED_POSITION, ENABLED},
        {GL_VERTEX_ARRAY_SIZE, GL_FIXED_POSITION, SIZE},
        {GL_VERTEX_ARRAY_TYPE, GL_FIXED_POSITION, TYPE},
        {GL_VERTEX_ARRAY_STRIDE, GL_FIXED_POSITION, STRIDE},
        {GL_VERTEX_ARRAY_BUFFER_BINDING, GL_FIXED_POSITION, BUFFER},
        {GL_NORMAL_ARRAY, GL_FIXED_NORMAL, ENABLED},
        {GL_NORMAL_ARRAY_TYPE, GL_FIXED_NORMAL, TYPE},
        {GL_NORMAL_ARRAY_STRIDE, GL_FIXED_NORMAL, STRIDE},
        {GL_NORMAL_ARRAY_BUFFER_BINDING, GL_FIXED_NORMAL, BUFFER},
        {GL_COLOR_ARRAY, GL_FIXED_COLOR, ENABLED},
        {GL_COLOR_ARRAY_SIZE, GL_FIXED_COLOR, SIZE},
        {GL_COLOR_ARRAY_TYPE, GL_FIXED_COLOR, TYPE},
        {GL_COLOR_ARRAY_STRIDE, GL_FIXED_COLOR, STRIDE},
        {GL_COLOR_ARRAY_BUFFER_BINDING, GL_FIXED_COLOR, BUFFER},
        {GL_TEXTURE_COORD_ARRAY, client_coordinates(context), ENABLED},
        {GL_TEXTURE_COORD_ARRAY_SIZE, client_coordinates(context), SIZE},
        {GL_TEXTURE_COORD_ARRAY_TYPE, client_coordinates(context), TYPE},
        {GL_TEXTURE_COORD_ARRAY_STRIDE, client_coordinates(context), STRIDE},
        {GL_TEXTURE_COORD_ARRAY_BUFFER_BINDING, client_coordinates(context), BUFFER},
        {GL_POINT_SIZE_ARRAY_OES, GL_FIXED_SIZE, ENABLED},
        {GL_POINT_SIZE_ARRAY_TYPE_OES, GL_FIXED_SIZE, TYPE},
        {GL_POINT_SIZE_ARRAY_STRIDE_OES, GL_FIXED_SIZE, STRIDE},
        {GL_POINT_SIZE_ARRAY_BUFFER_BINDING_OES, GL_FIXED_SIZE, BUFFER},
    };
    for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++)
        if (rows[i].name == name) {
            *out = field_of(&context->vertex_array->array[rows[i].location], rows[i].field);
            return true;
        }
    return false;
}

static unsigned copy_numbers(GLfloat *to, const GLfloat *from, unsigned count)
{
    memcpy(to, from, count * sizeof *to);
    return count;
}

/* Matrices, and current values. */
static unsigned get_numbers(struct gl_context *context, GLenum name, GLfloat *out, bool *unit)
{
    const struct gl_fixed *fixed = context->fixed;
    const struct gl_fixed_stack *texture = &fixed->texture[gl_state_unit(context)];
    *unit = name == GL_CURRENT_COLOR || name == GL_CURRENT_NORMAL;
    switch (name) {
    case GL_MODELVIEW_MATRIX: return copy_numbers(out, gl_fixed_modelview(fixed), 16);
    case GL_PROJECTION_MATRIX:
        return copy_numbers(out, fixed->projection.matrix[fixed->projection.depth], 16);
    case GL_TEXTURE_MATRIX: return copy_numbers(out, texture->matrix[texture->depth], 16);
    case GL_CURRENT_COLOR: return copy_numbers(out, context->current[GL_FIXED_COLOR], 4);
    case GL_CURRENT_NORMAL: return copy_numbers(out, context->current[GL_FIXED_NORMAL], 3);
    case GL_CURRENT_TEXTURE_COORDS:
        return copy_numbers(out, context->current[GL_FIXED_COORDINATES + gl_state_unit(context)], 4);
    default: return 0;
    }
}

unsigned gl_fixed_get(struct gl_context *context, GLenum name, GLfloat *out, bool *number, bool *unit)
{
    const struct gl_fixed *fixed = context->fixed;
    unsigned count = get_numbers(context, name, out, unit);
    *number = count;
    if (count)
        return count;
    switch (name) {
    case GL_MODELVIEW_STACK_DEPTH: *out = (GLfloat)fixed->modelview.depth + 1; return 1;
    case GL_PROJECTION_STACK_DEPTH: *out = (GLfloat)fixed->projection.depth + 1; return 1;
    case GL_TEXTURE_STACK_DEPTH: *out = (GLfloat)fixed->texture[gl_state_unit(context)].depth + 1; return 1;
    case GL_TEXTURE_2D: *out = fixed->texture_2d[gl_state_unit(context)]; return 1;
    case GL_BLEND_SRC: *out = (GLfloat)context->values.blend_source[0]; return 1;
    case GL_BLEND_DST: *out = (GLfloat)context->values.blend_target[0]; return 1;
    default: return get_array(context, name, out);
    }
}
