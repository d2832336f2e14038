/* The renderer's states that follow from a context's values. */
#include "front/gl/draw/prepare.h"
#include "front/gl/fixed.h"
#include "front/gl/program/program.h"
#include "front/gl/state.h"

struct row {
    enum triptych_state state;
    uint32_t value;
};

static void pass(struct gl_context *context, const struct row *rows, unsigned count)
{
    for (unsigned i = 0; i < count; i++)
        triptych_set_state(context->renderer, rows[i].state, rows[i].value);
}
#define PASS(context, rows) pass(context, rows, sizeof(rows) / sizeof *(rows))

/* Comparisons have one order in both interfaces. */
static uint32_t comparison_of(GLenum function)
{
    return function - GL_NEVER + TRIPTYCH_COMPARE_NEVER;
}

static uint32_t operation_of(GLenum operation)
{
    switch (operation) {
    case GL_ZERO: return TRIPTYCH_STENCILOP_ZERO;
    case GL_REPLACE: return TRIPTYCH_STENCILOP_REPLACE;
    case GL_INCR: return TRIPTYCH_STENCILOP_INCRSAT;
    case GL_DECR: return TRIPTYCH_STENCILOP_DECRSAT;
    case GL_INVERT: return TRIPTYCH_STENCILOP_INVERT;
    case GL_INCR_WRAP: return TRIPTYCH_STENCILOP_INCR;
    case GL_DECR_WRAP: return TRIPTYCH_STENCILOP_DECR;
    default: return TRIPTYCH_STENCILOP_KEEP;
    }
}

/* --- Triangles --- */

/* A triangle that is counter-clockwise in OpenGL is clockwise in rows of the renderer. */
static uint32_t cull_of(const struct gl_values *values)
{
    bool back = values->cull_mode[0] == GL_BACK, front_ccw = gl_state_front_ccw(values);
    if (!values->cull[0] || values->cull_mode[0] == GL_FRONT_AND_BACK)
        return TRIPTYCH_CULL_NONE;
    return back == front_ccw ? TRIPTYCH_CULL_CCW : TRIPTYCH_CULL_CW;
}

/* Depths that are one step of the format apart can round to one number. Two steps are the smallest difference
 * that never does, the unit r of 3.5.2. */
enum { RESOLVABLE = 2 };

static void pass_triangles(struct gl_context *context)
{
    const struct gl_values *values = &context->values;
    bool offset = values->offset[0];
    float units = offset ? RESOLVABLE * values->offset_units[0] : 0, width = values->line_width[0];
    const struct row rows[] = {
        {TRIPTYCH_STATE_CULLMODE, cull_of(values)},
        {TRIPTYCH_STATE_SLOPESCALEDEPTHBIAS, triptych_float_bits(offset ? values->offset_factor[0] : 0)},
        {TRIPTYCH_STATE_DEPTHBIAS, triptych_float_bits(units)},
        {TRIPTYCH_STATE_SAMPLECOVERAGE,
         triptych_float_bits(values->sample_coverage[0] ? values->coverage[0] : 1)},
        {TRIPTYCH_STATE_SAMPLECOVERAGEINVERT, values->sample_coverage[0] && values->coverage_invert[0]},
        {TRIPTYCH_STATE_LASTPIXEL, TRIPTYCH_BOOLEAN_FALSE},
        {TRIPTYCH_STATE_LINEWIDTH, triptych_float_bits(width < GL_LINE_MOST ? width : GL_LINE_MOST)},
        {TRIPTYCH_STATE_POINTSIZE_MAX, triptych_float_bits(GL_POINT_MOST)},
    };
    PASS(context, rows);
}

/* --- Depth and stencil --- */

static void pass_depth(struct gl_context *context, const struct gl_target *target)
{
    const struct gl_values *values = &context->values;
    const struct row rows[] = {
        {TRIPTYCH_STATE_ZENABLE, values->depth_test[0] && target->depth_bits},
        {TRIPTYCH_STATE_ZWRITEENABLE, values->depth_write[0]},
        {TRIPTYCH_STATE_ZFUNC, comparison_of(values->depth_func[0])},
    };
    PASS(context, rows);
}

/* A reference is limited to the bits of the surface. */
static uint32_t reference_of(GLint reference, unsigned bits)
{
    GLint most = (GLint)((1u << bits) - 1);
    return (uint32_t)(reference < 0 ? 0 : reference < most ? reference : most);
}

