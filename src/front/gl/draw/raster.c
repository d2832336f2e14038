/* Values of rasterization, of operations on fragments, and of clears: chapters 2.12, 3.4 to 3.6, 4.1, 4.2. */
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/state.h"

#include <string.h>

static bool refuse(struct gl_context *context, GLenum found, const char *expected)
{
    gl_error(context, GL_INVALID_ENUM, "found %s, expected %s", gl_constant_name(found), expected);
    return false;
}

static bool check_size(struct gl_context *context, GLsizei width, GLsizei height)
{
    if (width < 0 || height < 0)
        gl_error(context, GL_INVALID_VALUE, "found a size of %d x %d, expected 0 or more", width, height);
    return width >= 0 && height >= 0;
}

/* --- Areas --- */

void gl_Viewport(struct gl_context *context, GLint x, GLint y, GLsizei width, GLsizei height)
{
    const GLint viewport[4] = {x, y, width < GL_SIDE ? width : GL_SIDE, height < GL_SIDE ? height : GL_SIDE};
    if (!check_size(context, width, height))
        return;
    memcpy(context->values.viewport, viewport, sizeof viewport);
    context->late |= GL_LATE_AREA;
}

void gl_Scissor(struct gl_context *context, GLint x, GLint y, GLsizei width, GLsizei height)
{
    const GLint scissor[4] = {x, y, width, height};
    if (!check_size(context, width, height))
        return;
    memcpy(context->values.scissor, scissor, sizeof scissor);
    context->late |= GL_LATE_AREA;
}

void gl_DepthRangef(struct gl_context *context, GLfloat n, GLfloat f)
{
    context->values.depth_range[0] = gl_clamp(n);
    context->values.depth_range[1] = gl_clamp(f);
    context->late |= GL_LATE_AREA | GL_LATE_PROGRAM;
}

void gl_ClipControlEXT(struct gl_context *context, GLenum origin, GLenum depth)
{
    bool has_origin = origin == GL_LOWER_LEFT_EXT || origin == GL_UPPER_LEFT_EXT;
    if (!has_origin || (depth != GL_NEGATIVE_ONE_TO_ONE_EXT && depth != GL_ZERO_TO_ONE_EXT)) {
        refuse(context, has_origin ? depth : origin, has_origin ? "a range of depth" : "a corner");
        return;
    }
    context->values.clip_origin[0] = origin;
    context->values.clip_depth[0] = depth;
    context->late |= GL_LATE_AREA | GL_LATE_RASTER;
}

/* --- Primitives --- */

void gl_CullFace(struct gl_context *context, GLenum mode)
{
    if (mode != GL_FRONT && mode != GL_BACK && mode != GL_FRONT_AND_BACK) {
        refuse(context, mode, "a face");
        return;
    }
    context->values.cull_mode[0] = mode;
    context->late |= GL_LATE_RASTER;
}

void gl_FrontFace(struct gl_context *context, GLenum mode)
{
    if (mode != GL_CW && mode != GL_CCW) {
        refuse(context, mode, "GL_CW or GL_CCW");
        return;
    }
    context->values.front_face[0] = mode;
    context->late |= GL_LATE_RASTER;
}

void gl_LineWidth(struct gl_context *context, GLfloat width)
{
    if (width > 0) {
        context->values.line_width[0] = width;
        context->late |= GL_LATE_RASTER;
    } else {
        gl_error(context, GL_INVALID_VALUE, "found a width of %g, expected more than 0", (double)width);
    }
}

void gl_PolygonOffset(struct gl_context *context, GLfloat factor, GLfloat units)
{
    context->values.offset_factor[0] = factor;
    context->values.offset_units[0] = units;
    context->late |= GL_LATE_RASTER;
}

void gl_SampleCoverage(struct gl_context *context, GLfloat value, GLboolean invert)
{
    context->values.coverage[0] = gl_clamp(value);
    context->values.coverage_invert[0] = invert != 0;
    context->late |= GL_LATE_RASTER;
}

/* --- Depth and stencil --- */

static bool is_comparison(GLenum function)
{
    return function >= GL_NEVER && function <= GL_ALWAYS;
}

static bool is_face(GLenum face)
{
    return face == GL_FRONT || face == GL_BACK || face == GL_FRONT_AND_BACK;
}

