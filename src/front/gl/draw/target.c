/* Targets and areas: what a draw or a clear passes on to the renderer first. */
#include "front/gl/draw/prepare.h"
#include "front/gl/state.h"

static void pass_conventions(triptych_device *renderer)
{
    triptych_set_convention(renderer, TRIPTYCH_PIXEL_CENTER, TRIPTYCH_PIXEL_CENTER_HALF);
    triptych_set_convention(renderer, TRIPTYCH_MULTIPLY, TRIPTYCH_MULTIPLY_IEEE);
    triptych_set_convention(renderer, TRIPTYCH_POINT_CLIP, TRIPTYCH_POINT_CLIP_VIEWPORT);
    triptych_set_convention(renderer, TRIPTYCH_DEPTH_BIAS_UNIT, TRIPTYCH_DEPTH_BIAS_UNIT_SMALLEST);
    triptych_set_convention(renderer, TRIPTYCH_CUBE_ADDRESS, TRIPTYCH_CUBE_ADDRESS_SAMPLER);
    triptych_set_convention(renderer, TRIPTYCH_PROVOKING_VERTEX, TRIPTYCH_PROVOKING_VERTEX_LAST);
    triptych_set_convention(renderer, TRIPTYCH_MAGNIFY_LIMIT, TRIPTYCH_MAGNIFY_LIMIT_HALF);
    triptych_set_convention(renderer, TRIPTYCH_SPRITE_ORIGIN, TRIPTYCH_SPRITE_ORIGIN_LAST);
}

/* How clip space lies in the window: EXT_clip_control. */
static void pass_clip(struct gl_context *context)
{
    bool lower = context->values.clip_origin[0] == GL_LOWER_LEFT_EXT;
    bool minus = context->values.clip_depth[0] == GL_NEGATIVE_ONE_TO_ONE_EXT;
    triptych_set_convention(context->renderer, TRIPTYCH_DEPTH_RANGE,
                            minus ? TRIPTYCH_DEPTH_RANGE_MINUS : TRIPTYCH_DEPTH_RANGE_ZERO);
    triptych_set_convention(context->renderer, TRIPTYCH_WINDOW_ORIGIN,
                            lower ? TRIPTYCH_WINDOW_ORIGIN_LOWER : TRIPTYCH_WINDOW_ORIGIN_UPPER);
}

static unsigned side_of(int64_t first, int64_t last)
{
    return last > first ? (unsigned)(last - first) : 0;
}

static void pass_areas(struct gl_context *context)
{
    const struct gl_values *values = &context->values;
    const GLint *s = values->scissor, *v = values->viewport;
    struct triptych_viewport viewport = {.x = (float)v[0],
                                         .y = (float)v[1],
                                         .width = (float)v[2],
                                         .height = (float)v[3],
                                         .depth_near = values->depth_range[0],
                                         .depth_far = values->depth_range[1]};
    unsigned left = s[0] > 0 ? (unsigned)s[0] : 0, bottom = s[1] > 0 ? (unsigned)s[1] : 0;
    pass_clip(context);
    triptych_set_viewport(context->renderer, &viewport);
    triptych_set_scissor(context->renderer, left, bottom, side_of(left, (int64_t)s[0] + s[2]),
                         side_of(bottom, (int64_t)s[1] + s[3]));
}

/* The depth and the stencil of two images in one surface. */
static bool join(struct gl_context *context, const struct gl_target *target,
                 struct triptych_target_surfaces *surfaces)
{
    *surfaces = target->surfaces;
    if (target->depth && target->stencil && !gl_depth_join(context->share, target->depth, target->stencil)) {
        gl_error(context, GL_OUT_OF_MEMORY, "no memory for a copy of stencil");
        return false;
    }
    if (target->depth || target->stencil)
        surfaces->depth = (target->depth ? target->depth : gl_depth_host(target->stencil))->surface;
    return true;
}

static bool pass_surfaces(struct gl_context *context, const struct gl_target *target)
{
    struct triptych_target_surfaces surfaces;
    if (!join(context, target, &surfaces) ||
        !gl_renderer_did(context, triptych_set_target_surfaces(context->renderer, &surfaces)))
        return false;
    context->moves = context->share->moves;
    return true;
}

bool gl_prepare_target(struct gl_context *context, const struct gl_target *target)
{
    triptych_device *renderer = context->renderer;
    if (!target->colors && !target->depth_bits && !target->stencil_bits)
        return false;
    if (context->late & GL_LATE_TARGET || context->moves != context->share->moves) {
        pass_conventions(renderer);
        if (!pass_surfaces(context, target))
            return false;
        /* New targets reset the areas, and decide on tests and masks. */
        context->late = (context->late & ~(unsigned)GL_LATE_TARGET) | GL_LATE_AREA | GL_LATE_RASTER;
    }
    if (context->late & GL_LATE_AREA)
        pass_areas(context);
    context->late &= ~(unsigned)GL_LATE_AREA;
    triptych_set_state(renderer, TRIPTYCH_STATE_SCISSORTESTENABLE, context->values.scissor_test[0]);
    return true;
}
