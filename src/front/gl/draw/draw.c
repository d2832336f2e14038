/* glDrawArrays and glDrawElements: chapter 2.8. Vertices and indices outside of their buffers do not stop a
 * program: the draw is left out. */
#include "front/gl/draw/draw.h"
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/draw/prepare.h"
#include "front/gl/fixed.h"
#include "front/gl/program/program.h"
#include "front/gl/state.h"

#include <string.h>

/* --- Primitives --- */

/* The primitives of `count` vertices. */
static uint32_t primitives_of(GLenum mode, uint32_t count, enum triptych_primitive *primitive)
{
    static const struct {
        enum triptych_primitive primitive;
        uint32_t least, shared, step;
    } modes[] = {
        [GL_POINTS] = {TRIPTYCH_POINT_LIST, 1, 0, 1},
        [GL_LINES] = {TRIPTYCH_LINE_LIST, 2, 0, 2},
        [GL_LINE_LOOP] = {TRIPTYCH_LINE_LOOP, 2, 0, 1},
        [GL_LINE_STRIP] = {TRIPTYCH_LINE_STRIP, 2, 1, 1},
        [GL_TRIANGLES] = {TRIPTYCH_TRIANGLE_LIST, 3, 0, 3},
        [GL_TRIANGLE_STRIP] = {TRIPTYCH_TRIANGLE_STRIP, 3, 2, 1},
        [GL_TRIANGLE_FAN] = {TRIPTYCH_TRIANGLE_FAN, 3, 2, 1},
    };
    *primitive = modes[mode].primitive;
    return count < modes[mode].least ? 0 : (count - modes[mode].shared) / modes[mode].step;
}

/* Both faces are culled: points and lines are drawn. */
static bool is_culled(const struct gl_context *context, GLenum mode)
{
    const struct gl_values *values = &context->values;
    return values->cull[0] && values->cull_mode[0] == GL_FRONT_AND_BACK && mode >= GL_TRIANGLES;
}

static bool check_mode(struct gl_context *context, GLenum mode, GLsizei count)
{
    if (mode > GL_TRIANGLE_FAN)
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a primitive", gl_constant_name(mode));
    else if (count < 0)
        gl_error(context, GL_INVALID_VALUE, "found %d vertices, expected 0 or more", count);
    else
        return true;
    return false;
}

static bool reads_mapped(const struct gl_context *context)
{
    const struct gl_vertex_array *arrays = context->vertex_array;
    for (unsigned i = 0; i < GL_ATTRIBUTES; i++)
        if (arrays->array[i].enabled && arrays->array[i].buffer && arrays->array[i].buffer->mapped)
            return true;
    return false;
}

static bool has_several_colors(const struct gl_context *context)
{
    for (unsigned k = 1; k < GL_DRAWS && context->framebuffer; k++)
        if (context->framebuffer->draw[k] != GL_NONE)
            return true;
    return false;
}

static bool is_second(GLenum factor)
{
    return factor == GL_SRC1_COLOR_EXT || factor == GL_ONE_MINUS_SRC1_COLOR_EXT || factor == GL_SRC1_ALPHA ||
           factor == GL_ONE_MINUS_SRC1_ALPHA_EXT;
}

/* EXT_blend_func_extended */
static bool blends_by_second(const struct gl_values *values)
{
    return values->blend[0] &&
           (is_second(values->blend_source[0]) || is_second(values->blend_target[0]) ||
            is_second(values->blend_source_alpha[0]) || is_second(values->blend_target_alpha[0]));
}

/* KHR_blend_equation_advanced: the shader allows the equation, and there is one colour. */
static bool may_blend(const struct gl_context *context)
{
    static const GLenum equations[] = {
#define GLSL_BLEND(name, value, qualifier) GL_##name##_KHR,
#include "front/glsl/blend.def"
#undef GLSL_BLEND
    };
    const struct gl_values *values = &context->values;
    unsigned i = 0;
    while (i < GLSL_BLENDS && values->blend_equation[0] != equations[i])
        i++;
    if (i == GLSL_BLENDS || !values->blend[0])
        return true;
    return !has_several_colors(context) && context->program->program->blends >> i & 1;
}

/* Errors of the state. Without a program nothing is drawn. */
static bool check_state(struct gl_context *context, GLenum mode, struct gl_target *target)
{
    if (!gl_framebuffer_check(context, false, target) || (context->fixed && !gl_fixed_prepare(context, mode)))
        return false;
    const struct gl_program *program = context->program;
    if (!program || !program->program)
        return false;
    if (!gl_program_is_valid(program))
        gl_error(context, GL_INVALID_OPERATION, "found a texture unit with samplers of two types");
    else if (!may_blend(context))
        gl_error(context, GL_INVALID_OPERATION,
                 "found the equation %s, expected a shader that allows it and one colour",
                 gl_constant_name(context->values.blend_equation[0]));
    else if (blends_by_second(&context->values) && has_several_colors(context))
        gl_error(context, GL_INVALID_OPERATION,
                 "found several colours and a factor of the second source, expected one colour");
    else if (reads_mapped(context))
        gl_error(context, GL_INVALID_OPERATION, "found a mapped buffer, expected one that is not");
    else
        return true;
    return false;
}