static bool is_operation(GLenum operation)
{
    return operation == GL_KEEP || operation == GL_ZERO || operation == GL_REPLACE || operation == GL_INCR ||
           operation == GL_DECR || operation == GL_INVERT || operation == GL_INCR_WRAP ||
           operation == GL_DECR_WRAP;
}

void gl_DepthFunc(struct gl_context *context, GLenum function)
{
    if (!is_comparison(function)) {
        refuse(context, function, "a comparison");
        return;
    }
    context->values.depth_func[0] = function;
    context->late |= GL_LATE_RASTER;
}

void gl_DepthMask(struct gl_context *context, GLboolean flag)
{
    context->values.depth_write[0] = flag != 0;
    context->late |= GL_LATE_RASTER;
}

void gl_StencilFuncSeparate(struct gl_context *context, GLenum face, GLenum function, GLint reference,
                            GLuint mask)
{
    struct gl_values *values = &context->values;
    if (!is_face(face) || !is_comparison(function)) {
        refuse(context, is_face(face) ? function : face, "a face and a comparison");
        return;
    }
    if (face != GL_BACK) {
        values->stencil_func[0] = function;
        values->stencil_ref[0] = reference;
        values->stencil_mask[0] = mask;
    }
    if (face != GL_FRONT) {
        values->back_func[0] = function;
        values->back_ref[0] = reference;
        values->back_mask[0] = mask;
    }
    context->late |= GL_LATE_RASTER;
}

void gl_StencilFunc(struct gl_context *context, GLenum function, GLint reference, GLuint mask)
{
    gl_StencilFuncSeparate(context, GL_FRONT_AND_BACK, function, reference, mask);
}

void gl_StencilMaskSeparate(struct gl_context *context, GLenum face, GLuint mask)
{
    if (!is_face(face)) {
        refuse(context, face, "a face");
        return;
    }
    if (face != GL_BACK)
        context->values.stencil_write[0] = mask;
    if (face != GL_FRONT)
        context->values.back_write[0] = mask;
    context->late |= GL_LATE_RASTER;
}

void gl_StencilMask(struct gl_context *context, GLuint mask)
{
    gl_StencilMaskSeparate(context, GL_FRONT_AND_BACK, mask);
}

void gl_StencilOpSeparate(struct gl_context *context, GLenum face, GLenum fail, GLenum depth_fail,
                          GLenum pass)
{
    struct gl_values *values = &context->values;
    if (!is_face(face) || !is_operation(fail) || !is_operation(depth_fail) || !is_operation(pass)) {
        gl_error(context, GL_INVALID_ENUM, "found the face 0x%04x with the operations 0x%04x, 0x%04x, 0x%04x",
                 face, fail, depth_fail, pass);
        return;
    }
    if (face != GL_BACK) {
        values->stencil_fail[0] = fail;
        values->stencil_depth_fail[0] = depth_fail;
        values->stencil_pass[0] = pass;
    }
    if (face != GL_FRONT) {
        values->back_fail[0] = fail;
        values->back_depth_fail[0] = depth_fail;
        values->back_pass[0] = pass;
    }
    context->late |= GL_LATE_RASTER;
}

void gl_StencilOp(struct gl_context *context, GLenum fail, GLenum depth_fail, GLenum pass)
{
    gl_StencilOpSeparate(context, GL_FRONT_AND_BACK, fail, depth_fail, pass);
}

/* --- Blending and masks --- */

static bool is_equation(GLenum mode)
{
    return mode == GL_FUNC_ADD || mode == GL_FUNC_SUBTRACT || mode == GL_FUNC_REVERSE_SUBTRACT ||
           mode == GL_MIN_EXT || mode == GL_MAX_EXT;
}

static bool is_factor(GLenum factor)
{
    return factor == GL_ZERO || factor == GL_ONE ||
           (factor >= GL_SRC_COLOR && factor <= GL_ONE_MINUS_DST_COLOR) ||
           (factor >= GL_CONSTANT_COLOR && factor <= GL_ONE_MINUS_CONSTANT_ALPHA);
}

/* EXT_blend_func_extended, which version 1.1 does not have, adds the factors of a second source, and
 * GL_SRC_ALPHA_SATURATE for the target. */
