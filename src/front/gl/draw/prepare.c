/* Values that are passed on to the renderer before a draw: see context->late. */
#include "front/gl/draw/prepare.h"
#include "front/gl/program/program.h"
#include "front/gl/state.h"
#include "front/gl/texture/texture.h"

/* --- Textures --- */

static uint32_t address_of(GLenum wrap)
{
    return wrap == GL_REPEAT            ? TRIPTYCH_ADDRESS_WRAP
           : wrap == GL_MIRRORED_REPEAT ? TRIPTYCH_ADDRESS_MIRROR
                                        : TRIPTYCH_ADDRESS_CLAMP;
}

static uint32_t filter_of(GLenum filter)
{
    bool linear =
        filter == GL_LINEAR || filter == GL_LINEAR_MIPMAP_NEAREST || filter == GL_LINEAR_MIPMAP_LINEAR;
    return linear ? TRIPTYCH_FILTER_LINEAR : TRIPTYCH_FILTER_POINT;
}

static uint32_t mip_filter_of(GLenum filter)
{
    return filter == GL_NEAREST || filter == GL_LINEAR                               ? TRIPTYCH_FILTER_NONE
           : filter == GL_NEAREST_MIPMAP_LINEAR || filter == GL_LINEAR_MIPMAP_LINEAR ? TRIPTYCH_FILTER_LINEAR
                                                                                     : TRIPTYCH_FILTER_POINT;
}

static void pass_sampler(struct gl_context *context, unsigned sampler, const struct gl_texture *texture)
{
    triptych_device *renderer = context->renderer;
    bool anisotropic = texture->anisotropy > 1 && filter_of(texture->min_filter) == TRIPTYCH_FILTER_LINEAR &&
                       sampler < TRIPTYCH_VERTEX_SAMPLER;
    const struct {
        enum triptych_sampler_state state;
        uint32_t value;
    } states[] = {
        {TRIPTYCH_SAMPLER_ADDRESSU, address_of(texture->wrap_s)},
        {TRIPTYCH_SAMPLER_ADDRESSV, address_of(texture->wrap_t)},
        {TRIPTYCH_SAMPLER_ADDRESSW, TRIPTYCH_ADDRESS_CLAMP},
        {TRIPTYCH_SAMPLER_MAGFILTER, filter_of(texture->mag_filter)},
        {TRIPTYCH_SAMPLER_MINFILTER,
         anisotropic ? TRIPTYCH_FILTER_ANISOTROPIC : filter_of(texture->min_filter)},
        {TRIPTYCH_SAMPLER_MIPFILTER, mip_filter_of(texture->min_filter)},
        {TRIPTYCH_SAMPLER_MAXANISOTROPY, (uint32_t)texture->anisotropy},
    };
    for (unsigned i = 0; i < sizeof states / sizeof *states; i++)
        triptych_set_sampler_state(renderer, sampler, states[i].state, states[i].value);
}

/* An incomplete texture is none: shaders sample (0, 0, 0, 1). */
static void pass_texture(struct gl_context *context, unsigned sampler, struct gl_texture *texture)
{
    triptych_texture *made = gl_texture_use(context, texture);
    triptych_set_texture(context->renderer, sampler, made);
    if (made)
        pass_sampler(context, sampler, texture);
}

static void pass_uniform(struct gl_context *context, const struct gl_program *program,
                         const struct glsl_uniform *uniform)
{
    enum gl_dimension dimension =
        uniform->type.base == GLSL_SAMPLER_CUBE ? GL_DIMENSION_CUBE : GL_DIMENSION_2D;
    for (unsigned s = 0; s < GLSL_STAGES; s++)
        for (unsigned e = 0; uniform->stage[s].first >= 0 && e < uniform->stage[s].elements; e++) {
            unsigned i = (unsigned)uniform->stage[s].first + e;
            pass_texture(context, s == GLSL_VERTEX ? TRIPTYCH_VERTEX_SAMPLER + i : i,
                         context->texture[program->unit[s][i]][dimension]);
        }
}

/* A texture can change without this context: another one of its group draws to it, or uploads texels. Only
 * its contents do, and a draw of another context makes everything late. */
static void pass_textures(struct gl_context *context)
{
    const struct gl_program *program = context->program;
    for (unsigned i = 0; i < program->program->uniforms; i++)
        if (glsl_is_sampler(program->program->uniform[i].type))
            pass_uniform(context, program, program->program->uniform + i);
}

/* --- Programs --- */

static void pass_constants(struct gl_context *context, struct gl_program *program, bool all)
{
    for (unsigned s = 0; s < GLSL_STAGES; s++) {
        struct gl_constants *constants = &program->constants[s];
        unsigned first = all ? 0 : constants->first, last = all ? constants->used : constants->last;
        if (last > first)
            triptych_set_shader_floats(context->renderer,
                                       s == GLSL_VERTEX ? TRIPTYCH_SHADER_VERTEX : TRIPTYCH_SHADER_PIXEL,
                                       first, constants->value[first], last - first);
        constants->first = constants->last = 0;
    }
}

static void pass_program(struct gl_context *context)
{
    struct gl_program *program = context->program;
    bool all = context->late & GL_LATE_SHADERS;
    if (all) {
        triptych_set_vertex_shader(context->renderer, program->stage[GLSL_VERTEX]);
        triptych_set_pixel_shader(
            context->renderer,
            gl_program_pixel(context, program, (enum gl_form)context->form, context->turned));
    }
    gl_uniforms_set_range(program, context->values.depth_range);
    pass_constants(context, program, all);
    context->late &= ~(unsigned)(GL_LATE_SHADERS | GL_LATE_PROGRAM);
}

/* A texture of the renderer that is made again, for a sampler or a target, concerns both. */
static bool prepare_images(struct gl_context *context, struct gl_target *target)
{
    for (int i = 0; i < 3; i++) {
        if (context->late & GL_LATE_TEXTURES) {
            context->late &= ~(unsigned)GL_LATE_TEXTURES;
            pass_textures(context);
        }
        if (context->late & GL_LATE_TARGET &&
            gl_framebuffer_target(context, false, target) != GL_FRAMEBUFFER_COMPLETE)
            return false;
        if (!(context->late & GL_LATE_TEXTURES))
            break;
    }
    return true;
}

bool gl_prepare_draw(struct gl_context *context, struct gl_target *target)
{
    if (!prepare_images(context, target) || !gl_prepare_target(context, target))
        return false;
    if (context->late & GL_LATE_RASTER)
        gl_prepare_raster(context, target);
    if (context->late & (GL_LATE_SHADERS | GL_LATE_PROGRAM))
        pass_program(context);
    context->late &= ~(unsigned)GL_LATE_RASTER;
    return true;
}