static void pass_stencil(struct gl_context *context, const struct gl_target *target)
{
    const struct gl_values *v = &context->values;
    bool ccw = gl_state_front_ccw(v);
    unsigned bits = target->stencil_bits;
#define FRONT(field) (ccw ? v->stencil_##field[0] : v->back_##field[0])
#define BACK(field)  (ccw ? v->back_##field[0] : v->stencil_##field[0])
    const struct row rows[] = {
        {TRIPTYCH_STATE_STENCILENABLE, v->stencil_test[0] && bits},
        {TRIPTYCH_STATE_TWOSIDEDSTENCILMODE, TRIPTYCH_BOOLEAN_TRUE},
        {TRIPTYCH_STATE_STENCILSEPARATE, TRIPTYCH_BOOLEAN_TRUE},
        {TRIPTYCH_STATE_CCW_STENCILREF, reference_of(BACK(ref), bits)},
        {TRIPTYCH_STATE_CCW_STENCILMASK, BACK(mask)},
        {TRIPTYCH_STATE_CCW_STENCILWRITEMASK, BACK(write)},
        {TRIPTYCH_STATE_STENCILFUNC, comparison_of(FRONT(func))},
        {TRIPTYCH_STATE_STENCILREF, reference_of(FRONT(ref), bits)},
        {TRIPTYCH_STATE_STENCILMASK, FRONT(mask)},
        {TRIPTYCH_STATE_STENCILWRITEMASK, FRONT(write)},
        {TRIPTYCH_STATE_STENCILFAIL, operation_of(FRONT(fail))},
        {TRIPTYCH_STATE_STENCILZFAIL, operation_of(FRONT(depth_fail))},
        {TRIPTYCH_STATE_STENCILPASS, operation_of(FRONT(pass))},
        {TRIPTYCH_STATE_CCW_STENCILFUNC, comparison_of(BACK(func))},
        {TRIPTYCH_STATE_CCW_STENCILFAIL, operation_of(BACK(fail))},
        {TRIPTYCH_STATE_CCW_STENCILZFAIL, operation_of(BACK(depth_fail))},
        {TRIPTYCH_STATE_CCW_STENCILPASS, operation_of(BACK(pass))},
    };
#undef FRONT
#undef BACK
    PASS(context, rows);
}

/* --- Colours --- */

static uint32_t factor_of(GLenum factor)
{
    switch (factor) {
    case GL_ZERO: return TRIPTYCH_BLEND_ZERO;
    case GL_SRC_COLOR: return TRIPTYCH_BLEND_SRCCOLOR;
    case GL_ONE_MINUS_SRC_COLOR: return TRIPTYCH_BLEND_INVSRCCOLOR;
    case GL_SRC_ALPHA: return TRIPTYCH_BLEND_SRCALPHA;
    case GL_ONE_MINUS_SRC_ALPHA: return TRIPTYCH_BLEND_INVSRCALPHA;
    case GL_DST_ALPHA: return TRIPTYCH_BLEND_DESTALPHA;
    case GL_ONE_MINUS_DST_ALPHA: return TRIPTYCH_BLEND_INVDESTALPHA;
    case GL_DST_COLOR: return TRIPTYCH_BLEND_DESTCOLOR;
    case GL_ONE_MINUS_DST_COLOR: return TRIPTYCH_BLEND_INVDESTCOLOR;
    case GL_SRC_ALPHA_SATURATE: return TRIPTYCH_BLEND_SRCALPHASAT;
    case GL_CONSTANT_ALPHA: return TRIPTYCH_BLEND_BLENDFACTORALPHA;
    case GL_ONE_MINUS_CONSTANT_ALPHA: return TRIPTYCH_BLEND_INVBLENDFACTORALPHA;
    case GL_CONSTANT_COLOR: return TRIPTYCH_BLEND_BLENDFACTOR;
    case GL_ONE_MINUS_CONSTANT_COLOR: return TRIPTYCH_BLEND_INVBLENDFACTOR;
    case GL_SRC1_COLOR_EXT: return TRIPTYCH_BLEND_SRCCOLOR2;
    case GL_ONE_MINUS_SRC1_COLOR_EXT: return TRIPTYCH_BLEND_INVSRCCOLOR2;
    case GL_SRC1_ALPHA: return TRIPTYCH_BLEND_SRCALPHA2;
    case GL_ONE_MINUS_SRC1_ALPHA_EXT: return TRIPTYCH_BLEND_INVSRCALPHA2;
    default: return TRIPTYCH_BLEND_ONE;
    }
}

static uint32_t equation_of(GLenum mode)
{
    switch (mode) {
    case GL_FUNC_SUBTRACT: return TRIPTYCH_BLENDOP_SUBTRACT;
    case GL_FUNC_REVERSE_SUBTRACT: return TRIPTYCH_BLENDOP_REVSUBTRACT;
    case GL_MIN_EXT: return TRIPTYCH_BLENDOP_MIN;
    case GL_MAX_EXT: return TRIPTYCH_BLENDOP_MAX;
#define GLSL_BLEND(name, value, qualifier)                                                                   \
    case GL_##name##_KHR:                                                                                    \
        return TRIPTYCH_BLENDOP_##value;
#include "front/glsl/blend.def"
#undef GLSL_BLEND
    default: return TRIPTYCH_BLENDOP_ADD;
    }
}