/* gl_FragColor is the colour of all targets. */
static void choose_form(struct gl_context *context)
{
    const struct glsl_program *program = context->program->program;
    enum gl_form form = GL_FORM_TARGETS;
    if (program->second[0] && blends_by_second(&context->values))
        form = GL_FORM_SECOND;
    else if (program->broadcasts && has_several_colors(context))
        form = GL_FORM_BROADCAST;
    if (form != context->form)
        context->late |= GL_LATE_SHADERS;
    context->form = (uint8_t)form;
}

/* gl_FrontFacing: points and lines are front. */
static void choose_front(struct gl_context *context, const struct gl_draw *d)
{
    bool triangles = d->primitive == TRIPTYCH_TRIANGLE_LIST || d->primitive == TRIPTYCH_TRIANGLE_STRIP ||
                     d->primitive == TRIPTYCH_TRIANGLE_FAN;
    bool turned = triangles && context->program->turned && !gl_state_front_ccw(&context->values);
    if (turned != context->turned)
        context->late |= GL_LATE_SHADERS;
    context->turned = turned;
}

static void draw(struct gl_context *context, const struct gl_draw *d, struct gl_target *target)
{
    uint32_t first;
    choose_front(context, d);
    choose_form(context);
    if (!d->primitives || !gl_stream_bind(context, d, &first) || !gl_prepare_draw(context, target))
        return;
    if (d->indices)
        triptych_draw_indexed(context->renderer, d->primitive, -(int32_t)d->origin, first, d->primitives);
    else
        triptych_draw(context->renderer, d->primitive, 0, d->primitives);
}

void gl_DrawArrays(struct gl_context *context, GLenum mode, GLint first, GLsizei count)
{
    struct gl_target target;
    struct gl_draw d = {.origin = (uint32_t)first, .vertices = (uint32_t)count};
    if (!check_mode(context, mode, count))
        return;
    if (first < 0) {
        gl_error(context, GL_INVALID_VALUE, "found the first vertex %d, expected 0 or more", first);
        return;
    }
    if (!check_state(context, mode, &target) || is_culled(context, mode))
        return;
    d.primitives = primitives_of(mode, (uint32_t)count, &d.primitive);
    draw(context, &d, &target);
}

/* --- Indices --- */

static uint32_t index_at(const struct gl_draw *d, uint32_t i)
{
    const uint8_t *at = (const uint8_t *)d->indices + (size_t)i * (d->bits / 8);
    uint16_t word;
    uint32_t wide;
    if (d->bits == 8)
        return *at;
    if (d->bits == 16) {
        memcpy(&word, at, sizeof word);
        return word;
    }
    memcpy(&wide, at, sizeof wide);
    return wide;
}

/* The vertices that an indexed draw reads. */
static void find_range(struct gl_draw *d)
{
    uint32_t least = UINT32_MAX, most = 0;
    for (uint32_t i = 0; i < d->count; i++) {
        uint32_t index = index_at(d, i);
        least = index < least ? index : least;
        most = index > most ? index : most;
    }
    d->origin = least;
    d->vertices = most - least + 1;
}

/* Finds indices in the buffer of indices. */
static bool find_indices(const struct gl_context *context, const void *indices, struct gl_draw *d)
{
    struct gl_buffer *elements = context->vertex_array->elements;
    size_t offset = (size_t)indices, bytes = (size_t)d->count * (d->bits / 8);
    d->indices = indices;
    d->elements = elements;
    if (!elements)
        return indices;
    if (!elements->memory || offset > elements->bytes || bytes > elements->bytes - offset)
        return false;
    d->indices = elements->memory + offset;
    return true;
}

void gl_DrawElements(struct gl_context *context, GLenum mode, GLsizei count, GLenum type, const void *indices)
{
    struct gl_target target;
    struct gl_draw d = {.count = (uint32_t)count};
    const struct gl_buffer *elements = context->vertex_array->elements;
    if (!check_mode(context, mode, count))
        return;
    d.bits = type == GL_UNSIGNED_BYTE ? 8 : type == GL_UNSIGNED_SHORT ? 16 : type == GL_UNSIGNED_INT ? 32 : 0;
    if (!d.bits) {
        gl_error(context, GL_INVALID_ENUM, "found %s, expected a type of indices", gl_constant_name(type));
        return;
    }
    if (elements && elements->mapped) {
        gl_error(context, GL_INVALID_OPERATION, "found a mapped buffer of indices, expected one that is not");
        return;
    }
    if (!check_state(context, mode, &target) || is_culled(context, mode) || !count ||
        !find_indices(context, indices, &d))
        return;
    if (gl_stream_reads_memory(context))
        find_range(&d);
    d.primitives = primitives_of(mode, d.count, &d.primitive);
    if (d.origin <= INT32_MAX)
        draw(context, &d, &target);
}