static bool is_target_factor(const struct gl_context *context, GLenum factor)
{
    bool extended = factor == GL_SRC_ALPHA_SATURATE || factor == GL_SRC1_COLOR_EXT ||
                    factor == GL_ONE_MINUS_SRC1_COLOR_EXT || factor == GL_SRC1_ALPHA ||
                    factor == GL_ONE_MINUS_SRC1_ALPHA_EXT;
    return is_factor(factor) || (extended && !context->fixed);
}

static bool is_source_factor(const struct gl_context *context, GLenum factor)
{
    return is_target_factor(context, factor) || factor == GL_SRC_ALPHA_SATURATE;
}

void gl_BlendEquationSeparate(struct gl_context *context, GLenum color, GLenum alpha)
{
    if (!is_equation(color) || !is_equation(alpha)) {
        refuse(context, is_equation(color) ? alpha : color, "an equation of blending");
        return;
    }
    context->values.blend_equation[0] = color;
    context->values.blend_equation_alpha[0] = alpha;
    context->late |= GL_LATE_RASTER;
}

static bool is_advanced(GLenum mode)
{
    switch (mode) {
#define GLSL_BLEND(name, value, qualifier) case GL_##name##_KHR:
#include "front/glsl/blend.def"
#undef GLSL_BLEND
        return true;
    default: return false;
    }
}

/* Version 1.1 has no shader that allows an advanced equation. */
void gl_BlendEquation(struct gl_context *context, GLenum mode)
{
    if (context->fixed || !is_advanced(mode)) {
        gl_BlendEquationSeparate(context, mode, mode);
        return;
    }
    context->values.blend_equation[0] = mode;
    context->values.blend_equation_alpha[0] = mode;
    context->late |= GL_LATE_RASTER;
}

/* The renderer blends in the order of primitives, so passes need no barrier. */
void gl_BlendBarrierKHR(struct gl_context *context)
{
    (void)context;
}

void gl_BlendFuncSeparate(struct gl_context *context, GLenum source, GLenum target, GLenum source_alpha,
                          GLenum target_alpha)
{
    struct gl_values *values = &context->values;
    bool sources = is_source_factor(context, source) && is_source_factor(context, source_alpha);
    if (!sources || !is_target_factor(context, target) || !is_target_factor(context, target_alpha)) {
        gl_error(context, GL_INVALID_ENUM, "found the factors 0x%04x, 0x%04x, 0x%04x, 0x%04x", source, target,
                 source_alpha, target_alpha);
        return;
    }
    values->blend_source[0] = source;
    values->blend_target[0] = target;
    values->blend_source_alpha[0] = source_alpha;
    values->blend_target_alpha[0] = target_alpha;
    context->late |= GL_LATE_RASTER;
}

void gl_BlendFunc(struct gl_context *context, GLenum source, GLenum target)
{
    gl_BlendFuncSeparate(context, source, target, source, target);
}

static void set_color(GLfloat *color, GLfloat red, GLfloat green, GLfloat blue, GLfloat alpha)
{
    color[0] = gl_clamp(red);
    color[1] = gl_clamp(green);
    color[2] = gl_clamp(blue);
    color[3] = gl_clamp(alpha);
}

void gl_BlendColor(struct gl_context *context, GLfloat red, GLfloat green, GLfloat blue, GLfloat alpha)
{
    set_color(context->values.blend_color, red, green, blue, alpha);
    context->late |= GL_LATE_RASTER;
}

void gl_ColorMask(struct gl_context *context, GLboolean red, GLboolean green, GLboolean blue, GLboolean alpha)
{
    GLboolean *mask = context->values.color_write;
    mask[0] = red != 0;
    mask[1] = green != 0;
    mask[2] = blue != 0;
    mask[3] = alpha != 0;
    context->late |= GL_LATE_RASTER;
}

/* --- Values of clears --- */

void gl_ClearColor(struct gl_context *context, GLfloat red, GLfloat green, GLfloat blue, GLfloat alpha)
{
    set_color(context->values.clear_color, red, green, blue, alpha);
}

void gl_ClearDepthf(struct gl_context *context, GLfloat depth)
{
    context->values.clear_depth[0] = gl_clamp(depth);
}

void gl_ClearStencil(struct gl_context *context, GLint stencil)
{
    context->values.clear_stencil[0] = stencil;
}