/* Advanced equations blend alpha too. */
static uint32_t alpha_equation_of(GLenum mode)
{
    uint32_t equation = equation_of(mode);
    return equation < TRIPTYCH_BLENDOP_MULTIPLY ? equation : TRIPTYCH_BLENDOP_ADD;
}

static uint32_t pack_color(const GLfloat color[4])
{
    uint32_t packed = 0;
    static const unsigned shifts[4] = {16, 8, 0, 24};
    for (unsigned i = 0; i < 4; i++)
        packed |= (uint32_t)(color[i] * 255 + 0.5F) << shifts[i];
    return packed;
}

static uint32_t mask_of(const GLboolean write[4])
{
    return write[0] | (uint32_t)write[1] << 1 | (uint32_t)write[2] << 2 | (uint32_t)write[3] << 3;
}

static void pass_colors(struct gl_context *context)
{
    const struct gl_values *values = &context->values;
    uint32_t mask = mask_of(values->color_write);
    const struct row rows[] = {
        {TRIPTYCH_STATE_ALPHABLENDENABLE, values->blend[0]},
        {TRIPTYCH_STATE_SEPARATEALPHABLENDENABLE, TRIPTYCH_BOOLEAN_TRUE},
        {TRIPTYCH_STATE_SRCBLEND, factor_of(values->blend_source[0])},
        {TRIPTYCH_STATE_DESTBLEND, factor_of(values->blend_target[0])},
        {TRIPTYCH_STATE_BLENDOP, equation_of(values->blend_equation[0])},
        {TRIPTYCH_STATE_SRCBLENDALPHA, factor_of(values->blend_source_alpha[0])},
        {TRIPTYCH_STATE_DESTBLENDALPHA, factor_of(values->blend_target_alpha[0])},
        {TRIPTYCH_STATE_BLENDOPALPHA, alpha_equation_of(values->blend_equation_alpha[0])},
        {TRIPTYCH_STATE_BLENDFACTOR, pack_color(values->blend_color)},
        {TRIPTYCH_STATE_COLORWRITEENABLE, mask},
        {TRIPTYCH_STATE_COLORWRITEENABLE1, mask},
        {TRIPTYCH_STATE_COLORWRITEENABLE2, mask},
        {TRIPTYCH_STATE_COLORWRITEENABLE3, mask},
    };
    PASS(context, rows);
}

/* The renderer's operations have OpenGL's order. */
static uint32_t logic_of(const struct gl_context *context)
{
    if (!context->fixed || !context->values.color_logic_op[0])
        return TRIPTYCH_LOGICOP_NONE;
    return TRIPTYCH_LOGICOP_CLEAR + (uint32_t)context->fixed->logic_op[0] - GL_CLEAR;
}

/* The alpha test of version 1.1, whose reference has the precision of a byte. The renderer's alpha to
 * coverage needs a test: one that all pass. */
static void pass_alpha(struct gl_context *context)
{
    const struct gl_fixed *fixed = context->fixed;
    bool tests = fixed && context->values.alpha_test[0], covers = context->values.alpha_to_coverage[0];
    const struct row rows[] = {
        {TRIPTYCH_STATE_ALPHATESTENABLE, tests || covers},
        {TRIPTYCH_STATE_ALPHAFUNC, comparison_of(tests ? (GLenum)fixed->alpha_func[0] : GL_ALWAYS)},
        {TRIPTYCH_STATE_ALPHAREF, tests ? (uint32_t)(fixed->alpha_reference[0] * 255 + 0.5F) : 0},
        {TRIPTYCH_STATE_ADAPTIVETESS_Y, covers ? TRIPTYCH_TESSELLATION_ATOC : TRIPTYCH_TESSELLATION_NONE},
    };
    PASS(context, rows);
}

/* Version 1.1. */
static void pass_fixed(struct gl_context *context)
{
    const struct gl_fixed *fixed = context->fixed;
    bool flat = fixed && fixed->shade_model[0] == GL_FLAT;
    const struct row rows[] = {
        {TRIPTYCH_STATE_LOGICOP, logic_of(context)},
        {TRIPTYCH_STATE_ANTIALIASEDLINEENABLE, fixed && context->values.line_smooth[0]},
        {TRIPTYCH_STATE_SHADEMODE, flat ? TRIPTYCH_SHADE_FLAT : TRIPTYCH_SHADE_GOURAUD},
    };
    PASS(context, rows);
}

void gl_prepare_raster(struct gl_context *context, const struct gl_target *target)
{
    pass_triangles(context);
    pass_depth(context, target);
    pass_stencil(context, target);
    pass_colors(context);
    pass_alpha(context);
    pass_fixed(context);
}
